// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace morph
{
using Index = std::int64_t; ///< node and cell ids; the same width as vtkIdType

/// n x 3 coordinates or vectors, one row per node: the memory layout of a double vtkPoints array.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Read-only argument: binds to Points and to an Eigen::Map over foreign memory without a copy.
using ConstPoints = Eigen::Ref<const Points>;

/// A mesh in VTK's numbering: cell types are VTK's, and so is the order of the nodes in a cell.
struct Mesh
{
  Points points;                   ///< #nodes x 3
  std::vector<std::uint8_t> types; ///< #cells, VTK cell types (see CellShape.h)
  std::vector<Index> offsets;      ///< #cells + 1, where each cell starts in `connectivity`
  std::vector<Index> connectivity; ///< node ids of all cells, one cell after another

  Index numberOfNodes() const { return static_cast<Index>(this->points.rows()); }
  Index numberOfCells() const { return static_cast<Index>(this->types.size()); }
  const Index* cell(Index id) const { return this->connectivity.data() + this->offsets[id]; }
  Index cellSize(Index id) const { return this->offsets[id + 1] - this->offsets[id]; }
};

/// Throws Error unless every array has a consistent length, every node id exists, every coordinate
/// is finite, and every cell has the number of nodes its type asks for. Cells of a type that is not in
/// CellShape.h (polyhedra, for instance) are named. Cost: one pass over the mesh.
void validate(const Mesh& mesh);
}
