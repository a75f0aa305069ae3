// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SharedPlaces.h"

#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <tuple>

namespace morph::distributed
{
namespace
{
/// -0 becomes 0, so that equal places have equal bits.
SharedPlaces::Position plain(const SharedPlaces::Position& x)
{
  return { x[0] + 0., x[1] + 0., x[2] + 0. };
}

/// The rank whose share of the positions has this one.
int rankOfPlace(const SharedPlaces::Position& x, int ranks)
{
  std::uint64_t hash = 1469598103934665603ULL;
  for (const double value : x)
  {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 32;
  }
  return static_cast<int>(hash % static_cast<std::uint64_t>(ranks));
}
}

std::int64_t SharedPlaces::contradiction(
  const Ranks& ranks, const std::vector<Node>& nodes, double tolerance)
{
  std::vector<std::vector<Place>> to(ranks.count());
  for (const Node& node : nodes)
  {
    if (node.id >= 0)
    {
      to[Directory::place(ranks, node.id)].push_back({ node.x, node.id });
    }
  }
  std::vector<Place> all = joined(ranks.exchange(to));
  std::stable_sort(
    all.begin(), all.end(), [](const Place& a, const Place& b) { return a.id < b.id; });
  Index found = -1;
  for (std::size_t i = 0, first = 0; i < all.size(); ++i)
  {
    first = all[i].id == all[first].id ? first : i;
    if (!(distance(all[i].x, all[first].x) <= tolerance)) // a NaN is one, too
    {
      found = all[i].id;
    }
  }
  return ranks.maximum(found);
}

SharedPlaces::SharedPlaces(const Ranks& ranks, const std::vector<Node>& nodes)
  : ranks_(ranks)
{
  Index highest = -1;
  for (const Node& node : nodes)
  {
    highest = std::max<Index>(highest, node.id);
  }
  const std::int64_t firstNew = ranks.maximum(highest) + 1;
  std::vector<Node> sent = nodes;
  // A point of no cell may have no place, and is then apart from all others.
  std::int64_t apart = -2 - ranks.sumBefore(static_cast<Index>(nodes.size()));
  for (Node& node : sent)
  {
    if (!std::isfinite(node.x[0] + node.x[1] + node.x[2]))
    {
      node.x.fill(HUGE_VAL);
      node.group = apart--;
    }
    node.x = plain(node.x);
  }
  this->ids_ = ranks.ask<std::int64_t>(
    sent, [&](const Node& node) { return rankOfPlace(node.x, ranks.count()); },
    [&](const std::vector<std::vector<Node>>& parts)
    {
      std::vector<std::vector<std::int64_t>> answers(ranks.count());
      for (int r = 0; r < ranks.count(); ++r)
      {
        answers[r].resize(parts[r].size());
        for (std::size_t i = 0; i < parts[r].size(); ++i)
        {
          const Node& node = parts[r][i];
          this->met_.push_back({ node.x, node.group, node.block, Index(node.isUsed == 0), node.id,
            r, static_cast<Index>(i) });
        }
      }
      std::int64_t news = 0;
      const std::string problem = this->numberPlaces(firstNew, news);
      ranks.together(
        [&]
        {
          if (!problem.empty())
          {
            throw Error(problem);
          }
        });
      const std::int64_t before = ranks.sumBefore(news);
      for (Met& met : this->met_)
      {
        met.id += met.id >= firstNew ? before : 0;
        answers[met.rank][met.number] = met.id;
      }
      return answers;
    });
  this->coinciding_ = ranks.sum(this->coinciding_);
}

/// Gives nodes without ids the id of another node at the place, or new ones from `firstNew` on.
/// Counts the nodes of several blocks that coincide. Returns what leaves doubt, or "".
std::string SharedPlaces::numberPlaces(std::int64_t firstNew, std::int64_t& news)
{
  const auto key = [](const Met& m)
  {
    // Nodes with ids come first; then those of own cells, and those of ghost cells last.
    const bool hasId = m.id >= 0;
    return std::tuple(
      m.x, m.group, !hasId, hasId ? std::int64_t(0) : m.isGhost, m.block, m.id, m.rank, m.number);
  };
  std::sort(this->met_.begin(), this->met_.end(),
    [&](const Met& a, const Met& b) { return key(a) < key(b); });
  std::string problem;
  for (std::size_t first = 0, last = 0; first < this->met_.size(); first = last)
  {
    const Met& front = this->met_[first];
    const bool hasIds = front.id >= 0;
    bool isTwice = false, isShared = false;
    std::vector<std::int64_t> different;
    for (last = first; last < this->met_.size() && this->met_[last].x == front.x &&
                       this->met_[last].group == front.group;
         ++last)
    {
      const Met& met = this->met_[last];
      if (met.id >= 0)
      {
        if (std::find(different.begin(), different.end(), met.id) == different.end())
        {
          different.push_back(met.id);
          this->coinciding_ += different.size() > 1 && met.block != front.block;
        }
        continue;
      }
      const bool follows = last > first && this->met_[last - 1].id < 0;
      isTwice = isTwice || (follows && met.isGhost == 0 && met.rank == this->met_[last - 1].rank);
      isShared = isShared || hasIds || met.isGhost != 0 || met.rank != front.rank;
    }
    if (isTwice && isShared && problem.empty())
    {
      std::ostringstream text;
      text.precision(9);
      text << "Several nodes of one MPI rank and one of another are at the same position ("
           << front.x[0] << ", " << front.x[1] << ", " << front.x[2]
           << "), so positions do not tell which of them are one node. Give the mesh global point "
              "ids before it is distributed.";
      problem = text.str();
    }
    std::int64_t id = hasIds ? front.id : firstNew + news;
    bool isUsed = hasIds;
    for (std::size_t k = first; k < last; ++k)
    {
      if (this->met_[k].id < 0)
      {
        // Nodes of one rank stay apart, as the two sides of a crack.
        if (isTwice && isUsed)
        {
          id = firstNew + ++news;
        }
        this->met_[k].id = id;
        isUsed = true;
      }
    }
    news += isUsed && !hasIds ? 1 : 0;
  }
  return problem;
}

std::vector<std::int64_t> SharedPlaces::find(const std::vector<Place>& places) const
{
  const Ranks& ranks = this->ranks_;
  std::vector<Place> sent = places;
  for (Place& place : sent)
  {
    place.x = plain(place.x);
  }
  const auto nodeAt = [&](const Place& place)
  {
    std::int64_t found = -1;
    auto at = std::lower_bound(this->met_.begin(), this->met_.end(), place.x,
      [](const Met& met, const Position& x) { return met.x < x; });
    std::int64_t block = std::numeric_limits<std::int64_t>::max();
    for (; at != this->met_.end() && at->x == place.x; ++at)
    {
      if (place.id >= 0 && at->id == place.id)
      {
        return at->id;
      }
      if (at->block < block)
      {
        block = at->block;
        found = at->id;
      }
    }
    return found;
  };
  return ranks.ask<std::int64_t>(
    sent, [&](const Place& place) { return rankOfPlace(place.x, ranks.count()); },
    [&](const std::vector<std::vector<Place>>& parts)
    {
      std::vector<std::vector<std::int64_t>> answers(ranks.count());
      for (int r = 0; r < ranks.count(); ++r)
      {
        std::transform(parts[r].begin(), parts[r].end(), std::back_inserter(answers[r]), nodeAt);
      }
      return answers;
    });
}

const Directory& SharedPlaces::directory() const
{
  if (!this->directory_)
  {
    std::vector<std::int64_t> ids = this->ids_; // copies in ghost cells may have that of a node
    sortUnique(ids);
    std::vector<NodeRecord> nodes;
    for (const std::int64_t id : ids)
    {
      nodes.push_back({ id, {}, 1 });
    }
    this->directory_ = std::make_unique<const Directory>(this->ranks_, nodes, 0);
  }
  return *this->directory_;
}

std::vector<std::uint8_t> SharedPlaces::isShared() const
{
  std::vector<std::int64_t> shared;
  for (const Directory::Request& request : this->directory().requests(this->ids_))
  {
    shared.push_back(request.id);
  }
  sortUnique(shared);
  std::vector<std::uint8_t> result;
  for (const std::int64_t id : this->ids_)
  {
    result.push_back(std::binary_search(shared.begin(), shared.end(), id));
  }
  return result;
}
}
