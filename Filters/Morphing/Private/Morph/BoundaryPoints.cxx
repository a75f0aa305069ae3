// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/BoundaryPoints.h"

#include "Private/Data/DataCheck.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Support/Error.h"

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
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

namespace morph::filters
{
namespace
{
using BoundaryPoints::Pairs;
using morph::Error;
using morph::Index;
using morph::Points;

constexpr Index MostIds = Index(1) << 52; // of a mesh of which this process has a part

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
}

namespace BoundaryPoints
{
Pairs ByPosition(const Points& positions, const morph::Mesh& rest, const std::vector<Index>& outer,
  double tolerance, Index& unmatched)
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

morph::NamedPoints Read(
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

Index TakeBackRounding(
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

Index Count(const BoundaryMatch::Nodes& nodes)
{
  const Index front = nodes.Rest.layer.nodes; // without images
  return nodes.Ids ? nodes.Points : front > 0 ? front : nodes.Rest.numberOfNodes();
}

Way FindWay(vtkPointSet* boundary, const BoundaryMatch::Nodes& nodes, bool areCopies,
  const BoundaryMatch::Options& options, BoundaryMatch::Gathered& gathered)
{
  const bool isPart = nodes.Ids != nullptr;
  const Index most = isPart ? MostIds : nodes.Rest.numberOfNodes(), own = Count(nodes);
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
        "where it numbers the points of another data set. Extract Morph Boundary writes ids that "
        "can be checked.");
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
}
}
