// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HangingNodes.h"

#include "Mesh/CellShape.h"
#include "Mesh/DividedFaces.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>

namespace morph
{
namespace
{
constexpr Index FaceGrain = 256;

/// The nodes on edges, whose ends ascend, and how far they are from the first end, in its lengths.
using NodesOnEdges = std::map<std::pair<Index, Index>, std::map<Index, double>>;

/// Adds nodes on a part of an edge to the edge, and those of an edge to its parts: each may have
/// been found at another face.
void complete(NodesOnEdges& onEdge)
{
  for (bool isChanged = true; isChanged;)
  {
    isChanged = false;
    const NodesOnEdges before = onEdge;
    for (const auto& [edge, nodes] : before)
    {
      std::vector<std::pair<double, Index>> chain = { { 0, edge.first }, { 1, edge.second } };
      for (const auto& [node, at] : nodes)
      {
        chain.emplace_back(at, node);
      }
      std::sort(chain.begin(), chain.end());
      const std::size_t count = chain.size();
      for (std::size_t i = 0; i < count; ++i)
      {
        for (std::size_t j = i + 1; j < count && j - i + 1 < count; ++j)
        {
          const auto [from, first] = chain[i];
          const auto [to, last] = chain[j];
          const bool isReversed = first > last;
          const auto part = std::minmax(first, last);
          for (std::size_t k = i + 1; k < j; ++k)
          {
            const double at = (chain[k].first - from) / (to - from);
            isChanged |= onEdge[part].emplace(chain[k].second, isReversed ? 1 - at : at).second;
          }
          const auto found = before.find(part);
          if (found != before.end())
          {
            for (const auto& [node, at] : found->second)
            {
              const double along = from + (isReversed ? 1 - at : at) * (to - from);
              isChanged |= onEdge[edge].emplace(node, along).second;
            }
          }
        }
      }
    }
  }
}

/// What a node is tied to, and by what weights.
using Tie = std::map<Index, double>;

/// The corners of the sides of a volume cell, each once; none of other cells.
std::vector<std::vector<Index>> sidesOf(const Mesh& mesh, Index cell)
{
  std::vector<std::vector<Index>> sides;
  forEachSide(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      std::vector<Index>& corners = sides.emplace_back();
      std::copy_if(nodes, nodes + size, std::back_inserter(corners),
        [&](Index node)
        { return std::find(corners.begin(), corners.end(), node) == corners.end(); });
    });
  if (hasFaces(mesh, cell) && !isPolyhedron(mesh, cell))
  {
    // A side that is not among the cell's own faces covers itself or another side.
    std::set<std::vector<Index>> own;
    forEachFace(
      mesh, cell, [&](const Index* nodes, Index size) { own.emplace(nodes, nodes + size); });
    for (std::vector<Index>& corners : sides)
    {
      corners.resize(own.count(corners) > 0 ? corners.size() : 0);
    }
  }
  return sides;
}

/// Replaces nodes in ties that are tied themselves.
void resolve(std::map<Index, Tie>& ties)
{
  constexpr int MostLevels = 64; // each at most half as large
  bool isResolved = false;
  for (int level = 0; level < MostLevels && !isResolved; ++level)
  {
    isResolved = true;
    for (auto& [node, tie] : ties)
    {
      Tie flat;
      for (const auto& [master, weight] : tie)
      {
        const auto other = ties.find(master);
        if (other == ties.end())
        {
          flat[master] += weight;
          continue;
        }
        isResolved = false;
        for (const auto& [above, share] : other->second)
        {
          flat[above] += weight * share;
        }
      }
      tie = std::move(flat);
    }
  }
}
}

