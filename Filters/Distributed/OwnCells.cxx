// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/OwnCells.h"

#include "Mesh/CellShape.h"
#include "Mesh/FacesOfCells.h"

#include <algorithm>
#include <utility>

namespace morph::distributed
{
namespace
{
std::vector<Index> ownVolumeCells(const DistributedMesh& mesh)
{
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.pieceCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh.mesh().types[c]);
    if (mesh.isGhost()[c] == 0 && shape && shape->dimension == 3)
    {
      cells.push_back(c);
    }
  }
  return cells;
}

NodePartition partitionOf(const SubMesh& part, const NodePartition& whole)
{
  std::vector<Index> prescribed = part.numbersOf(whole.prescribed);
  prescribed.erase(std::remove(prescribed.begin(), prescribed.end(), -1), prescribed.end());
  return partitionNodes(part.mesh, prescribed);
}
}

OwnCells::OwnCells(const DistributedMesh& mesh, const NodePartition& partition)
  : whole_(mesh)
  , part_(mesh.mesh(), ownVolumeCells(mesh))
  , partition_(partitionOf(this->part_, partition))
  , communicator_(mesh, this->part_.nodes)
{
  for (const Index c : this->part_.cells)
  {
    this->orientation_.push_back(mesh.orientation()[c]);
  }
}

ConnectedComponents OwnCells::bodies() const
{
  ConnectedComponents result;
  const ConnectedComponents& whole = this->whole_.bodies();
  result.count = whole.count;
  for (const Index node : this->part_.nodes)
  {
    result.ofNode.push_back(whole.ofNode[node]);
  }
  for (const Index cell : this->part_.cells)
  {
    result.ofCell.push_back(whole.ofCell[cell]);
  }
  return result;
}

BoundaryFaces OwnCells::outerFaces() const
{
  const BoundaryFaces& outer = this->whole_.outerFaces();
  std::vector<std::pair<Index, int>> places;
  for (std::size_t f = 0; f < outer.cells.size(); ++f)
  {
    const auto cell =
      std::lower_bound(this->part_.cells.begin(), this->part_.cells.end(), outer.cells[f]);
    places.emplace_back(cell - this->part_.cells.begin(), outer.sides[f]);
  }
  return facesAt(this->part_.mesh, places);
}

std::vector<Index> OwnCells::gatherIds(const std::vector<Index>& cells) const
{
  std::vector<Index> ofWhole;
  for (const Index cell : cells)
  {
    ofWhole.push_back(this->part_.cells[cell]);
  }
  return this->whole_.gatherCells(ofWhole);
}
}
