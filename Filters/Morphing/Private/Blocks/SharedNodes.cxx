// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/SharedNodes.h"

#include "Support/Lists.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace morph::filters
{
std::size_t SharedNodes::Hash::operator()(const Place& place) const
{
  std::uint64_t hash = 0;
  for (const double x : place.X)
  {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    // The finaliser of MurmurHash3: coordinates differ in few bits.
    hash ^= bits;
    hash ^= hash >> 33;
    hash *= 0xff51afd7ed558ccdULL;
    hash ^= hash >> 33;
    hash *= 0xc4ceb9fe1a85ec53ULL;
    hash ^= hash >> 33;
  }
  return static_cast<std::size_t>(hash);
}

SharedNodes::Place SharedNodes::PlaceOf(const morph::Points& points, Index row)
{
  // Plus 0: -0 becomes 0, and equal places have equal bits.
  return { { points(row, 0) + 0., points(row, 1) + 0., points(row, 2) + 0. } };
}

Index SharedNodes::NewNode(const Place& place, List& list, Index group, Index id)
{
  const Index node = this->Number();
  this->Nodes.push_back({ id, group, this->Block, -1 });
  this->Spots.push_back(place);
  if (list.First < 0)
  {
    list.First = node;
  }
  else
  {
    this->Nodes[list.Last].Next = node;
  }
  list.Last = node;
  return node;
}

Index SharedNodes::Sharable(List& list, const Points& block, bool needsFree)
{
  const auto isFree = [&](Index node)
  { return this->Nodes[node].Group == block.Group && !(needsFree && this->Nodes[node].Id >= 0); };
  if (block.MergesWithin)
  {
    // Its own node, as at a seam, or another block's.
    Index node = list.First;
    while (node >= 0 && this->Nodes[node].Block != this->Block && !isFree(node))
    {
      node = this->Nodes[node].Next;
    }
    return node;
  }
  if (list.Block != this->Block)
  {
    list.Block = this->Block;
    list.Cursor = list.First;
  }
  // A block uses a node once, and the list is walked once for each block.
  while (list.Cursor >= 0)
  {
    const Index node = list.Cursor;
    const Node& known = this->Nodes[node];
    list.Cursor = known.Next;
    if (known.Block != this->Block && isFree(node))
    {
      return node;
    }
  }
  return -1;
}

std::vector<Index> SharedNodes::Add(const Points& block)
{
  ++this->Block;
  const Index count = static_cast<Index>(block.Places.rows());
  std::vector<Index> nodes(count);
  for (Index i = 0; i < count; ++i)
  {
    const Place place = PlaceOf(block.Places, i);
    const Index id = block.Ids.empty() ? -1 : block.Ids[i];
    if (id >= 0)
    {
      if (const auto known = this->ById.find(id); known != this->ById.end())
      {
        nodes[i] = known->second;
        const double* x = this->Spots[known->second].X;
        const double distance = std::hypot(x[0] - place.X[0], x[1] - place.X[1], x[2] - place.X[2]);
        if (distance > 0 && (!this->Worst || distance > this->Worst->Distance))
        {
          this->Worst = { id, distance };
        }
        this->Nodes[nodes[i]].Block = this->Block;
        continue;
      }
    }
    List& list = this->Lists.try_emplace(place, List{ -1, -1, -1, -1 }).first->second;
    Index node = this->Sharable(list, block, id >= 0);
    if (node < 0)
    {
      this->Parted += id >= 0 && list.First >= 0 && this->Nodes[list.First].Block != this->Block;
      node = this->NewNode(place, list, block.Group, id);
    }
    this->Nodes[node].Block = this->Block;
    if (id >= 0)
    {
      this->Nodes[node].Id = id;
      this->ById[id] = node;
    }
    nodes[i] = node;
  }
  return nodes;
}

std::vector<Index> SharedNodes::Find(const Points& block) const
{
  const Index count = static_cast<Index>(block.Places.rows());
  std::vector<Index> nodes(count, -1);
  for (Index i = 0; i < count; ++i)
  {
    const auto list = this->Lists.find(PlaceOf(block.Places, i));
    if (list == this->Lists.end())
    {
      continue;
    }
    nodes[i] = list->second.First;
    const auto named = block.Ids.empty() ? this->ById.end() : this->ById.find(block.Ids[i]);
    for (Index node = list->second.First; node >= 0 && named != this->ById.end();
         node = this->Nodes[node].Next)
    {
      if (node == named->second)
      {
        nodes[i] = node;
        break;
      }
    }
  }
  return nodes;
}

std::optional<Index> SharedNodes::Contradiction(double tolerance) const
{
  // Written so that a NaN is a contradiction.
  return this->Worst && !(this->Worst->Distance <= tolerance) ? std::optional(this->Worst->Id)
                                                              : std::nullopt;
}

std::vector<Index> SharedNodes::Places(std::vector<std::uint8_t>& isSplit) const
{
  std::vector<Index> first(this->Nodes.size());
  isSplit.assign(this->Nodes.size(), 0);
  for (const auto& [place, list] : this->Lists)
  {
    for (Index node = list.First; node >= 0; node = this->Nodes[node].Next)
    {
      const auto isOfGroup = [&](Index other)
      { return this->Nodes[other].Group == this->Nodes[node].Group; };
      bool hasIds = false;
      Index members = 0;
      for (Index other = list.First; other >= 0; other = this->Nodes[other].Next)
      {
        if (isOfGroup(other))
        {
          first[node] = members++ == 0 ? other : first[node];
          hasIds = hasIds || this->Nodes[other].Id >= 0;
        }
      }
      isSplit[node] = !hasIds && members > 1;
    }
  }
  return first;
}

std::vector<Index> SharedNodes::Order() const
{
  if (std::any_of(
        this->Nodes.begin(), this->Nodes.end(), [](const Node& node) { return node.Id < 0; }))
  {
    return {};
  }
  std::vector<Index> order = consecutive(this->Nodes.size());
  std::sort(order.begin(), order.end(),
    [this](Index a, Index b) { return this->Nodes[a].Id < this->Nodes[b].Id; });
  return order;
}
}
