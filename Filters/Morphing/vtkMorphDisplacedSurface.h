// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkMorphDisplacedSurface_h
#define vtkMorphDisplacedSurface_h

#include "vtkMorphSpread.h"

class vtkPointSet;
class vtkPolyData;

/// A boundary at its new places, as vtkBoundaryDisplacement writes it.
namespace vtkMorphDisplacedSurface
{
/// Makes `output` a shallow copy of model.Surface() with new points and the point arrays Role and
/// BoundaryDisplacement. `input`: what `model` was made from; with `precision`, vtkAlgorithm::SINGLE_PRECISION and so
/// on, it tells the type of the points.
void Write(const vtkMorphBoundaryModel& model, const vtkMorphSpread::Result& result,
  vtkPointSet* input, int precision, vtkPolyData* output);
}

#endif
