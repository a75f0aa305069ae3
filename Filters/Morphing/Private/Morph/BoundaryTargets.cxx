// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/DataCheck.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Support/Error.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

/// Node ids as messages name them.
class Names
{
public:
  explicit Names(const std::vector<std::int64_t>* globalIds)
    : GlobalIds(globalIds)
  {
  }
  std::string Of(std::vector<Index> nodes) const
  {
    if (this->GlobalIds)
    {
      for (Index& node : nodes)
      {
        node = (*this->GlobalIds)[node];
      }
    }
    return morph::listIds(nodes);
  }

private:
  const std::vector<std::int64_t>* GlobalIds;
};

/// Ids that were made from another mesh, or went stale when a filter changed the points.
void verifyRestPositions(const BoundaryMatch::NamedPoints& named, const morph::Mesh& rest,
  double tolerance, const Names& names)
{
  if (named.Rest.rows() == 0)
  {
    return;
  }
  std::vector<Index> stale;
  for (const auto& [point, node] : named.Pairs)
  {
    // Written so that a NaN disagrees.
    if (!((named.Rest.row(point) - rest.points.row(node)).norm() <= tolerance))
    {
      stale.push_back(node);
    }
  }
  if (!stale.empty())
  {
    throw Error(
      "The boundary's ids are stale: its 'RestPosition' disagrees with the grid at node ids " +
      names.Of(stale) +
      ". The boundary was made from another mesh, or a filter has interpolated its arrays. Apply "
      "Extract Morph Boundary to this grid again.");
  }
}

/// The positions asked for, ScaleFactor not yet applied.
Points targetPositions(
  const BoundaryMatch::NamedPoints& named, const morph::Mesh& rest, const Names& names)
{
  Points targets(static_cast<Index>(named.Pairs.size()), 3);
  std::vector<Index> notFinite, huge;
  for (std::size_t k = 0; k < named.Pairs.size(); ++k)
  {
    const auto [point, node] = named.Pairs[k];
    const auto from = rest.points.row(node);
    auto to = targets.row(static_cast<Index>(k));
    to = named.Positions.row(point);
    if (named.Displacements.rows() > 0)
    {
      to = from + named.Displacements.row(point);
    }
    if (!to.allFinite())
    {
      notFinite.push_back(node);
    }
    else if (!DataCheck::IsModerate(to))
    {
      huge.push_back(node);
    }
  }
  if (!notFinite.empty())
  {
    throw Error(
      "The boundary has coordinates or displacements that are not finite (NaN or infinite), "
      "at node ids " +
      names.Of(notFinite) + ".");
  }
  if (!huge.empty())
  {
    throw Error("The boundary moves nodes beyond 1e50, at node ids " + names.Of(huge) +
                ". Use another unit, or correct the displacements.");
  }
  return targets;
}

/// What a node has that is in no row of the targets.
constexpr Index Held = -1, Unnamed = -2, Free = -3;

/// Marks the nodes of free points, and removes their pairs.
void takeFree(BoundaryMatch::NamedPoints& named, std::vector<Index>& row, bool isPart)
{
  auto& pairs = named.Pairs;
  if (named.IsFree.empty() || pairs.empty())
  {
    return;
  }
  const auto isFree = [&](const std::pair<Index, Index>& pair)
  { return named.IsFree[pair.first] != 0; };
  for (const auto& pair : pairs)
  {
    if (isFree(pair))
    {
      row[pair.second] = Free;
    }
  }
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), isFree), pairs.end());
  if (pairs.empty() && !isPart)
  {
    throw Error("All points of the boundary are free (its point array MorphFree is not 0), so "
                "nothing says where the mesh goes. Let some of them stay or move.");
  }
}

/// Marks the outer nodes without a row as held, but for mid-side and face nodes between corners one
/// of which moves: those follow their cell, or edges would bend where corners alone are named.
/// ScaleFactor does not matter, so that changing it does not prepare again.
void holdUnnamed(const morph::BoundaryFaces& outer, const morph::Mesh& rest, const Points& targets,
  std::vector<Index>& row)
{
  const auto moves = [&](Index node)
  { return row[node] >= 0 && targets.row(row[node]) != rest.points.row(node); };
  for (std::size_t i = 0; i < outer.nodes.size(); ++i)
  {
    const Index node = outer.nodes[i], k = static_cast<Index>(i);
    if (row[node] == Unnamed && std::none_of(outer.between.begin(k), outer.between.end(k), moves))
    {
      row[node] = Held;
    }
  }
}
}

namespace BoundaryMatch
{
Result FindTargets(NamedPoints named, const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  double size, const Options& options, const std::vector<std::int64_t>* globalIds)
{
  const double tolerance = options.MatchTolerance * size;
  const Names names(globalIds);
  Result result;
  result.Unmatched = named.Unmatched;
  verifyRestPositions(named, rest, tolerance, names);
  std::vector<Index> row(rest.numberOfNodes(), Unnamed);
  takeFree(named, row, globalIds != nullptr);
  const Points targets = targetPositions(named, rest, names);
  const auto& pairs = named.Pairs;

  std::vector<Index> torn;
  for (std::size_t k = 0; k < pairs.size(); ++k)
  {
    Index& r = row[pairs[k].second];
    if (r < 0)
    {
      r = static_cast<Index>(k);
    }
    else if ((targets.row(r) - targets.row(static_cast<Index>(k))).norm() > tolerance)
    {
      torn.push_back(pairs[k].second);
    }
  }
  if (!torn.empty())
  {
    throw Error(
      "The boundary names the same node more than once with different targets, at node ids " +
      names.Of(torn) + ". Points that stand for one node have to move together.");
  }

  if (options.HoldUnnamedBoundary)
  {
    holdUnnamed(outer, rest, targets, row);
  }

  result.Ids.reserve(pairs.size() + outer.nodes.size());
  result.Sources.reserve(pairs.size() + outer.nodes.size());
  for (Index node = 0; node < rest.numberOfNodes(); ++node)
  {
    if (row[node] != Unnamed && row[node] != Free)
    {
      result.Ids.push_back(node);
      result.Sources.push_back(row[node] < 0 ? -1 : pairs[row[node]].first);
    }
  }
  const double scale = options.ScaleFactor;
  std::vector<Index> huge;
  result.Targets.resize(static_cast<Index>(result.Ids.size()), 3);
  for (std::size_t k = 0; k < result.Ids.size(); ++k)
  {
    const auto from = rest.points.row(result.Ids[k]);
    const Index r = row[result.Ids[k]];
    auto to = result.Targets.row(static_cast<Index>(k));
    // ScaleFactor 0 and 1 give the rest and the target positions bit for bit.
    if (r < 0 || scale == 0)
    {
      to = from;
    }
    else if (scale == 1)
    {
      to = targets.row(r);
    }
    else
    {
      to = from + scale * (targets.row(r) - from);
    }
    if (!DataCheck::IsModerate(to))
    {
      huge.push_back(result.Ids[k]);
    }
  }
  if (!huge.empty())
  {
    std::ostringstream text;
    text << scale;
    throw Error("ScaleFactor " + text.str() + " moves nodes beyond 1e50, at node ids " +
                names.Of(huge) + ". Lower it.");
  }
  if (result.Unmatched > 0)
  {
    result.Warnings.push_back(
      std::to_string(result.Unmatched) + " of the boundary's " +
      std::to_string(named.Positions.rows()) +
      " points are not within MatchTolerance of a node of the grid and were left out.");
  }
  return result;
}
}
}
