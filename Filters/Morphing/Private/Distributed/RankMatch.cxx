// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankMatch.h"

#include "Distributed/DistributedMesh.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/Surface.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

/// How points find their nodes. All ranks with points agree on it.
enum class Way
{
  None, ///< this rank has no points
  Ids,
  Copies, ///< point i is node i of the rank's piece
  Positions
};

/// A point of the boundary as it travels.
struct Traveller
{
  std::int64_t id;          ///< of its node, or -1
  std::int64_t rank, point; ///< where it comes from
  std::int64_t isFree;
  std::array<double, 3> position, rest, displacement;
};

constexpr Index MostIds = Index(1) << 52;

Way wayOf(vtkPointSet* boundary, const DistributedMesh& mesh, bool areCopies,
  const BoundaryMatch::Options& options)
{
  if (boundary->GetNumberOfPoints() == 0)
  {
    return Way::None;
  }
  if (BoundaryMatch::FindIds(boundary, options))
  {
    return Way::Ids;
  }
  if (areCopies && boundary->GetNumberOfPoints() == mesh.pieceNodes())
  {
    return Way::Copies;
  }
  for (const char* name : { "PointIds", "vtkOriginalPointIds" })
  {
    if (boundary->GetPointData()->HasArray(name))
    {
      throw Error("On several MPI ranks the point array '" + std::string(name) +
                  "' may number each rank's points. Name it as `BoundaryIdArray` if its ids are "
                  "global, or make the boundary with Extract Morph Boundary.");
    }
  }
  if (options.displacementArray.empty())
  {
    throw Error("Nothing says which nodes the boundary's points are: there is no point array "
                "MorphPointId. Make the boundary with Extract Morph Boundary, or set "
                "`BoundaryIdArray`, or give undeformed points with a `DisplacementArray`.");
  }
  return Way::Positions;
}

/// The way that all ranks with points take.
Way agree(const Ranks& ranks, Way mine)
{
  const auto value = static_cast<Index>(mine);
  const Index most = ranks.maximum(value);
  const Index least = ranks.minimum(mine == Way::None ? std::numeric_limits<Index>::max() : value);
  if (most == static_cast<Index>(Way::None))
  {
    throw Error("The boundary has no points, so nothing says where the mesh goes.");
  }
  if (most != least)
  {
    throw Error("The boundary's points have ids on some MPI ranks and not on others. Make it with "
                "Extract Morph Boundary on all.");
  }
  return static_cast<Way>(most);
}

std::array<double, 3> rowOf(const morph::Points& points, Index row)
{
  return points.rows() > 0 ? std::array<double, 3>{ points(row, 0), points(row, 1), points(row, 2) }
                           : std::array<double, 3>{};
}

/// This rank's points; `node`: of each, or -1.
std::vector<Traveller> travellers(const morph::NamedPoints& named,
  const std::vector<std::pair<Index, std::int64_t>>& pairs, int rank)
{
  std::vector<Traveller> result;
  for (const auto& [point, id] : pairs)
  {
    result.push_back({ id, rank, point, named.isFree.empty() ? 0 : named.isFree[point],
      rowOf(named.positions, point), rowOf(named.rest, point), rowOf(named.displacements, point) });
  }
  return result;
}

/// The points that the nodes of this process follow. `points`: of all processes, in their order;
/// `pairs`: those of the points and the nodes that they stand for.
std::vector<BoundaryMatch::Follower> followersOf(const DistributedMesh& mesh,
  const morph::BoundaryTargets& result, const std::vector<Traveller>& points,
  const std::vector<std::pair<Index, Index>>& pairs)
{
  std::map<Index, std::vector<Index>> ofNode; // the first point of each process
  for (const auto& [point, node] : pairs)
  {
    std::vector<Index>& list = ofNode[node];
    const auto isOfRank = [&, rank = points[point].rank](Index other)
    { return points[other].rank == rank; };
    if (points[point].isFree == 0 && std::none_of(list.begin(), list.end(), isOfRank))
    {
      list.push_back(point);
    }
  }
  std::vector<BoundaryMatch::Follower> followers;
  for (std::size_t k = 0; k < result.ids.size(); ++k)
  {
    if (result.sources[k] < 0 || !mesh.owns(result.ids[k]))
    {
      continue;
    }
    for (const Index point : ofNode[result.ids[k]])
    {
      followers.push_back({ result.ids[k], points[point].rank, points[point].point });
    }
  }
  return followers;
}

