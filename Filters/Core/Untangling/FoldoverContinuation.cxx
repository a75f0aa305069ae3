// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/FoldoverContinuation.h"

#include <algorithm>

#include <cmath>

namespace morph
{
namespace
{
constexpr double Valid = 1e-10; // the regularisation of a valid mesh: only for rounding
constexpr int StepsOfStage = 4; // more are wasted, as the next regularisation changes the mesh
constexpr int Patience = 10;    // stages without progress before untangling gives up
// As many that have not lowered their energy by Moving either: the mesh has come to rest.
constexpr int PatienceAtRest = 3;
constexpr double Moving = 0.01;
constexpr double Gain = 0.05;      // increase of the minimum determinant that is progress
constexpr double LeastRatio = 0.3; // minimum ratio of successive regularisations

double chi(double D, double epsilon)
{
  const double root = std::sqrt(epsilon * epsilon + D * D);
  return D > 0 ? (D + root) / 2 : epsilon * epsilon / (2 * (root - D));
}

/// The regularisation of the next stage.
class Regularisation
{
public:
  double first(double least)
  {
    this->best_ = least;
    return fast(least);
  }

  /// `least`: the minimum determinant, not positive; `decrease`: of the stage's energy, relative.
  double next(double least, double decrease, double epsilon)
  {
    // Near 0 it is the regularisation that a gain has to be seen beside.
    const double gain = Gain * std::max(std::abs(this->best_), epsilon);
    this->idle_ = least > this->best_ + gain ? 0 : this->idle_ + 1;
    this->best_ = std::max(this->best_, least);
    this->careful_ = this->careful_ || this->idle_ >= 3;
    if (!this->careful_)
    {
      // Steps that are too large leave the minimizer in a worse mesh.
      return std::max(fast(least), LeastRatio * epsilon);
    }
    // The rule with a proof of convergence.
    const double mu = (1 - std::max(decrease, 0.1)) * chi(least, epsilon);
    return 2 * std::sqrt(mu * (mu - least));
  }

private:
  /// Returns the regularisation that the worst tetrahedron needs.
  static double fast(double least) { return std::sqrt(1e-6 + 0.04 * least * least); }

  double best_ = 0;
  int idle_ = 0;
  bool careful_ = false;
};

class Stagnation
{
public:
  explicit Stagnation(const EnergyState& start)
    : inverted_(start.inverted)
    , least_(start.minimumDeterminant)
  {
  }

  /// Call it after each stage. `decrease`: of the stage's energy, relative.
  bool gaveUp(const EnergyState& state, double decrease)
  {
    const bool isProgress = state.inverted < this->inverted_ ||
                            state.minimumDeterminant > this->least_ + Gain * std::abs(this->least_);
    this->idle_ = isProgress ? 0 : this->idle_ + 1;
    this->atRest_ = isProgress || decrease > Moving ? 0 : this->atRest_ + 1;
    this->inverted_ = std::min(this->inverted_, state.inverted);
    this->least_ = std::max(this->least_, state.minimumDeterminant);
    return this->idle_ >= Patience || this->atRest_ >= PatienceAtRest;
  }

private:
  Index inverted_;
  double least_;
  int idle_ = 0, atRest_ = 0;
};
}

void FoldoverContinuation::setDensity(double epsilon)
{
  FoldoverDensity density = this->energy_.density();
  density.epsilon = epsilon;
  this->energy_.setDensity(density);
}

void FoldoverContinuation::include(const MinimizerEffort& effort)
{
  this->effort_.steps += effort.steps;
  this->effort_.linearIterations += effort.linearIterations;
  this->effort_.evaluations += effort.evaluations;
}

EnergyState FoldoverContinuation::evaluate(const Points& points, Monitor& monitor)
{
  ++this->effort_.evaluations;
  return this->energy_.evaluate(points, monitor);
}

bool FoldoverContinuation::untangle(Points& points, Monitor& monitor, int stages)
{
  this->setDensity(Valid);
  EnergyState state = this->evaluate(points, monitor);
  if (state.minimumDeterminant > 0)
  {
    return true;
  }
  Regularisation regularisation;
  double epsilon = regularisation.first(state.minimumDeterminant);
  Stagnation stagnation(state);
  MinimizerLimits limits;
  limits.steps = StepsOfStage;
  limits.preconditioner = this->preconditioner_;
  for (int stage = 0; stage < stages; ++stage)
  {
    monitor.progress(1 - std::pow(0.8, stage));
    this->setDensity(epsilon);
    const double start = this->evaluate(points, monitor).energy;
    newton(this->energy_, points, limits, this->matrix_, this->effort_, monitor);
    state = this->evaluate(points, monitor);
    if (state.minimumDeterminant > 0)
    {
      return true;
    }
    const double decrease = 1 - state.energy / start;
    // No step is taken from an infinite energy with any regularisation.
    if (!std::isfinite(start) || !std::isfinite(state.energy) || stagnation.gaveUp(state, decrease))
    {
      return false;
    }
    epsilon = regularisation.next(state.minimumDeterminant, decrease, epsilon);
  }
  return false;
}
}
