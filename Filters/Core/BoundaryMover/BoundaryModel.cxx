// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/BoundaryModel.h"

#include "Boundary/FaceQuality.h"
#include "Boundary/NodesBetween.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace morph
{
namespace
{
/// Whether all of these faces are among the last ones of `all`.
bool areLast(const std::vector<Index>& faces, const BoundaryFaces& all, std::size_t number)
{
  const auto first = static_cast<Index>(all.offsets.size() - 1 - number);
  return !faces.empty() &&
         std::all_of(faces.begin(), faces.end(), [first](Index face) { return face >= first; });
}

/// Which faces the marked cells have; a volume cell those on the boundary alone, and none where
/// `hasNodes`: then these say what the surface is.
std::vector<Index> facesOfCells(const Mesh& mesh, const BoundaryFaces& faces, std::size_t inside,
  const std::vector<std::uint8_t>& isMarked, bool hasNodes)
{
  const bool isMesh = mesh.numberOfCells() > 0;
  const std::map<Corners, int> flat = isMesh ? flatCells(mesh, isMarked) : std::map<Corners, int>();
  const std::size_t count = faces.offsets.size() - 1;
  std::vector<Index> result;
  if (isMesh && flat.empty() && hasNodes)
  {
    return result;
  }
  for (std::size_t f = 0; f < (flat.empty() ? count - inside : count); ++f)
  {
    const Index behind = isMesh ? faces.cells[f] : static_cast<Index>(f);
    if (flat.empty() ? isMarked[behind] != 0
                     : flat.count(cornersOfCell(mesh, faces, static_cast<Index>(f))) > 0)
    {
      result.push_back(static_cast<Index>(f));
    }
  }
  return result;
}

/// As a set of inner faces, which are the last ones of the boundary.
NamedSet setAt(const InnerSurface& surface, const BoundaryFaces& faces, std::size_t inside)
{
  NamedSet set;
  set.name = surface.name;
  for (std::size_t f = faces.cells.size() - inside; f < faces.cells.size(); ++f)
  {
    if (std::binary_search(surface.places.begin(), surface.places.end(),
          std::make_pair(faces.cells[f], faces.sides[f])))
    {
      const auto begin = faces.connectivity.begin();
      set.faces.push_back(static_cast<Index>(f));
      set.nodes.insert(set.nodes.end(), begin + faces.offsets[f], begin + faces.offsets[f + 1]);
    }
  }
  sortUnique(set.nodes);
  return set;
}

/// The diagonal of the box around these nodes; 0 for none.
double sizeOf(const Points& points, const std::vector<Index>& nodes)
{
  Eigen::AlignedBox3d box;
  for (const Index node : nodes)
  {
    box.extend(points.row(node).transpose());
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}
}

NamedSet boundarySet(const std::string& name, const Mesh& mesh, const BoundaryFaces& faces,
  std::size_t inside, const std::vector<std::uint8_t>& isNode,
  const std::vector<std::uint8_t>& isCell)
{
  NamedSet set;
  set.name = name;
  const auto begin = faces.connectivity.begin();
  if (!isNode.empty())
  {
    const std::size_t outer = faces.offsets.size() - 1 - inside;
    std::vector<std::uint8_t> isOuter(isNode.size(), 0);
    std::for_each(begin, begin + faces.offsets[outer], [&](Index node) { isOuter[node] = 1; });
    for (std::size_t i = 0; i < faces.nodes.size(); ++i)
    {
      const Index node = faces.nodes[i], k = static_cast<Index>(i);
      const Index *first = faces.between.begin(k), *last = faces.between.end(k);
      const bool isBetween =
        first != last && std::all_of(first, last, [&](Index n) { return isOuter[n] != 0; });
      if (isNode[node] && (isOuter[node] || isBetween))
      {
        set.nodes.push_back(node);
      }
    }
    const auto isMarked = [&](Index node) { return isNode[node] != 0; };
    for (std::size_t f = 0; f < outer; ++f)
    {
      if (std::all_of(begin + faces.offsets[f], begin + faces.offsets[f + 1], isMarked))
      {
        set.faces.push_back(static_cast<Index>(f));
      }
    }
  }
  if (!isCell.empty())
  {
    for (const Index face : facesOfCells(mesh, faces, inside, isCell, !set.nodes.empty()))
    {
      set.faces.push_back(face);
      set.nodes.insert(
        set.nodes.end(), begin + faces.offsets[face], begin + faces.offsets[face + 1]);
    }
  }
  sortUnique(set.nodes);
  sortUnique(set.faces);
  return set;
}

bool BoundaryModel::areInner(const std::vector<Index>& ids) const
{
  return areLast(ids, this->faces, this->inner.size());
}

std::vector<Index> BoundaryModel::sheets() const
{
  std::vector<Index> result;
  for (std::size_t s = 0; s < this->geometry.surfaces.size(); ++s)
  {
    if (areLast(this->geometry.surfaces[s].faces, this->faces, this->inner.sheets.size()))
    {
      result.push_back(static_cast<Index>(s));
    }
  }
  return result;
}

std::vector<std::uint8_t> BoundaryModel::nodesOnlyOn(const std::vector<Index>& surfaces) const
{
  std::vector<std::uint8_t> result(this->points().rows(), 0);
  const auto mark = [&](Index surface, std::uint8_t value)
  {
    for (const Index node : this->geometry.surfaces[surface].nodes)
    {
      result[node] = value;
    }
  };
  for (const Index s : surfaces)
  {
    mark(s, 1);
  }
  for (std::size_t s = 0; s < this->geometry.surfaces.size(); ++s)
  {
    if (!std::binary_search(surfaces.begin(), surfaces.end(), static_cast<Index>(s)))
    {
      mark(static_cast<Index>(s), 0);
    }
  }
  return result;
}

Points BoundaryModel::outwardAreas(const Points& at) const
{
  Points areas = faceAreas(at, this->faces);
  for (Index f = 0; f < areas.rows(); ++f)
  {
    areas.row(f) *= this->orientation[f];
  }
  return areas;
}

void BoundaryModel::findFaces(const std::vector<std::uint8_t>& isNamed, Monitor& monitor)
{
  const ConnectedComponents bodies = connectedComponents(this->mesh);
  this->bodyOfNode = bodyOfNodes(this->mesh, bodies);
  this->faces = boundaryFaces(this->mesh, this->hanging, monitor);
  this->inner = innerFaces(this->mesh, this->faces, isNamed, monitor);
  InnerFaces::Places& sheets = this->inner.sheets;
  for (const InnerSurface& surface : this->innerSurfaces)
  {
    for (const auto& place : surface.places)
    {
      const InnerFaces::Places& baffles = this->inner.baffles;
      if (this->asked.count(surface.name) > 0 &&
          !std::binary_search(baffles.begin(), baffles.end(), place))
      {
        sheets.push_back(place);
      }
    }
  }
  sortUnique(sheets);
  if (this->inner.size() > 0)
  {
    InnerFaces::Places places;
    for (std::size_t f = 0; f < this->faces.cells.size(); ++f)
    {
      places.emplace_back(this->faces.cells[f], this->faces.sides[f]);
    }
    for (const auto* some : { &this->inner.baffles, &this->inner.sheets })
    {
      places.insert(places.end(), some->begin(), some->end());
    }
    this->faces = facesAt(this->mesh, places);
    this->hanging.divideEdges(this->faces);
  }
  this->onLinearEdges = nodesOnLinearEdges(this->mesh, this->faces);
  const std::vector<std::int8_t> ofCell = cellSigns(this->mesh, bodies);
  this->orientation.clear();
  for (const Index cell : this->faces.cells)
  {
    this->orientation.push_back(ofCell[cell]);
  }
  monitor.check();
}

std::vector<Index> BoundaryModel::sheetNumbers() const
{
  std::map<std::vector<std::size_t>, Index> numberOf;
  std::vector<Index> numbers;
  for (const auto& place : this->inner.sheets)
  {
    std::vector<std::size_t> on;
    for (std::size_t i = 0; i < this->innerSurfaces.size(); ++i)
    {
      const InnerSurface& surface = this->innerSurfaces[i];
      if (this->asked.count(surface.name) > 0 &&
          std::binary_search(surface.places.begin(), surface.places.end(), place))
      {
        on.push_back(i);
      }
    }
    numbers.push_back(numberOf.emplace(std::move(on), Index(numberOf.size())).first->second);
  }
  return numbers;
}

void BoundaryModel::takeSets(std::vector<NamedSet> sets)
{
  const auto isInside = [this](const NamedSet& set)
  {
    return std::any_of(this->innerSurfaces.begin(), this->innerSurfaces.end(),
      [&](const InnerSurface& surface) { return surface.name == set.name; });
  };
  sets.erase(std::remove_if(sets.begin(), sets.end(), isInside), sets.end());
  for (const InnerSurface& surface : this->innerSurfaces)
  {
    if (this->asked.count(surface.name) > 0)
    {
      sets.push_back(setAt(surface, this->faces, this->inner.size()));
    }
  }
  const auto onBoundary = [](const NamedSet& set) { return !set.nodes.empty(); };
  const auto isOuter = [this](const NamedSet& set) { return !this->areInner(set.faces); };
  const auto others = std::stable_partition(sets.begin(), sets.end(), onBoundary);
  this->setsInside.assign(others, sets.end());
  sets.erase(others, sets.end());
  std::stable_partition(sets.begin(), sets.end(), isOuter);
  this->namedSets = std::move(sets);
  this->size = sizeOf(this->points(), this->faces.nodes);
}
}