/// The owners' choice for all local nodes.
void takeOwners(const DistributedMesh& mesh, morph::BoundaryTargets& result)
{
  constexpr std::int64_t Held = 1, Named = 2;
  const Index nodes = mesh.mesh().numberOfNodes();
  std::vector<std::int64_t> isPrescribed(nodes, 0);
  morph::Points targets = mesh.mesh().points;
  for (std::size_t i = 0; i < result.ids.size(); ++i)
  {
    isPrescribed[result.ids[i]] = result.sources[i] < 0 ? Held : Named;
    targets.row(result.ids[i]) = result.targets.row(static_cast<Index>(i));
  }
  mesh.halo().update(mesh.ranks(), isPrescribed);
  mesh.halo().update(mesh.ranks(), targets);
  result.ids.clear();
  result.sources.clear();
  for (Index n = 0; n < nodes; ++n)
  {
    if (isPrescribed[n] != 0)
    {
      result.ids.push_back(n);
      result.sources.push_back(isPrescribed[n] == Named ? 0 : -1);
    }
  }
  result.targets = targets(result.ids, morph::allColumns);
}

/// What the ranks have of a boundary.
struct Given
{
  Way How;      ///< the same on all ranks
  bool HasRest; ///< whether RestPosition counts: all points have it
  std::vector<Traveller> Mine;
  Precision PointPrecision; ///< of all ranks' points
  Index Valueless;          ///< of all ranks
};

/// That of all ranks' points.
Precision together(const Ranks& ranks, const Precision& mine)
{
  Precision all;
  all.IsFloat = ranks.maximum(Index(mine.IsFloat)) > 0;
  all.IsSingle = ranks.minimum(Index(mine.IsSingle)) > 0;
  all.Digits = static_cast<int>(ranks.maximum(Index(mine.Digits)));
  all.Largest = ranks.maximum(mine.Largest);
  return all;
}

Given read(
  vtkPointSet* boundary, const DistributedMesh& mesh, const BoundaryMatch::Options& options)
{
  const Ranks& ranks = mesh.ranks();
  const bool areCopies = ranks.sum(Index(boundary->GetNumberOfPoints() != mesh.pieceNodes())) == 0;
  Way way = Way::None;
  morph::NamedPoints named;
  Precision precision;
  std::vector<std::pair<Index, std::int64_t>> pairs;
  ranks.together(
    [&]
    {
      way = wayOf(boundary, mesh, areCopies, options);
      if (way == Way::None)
      {
        return;
      }
      named = BoundaryMatch::ReadPoints(boundary, options, precision);
      if (way == Way::Ids)
      {
        pairs = BoundaryMatch::FindByIds(BoundaryMatch::FindIds(boundary, options), MostIds);
      }
      else if (way == Way::Copies)
      {
        for (Index node : mesh.outerNodes().nodes)
        {
          pairs.emplace_back(node, mesh.nodeId(node));
        }
      }
      else
      {
        for (Index i = 0; i < named.positions.rows(); ++i)
        {
          pairs.emplace_back(i, -1);
        }
      }
    });
  const bool isEmpty = way == Way::None;
  way = agree(ranks, way);
  const bool hasRest = ranks.sum(Index(!isEmpty && named.rest.rows() == 0)) == 0;
  return { way, hasRest, travellers(named, pairs, ranks.rank()), together(ranks, precision),
    ranks.sum(named.valueless) };
}

/// All of NamedPoints but pairs; sorts `points` by where they come from.
morph::NamedPoints named(
  std::vector<Traveller>& points, const Given& given, const BoundaryMatch::Options& options)
{
  std::sort(points.begin(), points.end(),
    [](const Traveller& a, const Traveller& b)
    { return std::tie(a.rank, a.point) < std::tie(b.rank, b.point); });
  const Index count = static_cast<Index>(points.size());
  morph::NamedPoints here;
  here.valueless = given.Valueless;
  here.positions.resize(count, 3);
  here.rest.resize(given.HasRest ? count : 0, 3);
  here.displacements.resize(options.displacementArray.empty() ? 0 : count, 3);
  here.isFree.resize(count);
  for (Index i = 0; i < count; ++i)
  {
    const auto row = [](const std::array<double, 3>& x)
    { return Eigen::RowVector3d(x[0], x[1], x[2]); };
    here.positions.row(i) = row(points[i].position);
    if (given.HasRest)
    {
      here.rest.row(i) = row(points[i].rest);
    }
    if (here.displacements.rows() > 0)
    {
      here.displacements.row(i) = row(points[i].displacement);
    }
    here.isFree[i] = points[i].isFree != 0;
  }
  return here;
}

/// How many ranks say so of each point of the boundary.
std::vector<Index> countRanks(
  const Ranks& ranks, std::size_t points, const std::vector<std::pair<Index, Index>>& pairs)
{
  std::vector<Index> count(points, 0);
  for (const auto& pair : pairs)
  {
    count[pair.first] = 1;
  }
  ranks.sum(count.data(), count.size());
  return count;
}

