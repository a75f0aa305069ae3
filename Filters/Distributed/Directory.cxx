// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Directory.h"

#include "Support/Error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace morph::distributed
{
double distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Directory::Directory(const Ranks& ranks, const std::vector<NodeRecord>& nodes, double tolerance)
  : ranks_(ranks)
{
  std::vector<std::vector<NodeRecord>> to(ranks.count());
  for (const NodeRecord& node : nodes)
  {
    to[place(ranks, node.id)].push_back(node);
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

int Directory::place(const Ranks& ranks, std::int64_t id)
{
  const std::uint64_t mixed = static_cast<std::uint64_t>(id) * 0x9E3779B97F4A7C15ULL;
  return static_cast<int>((mixed >> 32) % static_cast<std::uint64_t>(ranks.count()));
}

const Directory::Entry* Directory::find(std::int64_t id) const
{
  const auto found = std::lower_bound(this->entries_.begin(), this->entries_.end(), id,
    [](const Entry& entry, std::int64_t wanted) { return entry.id < wanted; });
  return found != this->entries_.end() && found->id == id ? &*found : nullptr;
}

std::vector<int> Directory::owners(const std::vector<std::int64_t>& ids) const
{
  return this->ranks_.ask<int>(
    ids, [this](std::int64_t id) { return place(this->ranks_, id); },
    [this](const std::vector<std::vector<std::int64_t>>& asked)
    {
      std::vector<std::vector<int>> answers(asked.size());
      for (std::size_t r = 0; r < asked.size(); ++r)
      {
        for (const std::int64_t id : asked[r])
        {
          const Entry* entry = this->find(id);
          while (entry && entry != this->end() && entry->id == id && !entry->isUsed)
          {
            ++entry;
          }
          const bool isOwned = entry && entry != this->end() && entry->id == id;
          answers[r].push_back(isOwned ? entry->rank : -1);
        }
      }
      return answers;
    });
}

std::vector<std::vector<int>> Directory::holders(const std::vector<std::int64_t>& ids) const
{
  struct Question
  {
    std::int64_t id, rank, number;
  };
  std::vector<Question> questions;
  for (const std::int64_t id : ids)
  {
    questions.push_back({ id, this->ranks_.rank(), static_cast<Index>(questions.size()) });
  }
  std::vector<std::vector<std::int64_t>> known(this->ranks_.count());
  for (const Question& question : this->route(questions))
  {
    known[question.rank].push_back(question.number);
  }
  known = this->ranks_.exchange(known);
  std::vector<std::vector<int>> result(ids.size());
  for (int r = 0; r < this->ranks_.count(); ++r)
  {
    for (const std::int64_t number : known[r])
    {
      result[number].push_back(r);
    }
  }
  return result;
}

std::vector<Directory::Request> Directory::requests(const std::vector<std::int64_t>& ids) const
{
  std::vector<Request> asked;
  for (const std::int64_t id : ids)
  {
    asked.push_back({ id, this->ranks_.rank() });
  }
  asked = this->route(asked);
  asked.erase(std::remove_if(asked.begin(), asked.end(),
                [this](const Request& request) { return request.rank == this->ranks_.rank(); }),
    asked.end());
  return asked;
}
}
