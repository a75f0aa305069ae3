// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/Surroundings.h"

class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
class InputBoundary;
}

/// Writes a boundary at its new positions, the output of vtkBoundaryDisplacement.
namespace morph::filters::DisplacedSurface
{
/// Makes `output` a shallow copy of model.Surface() with new points, the point arrays Role and
/// BoundaryDisplacement, and the cell array Role. `input`: the data that `model` was made from;
/// with `precision`, vtkAlgorithm::SINGLE_PRECISION and so on, it determines the type of the
/// points.
void Write(const InputBoundary& model, const Surroundings::Result& result, vtkPointSet* input,
  int precision, vtkPolyData* output);

/// Adds inner nodes of a mesh to `output` as points without cells. `nodes`: ids in `grid`; `rest`,
/// `moved`: #nodes x 3; `roles`: #nodes. Arrays that the grid has too get its values, those that
/// the filters add theirs, and others 0.
void AppendInner(vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes,
  const morph::Points& rest, const morph::Points& moved, const std::vector<signed char>& roles,
  vtkPolyData* output);
}
