// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkPolyData;
class vtkUnstructuredGrid;

/// A mesh's boundary with its surfaces, as a grid to look at.
namespace morph::filters::SurfaceGrid
{
/// The cell array, active scalars, with the id of each face's surface.
inline constexpr const char* SurfaceName = "SurfaceId";

/// Makes `output` the faces of `boundary`, as vtkBoundaryDisplacement writes it, with the points
/// and point arrays of `grid`: a point keeps its id. The cell array MorphCellId names the cell
/// behind each face. Cost: one pass over the faces.
void Write(vtkUnstructuredGrid* grid, vtkPolyData* boundary, vtkUnstructuredGrid* output);

/// Makes `output` a shallow copy of `boundary` with that array.
void Write(vtkPolyData* boundary, vtkPolyData* output);
}
