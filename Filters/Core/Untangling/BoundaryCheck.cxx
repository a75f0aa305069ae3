// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/BoundaryCheck.h"

#include "Boundary/CrossingFaces.h"
#include "Boundary/FoldedFaces.h"
#include "Mesh/FacesOfCells.h"
#include "Support/Lists.h"

#include <algorithm>

namespace morph
{
namespace
{
void makeUnique(std::vector<Index>& ids)
{
  sortUnique(ids);
}
}

std::vector<Index> ForbiddenCells::all(const InvertedBefore& before) const
{
  std::vector<Index> cells = this->determined;
  for (const NodeWithoutPlace& node : this->withoutPlace)
  {
    if (before.without(node.cells).size() == node.cells.size())
    {
      cells.insert(cells.end(), node.cells.begin(), node.cells.end());
    }
  }
  cells.insert(cells.end(), this->folded.begin(), this->folded.end());
  cells.insert(cells.end(), this->crossing.begin(), this->crossing.end());
  makeUnique(cells);
  return before.without(cells);
}

std::vector<Index> crossingCells(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, const Points& points,
  Monitor& monitor)
{
  if (mesh.layer.isCurved())
  {
    return {}; // edges cross no edges in space
  }
  const auto isPrescribed = [&](Index node)
  { return std::binary_search(partition.prescribed.begin(), partition.prescribed.end(), node); };
  std::vector<std::pair<Index, int>> places;
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const auto corners = faces.connectivity.begin();
    if (std::all_of(corners + faces.offsets[f], corners + faces.offsets[f + 1], isPrescribed))
    {
      places.emplace_back(faces.cells[f], faces.sides[f]);
    }
  }
  const BoundaryFaces given = facesAt(mesh, places);
  std::vector<Index> cells;
  for (const auto& [f, g] :
    crossingFaces(ConstPoints(mesh.points), ConstPoints(points), given, orientation, monitor))
  {
    cells.insert(cells.end(), { given.cells[f], given.cells[g] });
  }
  makeUnique(cells);
  return cells;
}

BoundaryCheck::BoundaryCheck(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, Monitor& monitor)
  : mesh_(mesh)
  , partition_(partition)
  , orientation_(orientation)
  , faces_(faces)
  , monitor_(monitor)
  , geometry_(classify(mesh, faces, {}, monitor))
  , isPrescribed_(mesh.numberOfNodes(), 0)
{
  for (Index node : partition.prescribed)
  {
    this->isPrescribed_[node] = 1;
  }
}

ForbiddenCells BoundaryCheck::at(const Points& boundary) const
{
  this->monitor_.check();
  if (this->mesh_.layer.isCurved())
  {
    return {}; // which way a cell faces is told by its neighbors, not by prescribed nodes alone
  }
  Points points = this->mesh_.points;
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    points.row(this->partition_.prescribed[i]) = boundary.row(i);
  }
  ForbiddenCells result;
  result.determined =
    boundaryDeterminedInversions(this->mesh_, this->partition_, this->orientation_, points);
  result.withoutPlace =
    nodesWithoutPlace(this->mesh_, this->partition_, this->orientation_, points, this->monitor_);
  for (Index f :
    foldedFaces(this->mesh_.points, points, this->faces_, this->geometry_, this->isPrescribed_))
  {
    result.folded.push_back(this->faces_.cells[f]);
  }
  makeUnique(result.folded);
  result.crossing = crossingCells(
    this->mesh_, this->partition_, this->orientation_, this->faces_, points, this->monitor_);
  return result;
}
}
