// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// Carries values of nodes, or of cells, from their owners to the ranks that have them as ghosts,
/// and back.
class Halo
{
public:
  Halo() = default;
  /// `ids`: #nodes global ids. `owner`: #nodes ranks, -1 for a node without one. `localOf`: the
  /// node of an id, which this rank owns. Collective, as all below.
  Halo(const Ranks& ranks, const std::vector<std::int64_t>& ids, const std::vector<int>& owner,
    const std::function<Index(std::int64_t id)>& localOf);
  /// `sends`: for each rank what it has of this one, `receives`: what this one has of it, in the
  /// same order. Not collective.
  Halo(
    const std::vector<std::vector<Index>>& sends, const std::vector<std::vector<Index>>& receives);

  /// Overwrites the ghosts' rows with those of their owners; #nodes x 3.
  void update(const Ranks& ranks, Points& values) const;
  void update(const Ranks& ranks, std::vector<double>& values) const;
  /// Adds the ghosts' rows to those of their owners, and sets the ghosts' to zero.
  void add(const Ranks& ranks, Points& values) const;
  /// Sets each owner's value to the minimum over all ranks that have the node, and then the
  /// ghosts' to the owner's.
  void minimum(const Ranks& ranks, std::vector<double>& values) const;

private:
  std::vector<int> targets_, sources_;
  std::vector<std::vector<Index>> sends_;    ///< a list of owned nodes for each target
  std::vector<std::vector<Index>> receives_; ///< a list of ghosts for each source
};
}
