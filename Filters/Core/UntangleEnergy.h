// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Objective.h"
#include "TargetShapes.h"
#include "Topology.h"

#include <vector>

namespace morph
{
/// The untangling objective of P. M. Knupp, "Hexahedral and tetrahedral mesh untangling", Engineering with Computers 17
/// (2001) 261-268: the mean over all tetrahedra of (|d - b| - (d - b))^2, where d is the tetrahedron's determinant
/// relative to its target's (his alpha over a volume, so that the sizes of the mesh and of its cells do not matter)
/// and b the margin. It is 0, and flat, once all determinants are above the margin: what it leaves are barely
/// valid cells, so a shape measure has to follow. Tetrahedra without a free node and those of weight 0 are left out.
class UntangleEnergy : public Objective
{
public:
  /// `free`: ids of the nodes that move, ascending. `margin`: b, relative to the targets' volumes.
  /// Cost: passes over the tetrahedra; about 110 bytes each.
  UntangleEnergy(
    const Mesh& mesh, const std::vector<Index>& free, const TargetShapes& targets, double margin);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;

private:
  struct Tetrahedron
  {
    Index node[4];
    double volume; ///< 1 / determinant of the target, with its sign
  };
  Eigen::Matrix3d edges(const Tetrahedron& tetrahedron, const Points& points) const;

  std::vector<Index> free_;
  double margin_;
  std::vector<Tetrahedron> tetrahedra_;
  Adjacency uses_; ///< #free: 4 times the tetrahedron plus the corner
};
}
