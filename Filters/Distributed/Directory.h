// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Support/Types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// A node as its rank tells it to the directory.
struct NodeRecord
{
  std::int64_t id;
  std::array<double, 3> x;
  std::int64_t isUsed; ///< by a cell of the rank that is not a ghost
};

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b);

/// Which ranks use which nodes, by global id. Each rank keeps the entries of a share of the ids, so
/// none needs memory for all.
class Directory
{
public:
  /// Takes the nodes of this rank's piece. Throws Error on all ranks for a node whose positions on
  /// two ranks are farther apart than `tolerance`. Collective.
  Directory(const Ranks& ranks, const std::vector<NodeRecord>& nodes, double tolerance);

  /// The rank whose share of the ids has this one. Not collective.
  static int place(const Ranks& ranks, std::int64_t id);

  /// Returns for each of the ids the rank that owns the node: the lowest one that uses it. -1: no
  /// rank uses it. Collective, as all below.
  std::vector<int> owners(const std::vector<std::int64_t>& ids) const;

  /// Returns for each of the ids the ranks that know the node, ascending.
  std::vector<std::vector<int>> holders(const std::vector<std::int64_t>& ids) const;

  /// A rank that asks for all cells around a node.
  struct Request
  {
    std::int64_t id;
    std::int64_t rank;
  };
  /// Asks for all cells around these nodes; returns the requests of other ranks to this one, which
  /// knows the nodes.
  std::vector<Request> requests(const std::vector<std::int64_t>& ids) const;

  /// Sends each item to all ranks that know its node, those that merely have it in ghost cells
  /// included. Items have a member `id`. Returns the items for this rank.
  template <typename Item>
  std::vector<Item> route(const std::vector<Item>& items) const
  {
    std::vector<std::vector<Item>> to(this->ranks_.count()), onward = to;
    for (const Item& item : items)
    {
      to[place(this->ranks_, item.id)].push_back(item);
    }
    for (const Item& item : joined(this->ranks_.exchange(to)))
    {
      for (const Entry* e = this->find(item.id); e && e != this->end() && e->id == item.id; ++e)
      {
        onward[e->rank].push_back(item);
      }
    }
    return joined(this->ranks_.exchange(onward));
  }

private:
  struct Entry
  {
    std::int64_t id;
    int rank;
    bool isUsed;
  };

  const Entry* end() const { return this->entries_.data() + this->entries_.size(); }
  /// The first entry of an id, or null.
  const Entry* find(std::int64_t id) const;

  const Ranks& ranks_;
  std::vector<Entry> entries_; ///< sorted by id, then rank
};
}
