// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/FoldoverContinuation.h"

#include <algorithm>

#include <cmath>

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
}

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
}
