// SPDX-License-Identifier: BSD-3-Clause
#include "Session/BoundaryTargets.h"

#include "Mesh/Mesh.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
/// Node ids as messages name them.
std::string listNodes(std::vector<Index> nodes, const std::vector<std::int64_t>* globalIds)
{
  for (Index& node : nodes)
  {
    node = globalIds ? (*globalIds)[node] : node;
  }
  return listIds(nodes);
}

/// Ids that were made from another mesh, or went stale when a filter changed the points.
void verifyRestPositions(const NamedPoints& named, const Mesh& rest, double tolerance,
  const std::vector<std::int64_t>* globalIds)
{
  if (named.rest.rows() == 0)
  {
    return;
  }
  std::vector<Index> stale;
  for (const auto& [point, node] : named.pairs)
  {
    // Written so that a NaN disagrees.
    if (!((named.rest.row(point) - rest.points.row(node)).norm() <= tolerance))
    {
      stale.push_back(node);
    }
  }
  if (!stale.empty())
  {
    throw Error(
      "The boundary's ids are stale: its 'RestPosition' disagrees with the grid at node ids " +
      listNodes(stale, globalIds) +
      ". The boundary was made from another mesh or at another time, or a filter has interpolated "
      "its arrays. Apply Extract Morph Boundary to this grid again.");
  }
}

/// Keeps the targets of a plane layer's nodes in their plane, unless the boundary leaves it by more
/// than 1e-6 of the size. Returns the nodes that do. `targets`: of named.pairs, those of images
/// being the front's, which they follow.
std::vector<Index> keepInPlane(
  const NamedPoints& named, const Mesh& rest, double size, Points& targets)
{
  const auto ofPair = [&](std::size_t k)
  {
    const Index node = named.pairs[k].second;
    return std::make_pair(node, rest.layer.frontOf(node));
  };
  const Eigen::RowVector3d& normal = rest.layer.normal;
  std::vector<Index> leaving;
  Points inPlane = targets;
  for (std::size_t k = 0; k < named.pairs.size(); ++k)
  {
    auto to = inPlane.row(static_cast<Index>(k));
    const double height = (to - rest.points.row(ofPair(k).second)).dot(normal);
    if (std::abs(height) > 1e-6 * size)
    {
      leaving.push_back(ofPair(k).second);
    }
    to -= height * normal;
  }
  if (leaving.empty())
  {
    targets.swap(inPlane);
  }
  for (std::size_t k = 0; k < named.pairs.size(); ++k)
  {
    if (const auto [node, front] = ofPair(k); node != front)
    {
      auto to = targets.row(static_cast<Index>(k));
      to = rest.points.row(node) + (to - rest.points.row(front));
    }
  }
  sortUnique(leaving);
  return leaving;
}

/// The positions asked for, the scale factor not yet applied.
Points targetPositions(
  const NamedPoints& named, const Mesh& rest, const std::vector<std::int64_t>* globalIds)
{
  Points targets(static_cast<Index>(named.pairs.size()), 3);
  std::vector<Index> notFinite, huge;
  for (std::size_t k = 0; k < named.pairs.size(); ++k)
  {
    const auto [point, node] = named.pairs[k];
    const auto from = rest.points.row(rest.layer.frontOf(node));
    auto to = targets.row(static_cast<Index>(k));
    to = named.positions.row(point);
    if (named.displacements.rows() > 0)
    {
      to = from + named.displacements.row(point);
    }
    if (!to.allFinite())
    {
      notFinite.push_back(node);
    }
    else if (!isModerate(to))
    {
      huge.push_back(node);
    }
  }
  if (!notFinite.empty())
  {
    throw Error(
      "The boundary has coordinates or displacements that are not finite (NaN or infinite), "
      "at node ids " +
      listNodes(notFinite, globalIds) + ".");
  }
  if (!huge.empty())
  {
    throw Error("The boundary moves nodes beyond 1e50, at node ids " + listNodes(huge, globalIds) +
                ". Use another unit, or correct the displacements.");
  }
  return targets;
}

/// What a node has that is in no row of the targets.
constexpr Index Held = -1, Unnamed = -2, Free = -3;