/// RankMatch::Gather(), with all points as they came.
RankMatch::Gathered gather(vtkPointSet* boundary, const DistributedMesh& mesh,
  const BoundaryMatch::Options& options, std::vector<Traveller>& points)
{
  const Given given = read(boundary, mesh, options);
  points = mesh.ranks().gather(given.Mine);
  RankMatch::Gathered result;
  result.ByPosition = given.How == Way::Positions;
  result.PointPrecision = given.PointPrecision;
  result.Points = named(points, given, options);
  std::vector<std::pair<Index, Index>> here;
  for (std::size_t i = 0; !result.ByPosition && i < points.size(); ++i)
  {
    result.Points.pairs.emplace_back(static_cast<Index>(i), points[i].id);
    if (mesh.nodeOf(points[i].id) >= 0)
    {
      here.push_back(result.Points.pairs.back());
    }
  }
  const std::vector<Index> known = countRanks(mesh.ranks(), points.size(), here);
  std::vector<Index> unknown;
  for (const auto& [point, id] : result.Points.pairs)
  {
    if (known[point] == 0)
    {
      unknown.push_back(id);
    }
  }
  if (!unknown.empty())
  {
    sortUnique(unknown);
    throw Error("The boundary names nodes that the grid does not have: global ids " +
                morph::listIds(unknown) +
                ". Make the boundary from this grid, with Extract Morph Boundary.");
  }
  return result;
}
}

namespace RankMatch
{
morph::BoundaryTargets Match(vtkPointSet* boundary, const DistributedMesh& mesh,
  const BoundaryMatch::Options& options, std::vector<BoundaryMatch::Follower>* followers)
{
  const Ranks& ranks = mesh.ranks();
  std::vector<Traveller> points;
  Gathered all = gather(boundary, mesh, options, points);
  const auto nodeOf = [&mesh](std::int64_t id)
  {
    const Index node = mesh.nodeOf(id);
    return node < mesh.pieceNodes() ? node : -1;
  };
  morph::BoundaryTargets result;
  Index rounded = 0;
  ranks.together(
    [&]
    {
      result = TargetsOf(all,
        { mesh.mesh(), mesh.outerNodes(), mesh.size(), mesh.nodeIds(), nodeOf }, options, rounded);
    });
  const std::vector<std::pair<Index, Index>>& found = all.Points.pairs;
  if (all.ByPosition)
  {
    const std::vector<Index> count = countRanks(ranks, points.size(), found);
    result.unmatched = std::count(count.begin(), count.end(), 0);
  }
  if (followers)
  {
    *followers = followersOf(mesh, result, points, found);
  }
  takeOwners(mesh, result);
  morph::countStaying(
    mesh.mesh(), mesh.outerNodes(), [&](Index node) { return mesh.owns(node); }, result);
  result.points = static_cast<Index>(points.size());
  for (Index* count : { &result.freed, &result.following, &result.staying, &result.open, &rounded })
  {
    *count = ranks.sum(*count);
  }
  BoundaryMatch::Conclude(mesh.size(), options, all.PointPrecision, rounded, result);
  return result;
}

void SendBack(const Ranks& ranks, const std::vector<Index>& ids, const morph::Points& prescribed,
  const std::vector<BoundaryMatch::Follower>& followers, vtkIdType points, vtkDoubleArray* result)
{
  struct Row
  {
    Index point;
    double value[3];
  };
  std::vector<std::vector<Row>> to(ranks.count());
  for (const BoundaryMatch::Follower& follower : followers)
  {
    const Index k = std::lower_bound(ids.begin(), ids.end(), follower.Node) - ids.begin();
    to[follower.Rank].push_back(
      { follower.Point, { prescribed(k, 0), prescribed(k, 1), prescribed(k, 2) } });
  }
  morph::Points sums = morph::Points::Zero(points, 3);
  for (const std::vector<Row>& part : ranks.exchange(to))
  {
    for (const Row& row : part)
    {
      sums.row(row.point) += Eigen::RowVector3d(row.value[0], row.value[1], row.value[2]);
    }
  }
  const std::vector<Index> sources = morph::consecutive(static_cast<std::size_t>(points));
  ranks.together([&] { Gradient::Gather(sums, sources, points, result); });
}

morph::BoundaryTargets TargetsOf(
  Gathered& all, const Nodes& nodes, const BoundaryMatch::Options& options, Index& rounded)
{
  morph::NamedPoints& named = all.Points;
  std::vector<std::pair<Index, Index>> pairs;
  for (const auto& [point, id] : named.pairs)
  {
    if (const Index node = nodes.NodeOf(id); node >= 0)
    {
      pairs.emplace_back(point, node);
    }
  }
  if (all.ByPosition && nodes.Rest.numberOfNodes() > 0)
  {
    pairs = BoundaryMatch::FindByPosition(named.positions, nodes.Rest, nodes.Outer.nodes,
      options.matchTolerance * nodes.Size, named.unmatched);
  }
  named.pairs = pairs;
  rounded = BoundaryMatch::TakeBackRounding(all.PointPrecision, nodes.Rest, named);
  morph::BoundaryTargets result =
    morph::findTargets(std::move(named), nodes.Rest, nodes.Outer, nodes.Size, options, &nodes.Ids);
  named.pairs = std::move(pairs);
  return result;
}

Gathered Gather(
  vtkPointSet* boundary, const DistributedMesh& mesh, const BoundaryMatch::Options& options)
{
  std::vector<Traveller> points;
  return gather(boundary, mesh, options, points);
}
}
}
