// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Stiffness.h"

#include "LinearMethods/StiffnessFactors.h"
#include "Mesh/CellShape.h"
#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace morph::distributed
{
namespace
{
/// The positions of the walls, on all ranks. `named`: of stiffness.walls, all ranks.
Points gatherWalls(
  const DistributedMesh& mesh, const std::vector<Index>& prescribed, const CellStiffness& stiffness)
{
  const Ranks& ranks = mesh.ranks();
  const bool isNamed = ranks.sum(static_cast<Index>(stiffness.walls.size())) > 0;
  ranks.together(
    [&]
    {
      if (!isNamed && !stiffness.noWalls.empty())
      {
        throw Error(stiffness.noWalls);
      }
    });
  std::vector<Index> nodes = isNamed ? stiffness.walls : prescribed;
  if (isNamed && stiffness.areWallsGlobal)
  {
    // The boundary may be on another rank than its nodes.
    nodes = ranks.gatherSorted(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::transform(
      nodes.begin(), nodes.end(), nodes.begin(), [&](Index id) { return mesh.nodeOf(id); });
  }
  std::vector<std::array<double, 3>> mine;
  for (const Index node : nodes)
  {
    if (node >= 0 && mesh.owns(node))
    {
      const auto x = mesh.mesh().points.row(node);
      mine.push_back({ x[0], x[1], x[2] });
    }
  }
  const auto all = ranks.gather(mine);
  Points walls(static_cast<Index>(all.size()), 3);
  for (Index i = 0; i < walls.rows(); ++i)
  {
    walls.row(i) << all[i][0], all[i][1], all[i][2];
  }
  return walls;
}

/// The values of all cells, ghosts included. Throws on all ranks for some that are not positive,
/// with global ids.
std::vector<double> valuesOf(const DistributedMesh& mesh, const std::vector<double>& ofPiece)
{
  const Ranks& ranks = mesh.ranks();
  std::vector<double> values = ofPiece;
  values.resize(mesh.mesh().numberOfCells(), 1);
  std::vector<Index> wrong;
  for (Index c = 0; c < mesh.pieceCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh.mesh().types[c]);
    if (mesh.isGhost()[c] == 0 && shape && shape->dimension == 3 &&
        !(values[c] > 0 && std::isfinite(values[c])))
    {
      wrong.push_back(mesh.cellId(c));
    }
  }
  wrong = ranks.gatherSorted(wrong);
  if (!wrong.empty())
  {
    throw Error("The stiffness is not positive and finite at cell ids " + listIds(wrong) +
                ". Give each volume cell a positive number.");
  }
  mesh.cellHalo().update(ranks, values);
  return values;
}
}

std::vector<double> stiffnessFactors(const DistributedMesh& mesh,
  const std::vector<Index>& prescribed, const CellStiffness& stiffness, Monitor& monitor)
{
  const Ranks& ranks = mesh.ranks();
  const bool hasValues = ranks.sum(Index(!stiffness.values.empty())) > 0;
  if (stiffness.kind == CellStiffness::Kind::Uniform && !hasValues)
  {
    return {};
  }
  CellStiffness local = stiffness;
  StiffnessPart part{ mesh.isGhost(), Points(0, 3),
    [&ranks](double value) { return ranks.sum(value); },
    [&ranks](double value) { return ranks.maximum(value); } };
  if (stiffness.kind == CellStiffness::Kind::WallDistance)
  {
    part.walls = gatherWalls(mesh, prescribed, stiffness);
  }
  if (hasValues)
  {
    local.values = valuesOf(mesh, stiffness.values);
  }
  return morph::stiffnessFactors(mesh.mesh(), local, part, monitor);
}
}
