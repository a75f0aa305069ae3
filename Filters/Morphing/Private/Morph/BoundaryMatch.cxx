// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/BoundaryMatch.h"

#include "Mesh/Extent.h"
#include "Private/Data/AffineArrays.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

using Pairs = std::vector<std::pair<Index, Index>>; // see NamedPoints

std::string quoted(const std::string& name)
{
  return "'" + name + "'";
}

std::string pointArrays(vtkPointSet* boundary)
{
  std::string names;
  vtkPointData* data = boundary->GetPointData();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    if (const char* name = data->GetArrayName(i))
    {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  }
  return names.empty() ? "it has no point arrays" : "its point arrays are " + names;
}

/// As messages show it: all digits of an id, few of a fraction.
std::string text(double value)
{
  std::ostringstream stream;
  stream << std::setprecision(std::floor(value) == value ? 15 : 6) << value;
  return stream.str();
}

/// The boundary's point array of that name, with a number or vector for each of its points; null
/// where there is none.
vtkDataArray* findArray(vtkPointSet* boundary, const std::string& name)
{
  vtkAbstractArray* array = boundary->GetPointData()->GetAbstractArray(name.c_str());
  if (!array)
  {
    return nullptr;
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers)
  {
    throw Error("The boundary's point array " + quoted(name) + " is not numeric (it is a " +
                array->GetClassName() + "). Convert it to numbers, or rename it.");
  }
  // VTK does not see to it that arrays are as long as their data set.
  if (array->GetNumberOfTuples() != boundary->GetNumberOfPoints())
  {
    throw Error("The boundary's point array " + quoted(name) + " has " +
                std::to_string(array->GetNumberOfTuples()) + " tuples for " +
                std::to_string(boundary->GetNumberOfPoints()) +
                " points. Give it one for each, or remove the array.");
  }
  return numbers;
}

vtkDataArray* requireArray(
  vtkPointSet* boundary, const std::string& name, const char* property, int components)
{
  vtkDataArray* array = findArray(boundary, name);
  if (!array)
  {
    throw Error("`" + std::string(property) + "` names " + quoted(name) +
                ", which the boundary does not have: " + pointArrays(boundary) + ".");
  }
  if (array->GetNumberOfComponents() != components)
  {
    throw Error("The boundary's point array " + quoted(name) + " has " +
                std::to_string(array->GetNumberOfComponents()) + " components; `" + property +
                "` needs " + std::to_string(components) + ".");
  }
  return array;
}

/// Ids that nothing verifies, and that may number the boundary instead of the grid, show by naming
/// interior nodes.
void warnOfInteriorNodes(vtkDataArray* ids, const Pairs& pairs, const std::vector<Index>& outer,
  std::vector<std::string>& warnings)
{
  std::vector<Index> interior;
  for (const auto& pair : pairs)
  {
    if (!std::binary_search(outer.begin(), outer.end(), pair.second))
    {
      interior.push_back(pair.second);
    }
  }
  if (!interior.empty())
  {
    warnings.push_back(
      "The boundary's '" + std::string(ids->GetName()) +
      "' names nodes that are not on the grid's outer boundary: " + morph::listIds(interior) +
      ". If it numbers the boundary's own points, make the boundary with Extract Morph Boundary "
      "instead, whose ids are checked.");
  }
}

/// Throws where most of the boundary's cells join nodes that no cell of the mesh joins: its nodes
/// come in another order, or are those of another mesh.
void requireCellsOfMesh(vtkPointSet* boundary, const Pairs& pairs, const morph::Mesh& rest)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(boundary);
  auto* surface = vtkPolyData::SafeDownCast(boundary);
  const vtkIdType count = surface ? surface->GetNumberOfPolys() : boundary->GetNumberOfCells();
  if (count == 0 || (grid && GridMesh::SameCells(grid, rest)))
  {
    return;
  }
  std::vector<Index> nodeOf(boundary->GetNumberOfPoints(), -1);
  for (const auto& [point, node] : pairs)
  {
    nodeOf[point] = node;
  }
  const morph::Adjacency cellsOf = morph::nodeToCells(rest);
  const auto haveOne = [&cellsOf](const std::vector<Index>& nodes)
  {
    return std::any_of(cellsOf.begin(nodes[0]), cellsOf.end(nodes[0]),
      [&](Index cell)
      {
        return std::all_of(nodes.begin(), nodes.end(),
          [&](Index node)
          { return std::binary_search(cellsOf.begin(node), cellsOf.end(node), cell); });
      });
  };
  std::vector<Index> strange;
  Index known = 0;
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < count; ++c)
  {
    surface ? surface->GetPolys()->GetCellAtId(c, points) : boundary->GetCellPoints(c, points);
    std::vector<Index> corners; // those of the mesh's cells
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      const Index node = nodeOf[points->GetId(k)];
      if (node >= 0 && cellsOf.begin(node) != cellsOf.end(node))
      {
        corners.push_back(node);
      }
    }
    known += corners.size() > 2;
    if (corners.size() > 2 && !haveOne(corners))
    {
      strange.push_back(c);
    }
  }
  if (2 * static_cast<Index>(strange.size()) > known)
  {
    throw Error(
      "The boundary's points are not the grid's nodes: " + std::to_string(strange.size()) +
      " of its " + std::to_string(count) +
      " cells join nodes that no cell of the grid joins, the cells " + morph::listIds(strange) +
      ". Its nodes come in another order, or are those of another mesh. Make the "
      "boundary with Extract Morph Boundary, or set `BoundaryIdArray`.");
  }
}

