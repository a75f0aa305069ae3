// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/BoundaryCheck.h"

#include "Boundary/FaceQuality.h"
#include "Support/Lists.h"

#include <algorithm>

namespace morph
{
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
  sortUnique(cells);
  return before.without(cells);
}

std::vector<Index> crossingCells(const WholeBoundary& boundary,
  const std::vector<char>& isPrescribed, const Points& points, Monitor& monitor)
{
  const BoundaryFaces& all = boundary.faces();
  BoundaryFaces given;
  for (const Index f : all.cells)
  {
    const auto first = all.connectivity.begin() + all.offsets[f],
               last = all.connectivity.begin() + all.offsets[f + 1];
    if (std::all_of(first, last, [&](Index node) { return isPrescribed[node] != 0; }))
    {
      given.cells.push_back(f);
      given.add(first, last);
    }
  }
  std::vector<Index> cells;
  for (const auto& pair : boundary.crossings(given, points, monitor))
  {
    for (const Index f : pair)
    {
      cells.push_back(boundary.cells()[given.cells[f]]);
    }
  }
  sortUnique(cells);
  return cells;
}

BoundaryCheck::BoundaryCheck(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, Monitor& monitor,
  const Communicator& processes)
  : mesh_(mesh)
  , partition_(partition)
  , orientation_(orientation)
  , monitor_(monitor)
  , processes_(processes)
  , whole_(mesh, faces, orientation, processes)
  , isPrescribed_(this->whole_.isAmong(partition.prescribed))
{
  processes.together(
    [&]
    {
      this->geometry_ =
        classify(ConstPoints(this->whole_.rest()), this->whole_.faces(), {}, monitor);
    });
}

ForbiddenCells BoundaryCheck::at(const Points& boundary) const
{
  if (this->mesh_.layer.isCurved())
  {
    return {}; // which way a cell faces is told by its neighbors, not by prescribed nodes alone
  }
  Points points = this->mesh_.points;
  points(this->partition_.prescribed, allColumns) = boundary;
  const Points moved = this->whole_.gather(points);
  ForbiddenCells result;
  this->processes_.together(
    [&]
    {
      this->monitor_.check();
      result.determined =
        boundaryDeterminedInversions(this->mesh_, this->partition_, this->orientation_, points);
      result.withoutPlace = nodesWithoutPlace(this->mesh_, this->partition_, this->orientation_,
        points, this->monitor_, this->processes_);
      for (const Index f : foldedFaces(this->whole_.rest(), moved, this->whole_.faces(),
             this->geometry_, this->isPrescribed_))
      {
        result.folded.push_back(this->whole_.cells()[f]);
      }
      sortUnique(result.folded);
      result.folded = this->processes_.cellsOf(result.folded);
    });
  result.crossing = this->processes_.cellsOf(
    crossingCells(this->whole_, this->isPrescribed_, moved, this->monitor_));
  return result;
}
}
