// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkPointSet;
class vtkPolyData;

namespace morph::filters
{
/// The part of a boundary that the mesh's file names: a node set, side set, patch or marker.
struct NamedSet
{
  std::string Name;
  std::vector<morph::Index> Nodes; ///< ascending
  std::vector<morph::Index> Faces; ///< ascending
};

/// The names that the input's field data `SurfaceNames` (vtkStringArray) lists, each once.
std::vector<std::string> NamesOfSets(vtkPointSet* input);

/// For each cell of the input whether a set that its field data `SurfaceNames` lists has it.
std::vector<std::uint8_t> CellsOfNamedSets(vtkPointSet* input);

/// The sets that the input's field data `SurfaceNames` (vtkStringArray) lists. The point array of
/// that name marks nodes, by values that are not zero: a face belongs to the set if all of its
/// corners do. The cell array marks cells: a face belongs to the set if a two-dimensional cell on
/// it does or, where no two-dimensional cell does, if the volume cell behind it does. A name
/// without arrays is left out; a set that is not on the boundary has no nodes.
/// `mesh`, `faces`: of a grid; of a surface `mesh` has no cells, and each face is a polygon, the
/// first one the cell `firstPolygon`. `inside`: how many faces, the last ones, lie inside.
std::vector<NamedSet> FindNamedSets(vtkPointSet* input, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, morph::Index firstPolygon, std::size_t inside = 0);

/// Adds a cell array for each set to the boundary: 1 on its faces. `faceOf`: the face of each
/// polygon. Adds SurfaceNames to the field data where there are sets.
void AddNamedSets(const std::vector<NamedSet>& sets, const std::vector<morph::Index>& faceOf,
  morph::Index firstPolygon, vtkPolyData* output);
}