/// Frees the points whose displacement is NaN, or where the mask, if there is one, is 0.
void freeValueless(vtkDataArray* mask, morph::NamedPoints& named)
{
  named.isFree.resize(named.positions.rows(), 0);
  for (Index i = 0; i < named.positions.rows(); ++i)
  {
    if (DataCheck::IsMissing(named.displacements.row(i), mask, i))
    {
      named.isFree[i] = 1;
      ++named.valueless;
    }
  }
}

/// `nearest`: gets for each of its nodes the squared distance of the nearest node of its cells that
/// is not in the very same place, or keeps infinity.
void findNeighbors(const morph::Mesh& mesh, std::map<Index, double>& nearest)
{
  for (Index c = 0; c < mesh.numberOfCells() && !nearest.empty(); ++c)
  {
    const Index* nodes = mesh.cell(c);
    for (Index k = 0; k < mesh.cellSize(c); ++k)
    {
      const auto found = nearest.find(nodes[k]);
      for (Index other = 0; found != nearest.end() && other < mesh.cellSize(c); ++other)
      {
        const double distance2 =
          (mesh.points.row(nodes[other]) - mesh.points.row(nodes[k])).squaredNorm();
        found->second = distance2 > 0 ? std::min(found->second, distance2) : found->second;
      }
    }
  }
}

/// The boundary's array of node ids that comes first, or null: BoundaryIdArray, MorphPointId.
vtkDataArray* findIds(vtkPointSet* boundary, const BoundaryMatch::Options& options)
{
  return options.BoundaryIdArray.empty()
           ? findArray(boundary, Surface::IdName)
           : requireArray(boundary, options.BoundaryIdArray, "BoundaryIdArray", 1);
}

/// Pairs of a point and its id; ids lie between 0 and `nodes` - 1.
Pairs pairsOf(vtkDataArray* ids, Index nodes)
{
  const std::string name = quoted(ids->GetName());
  if (ids->GetNumberOfComponents() != 1)
  {
    throw Error("The boundary's point array " + name + " has " +
                std::to_string(ids->GetNumberOfComponents()) + " components; ids have one.");
  }
  const Index points = ids->GetNumberOfTuples();
  Pairs pairs;
  pairs.reserve(points);
  std::vector<Index> outside, fractional; // boundary points
  for (Index i = 0; i < points; ++i)
  {
    const double value = ids->GetComponent(i, 0);
    if (!(std::floor(value) == value))
    {
      fractional.push_back(i);
    }
    else if (value < 0 || value >= static_cast<double>(nodes))
    {
      outside.push_back(i);
    }
    else
    {
      pairs.emplace_back(i, static_cast<Index>(value));
    }
  }
  if (!fractional.empty())
  {
    throw Error("The boundary's point array " + name +
                " holds values that are not whole numbers, at its points " +
                morph::listIds(fractional) +
                ". A filter has interpolated the ids: use one that keeps the points.");
  }
  if (!outside.empty())
  {
    throw Error("The boundary's point array " + name + " holds ids outside the grid's 0 to " +
                std::to_string(nodes - 1) + ", " + text(ids->GetComponent(outside.front(), 0)) +
                " for instance, at its points " + morph::listIds(outside) +
                ". Make the boundary from this grid, with Extract Morph Boundary.");
  }
  return pairs;
}