/// Marks the nodes of free points, and removes their pairs. Returns the number of these.
Index takeFree(NamedPoints& named, std::vector<Index>& row)
{
  auto& pairs = named.pairs;
  if (named.isFree.empty())
  {
    return 0;
  }
  const auto isFree = [&](const std::pair<Index, Index>& pair)
  { return named.isFree[pair.first] != 0; };
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
/// of which moves or is free: those follow their cell, or edges would bend where corners alone are
/// named. A motion of rounding is none: rotation about a node leaves such. ScaleFactor does not
/// matter, so that changing it does not prepare again.
void holdUnnamed(const BoundaryFaces& outer, const Mesh& rest, double size, const Points& targets,
  std::vector<Index>& row)
{
  const auto moves = [&](Index node)
  {
    const auto from = rest.points.row(node);
    const double rounding = 1e-12 * size + 1e-15 * from.cwiseAbs().maxCoeff();
    return row[node] == Free ||
           (row[node] >= 0 && (targets.row(row[node]) - from).norm() > rounding);
  };
  for (std::size_t i = 0; i < outer.nodes.size(); ++i)
  {
    const Index node = outer.nodes[i], k = static_cast<Index>(i);
    const bool isBetween = rest.layer.nodes > 0 && node >= 2 * rest.layer.nodes;
    if (row[node] == Unnamed && !isBetween &&
        std::none_of(outer.between.begin(k), outer.between.end(k), moves))
    {
      row[node] = Held;
    }
  }
}
}

void nameImages(const ShellLayer& layer, NamedPoints& named)
{
  auto& pairs = named.pairs;
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                [&](const auto& pair) { return pair.second >= layer.nodes; }),
    pairs.end());
  const std::size_t front = pairs.size();
  for (std::size_t k = 0; k < front; ++k)
  {
    pairs.emplace_back(pairs[k].first, pairs[k].second + layer.nodes);
  }
}

void gatherPoints(const Communicator& processes, NamedPoints& named)
{
  const Index own = named.positions.rows(), first = processes.sumBefore(own);
  std::vector<double> pairs;
  for (const auto& [point, node] : named.pairs)
  {
    pairs.insert(pairs.end(), { static_cast<double>(first + point), static_cast<double>(node) });
  }
  pairs = processes.gather(pairs);
  named.pairs.clear();
  for (std::size_t k = 0; k < pairs.size(); k += 2)
  {
    named.pairs.emplace_back(static_cast<Index>(pairs[k]), static_cast<Index>(pairs[k + 1]));
  }
  std::vector<double> isFree(named.isFree.begin(), named.isFree.end());
  isFree.resize(static_cast<std::size_t>(own), 0);
  isFree = processes.gather(isFree);
  named.isFree.clear();
  std::transform(isFree.begin(), isFree.end(), std::back_inserter(named.isFree),
    [](double value) { return value != 0; });
  for (Points* rows : { &named.positions, &named.rest, &named.displacements })
  {
    std::vector<double> flat(rows->data(), rows->data() + rows->size());
    flat = processes.gather(flat);
    *rows = Eigen::Map<const Points>(flat.data(), static_cast<Index>(flat.size() / 3), 3);
  }
  if (named.rest.rows() != named.positions.rows())
  {
    named.rest.resize(0, 3);
  }
  named.valueless = processes.sum(named.valueless);
}

