// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/NearUntangling.h"

#include "Energies/MeshEnergy.h"
#include "Mesh/KRing.h"
#include "Mesh/SubMesh.h"

#include <memory>
#include <utility>

namespace morph
{
namespace
{
constexpr int Rings[] = { 2, 5, 15 }; // of cells
constexpr int Stages = 15;
constexpr double MostTangled = 0.1; // of all cells: the rings around them then span the mesh
}

TargetMatrices untanglingTargets(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const Aim& aim, Monitor& monitor, const Communicator& communicator)
{
  TargetMatrices targets = targetMatrices(
    mesh, orientation, aim.guide, aim.target, CellWeights::Equal, monitor, communicator);
  for (const Index c : aim.hopeless)
  {
    targets.included[c] = 0;
  }
  return targets;
}

bool untangleNear(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, const std::vector<Index>& inverted, int firstRings,
  const Aim& aim, Points& points, MinimizerEffort& effort, Monitor& monitor,
  const Communicator& communicator)
{
  const auto count = communicator.sum(static_cast<double>(inverted.size()));
  if (count == 0 ||
      count > MostTangled * communicator.sum(static_cast<double>(mesh.numberOfCells())))
  {
    return false;
  }
  const Adjacency around = nodeToCells(mesh);
  Points trial = points;
  std::vector<Index> seeds = inverted;
  for (const int rings : Rings)
  {
    if (rings < firstRings)
    {
      continue;
    }
    const KRing ring = kRingOfCells(mesh, around, free, seeds, rings, communicator);
    const SubMesh part(mesh, ring.cells);
    const std::unique_ptr<Communicator> processes = communicator.part(part.nodes);
    const std::vector<Index> hopeless = part.cellNumbersOf(aim.hopeless);
    const Points guide = aim.guide(part.nodes, allColumns);
    const TargetMatrices targets = untanglingTargets(
      part.mesh, part.take(orientation), { guide, aim.target, hopeless }, monitor, *processes);
    MeshEnergy energy(part.mesh, part.numbersOf(ring.nodes), *processes);
    energy.setTargets(targets);
    FoldoverContinuation stages(energy);
    Points local = trial(part.nodes, allColumns);
    const bool done = stages.untangle(local, monitor, Stages);
    stages.include(effort);
    effort = stages.effort();
    if (done)
    {
      trial(part.nodes, allColumns) = local;
      points.swap(trial);
      return true;
    }
    // The part grows where it has stayed tangled, from the mesh that it has become.
    const std::vector<Index> left = tangledCells(part.mesh, local, targets);
    const auto still = communicator.sum(static_cast<double>(left.size()));
    if (still > 0 && still <= count)
    {
      trial(part.nodes, allColumns) = local;
      seeds.clear();
      for (const Index c : left)
      {
        seeds.push_back(part.cells[c]);
      }
    }
  }
  return false;
}
}
