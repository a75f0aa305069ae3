// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/Surroundings.h"

class vtkPointSet;
class vtkPolyData;

/// A boundary at its new places, as vtkBoundaryDisplacement writes it.
namespace morph::filters::DisplacedSurface
{
/// Makes `output` a shallow copy of model.Surface() with new points and the point arrays Role and
/// BoundaryDisplacement. `input`: what `model` was made from; with `precision`,
/// vtkAlgorithm::SINGLE_PRECISION and so on, it tells the type of the points.
void Write(const BoundaryModel& model, const Surroundings::Result& result, vtkPointSet* input,
  int precision, vtkPolyData* output);
}