void HangingNodes::find(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
{
  *this = HangingNodes();
  const Index count = static_cast<Index>(faces.cells.size());
  const DividedFaces divided(mesh, faces, monitor);
  std::vector<std::vector<Index>> parts(count);
  parallel(count, FaceGrain, monitor, [&](Index f) { parts[f] = divided.parts(f); });
  monitor.check();

  std::map<Index, Tie> ties;
  NodesOnEdges onEdge;
  for (Index f = 0; f < count; ++f)
  {
    if (parts[f].empty())
    {
      continue;
    }
    this->inside_.emplace(faces.cells[f], faces.sides[f]);
    std::vector<Polygon>& cover = this->covers_[{ faces.cells[f], faces.sides[f] }];
    for (const Index part : parts[f])
    {
      this->inside_.emplace(faces.cells[part], faces.sides[part]);
      const Index* corners = divided.begin(part);
      cover.emplace_back(corners, corners + divided.corners(part));
      std::reverse(cover.back().begin(), cover.back().end());
      for (const Index* node = corners; node != divided.end(part); ++node)
      {
        if (divided.isCorner(f, *node))
        {
          continue;
        }
        const auto at = divided.placeOn(f, mesh.points.row(*node));
        if (const auto side = at ? divided.sideOf(f, *at) : std::nullopt;
            side && divided.isCorner(part, *node))
        {
          const auto& [from, to, along] = *side;
          const Index first = divided.begin(f)[from], last = divided.begin(f)[to];
          onEdge[std::minmax(first, last)].emplace(*node, first < last ? along : 1 - along);
        }
        if (divided.has(f, *node))
        {
          continue;
        }
        Tie tie;
        for (Index k = 0; k < divided.size(f); ++k)
        {
          if (at->N[k] != 0)
          {
            tie[divided.begin(f)[k]] = at->N[k];
          }
        }
        // On an edge of one face and inside another, the edge is what all sides have.
        const auto [known, isNew] = ties.try_emplace(*node, tie);
        if (!isNew && tie.size() < known->second.size())
        {
          known->second = std::move(tie);
        }
      }
    }
  }
  complete(onEdge);
  for (const auto& [edge, nodes] : onEdge)
  {
    std::vector<std::pair<double, Index>> sorted;
    for (const auto& [node, at] : nodes)
    {
      sorted.emplace_back(at, node);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [at, node] : sorted)
    {
      this->onEdge_[edge].push_back(node);
    }
  }
  resolve(ties);
  this->take(ties, mesh.numberOfNodes());
}

void HangingNodes::take(const std::map<Index, std::map<Index, double>>& ties, Index nodes)
{
  this->ids_.clear();
  std::vector<Eigen::Triplet<double, int>> entries;
  for (const auto& [node, tie] : ties)
  {
    for (const auto& [master, weight] : tie)
    {
      entries.emplace_back(static_cast<int>(this->ids_.size()), static_cast<int>(master), weight);
    }
    this->ids_.push_back(node);
  }
  this->weights_.resize(static_cast<Index>(this->ids_.size()), nodes);
  this->weights_.setFromTriplets(entries.begin(), entries.end());
}

std::map<Index, std::map<Index, double>> HangingNodes::ties() const
{
  std::map<Index, Tie> result;
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    for (Weights::InnerIterator at(this->weights_, static_cast<Index>(i)); at; ++at)
    {
      result[this->ids_[i]][at.col()] = at.value();
    }
  }
  return result;
}

bool HangingNodes::mayBeAmong(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isOf, Monitor& monitor)
{
  const DividedFaces divided(mesh, faces, monitor);
  std::vector<std::uint8_t> isDivided(faces.cells.size(), 0);
  parallel(static_cast<Index>(isDivided.size()), FaceGrain, monitor,
    [&](Index f) { isDivided[f] = isOf[faces.cells[f]] != 0 && divided.hasPartsAtCorners(f); });
  monitor.check();
  return std::find(isDivided.begin(), isDivided.end(), 1) != isDivided.end();
}

HangingNodes HangingNodes::following(
  const std::function<std::map<Index, double>(Index node)>& weightsOf) const
{
  std::map<Index, Tie> ties = this->ties();
  std::vector<Index> open = this->ids_, added;
  while (!open.empty())
  {
    const Tie tie = ties.at(open.back());
    open.pop_back();
    for (const auto& [master, weight] : tie)
    {
      Tie own = weightsOf(master);
      if (!own.empty() && ties.emplace(master, std::move(own)).second)
      {
        open.push_back(master);
        added.push_back(master);
      }
    }
  }
  resolve(ties);
  for (const Index follower : added)
  {
    ties.erase(follower);
  }
  HangingNodes result = *this;
  result.take(ties, this->weights_.cols());
  return result;
}

