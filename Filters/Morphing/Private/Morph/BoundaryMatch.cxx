// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/BoundaryMatch.h"

#include "Mesh/Mesh.h"
#include "Private/Data/AffineArrays.h"
#include "Private/Data/Gradient.h"
#include "Private/Morph/BoundaryPoints.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkDoubleArray.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

using BoundaryPoints::Pairs;
using BoundaryPoints::Way;

/// Leaves these points, whose pairs have the new numbers.
void keepPoints(const std::vector<Index>& points, morph::NamedPoints& named)
{
  for (Points* rows : { &named.positions, &named.rest, &named.displacements })
  {
    if (rows->rows() > 0)
    {
      *rows = Points((*rows)(points, morph::allColumns));
    }
  }
  std::vector<std::uint8_t> isFree;
  for (const Index point : points)
  {
    isFree.push_back(named.isFree.empty() ? 0 : named.isFree[point]);
  }
  named.isFree.swap(isFree);
}

/// The way that all processes with points take.
Way agree(Way mine, const morph::Communicator& processes)
{
  const auto value = static_cast<double>(mine);
  const double most = processes.maximum(value),
               least = processes.minimum(mine == Way::None ? HUGE_VAL : value);
  if (most == static_cast<double>(Way::None))
  {
    throw Error("The boundary has no points, so nothing says where the mesh goes.");
  }
  if (most != least)
  {
    throw Error("The boundary's points have ids on some MPI ranks and not on others. Make it with "
                "Extract Morph Boundary on all.");
  }
  return static_cast<Way>(static_cast<int>(most));
}

/// That of all processes' points.
Precision together(const Precision& mine, const morph::Communicator& processes)
{
  Precision all;
  all.IsFloat = processes.maximum(double(mine.IsFloat)) > 0;
  all.IsSingle = processes.minimum(double(mine.IsSingle)) > 0;
  all.Digits = static_cast<int>(processes.maximum(double(mine.Digits)));
  all.Largest = processes.maximum(mine.Largest);
  return all;
}

/// The points that no process finds a node for. `pairs`: of this process.
std::vector<Index> unknownPoints(
  Index points, const Pairs& pairs, const morph::Communicator& processes)
{
  std::vector<double> known(static_cast<std::size_t>(points), 0);
  for (const auto& [point, node] : pairs)
  {
    known[point] = 1;
  }
  processes.sum(known.data(), static_cast<int>(points));
  std::vector<Index> unknown;
  for (Index point = 0; point < points; ++point)
  {
    if (known[point] == 0)
    {
      unknown.push_back(point);
    }
  }
  return unknown;
}

/// The points that the nodes of this process follow. `isFree`: of the points, or empty.
BoundaryMatch::Followers followersOf(BoundaryMatch::Gathered& gathered,
  const std::vector<std::uint8_t>& isFree, const morph::BoundaryTargets& match,
  const morph::ShellLayer& layer, const morph::Communicator& processes)
{
  if (layer.nodes > 0)
  {
    morph::nameImages(layer, gathered.Points);
  }
  BoundaryMatch::Followers result;
  result.Points = match.points;
  result.Own = gathered.Own;
  result.First = gathered.First;
  const std::vector<double> starts = processes.gather({ static_cast<double>(gathered.First) });
  std::set<std::pair<std::ptrdiff_t, Index>> met; // processes and nodes
  const auto add = [&](Index k, Index point)
  {
    const auto after = std::upper_bound(starts.begin(), starts.end(), static_cast<double>(point));
    if (met.emplace(after - starts.begin(), match.ids[k]).second)
    {
      result.Pairs.emplace_back(k, point);
    }
  };
  const auto isFollowed = [&](std::size_t k)
  { return k < match.ids.size() && match.sources[k] >= 0 && processes.owns(match.ids[k]); };
  for (std::size_t k = 0; k < match.ids.size(); ++k)
  {
    if (isFollowed(k))
    {
      add(static_cast<Index>(k), match.sources[k]);
    }
  }
  for (const auto& [point, node] : gathered.Points.pairs) // those of other processes
  {
    const Index k = std::lower_bound(match.ids.begin(), match.ids.end(), node) - match.ids.begin();
    if (isFollowed(k) && match.ids[k] == node && (isFree.empty() || isFree[point] == 0))
    {
      add(k, point);
    }
  }
  std::sort(result.Pairs.begin(), result.Pairs.end());
  return result;
}

