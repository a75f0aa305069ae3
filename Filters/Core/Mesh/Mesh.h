// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace morph
{
/// Of a mesh of faces as a solid one layer thick, see thicken(). Node n < `nodes` of the front has
/// its image n + `nodes` behind it. The faces of front and back are no boundary, and both images of
/// a node move alike: in the plane, or in a curved shell by what the front does.
struct ShellLayer
{
  Index nodes = 0;      ///< of the front; 0: no layer
  double thickness = 1; ///< from front to back
  /// Of a plane, of length 1, from front to back. Zero: the shell is curved, or there is none.
  Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();

  bool isCurved() const { return this->nodes > 0 && this->normal.isZero(0); }

  /// The node of the front that a node, of front or back, is an image of.
  Index frontOf(Index node) const
  {
    return this->nodes > 0 && node >= this->nodes ? node - this->nodes : node;
  }
};

/// A mesh in VTK's numbering of cell types and of the nodes in a cell.
struct Mesh
{
  Points points;                      ///< #nodes x 3
  std::vector<std::uint8_t> types;    ///< #cells, VTK cell types (see CellShape.h)
  std::vector<Index> offsets = { 0 }; ///< #cells + 1, start of each cell in `connectivity`
  std::vector<Index> connectivity;    ///< node ids of all cells, one cell after another
  /// #cells + 1, start of each cell's faces in `faces`; empty where none hasFaces() (Polyhedra.h)
  std::vector<Index> faceOffsets;
  /// each face, as of a polyhedron: its number of nodes, then their ids, outward
  std::vector<Index> faces;
  ShellLayer layer;

  Index numberOfNodes() const { return static_cast<Index>(this->points.rows()); }
  Index numberOfCells() const { return static_cast<Index>(this->types.size()); }
  const Index* cell(Index id) const { return this->connectivity.data() + this->offsets[id]; }
  Index cellSize(Index id) const { return this->offsets[id + 1] - this->offsets[id]; }
  /// Appends a cell; a polyhedron's faces are not added.
  template <typename Iterator>
  void add(std::uint8_t type, Iterator first, Iterator last)
  {
    this->types.push_back(type);
    this->connectivity.insert(this->connectivity.end(), first, last);
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  }
  void add(std::uint8_t type, std::initializer_list<Index> nodes)
  {
    this->add(type, nodes.begin(), nodes.end());
  }
};

/// Throws Error unless the mesh is consistent: array lengths, node ids, finite coordinates of the
/// cells' nodes, nodes per cell, closed polyhedra. The message names cells of a type that is not in
/// CellShape.h, or of another order. Cost: a pass over the mesh.
void validate(const Mesh& mesh);

/// Throws Error where a count is 2^31 - 2^20 or more. The methods keep half of their tables in
/// 32-bit numbers and pad batches of cells. requireEntries() checks the entries of matrices when
/// they are made. `corners`: of all cells, including mid-side nodes.
void requireIndexable(Index nodes, Index cells, Index corners);
void requireIndexable(const Mesh& mesh);

/// Numbers between these bounds have sixth powers that neither overflow nor vanish.
constexpr double LargestLength = 1e50, SmallestLength = 1e-50;

/// Whether `x` is finite and not above LargestLength.
bool isModerate(const Eigen::RowVector3d& x);
/// The rows of `x` that are not moderate. `monitor`: has the threads for it, null for none.
std::vector<Index> immoderateRows(const Points& x, Monitor* monitor = nullptr);

/// The diagonal of the bounding box of the nodes that volume cells use.
double meshSize(const Mesh& mesh);
/// Throws Error unless `size` is 0 or at least SmallestLength. `size`: the largest side of a
/// bounding box; `subject`: what it bounds.
void requireExtent(double size, const char* subject);
/// Throws Error unless there are cells of dimension 3, and meshSize() is not too small. All types
/// have to be known to the core.
void requireVolumeCells(const Mesh& mesh);
}
