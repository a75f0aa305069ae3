// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "BoundaryMorphing/Target.h"
#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Surroundings.h"
#include "Geometry/TriangleTree.h"
#include "Support/Monitor.h"

#include <Eigen/Geometry>

#include <map>
#include <set>
#include <string>
#include <vector>

/// Moves a part of a boundary onto a target surface.

namespace morph
{
/// Returns the rotation and shift that lays the triangles of `surface` on those of `onto`; both
/// have some. `landmarks`: points of the surface, of which some hundred are taken, evenly from all.
/// Iterative closest points, each by Umeyama's least squares (IEEE Trans. PAMI 13 (1991) 376-380),
/// run from six starts: the current place, equal centers, and the four rotations that turn
/// principal axes into each other. The start that ends with the least mean distance is taken; of
/// nearly equal ones the first, which turns it less. A symmetric surface may so be turned about its
/// symmetry. Cost: some 70,000 searches at most.
Eigen::Isometry3d alignment(
  const TriangleTree& surface, const Points& landmarks, const TriangleTree& onto, Monitor& monitor);

/// The rotation and shift that lays a target on the boundary, or on what moves of it. `choice`:
/// what moves, or null. See alignment().
Eigen::Isometry3d alignedOnto(
  const BoundaryModel& model, const Choice* choice, const Target& target, Monitor& monitor);

/// Returns the names of the surfaces that the target belongs to. Each is the nearest one for an
/// area of the target of at least half its own. Throws Error where there is none.
std::set<std::string> surfacesNearest(const Target& target, const BoundaryModel& model);

/// The nodes on vertices and curves of what moves that are on sliding surfaces, too.
class TargetRim
{
public:
  using Row = Eigen::RowVector3d;
  TargetRim(const BoundaryModel& model, const Choice& choice, const std::vector<Index>& sliding,
    Surroundings& surroundings);

  bool has(Index node) const { return this->nodes_.count(node) > 0; }
  /// Whether surfaces that move meet there.
  bool isOnEdge(Index node) const { return this->nodes_.at(node).moving > 1; }
  /// The direction nearest to that one in which a node stays on its sliding surfaces, of unit
  /// length.
  Row along(Index node, const Row& direction) const;
  /// Finds the point near `x` on the sliding surfaces and where `find`(x, y) leads to, by
  /// alternating projections. Returns false where that leads nowhere. Several threads may call
  /// it.
  template <typename Find>
  bool meet(Index node, const Row& x, const Find& find, Row& y) const
  {
    constexpr int Rounds = 100;
    y = x;
    for (int round = 0; round < Rounds; ++round)
    {
      Row there;
      if (!find(y, there))
      {
        return false;
      }
      y = this->surfaces_.slid(
        this->model_, this->nodes_.at(node).sliding, this->model_.points().row(node), there);
      if ((y - there).norm() <= 1e-14 * this->model_.size)
      {
        break;
      }
    }
    return true;
  }

private:
  struct Node
  {
    std::vector<Index> sliding; ///< surfaces
    int moving = 0;             ///< surfaces with faces that move
  };
  const BoundaryModel& model_;
  Surroundings& surfaces_;
  std::map<Index, Node> nodes_;
};

/// Returns the positions of choice.moving on the target, #moving x 3. Without `along` vertices go
/// to vertices of the target, then curves to its feature edges, then surfaces follow and go to the
/// target, as projectCurves() and projectSurfaces() move them. What has no such place within reach
/// goes to the nearest place of the target. So does a vertex if another one is nearer to its place,
/// and a curve if another one is less than half as far from the edge. Else each node goes to the
/// nearest place of the target along this direction, or its normal if that is zero; what has none
/// follows the others, but for vertices, which stay. Nodes on surfaces that slide, by their numbers
/// in `sliding`, go to places that are on both. Of a layer the front goes there, and its images
/// along with it. The target is oriented by the nodes that move. A warning names nodes that do not
/// reach the target. Throws Error where none does.
Points fittedTo(Target& target, const BoundaryModel& model, const Choice& choice,
  const std::vector<Index>& sliding, const Eigen::RowVector3d* along, Surroundings& surroundings,
  Monitor& monitor);
}
