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

/// The positions asked for, ScaleFactor not yet applied. `rounded`: counts the coordinates that
/// differ from the undeformed ones by their rounding alone, and stay.
Points targetPositions(const BoundaryMatch::NamedPoints& named, const morph::Mesh& rest,
  const Names& names, Index& rounded)
{
  const auto stay = [&](const auto& from, auto to)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (to[j] != from[j] && named.PointPrecision.IsRounded(to[j], from[j]))
      {
        to[j] = from[j];
        ++rounded;
      }
    }
  };
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
    else if (named.Displacements.rows() == 0)
    {
      stay(from, to);
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

/// Marks the nodes of free points, and removes their pairs. Returns the number of these.
Index takeFree(BoundaryMatch::NamedPoints& named, std::vector<Index>& row)
{
  auto& pairs = named.Pairs;
  if (named.IsFree.empty())
  {
    return 0;
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
  const auto all = pairs.size();
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), isFree), pairs.end());
  return static_cast<Index>(all - pairs.size());
}

/// Marks the outer nodes without a row as held, but for mid-side and face nodes between corners one
/// of which moves: those follow their cell, or edges would bend where corners alone are named. A
/// motion of rounding is none: rotation about a node leaves such. ScaleFactor does not matter, so
/// that changing it does not prepare again.
void holdUnnamed(const morph::BoundaryFaces& outer, const morph::Mesh& rest, double size,
  const Points& targets, std::vector<Index>& row)
{
  const auto moves = [&](Index node)
  {
    const auto from = rest.points.row(node);
    const double rounding = 1e-12 * size + 1e-15 * from.cwiseAbs().maxCoeff();
    return row[node] >= 0 && (targets.row(row[node]) - from).norm() > rounding;
  };
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
  result.Points = named.Positions.rows();
  result.Unmatched = named.Unmatched;
  result.Valueless = named.Valueless;
  result.PointPrecision = named.PointPrecision;
  verifyRestPositions(named, rest, tolerance, names);
  std::vector<Index> row(rest.numberOfNodes(), Unnamed);
  result.Freed = takeFree(named, row);
  result.Following = static_cast<Index>(named.Pairs.size());
  const Points targets = targetPositions(named, rest, names, result.Rounded);
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

  if (options.FixUnnamedBoundary)
  {
    holdUnnamed(outer, rest, size, targets, row);
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
  return result;
}

void CountStaying(const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  const std::function<bool(Index node)>& owns, Result& result)
{
  for (std::size_t i = 0; i < result.Ids.size(); ++i)
  {
    result.Staying += result.Targets.row(static_cast<Index>(i)) == rest.points.row(result.Ids[i]) &&
                      owns(result.Ids[i]);
  }
  for (std::size_t i = 0; i < outer.nodes.size(); ++i)
  {
    const Index node = outer.nodes[i], k = static_cast<Index>(i);
    result.Open += outer.between.begin(k) == outer.between.end(k) && owns(node) &&
                   !std::binary_search(result.Ids.begin(), result.Ids.end(), node);
  }
}

void Conclude(double size, const Options& options, Result& result)
{
  const auto ofPoints = [&](Index count)
  {
    return std::to_string(count) + " of the boundary's " + std::to_string(result.Points) +
           " points";
  };
  const bool areFree = result.Following == 0 && result.Freed > 0;
  if (areFree && result.Valueless > 0)
  {
    throw Error("No point of the boundary has a displacement, so nothing says where the mesh goes: "
                "'" +
                options.DisplacementArray + "' is NaN, or vtkValidPointMask 0, at " +
                ofPoints(result.Valueless) + ". Give displacements where the boundary is.");
  }
  if (areFree)
  {
    throw Error("All points of the boundary are free (its point array MorphFree is not 0), so "
                "nothing says where the mesh goes. Let some of them stay or move.");
  }
  if (result.Valueless > 0)
  {
    result.Warnings.push_back(
      ofPoints(result.Valueless) + " have no displacement ('" + options.DisplacementArray +
      "' is NaN, or vtkValidPointMask 0, there). Their nodes are free: they "
      "are solved with the interior.");
  }
  const Precision& precision = result.PointPrecision;
  if ((result.Rounded > 0 || precision.IsFloat) && options.DisplacementArray.empty() &&
      precision.Step() > 2 * options.MatchTolerance * size)
  {
    result.Warnings.push_back(
      "The boundary has " + precision.Text() +
      ". What is nearer to its old place than that stays, and what moves is as far off. Give the "
      "boundary in double precision, or displacements (DisplacementArray), or coordinates with "
      "an origin near the mesh.");
  }
  if (result.Unmatched > 0)
  {
    result.Warnings.push_back(
      ofPoints(result.Unmatched) +
      " are not within MatchTolerance of a node of the grid and were left out.");
  }
}

void WarnIfNothingStays(const Result& result, morph::Monitor& monitor)
{
  if (result.Staying == 0 && result.Open > 0)
  {
    monitor.warn("Nothing holds the mesh: all prescribed nodes move, and the other outer nodes are "
                 "free, so that the whole mesh may go along. Hold a surface if that is not meant.");
  }
}
}
}
