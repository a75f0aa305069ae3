// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Untangling.h"

#include "Energies/MeshEnergy.h"
#include "Mesh/KRing.h"
#include "Mesh/SubMesh.h"
#include "Untangling/FoldoverContinuation.h"

#include <memory>

namespace morph
{
namespace
{
// Within the ranges given, as many cells of 109 hard meshes stay inverted.
constexpr int FirstRings = 2; // of cells around inverted ones, whose nodes move first: 2 to 3
constexpr int Widening = 3;   // of the rings around what has stayed inverted: 2 to 3

TargetMatrices includedTargets(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const Aim& aim, Monitor& monitor, const Communicator& communicator)
{
  TargetMatrices targets = targetMatrices(
    mesh, orientation, aim.guide, aim.target, CellWeights::Equal, monitor, communicator);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    targets.included[c] &= aim.included[c];
  }
  return targets;
}
}

TargetMatrices Untangling::targets(const Aim& aim, Monitor& monitor) const
{
  return includedTargets(this->mesh_, this->orientation_, aim, monitor, this->communicator_);
}

bool Untangling::run(std::vector<Index> seeds, const Aim& aim, bool nearOnly, Points& points,
  MinimizerEffort& effort, Monitor& monitor) const
{
  const Adjacency around = nodeToCells(this->mesh_);
  const auto count = [&](const std::vector<Index>& ids)
  { return this->communicator_.sum(static_cast<double>(ids.size())); };
  Points trial = points;
  double before = -1;
  for (int rings = FirstRings;; rings *= Widening)
  {
    KRing ring = kRingOfCells(this->mesh_, around, this->free_, seeds, rings, this->communicator_);
    const double nodes = count(ring.nodes);
    // A part that has stopped to grow is a body of its own.
    const bool isWhole = 2 * nodes > count(this->free_) || nodes == before;
    before = nodes;
    if (isWhole && nearOnly && rings > FirstRings)
    {
      return false;
    }
    if (isWhole)
    {
      ring.nodes = this->free_;
      ring.cells.clear();
      for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
      {
        if (numberOfCorners(cellShape(this->mesh_, c)->shape) > 0)
        {
          ring.cells.push_back(c);
        }
      }
    }
    const SubMesh part(this->mesh_, ring.cells);
    const std::unique_ptr<Communicator> processes = this->communicator_.part(part.nodes);
    const Points guide = aim.guide(part.nodes, allColumns);
    const TargetMatrices targets = includedTargets(part.mesh, part.take(this->orientation_),
      { guide, aim.target, part.take(aim.included) }, monitor, *processes);
    MeshEnergy energy(part.mesh, part.numbersOf(ring.nodes), *processes);
    energy.setTargets(targets);
    Points local = trial(part.nodes, allColumns);
    const bool isSame = part.mesh.numberOfNodes() == this->mesh_.numberOfNodes();
    const bool done = minimizeFoldover(
      energy, isWhole && isSame ? this->preconditioner_ : nullptr, local, effort, monitor);
    const std::vector<Index> left = tangledCells(part.mesh, local, targets);
    if (done || isWhole || count(left) <= count(seeds))
    {
      trial(part.nodes, allColumns) = local;
      seeds.clear();
      for (const Index c : left)
      {
        seeds.push_back(part.cells[c]);
      }
    }
    if (done || isWhole)
    {
      points.swap(trial);
      return done;
    }
  }
}
}
