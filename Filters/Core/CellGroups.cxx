// SPDX-License-Identifier: BSD-3-Clause
#include "CellGroups.h"

#include "NodeUses.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace morph
{
namespace
{
std::vector<Index> allCells(const Mesh& mesh)
{
  std::vector<Index> ids(mesh.numberOfCells());
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}
}

CellGroups::CellGroups(const Mesh& mesh, const std::vector<std::int32_t>& row)
  : CellGroups(mesh, row, allCells(mesh))
{
}

CellGroups::CellGroups(
  const Mesh& mesh, const std::vector<std::int32_t>& row, const std::vector<Index>& cells)
{
  constexpr std::array<Shape, 4> Volumes = { Shape::Tet, Shape::Hex, Shape::Wedge, Shape::Pyramid };
  std::array<Group, Volumes.size()> open{};
  const auto close = [&](Group& group)
  {
    if (group.cells > 0)
    {
      this->addPlaces(mesh, row, group);
      this->groups_.push_back(group);
      group.cells = 0;
    }
  };
  for (Index c : cells)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const auto* volume = std::find(Volumes.begin(), Volumes.end(), shape.shape);
    const auto isFree = [&](int a) { return row[mesh.cell(c)[shape.cornerNode[a]]] >= 0; };
    bool movable = false;
    for (int a = 0; a < numberOfCorners(shape.shape) && !movable; ++a)
    {
      movable = isFree(a);
    }
    if (volume == Volumes.end() || !movable)
    {
      continue;
    }
    Group& group = open[volume - Volumes.begin()];
    group.shape = shape.shape;
    group.cell[group.cells++] = c;
    if (group.cells == LaneCount)
    {
      close(group);
    }
  }
  std::for_each(open.begin(), open.end(), close);
}

void CellGroups::addPlaces(const Mesh& mesh, const std::vector<std::int32_t>& row, Group& group)
{
  std::fill(group.cell + group.cells, group.cell + LaneCount, group.cell[0]);
  group.firstPlace = this->places();
  const int corners = numberOfCorners(group.shape);
  for (int a = 0; a < corners; ++a)
  {
    this->groupOf_.push_back(static_cast<std::int32_t>(this->size()));
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      const Index c = group.cell[lane];
      const Index node = mesh.cell(c)[cellShape(mesh.types[c])->cornerNode[a]];
      this->node_.push_back(static_cast<std::int32_t>(node));
      this->row_.push_back(lane < group.cells ? row[node] : -1);
    }
  }
}

Adjacency CellGroups::placesOf(Index rows) const
{
  return placesOfRows(this->places(), rows, [this](Index place) { return this->row(place); });
}

bool CellGroups::moves(Index group, int lane, const int* corner) const
{
  return std::any_of(corner, corner + 4,
    [&](int a) { return this->row(this->firstPlace(group) + a * LaneCount + lane) >= 0; });
}

void CellGroups::setTargets(const TargetShapes& targets)
{
  this->target_.clear();
  for (Index index = 0; index < this->size(); ++index)
  {
    Group& group = this->groups_[index];
    group.firstTarget = static_cast<Index>(this->target_.size());
    const SimplicialDecomposition parts = simplicialDecomposition(group.shape);
    this->target_.resize(this->target_.size() + parts.count, Tetrahedra{});
    for (int lane = 0; lane < group.cells; ++lane)
    {
      const Index c = group.cell[lane], first = targets.start[c];
      for (Index t = 0; t < targets.start[c + 1] - first; ++t)
      {
        const TargetShapes::Tetrahedron& from = targets.tetrahedra[first + t];
        if (!(from.weight > 0 && this->moves(index, lane, parts.tets[t].corner)))
        {
          continue;
        }
        Tetrahedra& to = this->target_[group.firstTarget + t];
        for (int i = 0; i < 9; ++i)
        {
          to.inverse[i][lane] = from.inverse[i];
        }
        to.weight[lane] = from.weight;
        to.theta[lane] = from.theta;
        to.stiffened[lane] = from.stiffened ? 1 : 0;
      }
    }
  }
}
}
