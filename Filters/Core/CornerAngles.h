// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Objective.h"
#include "Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// How near the corners of cells are to being flat: the mean over the corners of (least / s)^8, where s is the determinant of the
/// corner's three edges over the product of their lengths, scaled as in the cell's scaled Jacobian. So the worst corners outweigh all others,
/// and lengths do not count. Infinite, and no step may end, where an s is not positive. Of a pyramid the corners of its base.
class CornerAngles : public Objective
{
public:
  /// `cells`: ids of volume cells; `orientation`: #cells of the mesh; `free`: ids of the nodes that move, ascending; `least`: what s is
  /// held against, above 0. Cost: 50 bytes a corner.
  CornerAngles(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& cells, const std::vector<Index>& free, double least);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;

private:
  struct Corner
  {
    Index node[4]; ///< the corner, and the other ends of its edges
    double scale;  ///< of s, with the cell's sign, over `least`
  };
  /// s / least, and the three edges.
  double measure(const Corner& corner, const Points& points, Eigen::Matrix3d& edges) const;

  std::vector<Index> free_;
  std::vector<Corner> corners_;
  Adjacency uses_; ///< #free: 4 times the corner plus the place in `node`
};

/// Raises the least scaled Jacobian of a valid mesh: nodes within two rings of the worst cells move to lower their CornerAngles (L-BFGS,
/// 40 steps), for up to 6 rounds, as long as each raises it by 0.1 % or more. `free`: ids of nodes that may move, ascending; `points`:
/// #nodes x 3, in and out. The mesh stays valid. Returns the rounds that were kept. Cost: a pass over the cells a round, and the patches'.
int raiseWorstCells(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor);
}
