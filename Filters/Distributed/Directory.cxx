// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Directory.h"

#include "Support/Error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace morph::distributed
{
namespace
{
double distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
}

Directory::Directory(const Ranks& ranks, const std::vector<NodeRecord>& nodes, double tolerance)
  : ranks_(ranks)
{
  std::vector<std::vector<NodeRecord>> to(ranks.count());
  for (const NodeRecord& node : nodes)
  {
    to[this->place(node.id)].push_back(node);
  }
  const auto met = ranks.exchange(to);
  struct Known
  {
    NodeRecord node;
    int rank;
  };
  std::vector<Known> known;
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (const NodeRecord& node : met[r])
    {
      known.push_back({ node, r });
    }
  }
  std::sort(known.begin(), known.end(),
    [](const Known& a, const Known& b)
    { return std::tie(a.node.id, a.rank) < std::tie(b.node.id, b.rank); });
  std::vector<Index> apart, twice;
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const Known& entry = known[i];
    this->entries_.push_back({ entry.node.id, entry.rank, entry.node.isUsed != 0 });
    if (i > 0 && known[i - 1].node.id == entry.node.id)
    {
      if (known[i - 1].rank == entry.rank)
      {
        twice.push_back(entry.node.id);
      }
      else if (!(distance(known[i - 1].node.x, entry.node.x) <= tolerance))
      {
        apart.push_back(entry.node.id);
      }
    }
  }
  ranks.together(
    [&]
    {
      if (!twice.empty())
      {
        throw Error("Two nodes of one MPI rank have the same global point id: ids " +
                    listIds(twice) + ". Make the ids again (Generate Global Ids).");
      }
      if (!apart.empty())
      {
        throw Error("Nodes of two MPI ranks have the same global point id and different "
                    "positions: ids " +
                    listIds(apart) + ". Make the ids again (Generate Global Ids).");
      }
    });
}

int Directory::place(std::int64_t id) const
{
  const std::uint64_t mixed = static_cast<std::uint64_t>(id) * 0x9E3779B97F4A7C15ULL;
  return static_cast<int>((mixed >> 32) % static_cast<std::uint64_t>(this->ranks_.count()));
}

const Directory::Entry* Directory::find(std::int64_t id) const
{
  const auto found = std::lower_bound(this->entries_.begin(), this->entries_.end(), id,
    [](const Entry& entry, std::int64_t wanted) { return entry.id < wanted; });
  return found != this->entries_.end() && found->id == id ? &*found : nullptr;
}

std::vector<int> Directory::owners(const std::vector<std::int64_t>& ids) const
{
  std::vector<std::vector<std::int64_t>> to(this->ranks_.count());
  for (std::int64_t id : ids)
  {
    to[this->place(id)].push_back(id);
  }
  const auto asked = this->ranks_.exchange(to);
  std::vector<std::vector<int>> answers(this->ranks_.count());
  for (int r = 0; r < this->ranks_.count(); ++r)
  {
    for (std::int64_t id : asked[r])
    {
      int owner = -1;
      for (const Entry* e = this->find(id); e && e != this->end() && e->id == id; ++e)
      {
        if (e->isUsed)
        {
          owner = e->rank;
          break;
        }
      }
      answers[r].push_back(owner);
    }
  }
  const auto answered = this->ranks_.exchange(answers);
  std::vector<std::size_t> next(this->ranks_.count(), 0);
  std::vector<int> result;
  result.reserve(ids.size());
  for (std::int64_t id : ids)
  {
    const int r = this->place(id);
    result.push_back(answered[r][next[r]++]);
  }
  return result;
}

std::vector<Directory::Request> Directory::requests(const std::vector<std::int64_t>& ids) const
{
  std::vector<std::vector<std::int64_t>> to(this->ranks_.count());
  for (std::int64_t id : ids)
  {
    to[this->place(id)].push_back(id);
  }
  const auto asked = this->ranks_.exchange(to);
  std::vector<std::vector<Request>> onward(this->ranks_.count());
  for (int r = 0; r < this->ranks_.count(); ++r)
  {
    for (std::int64_t id : asked[r])
    {
      for (const Entry* e = this->find(id); e && e != this->end() && e->id == id; ++e)
      {
        if (e->isUsed && e->rank != r)
        {
          onward[e->rank].push_back({ id, r });
        }
      }
    }
  }
  return join(this->ranks_.exchange(onward));
}
}
