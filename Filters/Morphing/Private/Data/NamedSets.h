// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkPointSet;
class vtkPolyData;

namespace morph::filters
{
using morph::NamedSet;

/// A zone that can be named: volume cells or, where it is a set of nodes, a number of them.
struct ListedZone
{
  std::string Name;
  std::vector<morph::Index> Cells;       ///< of this process, ascending
  morph::Index CellCount = 0, Nodes = 0; ///< of all processes

  bool operator==(const ListedZone& other) const
  {
    return this->Name == other.Name && this->Cells == other.Cells &&
           this->CellCount == other.CellCount && this->Nodes == other.Nodes;
  }
};

/// The names that the input's field data `SurfaceNames` (vtkStringArray) lists, each once.
std::vector<std::string> NamesOfSets(vtkPointSet* input);

/// For each cell of the input whether a set that its field data `SurfaceNames` lists has it.
std::vector<std::uint8_t> CellsOfNamedSets(vtkPointSet* input);

/// Those that have volume cells.
std::vector<morph::NamedCells> PartsOf(const std::vector<ListedZone>& zones);

/// The sets of points that the input's field data `SurfaceNames` lists. Those that have volume
/// cells, too, are among them; those of other cells are not. With the sets of other `processes`, of
/// which nothing may be marked here. Collective.
std::vector<morph::NamedNodes> NodeSets(
  vtkPointSet* input, const morph::Communicator& processes = morph::Communicator::alone());

/// The sets that the input's field data `SurfaceNames` (vtkStringArray) lists, by the point and
/// cell arrays of their names, which mark by values that are not zero; see morph::boundarySet(). A
/// name without arrays is left out; a set that is not on the boundary has no nodes. `mesh`,
/// `faces`: of a grid, and `firstPolygon` is 0; of a surface `mesh` has no cells, and each face is
/// a polygon, the first one the cell `firstPolygon`.
std::vector<NamedSet> FindNamedSets(vtkPointSet* input, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, morph::Index firstPolygon, std::size_t inside = 0);

/// Adds a cell array for each set to the boundary: 1 on its faces. `faceOf`: the face of each
/// polygon. Adds SurfaceNames to the field data where there are sets.
void AddNamedSets(const std::vector<NamedSet>& sets, const std::vector<morph::Index>& faceOf,
  morph::Index firstPolygon, vtkPolyData* output);
}
