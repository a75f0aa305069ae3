// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/InputBoundary.h"
#include "Private/Displace/Motion.h"

class vtkDataArraySelection;
class vtkPolyData;
class vtkUnstructuredGrid;

/// What a view shows: a mesh's boundary with its surfaces, and a motion before it is made.
namespace morph::filters::Views
{
/// The cell array, active scalars, with the id of each face's surface.
inline constexpr const char* SurfaceName = "SurfaceId";

/// Makes `output` the faces of `boundary`, as vtkBoundaryDisplacement writes it, with the points
/// and point arrays of `grid`: a point keeps its id. The cell array MorphCellId names the cell
/// behind each face. Cost: one pass over the faces.
void Boundary(vtkUnstructuredGrid* grid, vtkPolyData* boundary, vtkUnstructuredGrid* output);

/// Makes `output` a shallow copy of `boundary` with that array.
void Boundary(vtkPolyData* boundary, vtkPolyData* output);

/// Makes `output` the polygons of the surfaces that `names` enables, at the targets of the motion,
/// and a dozen arrows to there from their undeformed places. Empty where nothing moves, or where
/// the motion is an error, as the execution then says. `motion`: without Given. Cost: that of
/// Motion::Targets(), and a pass over the faces.
void Preview(const InputBoundary& model, vtkDataArraySelection* names,
  const Motion::Options& motion, vtkPolyData* output);
}
