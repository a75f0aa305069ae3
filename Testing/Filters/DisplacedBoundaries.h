// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestGrids.h"

#include "vtkBoundaryDisplacement.h"

#include <array>

class vtkPointSet;
class vtkSelection;

/// For the tests of vtkBoundaryDisplacement.
namespace displaced
{
/// A filter with that input; null for none.
vtkSmartPointer<vtkBoundaryDisplacement> make(vtkDataObject* input);

/// First three components of the output's RestPosition, or of another point array.
morph::Points restPositions(vtkPolyData* output);
morph::Points vectors(vtkPolyData* output, const char* name);
/// The point's Role.
int role(vtkPolyData* output, vtkIdType point);

/// Points where `is` holds.
std::vector<morph::Index> nodesWhere(
  vtkPointSet* data, const std::function<bool(const grids::Row&)>& is);
/// "Surface 3": the surface whose nodes all satisfy `is` in their undeformed positions. Executes a
/// copy of the filter that moves nothing.
std::string surfaceName(
  vtkBoundaryDisplacement* filter, const std::function<bool(const grids::Row&)>& is);

/// A filter that moves the surface of which that tells.
vtkSmartPointer<vtkBoundaryDisplacement> moving(
  vtkDataObject* input, const std::function<bool(const grids::Row&)>& is);

/// A selection of points or cells (vtkSelectionNode::POINT, CELL) by their numbers.
vtkSmartPointer<vtkSelection> indices(int fieldType, const std::vector<morph::Index>& ids);
/// Of those in a box.
vtkSmartPointer<vtkSelection> frustum(int fieldType, const std::array<double, 6>& bounds);
}
