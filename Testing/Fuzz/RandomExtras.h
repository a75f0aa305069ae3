// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RandomBoundary.h"
#include "RandomGrid.h"

class vtkAlgorithm;
class vtkBoundaryDisplacement;

namespace fuzz
{
/// What else a filter takes. All return whether what they made is right.

/// A target surface for vtkMorphBoundary; null for none.
bool randomTarget(Choices& choices, const RandomGrid& grid, vtkSmartPointer<vtkDataObject>& target);
/// What moves and how: transform, region, selection, patches, displacement array.
bool setMotion(Choices& choices, const RandomGrid& grid, vtkBoundaryDisplacement* filter,
  vtkSmartPointer<vtkDataObject>& selection);
/// The point vectors `Gradient`, on a copy of the grid.
bool randomGradient(
  Choices& choices, const RandomGrid& grid, vtkSmartPointer<vtkDataObject>& carrier);
/// Of a boundary on port 0 of vtkBoundaryDisplacement: the grid's boundary as Extract Morph
/// Boundary writes it, or what another filter left of it.
vtkSmartPointer<vtkDataObject> boundaryOfGrid(Choices& choices, const RandomGrid& grid);
}