HangingNodes HangingNodes::renumbered(
  const std::vector<Index>& nodeOf, const std::vector<Index>& cellOf, Index nodes) const
{
  const auto areKnown = [&](const auto& ids)
  { return std::all_of(ids.begin(), ids.end(), [&](Index id) { return nodeOf[id] >= 0; }); };
  const auto rename = [&](std::vector<Index> ids)
  {
    std::transform(ids.begin(), ids.end(), ids.begin(), [&](Index id) { return nodeOf[id]; });
    return ids;
  };
  HangingNodes result;
  for (const auto& [cell, side] : this->inside_)
  {
    if (cellOf[cell] >= 0)
    {
      result.inside_.emplace(cellOf[cell], side);
    }
  }
  for (const auto& [place, cover] : this->covers_)
  {
    if (cellOf[place.first] >= 0 && std::all_of(cover.begin(), cover.end(), areKnown))
    {
      std::vector<Polygon>& own = result.covers_[{ cellOf[place.first], place.second }];
      std::transform(cover.begin(), cover.end(), std::back_inserter(own), rename);
    }
  }
  for (const auto& [edge, own] : this->onEdge_)
  {
    const Index first = nodeOf[edge.first], last = nodeOf[edge.second];
    if (first >= 0 && last >= 0 && areKnown(own))
    {
      std::vector<Index>& between = result.onEdge_[std::minmax(first, last)] = rename(own);
      if (first > last)
      {
        std::reverse(between.begin(), between.end());
      }
    }
  }
  std::map<Index, Tie> ties;
  for (const auto& [node, tie] : this->ties())
  {
    const auto isKnown = [&](const auto& master) { return nodeOf[master.first] >= 0; };
    if (nodeOf[node] >= 0 && std::all_of(tie.begin(), tie.end(), isKnown))
    {
      for (const auto& [master, weight] : tie)
      {
        ties[nodeOf[node]][nodeOf[master]] = weight;
      }
    }
  }
  result.take(ties, nodes);
  return result;
}

std::vector<Index> HangingNodes::reach(
  const std::vector<Index>& known, const std::vector<Index>& cells) const
{
  std::set<Index> nodes(known.begin(), known.end());
  for (const auto& [place, cover] : this->covers_)
  {
    if (std::binary_search(cells.begin(), cells.end(), place.first))
    {
      for (const Polygon& polygon : cover)
      {
        nodes.insert(polygon.begin(), polygon.end());
      }
    }
  }
  std::set<Index> more = nodes;
  for (const auto& [edge, own] : this->onEdge_)
  {
    if (nodes.count(edge.first) > 0 && nodes.count(edge.second) > 0)
    {
      more.insert(own.begin(), own.end());
    }
  }
  for (const auto& [node, tie] : this->ties())
  {
    if (more.count(node) > 0)
    {
      for (const auto& [master, weight] : tie)
      {
        nodes.insert(master);
      }
    }
  }
  nodes.insert(more.begin(), more.end());
  return { nodes.begin(), nodes.end() };
}

bool HangingNodes::hangs(Index node) const
{
  return std::binary_search(this->ids_.begin(), this->ids_.end(), node);
}

NodePartition HangingNodes::extend(NodePartition partition) const
{
  std::vector<Index> more;
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    bool isGiven = true;
    for (Weights::InnerIterator master(this->weights_, static_cast<Index>(i)); master; ++master)
    {
      isGiven = isGiven && std::binary_search(partition.prescribed.begin(),
                             partition.prescribed.end(), static_cast<Index>(master.col()));
    }
    if (isGiven)
    {
      more.push_back(this->ids_[i]);
    }
  }
  std::vector<Index> prescribed, free;
  std::set_union(partition.prescribed.begin(), partition.prescribed.end(), more.begin(), more.end(),
    std::back_inserter(prescribed));
  std::set_difference(partition.free.begin(), partition.free.end(), more.begin(), more.end(),
    std::back_inserter(free));
  partition.prescribed = std::move(prescribed);
  partition.free = std::move(free);
  return partition;
}

std::vector<Index> HangingNodes::tiedTo(const std::vector<Index>& nodes) const
{
  std::set<Index> masters;
  for (const auto& [node, tie] : this->ties())
  {
    std::transform(tie.begin(), tie.end(), std::inserter(masters, masters.end()),
      [](const auto& master) { return master.first; });
  }
  std::vector<Index> result;
  std::set_intersection(
    masters.begin(), masters.end(), nodes.begin(), nodes.end(), std::back_inserter(result));
  return result;
}

std::vector<Index> HangingNodes::without(const std::vector<Index>& ids) const
{
  std::vector<Index> result;
  std::copy_if(
    ids.begin(), ids.end(), std::back_inserter(result), [&](Index id) { return !this->hangs(id); });
  return result;
}

void HangingNodes::apply(Points& displacement) const
{
  if (!this->ids_.empty())
  {
    const Points tied = this->weights_ * displacement;
    displacement(this->ids_, allColumns) = tied;
  }
}

void HangingNodes::applyTranspose(Points& gradient) const
{
  if (!this->ids_.empty())
  {
    const Points own = gradient(this->ids_, allColumns);
    gradient(this->ids_, allColumns).setZero();
    gradient += this->weights_.transpose() * own;
  }
}