/// Pairs of a point and its node, by position; `unmatched` counts the points without one.
Pairs findByPosition(const Points& positions, const morph::Mesh& rest,
  const std::vector<Index>& outer, double tolerance, Index& unmatched)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  // The locator only reads, and VTK has no constant arrays.
  coordinates->SetArray(const_cast<double*>(rest.points.data()), rest.points.size(), 1);
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkPolyData> nodes;
  nodes->SetPoints(points);
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(nodes);
  locator->BuildLocator();

  Pairs pairs;
  // The locator turns places into bucket numbers, and those far outside overflow.
  const Eigen::AlignedBox3d box(
    rest.points.colwise().minCoeff().transpose() - Eigen::Vector3d::Constant(tolerance),
    rest.points.colwise().maxCoeff().transpose() + Eigen::Vector3d::Constant(tolerance));
  std::vector<std::uint8_t> taken(rest.numberOfNodes(), 0);
  for (Index i = 0; i < positions.rows(); ++i)
  {
    double distance2 = 0;
    const vtkIdType closest =
      box.contains(positions.row(i).transpose())
        ? locator->FindClosestPointWithinRadius(tolerance, positions.row(i).data(), distance2)
        : -1;
    if (closest < 0)
    {
      ++unmatched;
      continue;
    }
    pairs.emplace_back(i, closest);
    taken[closest] = 1;
  }

  // Bodies that touch have a node each in the same place, but for rounding: an outer node that no
  // point is closest to goes along with the nearest node that has one. It is in the same place if
  // it is closer than to its neighbors.
  struct Companion
  {
    Index Node;
    double Distance2;
    Index Point;
    bool operator<(const Companion& other) const
    {
      return std::tie(Node, Distance2, Point) < std::tie(other.Node, other.Distance2, other.Point);
    }
  };
  std::vector<Companion> companions;
  vtkNew<vtkIdList> near;
  for (const auto& [point, closest] : pairs)
  {
    const auto center = rest.points.row(closest);
    locator->FindPointsWithinRadius(tolerance, center.data(), near);
    for (vtkIdType k = 0; k < near->GetNumberOfIds(); ++k)
    {
      const Index node = near->GetId(k);
      if (!taken[node] && std::binary_search(outer.begin(), outer.end(), node))
      {
        companions.push_back({ node, (rest.points.row(node) - center).squaredNorm(), point });
      }
    }
  }
  std::sort(companions.begin(), companions.end());
  std::map<Index, double> nearest;
  for (const Companion& companion : companions)
  {
    nearest.emplace(companion.Node, std::numeric_limits<double>::infinity());
  }
  findNeighbors(rest, nearest);
  for (const Companion& companion : companions)
  {
    if (!taken[companion.Node] && companion.Distance2 < nearest[companion.Node])
    {
      taken[companion.Node] = 1;
      pairs.emplace_back(companion.Point, companion.Node);
    }
  }
  return pairs;
}

/// All of NamedPoints but its pairs. `precision`: gets that of the points if they are the targets.
morph::NamedPoints readPoints(
  vtkPointSet* boundary, const BoundaryMatch::Options& options, Precision& precision)
{
  morph::NamedPoints named;
  named.positions = GridMesh::FromPoints(boundary->GetPoints());
  if (options.displacementArray.empty())
  {
    precision = Precision::Of(boundary->GetPoints(), named.positions);
  }
  if (vtkDataArray* array = findArray(boundary, Surface::RestName))
  {
    if (array->GetNumberOfComponents() < 3)
    {
      throw Error(
        "The boundary's point array 'RestPosition' has " +
        std::to_string(array->GetNumberOfComponents()) +
        " components; a position has three. Rename it, or make the boundary with Extract Morph "
        "Boundary.");
    }
    named.rest = GridMesh::FromVectors(array);
  }
  if (vtkDataArray* marks = findArray(boundary, Surface::FreeName))
  {
    named.isFree.resize(boundary->GetNumberOfPoints());
    for (std::size_t i = 0; i < named.isFree.size(); ++i)
    {
      named.isFree[i] = marks->GetComponent(static_cast<vtkIdType>(i), 0) != 0;
    }
  }
  if (!options.displacementArray.empty())
  {
    named.displacements = GridMesh::FromVectors(
      requireArray(boundary, options.displacementArray, "DisplacementArray", 3));
    freeValueless(findArray(boundary, DataCheck::MaskName), named);
  }
  return named;
}

/// Puts coordinates back that differ from those of `rest` by their rounding alone. Returns their
/// number.
Index takeBackRounding(
  const Precision& precision, const morph::Mesh& rest, morph::NamedPoints& named)
{
  Index rounded = 0;
  if (named.displacements.rows() > 0)
  {
    return rounded;
  }
  for (const auto& [point, node] : named.pairs)
  {
    const auto from = rest.points.row(node);
    auto to = named.positions.row(point);
    const bool isFree = !named.isFree.empty() && named.isFree[point] != 0;
    for (int j = 0; j < 3 && !isFree && morph::isModerate(to); ++j)
    {
      if (to[j] != from[j] && precision.IsRounded(to[j], from[j]))
      {
        to[j] = from[j];
        ++rounded;
      }
    }
  }
  return rounded;
}

/// How many points a copy of the grid, or of this process's piece, has.
Index pointsOf(const BoundaryMatch::Nodes& nodes)
{
  const Index front = nodes.Rest.layer.nodes; // without images
  return nodes.Ids ? nodes.Points : front > 0 ? front : nodes.Rest.numberOfNodes();
}

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

