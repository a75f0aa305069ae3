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

bool untangleNear(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, const std::vector<Index>& inverted, int firstRings,
  const Aim& aim, FoldoverContinuation::Minimizer minimizer, Points& points,
  MinimizerEffort& effort, Monitor& monitor, const Communicator& communicator)
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
    std::vector<std::int8_t> signs;
    for (const Index c : part.cells)
    {
      signs.push_back(orientation[c]);
    }
    // All cells count alike, so that those of a boundary layer are untangled, too.
    const CellWeights weights =
      aim.target == TargetConstruction::Initial ? CellWeights::Volume : CellWeights::Equal;
    const TargetMatrices targets = targetMatrices(part.mesh, signs,
      aim.guide(part.nodes, allColumns), aim.target, weights, monitor, *processes);
    MeshEnergy energy(part.mesh, part.numbersOf(ring.nodes), *processes);
    energy.setTargets(targets);
    FoldoverContinuation stages(energy, minimizer);
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
