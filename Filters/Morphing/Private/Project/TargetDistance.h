// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

class vtkDataSet;
class vtkPolyData;

/// How far nodes are from a target surface, before and after they were moved.
namespace morph::filters::TargetDistance
{
/// Largest and mean distance, each node counting once; NaN without nodes.
struct Summary
{
  double MaxBefore, MeanBefore, Max, Mean;
};

/// Adds the point arrays TargetDistanceBefore and TargetDistance to `data`: at the points `ids` the
/// distance from `target` (triangles) of `before` and `after`, #ids x 3 each; NaN elsewhere. Cost:
/// two searches a node.
Summary Write(vtkPolyData* target, const std::vector<morph::Index>& ids,
  const morph::Points& before, const morph::Points& after, vtkDataSet* data);
}
