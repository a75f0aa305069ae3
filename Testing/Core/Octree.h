// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <array>
#include <map>
#include <vector>

namespace meshes
{
/// A box of cubes, some of them in eight, some of these in eight again, and the nodes that hang.
struct Octree
{
  using Place = std::array<int, 3>; ///< in eighths of a cube
  /// A node on a hexahedron that is none of its nodes.
  struct Hanging
  {
    Index node;
    std::vector<Index> masters; ///< of the face or edge that it lies on
    std::vector<double> weights;
  };

  static constexpr int Width = 3, Height = 2; ///< cubes before refinement, unless given

  Mesh mesh;
  std::map<Place, Index> nodeAt;
  std::vector<Hanging> hanging;

  /// `order`: 1, or 2 for hexahedra of 20 nodes; 0: as 1, with every third one as a polyhedron.
  /// `cubes`: along each side, 2 of them at least.
  explicit Octree(unsigned seed, int order = 1, const Place& cubes = { Width, Width, Height });

  /// The nodes on the sides of the box, ascending.
  std::vector<Index> outer() const;

  /// The largest distance of a node that hangs from its place on its face or edge.
  double gap(const Points& points) const;

private:
  Place cubes_;

  Index node(const Place& place);
  void findHanging(const Place& low, int size, int order);
};

/// 3 x 3 x 1 hexahedra of 20 nodes under one of three times their size, whose nodes between corners
/// are no corners of the small ones.
Mesh dividedInThree();
}
