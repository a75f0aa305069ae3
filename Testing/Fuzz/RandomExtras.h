// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RandomBoundary.h"
#include "RandomGrid.h"

class vtkDisplacementAlgorithm;

namespace fuzz
{
/// What else a filter takes. All return whether what they made is right.

/// A target surface with that probability; null for none.
bool randomTarget(
  Choices& choices, const RandomGrid& grid, double chance, vtkSmartPointer<vtkDataObject>& target);
/// What moves and how, but for properties that take a number: transform, regions, selection (for
/// zones, too), surfaces, zones, handles, lattice, arrays.
bool setMotion(Choices& choices, const RandomGrid& grid, vtkDisplacementAlgorithm* filter,
  vtkSmartPointer<vtkDataObject>& selection);
/// The point vectors `Gradient`, on a copy of the grid.
bool randomGradient(
  Choices& choices, const RandomGrid& grid, vtkSmartPointer<vtkDataObject>& carrier);
/// Of a boundary on port 0 of vtkBoundaryDisplacement: the grid's boundary as Extract Morph
/// Boundary writes it, or what another filter left of it.
vtkSmartPointer<vtkDataObject> boundaryOfGrid(Choices& choices, const RandomGrid& grid);
}