/// How points find their nodes. All processes with points agree on it.
enum class Way
{
  None, ///< this process has no points
  Ids,
  Copies, ///< point i is node i of the process's piece
  Positions
};

constexpr Index MostIds = Index(1) << 52; // of a mesh of which this process has a part

/// How the points of this process find their nodes; adds their pairs to `gathered`, unless by
/// positions. `areCopies`: each process has as many points as its piece.
Way findWay(vtkPointSet* boundary, const BoundaryMatch::Nodes& nodes, bool areCopies,
  const BoundaryMatch::Options& options, BoundaryMatch::Gathered& gathered)
{
  const bool isPart = nodes.Ids != nullptr;
  const Index most = isPart ? MostIds : nodes.Rest.numberOfNodes(), own = pointsOf(nodes);
  Pairs& pairs = gathered.Points.pairs;
  const auto verify = [&]
  {
    if (!isPart &&
        !boundary->GetPointData()->HasArray(Surface::RestName)) // else findTargets() does
    {
      requireCellsOfMesh(boundary, pairs, nodes.Rest);
    }
  };
  if (vtkDataArray* ids = findIds(boundary, options))
  {
    pairs = pairsOf(ids, most);
    verify();
    return Way::Ids;
  }
  if (areCopies)
  {
    // A warped copy of the grid: its interior says nothing about the boundary.
    pairs.reserve(nodes.Outer.nodes.size());
    for (const Index node : nodes.Outer.nodes)
    {
      if (node < own)
      {
        pairs.emplace_back(node, isPart ? (*nodes.Ids)[node] : node);
      }
    }
    verify();
    return Way::Copies;
  }
  for (const std::string name : { "PointIds", "vtkOriginalPointIds" })
  {
    vtkDataArray* ids = findArray(boundary, name);
    if (!ids)
    {
      continue;
    }
    if (isPart)
    {
      throw Error("On several MPI ranks the point array '" + name +
                  "' may number each rank's points. Name it as `BoundaryIdArray` if its ids are "
                  "global, or make the boundary with Extract Morph Boundary.");
    }
    pairs = pairsOf(ids, most);
    warnOfInteriorNodes(ids, pairs, nodes.Outer.nodes, gathered.Warnings);
    if (name != "PointIds")
    {
      gathered.Warnings.emplace_back(
        "The boundary's points are matched by 'vtkOriginalPointIds', which filters pass on even "
        "where "
        "it numbers the points of another data set. Extract Morph Boundary writes ids that can be "
        "checked.");
    }
    verify();
    return Way::Ids;
  }
  if (options.displacementArray.empty())
  {
    throw Error(
      "Nothing says which nodes the boundary's " + std::to_string(boundary->GetNumberOfPoints()) +
      " points are (the grid has " + std::to_string(own) +
      " points): there is no point array MorphPointId, PointIds or vtkOriginalPointIds; " +
      pointArrays(boundary) +
      ". Make the boundary with Extract Morph Boundary, or set `BoundaryIdArray`, or give "
      "undeformed points with a `DisplacementArray`.");
  }
  return Way::Positions;
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
BoundaryMatch::Followers followersOf(const BoundaryMatch::Gathered& gathered,
  const std::vector<std::uint8_t>& isFree, const morph::BoundaryTargets& match,
  const morph::Communicator& processes)
{
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
  const bool areCopies = processes.all(boundary->GetNumberOfPoints() == pointsOf(nodes));
  processes.together(
    [&]
    {
      if (boundary->GetNumberOfPoints() > 0)
      {
        named = readPoints(boundary, options, precision);
        way = findWay(boundary, nodes, areCopies, options, result);
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
    named.pairs = findByPosition(named.positions, nodes.Rest, nodes.Outer.nodes,
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
  rounded = takeBackRounding(all.PointPrecision, nodes.Rest, named);
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
  const std::vector<std::uint8_t> isFree = gathered.Points.isFree;
  morph::BoundaryTargets result;
  Index rounded = 0;
  processes.together([&] { result = TargetsOf(gathered, nodes, options, rounded); });
  if (gathered.ByPosition)
  {
    const auto unmatched = unknownPoints(result.points, gathered.Points.pairs, processes);
    result.unmatched = static_cast<Index>(unmatched.size());
    if (result.unmatched == result.points)
    {
      throw Error("None of the boundary's " + std::to_string(result.points) +
                  " points is within `MatchTolerance` (" + text(options.matchTolerance) +
                  " of the grid's size) of a node of the grid. Where a `DisplacementArray` is set, "
                  "the points "
                  "have to be undeformed.");
    }
  }
  if (nodes.Ids)
  {
    takeOwners(nodes.Rest, processes, result);
  }
  if (followers)
  {
    *followers = followersOf(gathered, isFree, result, processes);
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
