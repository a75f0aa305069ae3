// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Surroundings.h"
#include "Support/Monitor.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace morph
{
/// Contact between bodies, whose nodes need not match. Nodes of a body of which nothing else is
/// asked follow their nearest place on the boundary of a body that moves. A node x above the place
/// p of a face goes to p' + R (x - p). The weights of p' in the face are those of p, and R turns
/// the face's normal into its new direction. So the gap stays, 0 exactly. Such a body may take
/// others along.
class Contact
{
public:
  struct Options
  {
    /// Nodes are in contact up to this distance from another body's boundary, in the unit of the
    /// points; 0: there is no contact.
    double distance = 0;
    std::vector<Index> surfaces; ///< on which both sides lie, ascending; empty: on any
  };
  /// The distances of the nodes in contact from the other body's boundary. Those below it are
  /// negative.
  struct Gaps
  {
    double least = 0, most = 0;
  };

  /// Finds the nodes in contact, unless the same are kept. Throws Error where there are none.
  /// Cost: a search for each node of the surfaces.
  void find(const BoundaryModel& model, const Options& options);
  /// Adds nodes in contact with faces that have moved to what moves; not those of bodies in which
  /// something moves. `result`: of `choice` and `targets`. Returns whether there are some.
  bool follow(const BoundaryModel& model, const Surroundings::Result& result, Choice& choice,
    Points& targets);
  /// Warns of nodes of bodies that nothing of `choice` is in, and whose gaps do not stay: something
  /// else moves or holds them.
  void warnOfLost(const BoundaryModel& model, const Choice& choice,
    const Surroundings::Result& result, Monitor& monitor) const;
  /// Gives the nodes that follow() has added since find() their role.
  void setRoles(Surroundings::Result& result) const;
  /// Of all nodes in contact, the boundary being at `points`, #nodes x 3. Cost: as find().
  Gaps gaps(const BoundaryModel& model, const Points& points) const;
  /// Tells the number of nodes in contact and their gaps.
  std::string report(const Gaps& before, const Gaps& after) const;

private:
  struct Pair
  {
    Index node;
    std::array<Index, 3> corners; ///< of the triangle of the nearest place
    Eigen::RowVector3d weights;
  };

  /// Whether the face of a pair has.
  static bool hasMoved(const Points& points, const Surroundings::Result& result, const Pair& pair);
  /// Where the gap of a pair stays.
  static Eigen::RowVector3d kept(
    const Points& points, const Surroundings::Result& result, const Pair& pair);

  std::int64_t version_ = -1; ///< BoundaryModel::motionVersion
  Options options_;
  std::vector<Pair> pairs_; ///< ascending
  std::vector<Index> followers_;
};
}