/// What the processes find where nodes count, for all nodes of this one.
void takeOwners(
  const morph::Mesh& rest, const morph::Communicator& processes, morph::BoundaryTargets& result)
{
  Points targets = rest.points, marks = Points::Zero(rest.numberOfNodes(), 3);
  targets(result.ids, morph::allColumns) = result.targets;
  for (std::size_t i = 0; i < result.ids.size(); ++i)
  {
    marks.row(result.ids[i]) << 1, static_cast<double>(result.sources[i]), 0;
  }
  processes.update(targets);
  processes.update(marks);
  result.ids.clear();
  result.sources.clear();
  for (Index node = 0; node < marks.rows(); ++node)
  {
    if (marks(node, 0) != 0)
    {
      result.ids.push_back(node);
      result.sources.push_back(static_cast<Index>(marks(node, 1)));
    }
  }
  result.targets = targets(result.ids, morph::allColumns);
}
}

namespace BoundaryMatch
{
Gathered Gather(vtkPointSet* boundary, const Nodes& nodes, const morph::Communicator& processes,
  const Options& options)
{
  Gathered result;
  morph::NamedPoints& named = result.Points;
  Precision precision;
  Way way = Way::None;
  const bool areCopies =
    processes.all(boundary->GetNumberOfPoints() == BoundaryPoints::Count(nodes));
  processes.together(
    [&]
    {
      if (boundary->GetNumberOfPoints() > 0)
      {
        named = BoundaryPoints::Read(boundary, options, precision);
        way = BoundaryPoints::FindWay(boundary, nodes, areCopies, options, result);
      }
    });
  result.ByPosition = agree(way, processes) == Way::Positions;
  result.PointPrecision = together(precision, processes);
  result.Own = morph::consecutive(static_cast<std::size_t>(named.positions.rows()));
  if (!nodes.Ids)
  {
    return result;
  }
  if (way == Way::Copies) // the inner points need not travel
  {
    result.Own.clear();
    for (auto& pair : named.pairs)
    {
      result.Own.push_back(pair.first);
      pair.first = static_cast<Index>(result.Own.size()) - 1;
    }
    keepPoints(result.Own, named);
  }
  result.First = processes.sumBefore(named.positions.rows());
  morph::gatherPoints(processes, named);
  Pairs here;
  std::copy_if(named.pairs.begin(), named.pairs.end(), std::back_inserter(here),
    [&](const auto& pair) { return nodes.NodeOf(pair.second) >= 0; });
  const std::vector<Index> unknown = unknownPoints(named.positions.rows(), here, processes);
  std::vector<Index> ids;
  for (const auto& [point, id] : named.pairs)
  {
    if (std::binary_search(unknown.begin(), unknown.end(), point))
    {
      ids.push_back(id);
    }
  }
  if (!ids.empty())
  {
    sortUnique(ids);
    throw Error("The boundary names nodes that the grid does not have: global ids " +
                morph::listIds(ids) +
                ". Make the boundary from this grid, with Extract Morph Boundary.");
  }
  return result;
}

morph::BoundaryTargets TargetsOf(
  Gathered& all, const Nodes& nodes, const Options& options, Index& rounded)
{
  morph::NamedPoints& named = all.Points;
  if (all.ByPosition && nodes.Rest.numberOfNodes() > 0)
  {
    named.pairs = BoundaryPoints::ByPosition(named.positions, nodes.Rest, nodes.Outer.nodes,
      options.matchTolerance * nodes.Size, named.unmatched);
  }
  else if (nodes.Ids)
  {
    Pairs pairs;
    for (const auto& [point, id] : named.pairs)
    {
      if (const Index node = nodes.NodeOf(id); node >= 0)
      {
        pairs.emplace_back(point, node);
      }
    }
    named.pairs.swap(pairs);
  }
  rounded = BoundaryPoints::TakeBackRounding(all.PointPrecision, nodes.Rest, named);
  Pairs pairs = named.pairs;
  morph::BoundaryTargets result =
    morph::findTargets(std::move(named), nodes.Rest, nodes.Outer, nodes.Size, options, nodes.Ids);
  named.pairs = std::move(pairs);
  result.warnings = all.Warnings;
  return result;
}

morph::BoundaryTargets Match(vtkPointSet* boundary, const Nodes& nodes, const Options& options,
  const morph::Communicator& processes, Followers* followers)
{
  Gathered gathered = Gather(boundary, nodes, processes, options);
  const std::vector<std::uint8_t> isFree =
    followers ? gathered.Points.isFree : std::vector<std::uint8_t>();
  morph::BoundaryTargets result;
  Index rounded = 0;
  processes.together([&] { result = TargetsOf(gathered, nodes, options, rounded); });
  if (gathered.ByPosition)
  {
    const auto unmatched = unknownPoints(result.points, gathered.Points.pairs, processes);
    result.unmatched = static_cast<Index>(unmatched.size());
    if (result.unmatched == result.points)
    {
      std::ostringstream message;
      message << "None of the boundary's " << result.points
              << " points is within `MatchTolerance` (" << options.matchTolerance
              << " of the grid's size) of a node of the grid. Where a "
              << "`DisplacementArray` is set, the points have to be undeformed.";
      throw Error(message.str());
    }
  }
  if (nodes.Ids)
  {
    takeOwners(nodes.Rest, processes, result);
  }
  if (followers)
  {
    *followers = followersOf(gathered, isFree, result, nodes.Rest.layer, processes);
  }
  morph::countStaying(
    nodes.Rest, nodes.Outer, [&](Index node) { return processes.owns(node); }, result);
  for (Index* count : { &result.freed, &result.following, &result.staying, &result.open, &rounded })
  {
    *count = processes.sum(*count);
  }
  Conclude(nodes.Size, options, gathered.PointPrecision, rounded, result);
  return result;
}

void SendBack(const Followers& followers, const Points& prescribed,
  const morph::Communicator& processes, vtkPointSet* boundary, vtkDoubleArray* result)
{
  Points sums = Points::Zero(followers.Points, 3);
  for (const auto& [k, point] : followers.Pairs)
  {
    sums.row(point) += prescribed.row(k);
  }
  processes.sum(sums.data(), static_cast<int>(sums.size()));
  const auto count = static_cast<Index>(followers.Own.size());
  processes.together(
    [&]
    {
      Gradient::Gather(sums.middleRows(followers.First, count), followers.Own,
        boundary->GetNumberOfPoints(), result);
    });
}

void Conclude(double size, const Options& options, const Precision& precision, Index rounded,
  morph::BoundaryTargets& result)
{
  morph::conclude(options, result);
  if ((rounded > 0 || precision.IsFloat) && options.displacementArray.empty() &&
      precision.Step() > 2 * options.matchTolerance * size)
  {
    result.warnings.push_back(
      "The boundary has " + precision.Text() +
      ". What is nearer to its old place than that stays, and what moves is as far off. Give the "
      "boundary in double precision, or displacements (`DisplacementArray`), or coordinates with "
      "an origin near the mesh.");
  }
}

std::optional<morph::Session::AffineHandle> FindHandle(vtkPointSet* boundary,
  const morph::BoundaryTargets& match, const morph::Mesh& rest, double scale, bool isFloat,
  const morph::Communicator& processes)
{
  const auto found = AffineArrays::Read(boundary);
  const bool hasPoints = boundary->GetNumberOfPoints() > 0;
  // Of each point, and the motion that multiplies them, which has to be one.
  morph::AffineFields own(found ? boundary->GetNumberOfPoints() : 0, 4);
  if (auto* doubles = found ? vtkDoubleArray::FastDownCast(found->Fields) : nullptr)
  {
    own = Eigen::Map<const morph::AffineFields>(doubles->GetPointer(0), own.rows(), 4);
  }
  else
  {
    for (Index i = 0; i < own.rows(); ++i)
    {
      found->Fields->GetTuple(i, own.row(i).data());
    }
  }
  const std::vector<double> fields =
    processes.gather(std::vector<double>(own.data(), own.data() + own.size()));
  std::vector<double> motions;
  if (found && hasPoints)
  {
    motions.assign(found->Motion.data(), found->Motion.data() + found->Motion.size());
  }
  motions = processes.gather(motions);
  constexpr std::size_t Size = morph::AffineMotion::SizeAtCompileTime;
  bool isOne = !motions.empty() && static_cast<Index>(fields.size()) == 4 * match.points;
  for (std::size_t k = Size; k < motions.size(); ++k)
  {
    isOne = isOne && motions[k] == motions[k - Size];
  }
  if (!isOne)
  {
    return {};
  }
  morph::Session::AffineHandle handle;
  handle.motion = scale * Eigen::Map<const morph::AffineMotion>(motions.data());
  handle.fields = morph::AffineFields::Zero(match.targets.rows(), 4);
  double after = 0, before = 0;
  for (std::size_t i = 0; i < match.ids.size(); ++i)
  {
    const auto row = static_cast<Index>(i);
    after = std::max(after, match.targets.row(row).cwiseAbs().maxCoeff());
    before = std::max(before, rest.points.row(match.ids[i]).cwiseAbs().maxCoeff());
  }
  const bool isSingle =
    !hasPoints || (isFloat && boundary->GetPoints()->GetDataType() == VTK_FLOAT);
  const double tolerance = AffineArrays::Rounding(
    processes.maximum(after) + processes.maximum(before), processes.all(isSingle));
  bool agrees = true;
  for (Index i = 0; i < handle.fields.rows() && agrees; ++i)
  {
    if (match.sources[i] >= 0)
    {
      std::copy_n(fields.data() + 4 * match.sources[i], 4, handle.fields.row(i).data());
    }
    const Eigen::RowVector3d place = rest.points.row(match.ids[i]) +
                                     morph::affineDisplacement(handle.motion, handle.fields.row(i));
    agrees = (place - match.targets.row(i)).cwiseAbs().maxCoeff() <= tolerance; // NaN does not
  }
  if (!processes.all(agrees))
  {
    return {};
  }
  return handle;
}
}
}
