// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/InputBoundary.h"
#include "Private/Displace/Motion.h"

class vtkDataArraySelection;
class vtkPolyData;

/// What a view shows of a motion before it is made.
namespace morph::filters::Preview
{
/// Makes `output` the polygons of the surfaces that `names` enables, at the targets of the motion,
/// and a dozen arrows to there from their undeformed places. Empty where nothing moves, or where
/// the motion is an error, as the execution then says. `motion`: without Given. Cost: that of
/// Motion::Targets(), and a pass over the faces.
void Write(const InputBoundary& model, vtkDataArraySelection* names, const Motion::Options& motion,
  vtkPolyData* output);
}
