// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/BoundaryMatch.h"

#include "Mesh/Extent.h"
#include "Private/Data/AffineArrays.h"
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

/// `named`: without its pairs; gets the number of unmatched points.
Pairs findNodes(vtkPointSet* boundary, const morph::Mesh& rest, const std::vector<Index>& outer,
  double tolerance, const BoundaryMatch::Options& options, morph::NamedPoints& named,
  std::vector<std::string>& warnings)
{
  const Points& positions = named.positions;
  const Index nodes = rest.numberOfNodes();
  const Index own = rest.layer.nodes > 0 ? rest.layer.nodes : nodes; // without images
  const auto verified = [&](Pairs pairs)
  {
    if (!boundary->GetPointData()->HasArray(Surface::RestName)) // which FindTargets() verifies
    {
      requireCellsOfMesh(boundary, pairs, rest);
    }
    return pairs;
  };
  if (vtkDataArray* ids = BoundaryMatch::FindIds(boundary, options))
  {
    return verified(BoundaryMatch::FindByIds(ids, nodes));
  }
  if (positions.rows() == own)
  {
    // A warped copy of the grid: its interior says nothing about the boundary.
    Pairs pairs;
    pairs.reserve(outer.size());
    for (Index node : outer)
    {
      if (node < own)
      {
        pairs.emplace_back(node, node);
      }
    }
    return verified(std::move(pairs));
  }
  if (vtkDataArray* ids = findArray(boundary, "PointIds"))
  {
    Pairs pairs = BoundaryMatch::FindByIds(ids, nodes);
    warnOfInteriorNodes(ids, pairs, outer, warnings);
    return verified(std::move(pairs));
  }
  if (vtkDataArray* ids = findArray(boundary, "vtkOriginalPointIds"))
  {
    Pairs pairs = BoundaryMatch::FindByIds(ids, nodes);
    warnOfInteriorNodes(ids, pairs, outer, warnings);
    warnings.emplace_back(
      "The boundary's points are matched by 'vtkOriginalPointIds', which filters pass on even "
      "where "
      "it numbers the points of another data set. Extract Morph Boundary writes ids that can be "
      "checked.");
    return verified(std::move(pairs));
  }
  if (!options.displacementArray.empty())
  {
    Pairs pairs = BoundaryMatch::FindByPosition(positions, rest, outer, tolerance, named.unmatched);
    if (pairs.empty())
    {
      throw Error("None of the boundary's " + std::to_string(positions.rows()) +
                  " points is within `MatchTolerance` (" + text(options.matchTolerance) +
                  " of the grid's size) of a node of the grid. Where a `DisplacementArray` is set, "
                  "the points "
                  "have to be undeformed.");
    }
    return pairs;
  }
  throw Error("Nothing says which nodes the boundary's " + std::to_string(positions.rows()) +
              " points are (the grid has " + std::to_string(own) +
              " points): there is no point array MorphPointId, PointIds or vtkOriginalPointIds; " +
              pointArrays(boundary) +
              ". Make the boundary with Extract Morph Boundary, or set `BoundaryIdArray`, or give "
              "undeformed points with a `DisplacementArray`.");
}
}

namespace BoundaryMatch
{
vtkDataArray* FindIds(vtkPointSet* boundary, const Options& options)
{
  return options.BoundaryIdArray.empty()
           ? findArray(boundary, Surface::IdName)
           : requireArray(boundary, options.BoundaryIdArray, "BoundaryIdArray", 1);
}

Pairs FindByIds(vtkDataArray* ids, Index nodes)
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

Pairs FindByPosition(const Points& positions, const morph::Mesh& rest,
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

morph::NamedPoints ReadPoints(vtkPointSet* boundary, const Options& options, Precision& precision)
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

morph::BoundaryTargets Match(vtkPointSet* boundary, const morph::Mesh& rest,
  const morph::BoundaryFaces& outer, double size, const Options& options)
{
  if (boundary->GetNumberOfPoints() == 0)
  {
    throw Error("The boundary has no points, so nothing says where the mesh goes.");
  }
  Precision precision;
  morph::NamedPoints named = ReadPoints(boundary, options, precision);
  std::vector<std::string> warnings;
  named.pairs =
    findNodes(boundary, rest, outer.nodes, options.matchTolerance * size, options, named, warnings);
  const Index rounded = TakeBackRounding(precision, rest, named);
  morph::BoundaryTargets found = morph::findTargets(std::move(named), rest, outer, size, options);
  found.warnings = std::move(warnings);
  morph::countStaying(
    rest, outer, [](Index) { return true; }, found);
  Conclude(size, options, precision, rounded, found);
  return found;
}

std::optional<morph::Session::AffineHandle> FindHandle(vtkPointSet* boundary,
  const morph::BoundaryTargets& match, const morph::Mesh& rest, double scale, bool isFloat)
{
  const auto found = AffineArrays::Read(boundary);
  if (!found || match.ids.empty())
  {
    return {};
  }
  morph::Session::AffineHandle handle;
  handle.motion = scale * found->Motion;
  handle.fields = morph::AffineFields::Zero(match.targets.rows(), 4);
  double size = match.targets.cwiseAbs().maxCoeff(), before = 0;
  for (const morph::Index node : match.ids)
  {
    before = std::max(before, rest.points.row(node).cwiseAbs().maxCoeff());
  }
  size += before;
  const bool isSingle = isFloat && boundary->GetPoints()->GetDataType() == VTK_FLOAT;
  const double tolerance = AffineArrays::Rounding(size, isSingle);
  auto* doubles = vtkDoubleArray::FastDownCast(found->Fields);
  const double* fields = doubles ? doubles->GetPointer(0) : nullptr;
  for (morph::Index i = 0; i < handle.fields.rows(); ++i)
  {
    if (match.sources[i] >= 0 && fields)
    {
      std::copy_n(fields + 4 * match.sources[i], 4, handle.fields.row(i).data());
    }
    else if (match.sources[i] >= 0)
    {
      found->Fields->GetTuple(match.sources[i], handle.fields.row(i).data());
    }
    const Eigen::RowVector3d place = rest.points.row(match.ids[i]) +
                                     morph::affineDisplacement(handle.motion, handle.fields.row(i));
    if (!((place - match.targets.row(i)).cwiseAbs().maxCoeff() <= tolerance)) // NaN, too
    {
      return {};
    }
  }
  return handle;
}
}
}
