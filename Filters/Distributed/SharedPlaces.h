// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Directory.h"
#include "Distributed/Ranks.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// Which nodes of different ranks are one: those with equal ids, and nodes without ids where their
/// coordinates are equal, bit by bit. Nodes of one rank stay apart. Each rank keeps the entries of
/// a share of the positions. All functions but the getters are collective.
class SharedPlaces
{
public:
  using Position = std::array<double, 3>;

  struct Node
  {
    Position x;
    std::int64_t id;     ///< or -1
    std::int64_t group;  ///< nodes of different groups are never one
    std::int64_t block;  ///< that has the node, as all ranks number the blocks
    std::int64_t isUsed; ///< by a cell of the rank that is not a ghost
  };

  /// Returns an id that nodes farther apart than `tolerance` have, or -1; all ranks get the same.
  static std::int64_t contradiction(
    const Ranks& ranks, const std::vector<Node>& nodes, double tolerance);

  /// Throws Error on all ranks where positions leave doubt which nodes are one.
  SharedPlaces(const Ranks& ranks, const std::vector<Node>& nodes);

  /// #nodes: the given ids and, for nodes without, new ones beyond these.
  const std::vector<std::int64_t>& ids() const { return this->ids_; }
  /// How many nodes of the whole mesh are at the place of another block's node.
  Index coinciding() const { return this->coinciding_; }

  struct Place
  {
    Position x;
    std::int64_t id; ///< or -1
  };
  /// Returns the id of the node at each place: of several that with the place's id, or the first.
  /// -1 where no rank has one.
  std::vector<std::int64_t> find(const std::vector<Place>& places) const;

  /// The ranks that have the nodes. Made at the first call, 40 bytes a node.
  const Directory& directory() const;
  /// #nodes: whether another rank has the node.
  std::vector<std::uint8_t> isShared() const;

private:
  struct Met
  {
    Position x;
    std::int64_t group, block, isGhost;
    std::int64_t id;
    int rank;
    Index number; ///< in the order of what the rank sent
  };
  std::string numberPlaces(std::int64_t firstNew, std::int64_t& news);

  const Ranks& ranks_;
  std::vector<std::int64_t> ids_;
  Index coinciding_ = 0;
  std::vector<Met> met_; ///< at this rank's share of the places, sorted
  mutable std::unique_ptr<const Directory> directory_;
};
}