void HangingNodes::place(const Points& rest, Points& moved) const
{
  if (this->ids_.empty())
  {
    return;
  }
  Points displacement = moved - rest;
  this->apply(displacement);
  for (const Index node : this->ids_)
  {
    moved.row(node) = rest.row(node) + displacement.row(node);
  }
}

void HangingNodes::divideEdges(Polygon& polygon) const
{
  Polygon all;
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Index from = polygon[k], to = polygon[(k + 1) % polygon.size()];
    all.push_back(from);
    const auto found = this->onEdge_.find({ std::min(from, to), std::max(from, to) });
    if (found != this->onEdge_.end())
    {
      std::vector<Index> nodes = found->second;
      if (from > to)
      {
        std::reverse(nodes.begin(), nodes.end());
      }
      all.insert(all.end(), nodes.begin(), nodes.end());
    }
  }
  polygon = std::move(all);
}

void HangingNodes::divideEdges(BoundaryFaces& faces) const
{
  if (this->onEdge_.empty())
  {
    return;
  }
  std::vector<Index> offsets = { 0 }, connectivity;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    Polygon polygon(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
    this->divideEdges(polygon);
    connectivity.insert(connectivity.end(), polygon.begin(), polygon.end());
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  setCorners(std::move(offsets), std::move(connectivity), faces);
}

Mesh HangingNodes::conforming(const Mesh& mesh) const
{
  bool isCut = !this->empty(); // some cell stands for a polyhedron
  for (Index c = 0; c < mesh.numberOfCells() && !isCut; ++c)
  {
    isCut = hasFaces(mesh, c) && !isPolyhedron(mesh, c);
  }
  if (!isCut)
  {
    return mesh;
  }
  std::vector<std::uint8_t> isEnd(mesh.numberOfNodes(), 0);
  for (const auto& [edge, nodes] : this->onEdge_)
  {
    isEnd[edge.first] = isEnd[edge.second] = 1;
  }
  Mesh result;
  result.points = mesh.points;
  result.types = mesh.types;
  result.faceOffsets = { 0 };
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index *begin = mesh.cell(c), *end = begin + mesh.cellSize(c);
    std::vector<Index> nodes(begin, end);
    const auto cover = this->covers_.lower_bound({ c, 0 });
    const bool isCovered = cover != this->covers_.end() && cover->first.first == c;
    if (hasFaces(mesh, c) || isCovered ||
        std::count_if(begin, end, [&](Index n) { return isEnd[n]; }) > 1)
    {
      const std::vector<Polygon> sides = sidesOf(mesh, c);
      std::vector<Polygon> polygons;
      bool isDivided = isCovered;
      for (std::size_t side = 0; side < sides.size(); ++side)
      {
        const auto parts = this->covers_.find({ c, static_cast<int>(side) });
        const std::vector<Polygon> own =
          parts == this->covers_.end() ? std::vector<Polygon>{ sides[side] } : parts->second;
        for (Polygon polygon : own)
        {
          const std::size_t before = polygon.size();
          this->divideEdges(polygon);
          isDivided = isDivided || polygon.size() > before;
          if (polygon.size() > 2) // else it is collapsed
          {
            polygons.push_back(std::move(polygon));
          }
        }
      }
      if (isDivided || hasFaces(mesh, c))
      {
        result.types[c] = Polyhedron;
        nodes.clear(); // those between its corners are in no piece
        for (const Polygon& polygon : polygons)
        {
          result.faces.push_back(static_cast<Index>(polygon.size()));
          result.faces.insert(result.faces.end(), polygon.begin(), polygon.end());
          nodes.insert(nodes.end(), polygon.begin(), polygon.end());
        }
        sortUnique(nodes);
      }
    }
    result.connectivity.insert(result.connectivity.end(), nodes.begin(), nodes.end());
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
    result.faceOffsets.push_back(static_cast<Index>(result.faces.size()));
  }
  return result;
}

NodePartition partitionNodes(
  const Mesh& mesh, const HangingNodes& hanging, std::vector<Index> prescribed)
{
  NodePartition partition = partitionNodes(mesh, std::move(prescribed));
  std::vector<Index>& between = partition.higherOrderNodes;
  const auto first = std::stable_partition(
    between.begin(), between.end(), [&](Index node) { return !hanging.hangs(node); });
  const auto known = static_cast<std::ptrdiff_t>(partition.free.size());
  partition.free.insert(partition.free.end(), first, between.end());
  between.erase(first, between.end());
  std::inplace_merge(partition.free.begin(), partition.free.begin() + known, partition.free.end());
  return partition;
}
}
