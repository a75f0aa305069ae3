// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

/// Writes the outer boundary of a grid as polygons that keep their node ids.
namespace morph::filters::Surface
{
/// The point arrays that vtkExtractMorphBoundary writes.
constexpr const char* IdName = "MorphPointId";
/// Four components, X, Y, Z and 1: vtkTransformFilter, as ParaView's Transform runs it, takes every
/// point array of three components for a vector and would rotate it.
constexpr const char* RestName = "RestPosition";
/// A point array of a displaced boundary: where it is not 0 the node is solved with the interior.
constexpr const char* FreeName = "MorphFree";

/// Fills `output` with faces.nodes as points, undeformed, and the faces as polygons. The arrays are
/// those of vtkExtractMorphBoundary: point arrays of the grid, MorphPointId and RestPosition, cell
/// arrays of the owning cells and MorphCellId. `mesh`, `faces`: of `grid`. `orientation`: #cells;
/// null for cellSigns() of `mesh`. Returns for each polygon the number of its face: a face of a
/// quadratic cell becomes several polygons.
std::vector<morph::Index> Write(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, vtkPolyData* output,
  const std::vector<std::int8_t>* orientation = nullptr);

/// Warns where a mesh has cells but no outer face, so that its boundary is empty.
void WarnOfNone(const morph::BoundaryFaces& faces, morph::Monitor& monitor);
}
