// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Untangling.h"

#include "Energies/MeshEnergy.h"
#include "Mesh/OwnCells.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Optimization/Minimizers.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace morph
{
namespace
{
// Within the ranges given, the sum of inverted cells over 109 hard meshes changes by less than 1 %.
constexpr int StepsOfStage = 4; // 3 leave 3 % more cells; 6 leave 2 % more, and take longer
constexpr int MostStages = 60;  // to 90
constexpr int Patience = 4;     // stages without progress before it gives up: 4 to 8
constexpr double Gain = 0.05;   // of the minimum determinant, which is progress: 0.05 to 0.1

double chi(double D, double epsilon)
{
  const double root = std::sqrt(epsilon * epsilon + D * D);
  return D > 0 ? (D + root) / 2 : epsilon * epsilon / (2 * (root - D));
}

/// Returns the regularisation that the worst tetrahedron needs, as in the source.
double regularisation(double least)
{
  return std::sqrt(1e-6 + 0.04 * least * least);
}

/// Minimizes a mesh's foldover-free energy by continuation in its regularisation, until no
/// tetrahedron is inverted. Source: Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv
/// 2102.03069. It ends after stages without progress, which soon ends it if the boundary admits no
/// valid mesh. Progress means fewer inverted tetrahedra, or a minimum determinant raised by 5 %.
/// `preconditioner`: for Newton's linear systems, by the rows of `energy`; null: none. `points`:
/// #nodes x 3, start and result. `effort`: added to. Returns whether all tetrahedra are positive.
bool minimizeFoldover(MeshEnergy& energy, const NodePreconditioner* preconditioner, Points& points,
  MinimizerEffort& effort, Monitor& monitor)
{
  const auto evaluate = [&]
  {
    ++effort.evaluations;
    return energy.evaluate(points, monitor);
  };
  EnergyState state = evaluate();
  MinimizerLimits limits;
  limits.steps = StepsOfStage;
  limits.preconditioner = preconditioner;
  BlockCsr3f matrix;
  FoldoverDensity density;
  density.epsilon = regularisation(state.minimumDeterminant);
  double best = state.minimumDeterminant;
  Index fewest = state.inverted;
  bool isCareful = false;
  int idle = 0;
  for (int stage = 0; stage < MostStages && !(state.minimumDeterminant > 0); ++stage)
  {
    monitor.progress(static_cast<double>(stage) / MostStages);
    energy.setDensity(density);
    const double start = evaluate().energy;
    newton(energy, points, limits, matrix, effort, monitor);
    state = evaluate();
    const double least = state.minimumDeterminant;
    const bool isProgress = state.inverted < fewest || least > best + Gain * std::abs(best);
    idle = isProgress ? 0 : idle + 1;
    // No step is taken from an infinite energy with any regularisation.
    if (!std::isfinite(start) || !std::isfinite(state.energy) || idle >= Patience)
    {
      break;
    }
    fewest = std::min(fewest, state.inverted);
    best = std::max(best, least);
    // Then the source's rule with a proof of convergence takes over.
    isCareful = isCareful || 2 * idle >= Patience;
    const double decrease = std::max(1 - state.energy / start, 0.1),
                 mu = (1 - decrease) * chi(least, density.epsilon);
    density.epsilon = isCareful ? 2 * std::sqrt(mu * (mu - least)) : regularisation(least);
  }
  return state.minimumDeterminant > 0;
}

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
  return includedTargets(
    this->own_.mesh(), this->own_.orientation(), aim, monitor, this->own_.communicator());
}

bool Untangling::run(std::vector<Index> seeds, const Aim& aim, bool nearOnly, Points& points,
  MinimizerEffort& effort, Monitor& monitor) const
{
  const Mesh& mesh = this->own_.mesh();
  const Communicator& communicator = this->own_.communicator();
  const std::vector<Index>& free = this->own_.partition().free;
  const Adjacency around = nodeToCells(mesh);
  const auto count = [&](const std::vector<Index>& ids)
  { return communicator.sum(static_cast<double>(ids.size())); };
  Points trial = points;
  double before = -1;
  for (int rings = FirstRings;; rings *= Widening)
  {
    KRing ring = kRingOfCells(mesh, around, free, seeds, rings, communicator);
    const double nodes = count(ring.nodes);
    // A part that has stopped to grow is a body of its own.
    const bool isWhole = 2 * nodes > count(free) || nodes == before;
    before = nodes;
    if (isWhole && nearOnly && rings > FirstRings)
    {
      return false;
    }
    if (isWhole)
    {
      ring.nodes = free;
      ring.cells.clear();
      for (Index c = 0; c < mesh.numberOfCells(); ++c)
      {
        if (hasCorners(mesh, c))
        {
          ring.cells.push_back(c);
        }
      }
    }
    const SubMesh part(mesh, ring.cells);
    const std::unique_ptr<Communicator> processes = communicator.part(part.nodes);
    const Points guide = aim.guide(part.nodes, allColumns);
    const TargetMatrices targets = includedTargets(part.mesh, part.take(this->own_.orientation()),
      { guide, aim.target, part.take(aim.included) }, monitor, *processes);
    MeshEnergy energy(part.mesh, part.numbersOf(ring.nodes), *processes);
    energy.setTargets(targets);
    Points local = trial(part.nodes, allColumns);
    const bool isSame = part.mesh.numberOfNodes() == mesh.numberOfNodes();
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