BoundaryTargets findTargets(NamedPoints named, const Mesh& rest, const BoundaryFaces& outer,
  double size, const TargetOptions& options, const std::vector<std::int64_t>* globalIds)
{
  const double tolerance = options.matchTolerance * size;
  BoundaryTargets result;
  result.points = named.positions.rows();
  result.unmatched = named.unmatched;
  result.valueless = named.valueless;
  verifyRestPositions(named, rest, tolerance, globalIds);
  const bool isLayer = rest.layer.nodes > 0;
  if (isLayer)
  {
    nameImages(rest.layer, named);
  }
  std::vector<Index> row(rest.numberOfNodes(), Unnamed);
  result.freed = takeFree(named, row);
  result.following = static_cast<Index>(named.pairs.size());
  Points targets = targetPositions(named, rest, globalIds);
  if (isLayer)
  {
    result.leaving = keepInPlane(named, rest, size, targets);
  }
  const auto& pairs = named.pairs;

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
      listNodes(torn, globalIds) + ". Points that stand for one node have to move together.");
  }

  if (options.fixUnnamedBoundary)
  {
    holdUnnamed(outer, rest, size, targets, row);
  }

  result.ids.reserve(pairs.size() + outer.nodes.size());
  result.sources.reserve(pairs.size() + outer.nodes.size());
  for (Index node = 0; node < rest.numberOfNodes(); ++node)
  {
    if (row[node] != Unnamed && row[node] != Free)
    {
      result.ids.push_back(node);
      result.sources.push_back(row[node] < 0 ? -1 : pairs[row[node]].first);
    }
  }
  const double scale = options.scaleFactor;
  std::vector<Index> huge;
  result.targets.resize(static_cast<Index>(result.ids.size()), 3);
  for (std::size_t k = 0; k < result.ids.size(); ++k)
  {
    const auto from = rest.points.row(result.ids[k]);
    const Index r = row[result.ids[k]];
    auto to = result.targets.row(static_cast<Index>(k));
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
    if (!isModerate(to))
    {
      huge.push_back(result.ids[k]);
    }
  }
  if (!huge.empty())
  {
    std::ostringstream text;
    text << scale;
    throw Error("`ScaleFactor` " + text.str() + " moves nodes beyond 1e50, at node ids " +
                listNodes(huge, globalIds) + ". Lower it.");
  }
  return result;
}

void countStaying(const Mesh& rest, const BoundaryFaces& outer,
  const std::function<bool(Index node)>& owns, BoundaryTargets& result)
{
  for (std::size_t i = 0; i < result.ids.size(); ++i)
  {
    result.staying += result.targets.row(static_cast<Index>(i)) == rest.points.row(result.ids[i]) &&
                      owns(result.ids[i]);
  }
  for (std::size_t i = 0; i < outer.nodes.size(); ++i)
  {
    const Index node = outer.nodes[i], k = static_cast<Index>(i);
    result.open += outer.between.begin(k) == outer.between.end(k) && owns(node) &&
                   !std::binary_search(result.ids.begin(), result.ids.end(), node);
  }
}

void conclude(const TargetOptions& options, BoundaryTargets& result)
{
  const auto ofPoints = [&](Index count)
  {
    return std::to_string(count) + " of the boundary's " + std::to_string(result.points) +
           " points";
  };
  const bool areFree = result.following == 0 && result.freed > 0;
  if (areFree && result.valueless > 0)
  {
    throw Error("No point of the boundary has a displacement, so nothing says where the mesh goes: "
                "'" +
                options.displacementArray + "' is NaN, or vtkValidPointMask 0, at " +
                ofPoints(result.valueless) + ". Give displacements where the boundary is.");
  }
  if (areFree)
  {
    throw Error("All points of the boundary are free (its point array MorphFree is not 0), so "
                "nothing says where the mesh goes. Let some of them stay or move.");
  }
  if (result.valueless > 0)
  {
    result.warnings.push_back(
      ofPoints(result.valueless) + " have no displacement ('" + options.displacementArray +
      "' is NaN, or vtkValidPointMask 0, there). Their nodes are free: they "
      "are solved with the interior.");
  }
  if (result.unmatched > 0)
  {
    result.warnings.push_back(
      ofPoints(result.unmatched) +
      " are not within `MatchTolerance` of a node of the grid and were left out.");
  }
}

void requirePlane(const BoundaryTargets& result, const Communicator& processes)
{
  std::vector<Index> leaving;
  std::copy_if(result.leaving.begin(), result.leaving.end(), std::back_inserter(leaving),
    [&](Index node) { return processes.owns(node); });
  leaving = processes.gatherNodes(leaving);
  if (!leaving.empty())
  {
    throw Error("The boundary of a plane mesh leaves its plane, at node ids " + listIds(leaving) +
                ". Shapes and derivatives of a plane mesh are those in the plane: morph it out of "
                "the plane first, and give them the curved shell.");
  }
}

void warnOf(const BoundaryTargets& result, Monitor& monitor)
{
  for (const std::string& warning : result.warnings)
  {
    monitor.warn(warning);
  }
  if (result.staying == 0 && result.open > 0)
  {
    monitor.warn("Nothing holds the mesh: all prescribed nodes move, and the other outer nodes are "
                 "free, so that the whole mesh may go along. Hold a surface if that is not meant.");
  }
}
}
