// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Halo.h"

#include <algorithm>
#include <iterator>

namespace morph::distributed
{
namespace
{
/// Sends `columns` doubles of each node in `lists`, one list a target, and receives the same of
/// `others`, one list a source.
template <typename Get, typename Put>
void carry(const Ranks& ranks, int columns, const std::vector<int>& targets,
  const std::vector<std::vector<Index>>& lists, const std::vector<int>& sources,
  const std::vector<std::vector<Index>>& others, const Get& get, const Put& put)
{
  std::vector<std::vector<double>> from(lists.size()), into(others.size());
  for (std::size_t i = 0; i < lists.size(); ++i)
  {
    from[i].reserve(lists[i].size() * columns);
    for (Index node : lists[i])
    {
      for (int j = 0; j < columns; ++j)
      {
        from[i].push_back(get(node, j));
      }
    }
  }
  for (std::size_t i = 0; i < others.size(); ++i)
  {
    into[i].resize(others[i].size() * columns);
  }
  ranks.exchangeNeighbors(targets, from, sources, into);
  for (std::size_t i = 0; i < others.size(); ++i)
  {
    const double* value = into[i].data();
    for (Index node : others[i])
    {
      for (int j = 0; j < columns; ++j)
      {
        put(node, j, *value++);
      }
    }
  }
}
}

Halo::Halo(const Ranks& ranks, const std::vector<std::int64_t>& ids, const std::vector<int>& owner,
  const std::function<Index(std::int64_t id)>& localOf)
{
  std::vector<std::vector<std::int64_t>> wanted(ranks.count());
  std::vector<std::vector<Index>> ghosts(ranks.count());
  for (std::size_t n = 0; n < ids.size(); ++n)
  {
    if (owner[n] >= 0 && owner[n] != ranks.rank())
    {
      wanted[owner[n]].push_back(ids[n]);
      ghosts[owner[n]].push_back(static_cast<Index>(n));
    }
  }
  std::vector<std::vector<Index>> sends;
  for (const std::vector<std::int64_t>& asked : ranks.exchange(wanted))
  {
    std::transform(asked.begin(), asked.end(), std::back_inserter(sends.emplace_back()), localOf);
  }
  *this = Halo(sends, ghosts);
}

Halo::Halo(
  const std::vector<std::vector<Index>>& sends, const std::vector<std::vector<Index>>& receives)
{
  for (std::size_t r = 0; r < sends.size(); ++r)
  {
    if (!sends[r].empty())
    {
      this->targets_.push_back(static_cast<int>(r));
      this->sends_.push_back(sends[r]);
    }
    if (!receives[r].empty())
    {
      this->sources_.push_back(static_cast<int>(r));
      this->receives_.push_back(receives[r]);
    }
  }
}

void Halo::update(const Ranks& ranks, std::vector<double>& values) const
{
  carry(
    ranks, 1, this->targets_, this->sends_, this->sources_, this->receives_,
    [&](Index node, int) { return values[node]; },
    [&](Index node, int, double value) { values[node] = value; });
}

void Halo::add(const Ranks& ranks, Points& values) const
{
  carry(
    ranks, 3, this->sources_, this->receives_, this->targets_, this->sends_,
    [&](Index node, int j) { return values(node, j); },
    [&](Index node, int j, double value) { values(node, j) += value; });
  for (const std::vector<Index>& list : this->receives_)
  {
    for (const Index node : list)
    {
      values.row(node).setZero();
    }
  }
}

void Halo::update(const Ranks& ranks, Points& values) const
{
  carry(
    ranks, 3, this->targets_, this->sends_, this->sources_, this->receives_,
    [&](Index node, int j) { return values(node, j); },
    [&](Index node, int j, double value) { values(node, j) = value; });
}

void Halo::minimum(const Ranks& ranks, std::vector<double>& values) const
{
  carry(
    ranks, 1, this->sources_, this->receives_, this->targets_, this->sends_,
    [&](Index node, int) { return values[node]; },
    [&](Index node, int, double value) { values[node] = std::min(values[node], value); });
  this->update(ranks, values);
}
}
