// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/OwnCells.h"

#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace morph
{
SubMesh::SubMesh(const Mesh& whole, const std::vector<Index>& cells)
  : cells(cells)
{
  std::vector<Index> number(whole.numberOfNodes(), -1);
  for (const Index c : cells)
  {
    std::for_each(
      whole.cell(c), whole.cell(c) + whole.cellSize(c), [&](Index node) { number[node] = 0; });
  }
  for (Index node = 0; node < whole.numberOfNodes(); ++node)
  {
    if (number[node] == 0)
    {
      number[node] = static_cast<Index>(this->nodes.size());
      this->nodes.push_back(node);
    }
  }
  this->mesh.points = whole.points(this->nodes, allColumns);
  this->mesh.layer = whole.layer; // cells have both images of their nodes, and fronts come first
  this->mesh.layer.nodes =
    std::lower_bound(this->nodes.begin(), this->nodes.end(), whole.layer.nodes) -
    this->nodes.begin();
  for (const Index c : cells)
  {
    this->mesh.types.push_back(whole.types[c]);
    std::transform(whole.cell(c), whole.cell(c) + whole.cellSize(c),
      std::back_inserter(this->mesh.connectivity), [&](Index node) { return number[node]; });
    this->mesh.offsets.push_back(static_cast<Index>(this->mesh.connectivity.size()));
  }
}

std::vector<Index> SubMesh::numbersOf(const std::vector<Index>& ids) const
{
  std::vector<Index> result(ids.size(), -1);
  std::transform(ids.begin(), ids.end(), result.begin(),
    [this](Index id)
    {
      const auto found = std::lower_bound(this->nodes.begin(), this->nodes.end(), id);
      return found != this->nodes.end() && *found == id
               ? static_cast<Index>(found - this->nodes.begin())
               : Index(-1);
    });
  return result;
}

namespace
{
SubMesh ownPart(Mesh mesh, bool isWhole, const Communicator& processes)
{
  const std::vector<std::uint8_t> isOther = OwnCells::others(mesh, processes);
  std::vector<Index> cells;
  for (std::size_t c = 0; c < isOther.size(); ++c)
  {
    if (isOther[c] == 0)
    {
      cells.push_back(static_cast<Index>(c));
    }
  }
  SubMesh part(mesh, cells);
  if (isWhole)
  {
    part.nodes = consecutive(mesh.numberOfNodes());
    part.cells = consecutive(mesh.numberOfCells());
    part.mesh = std::move(mesh);
  }
  return part;
}

NodePartition partitionOf(const SubMesh& part, const NodePartition& whole)
{
  std::vector<Index> prescribed = part.numbersOf(whole.prescribed);
  prescribed.erase(std::remove(prescribed.begin(), prescribed.end(), -1), prescribed.end());
  return partitionNodes(part.mesh, prescribed);
}
}

OwnCells::OwnCells(Mesh mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Communicator& processes)
  : processes_(processes)
  , isWhole_(!processes.bodies())
  , part_(ownPart(std::move(mesh), this->isWhole_, processes))
  , orientation_(this->part_.take(orientation))
  , partition_(this->isWhole_ ? partition : partitionOf(this->part_, partition))
  , communicator_(processes.part(this->part_.nodes))
{
}

std::vector<std::uint8_t> OwnCells::others(const Mesh& mesh, const Communicator& processes)
{
  std::vector<std::uint8_t> result(processes.bodies() ? mesh.numberOfCells() : 0);
  for (std::size_t c = 0; c < result.size(); ++c)
  {
    const CellShape* shape = cellShape(mesh.types[c]);
    result[c] = processes.isCopy(static_cast<Index>(c)) || !shape || shape->dimension < 3;
  }
  return result;
}

ConnectedComponents OwnCells::bodies(const ConnectedComponents& ofMesh) const
{
  ConnectedComponents result;
  result.count = ofMesh.count;
  result.ofCell = this->part_.take(ofMesh.ofCell);
  std::transform(this->part_.nodes.begin(), this->part_.nodes.end(),
    std::back_inserter(result.ofNode), [&](Index node) { return ofMesh.ofNode[node]; });
  return result;
}

BoundaryFaces OwnCells::outerFaces(const Mesh& mesh, Monitor& monitor) const
{
  BoundaryFaces outer = boundaryFaces(mesh, monitor);
  if (this->isWhole_)
  {
    return outer;
  }
  std::vector<std::pair<Index, int>> places;
  for (std::size_t f = 0; f < outer.cells.size(); ++f)
  {
    const auto cell =
      std::lower_bound(this->part_.cells.begin(), this->part_.cells.end(), outer.cells[f]);
    if (cell != this->part_.cells.end() && *cell == outer.cells[f])
    {
      places.emplace_back(cell - this->part_.cells.begin(), outer.sides[f]);
    }
  }
  return facesAt(this->part_.mesh, places);
}

std::vector<Index> OwnCells::gatherIds(const std::vector<Index>& cells) const
{
  std::vector<Index> ofMesh;
  for (const Index cell : cells)
  {
    ofMesh.push_back(this->part_.cells[cell]);
  }
  return this->processes_.gatherCells(ofMesh);
}
}
