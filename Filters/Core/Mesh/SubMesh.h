// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A part of a mesh as a mesh of its own, so that work on it costs nothing elsewhere. Nodes and
/// cells keep their order.
struct SubMesh
{
  /// `cells`: ids of the part's cells, ascending, no polyhedra. Cost: a pass over the nodes.
  SubMesh(const Mesh& whole, const std::vector<Index>& cells);

  Mesh mesh;
  std::vector<Index> nodes; ///< their ids in the whole mesh, ascending
  std::vector<Index> cells; ///< their ids in the whole mesh, ascending

  /// Returns the numbers here of nodes of the whole mesh, -1 for those outside. `ids`: ascending.
  std::vector<Index> numbersOf(const std::vector<Index>& ids) const;
  /// Returns the part's own of `values`, one a cell of the whole mesh.
  template <typename Value>
  std::vector<Value> take(const std::vector<Value>& values) const
  {
    std::vector<Value> own;
    for (const Index c : this->cells)
    {
      own.push_back(values[c]);
    }
    return own;
  }
};
}
