// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
/// Faces inside of a mesh on which two-dimensional cells lie. Each is the lower of its cells with
/// the face's number, as in BoundaryFaces::sides, ascending.
struct InnerFaces
{
  using Places = std::vector<std::pair<Index, int>>;
  Places baffles; ///< under two cells or more, one for each side
  Places sheets;  ///< under one

  std::size_t size() const { return this->baffles.size() + this->sheets.size(); }
};

using Corners = std::vector<Index>; ///< ascending

Corners sortedCorners(const Index* begin, const Index* end);

/// The corners of a boundary face that its cell has, without those on edges that are divided.
/// `mesh`: with the cells of the faces.
Corners cornersOfCell(const Mesh& mesh, const BoundaryFaces& faces, Index face);

/// How many of the two-dimensional cells that are marked have these corners. `isMarked`: #cells.
std::map<Corners, int> flatCells(const Mesh& mesh, const std::vector<std::uint8_t>& isMarked);

/// Returns those under the cells that `isMarked`, #cells; two-dimensional ones alone count.
/// `outer`: the mesh's boundaryFaces(). Cost: n log n for n marked cells and outer faces and, if
/// some lie inside, that of faceTable().
InnerFaces innerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<std::uint8_t>& isMarked, Monitor& monitor);

/// Cells with a name: a block, a region or an element set.
struct NamedCells
{
  std::string name;
  std::vector<Index> cells; ///< volume cells, ascending
};

/// A set of nodes with a name.
struct NamedNodes
{
  std::string name;
  std::vector<std::uint8_t> isNode; ///< #nodes

  bool operator==(const NamedNodes& other) const
  {
    return this->name == other.name && this->isNode == other.isNode;
  }
};

/// Faces inside of a mesh that a name stands for.
struct InnerSurface
{
  std::string name;
  InnerFaces::Places places; ///< ascending
};

/// Returns those between two parts, "a | b", by the numbers of the parts, which have no common
/// cell. Then those of the sets that mark nodes inside, all of them on inner faces whose corners
/// are marked, and neither a whole cell nor a whole outer face. Cost: a pass over the parts' cells
/// and faceTable(), if there are two parts or a set, and a pass over the faces for each set.
std::vector<InnerSurface> innerSurfaces(const Mesh& mesh, const std::vector<NamedCells>& parts,
  const std::vector<NamedNodes>& sets, Monitor& monitor);

/// Returns cells of this process, ascending. A mesh of these alone, of the two-dimensional cells
/// and of those behind the `outer` faces has the same innerFaces() and innerSurfaces() as the whole
/// mesh. They are the volume cells around nodes where parts meet, of sets that may be surfaces, and
/// of two-dimensional cells inside; and one cell for each way in which parts overlap, and for each
/// set that has a whole cell. On several processes `mesh` has copies of the cells around its nodes,
/// and parts and sets have the same names in the same order; of a process's own cells and nodes
/// each has its own. Flags may end before copies. Collective. Cost: passes over the cells, one for
/// each set, and messages of 8 bytes for each copy.
std::vector<Index> cellsAtInnerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<NamedCells>& parts, const std::vector<NamedNodes>& sets,
  std::vector<std::uint8_t> isMarked, const Communicator& processes, Monitor& monitor);
}
