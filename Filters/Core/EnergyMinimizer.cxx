// SPDX-License-Identifier: BSD-3-Clause
#include "EnergyMinimizer.h"

#include "BlockSum.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double Valid = 1e-10;   // the regularisation of a valid mesh: none, but for rounding
constexpr double Barrier = 1e-9;  // regularisation below which no step may invert a tetrahedron
constexpr int MostStages = 60;
constexpr int MostSteps = 30;
constexpr int MostHalvings = 30;
constexpr double SufficientDecrease = 1e-4;
constexpr double LinearTolerance = 1e-2;
constexpr int MostLinearIterations = 500;
constexpr double StageTolerance = 1e-5;

double dot(const Points& a, const Points& b, Monitor& monitor)
{
  return blockSum(a.rows(), monitor, 0., [&](Index i) { return a.row(i).dot(b.row(i)); });
}

double chi(double D, double epsilon)
{
  const double root = std::sqrt(epsilon * epsilon + D * D);
  return D > 0 ? (D + root) / 2 : epsilon * epsilon / (2 * (root - D));
}
}

MeshEnergy::State EnergyMinimizer::evaluate(
  const Points& points, const TargetShapes& targets, const FoldoverDensity& density, Monitor& monitor)
{
  ++this->effort_.evaluations;
  return this->energy_.evaluate(points, targets, density, monitor);
}

MeshEnergy::State EnergyMinimizer::minimise(Points& points, const TargetShapes& targets,
  const FoldoverDensity& density, int mostSteps, Monitor& monitor)
{
  MeshEnergy::State state = this->evaluate(points, targets, density, monitor);
  double firstNorm = -1;
  for (int step = 0; step < mostSteps; ++step)
  {
    monitor.check();
    Points gradient, direction;
    this->energy_.gradient(points, targets, density, gradient, monitor);
    const double norm = std::sqrt(dot(gradient, gradient, monitor));
    firstNorm = firstNorm < 0 ? norm : firstNorm;
    if (!(norm > 0))
    {
      break;
    }
    this->energy_.hessian(points, targets, density, this->hessian_, monitor);
    this->effort_.linearIterations += this->hessian_.solve(
      -gradient, direction, LinearTolerance, MostLinearIterations, monitor);
    ++this->effort_.newtonSteps;

    const double slope = dot(gradient, direction, monitor);
    if (!(slope < 0))
    {
      break;
    }
    double length = 1;
    bool found = false;
    MeshEnergy::State next;
    Points trial = points;
    for (int halving = 0; halving < MostHalvings && !found; ++halving, length /= 2)
    {
      for (Index i = 0; i < direction.rows(); ++i)
      {
        trial.row(this->free_[i]) = points.row(this->free_[i]) + length * direction.row(i);
      }
      next = this->evaluate(trial, targets, density, monitor);
      found = next.energy <= state.energy + SufficientDecrease * length * slope &&
        (density.epsilon > Barrier || next.leastDeterminant > 0);
    }
    if (!found)
    {
      break;
    }
    points.swap(trial);
    const double decrease = state.energy - next.energy;
    state = next;
    if (decrease < 1e-6 * state.energy || (decrease < 1e-4 * state.energy && norm < 1e-2 * firstNorm))
    {
      break;
    }
  }
  return state;
}

bool EnergyMinimizer::untangle(Points& points, const TargetShapes& targets, Monitor& monitor)
{
  FoldoverDensity density;
  density.epsilon = Valid;
  MeshEnergy::State state = this->evaluate(points, targets, density, monitor);
  // Fast: as much regularisation as the worst tetrahedron needs. Where that makes no headway, the rule with the proof.
  const auto fast = [](double least) { return std::sqrt(1e-6 + 0.04 * least * least); };
  if (!(state.leastDeterminant > 0))
  {
    density.epsilon = fast(state.leastDeterminant);
  }
  double before = std::numeric_limits<double>::infinity(), best = state.leastDeterminant;
  int idle = 0;
  bool careful = false;
  for (int stage = 0; stage < MostStages; ++stage)
  {
    const double start = this->evaluate(points, targets, density, monitor).energy;
    state = this->minimise(points, targets, density, MostSteps, monitor);
    if (state.leastDeterminant > 0)
    {
      if (density.epsilon <= Barrier && std::abs(before - state.energy) < StageTolerance * state.energy)
      {
        break;
      }
      before = density.epsilon <= Barrier ? state.energy : before;
      density.epsilon = Valid;
      continue;
    }
    idle = state.leastDeterminant > best + 0.05 * std::abs(best) ? 0 : idle + 1;
    best = std::max(best, state.leastDeterminant);
    careful = careful || idle >= 3;
    if (careful)
    {
      const double sigma = std::max(1 - state.energy / start, 0.1);
      const double mu = (1 - sigma) * chi(state.leastDeterminant, density.epsilon);
      density.epsilon = state.leastDeterminant < mu
        ? 2 * std::sqrt(mu * (mu - state.leastDeterminant))
        : Valid;
    }
    else
    {
      density.epsilon = fast(state.leastDeterminant);
    }
  }
  return state.leastDeterminant > 0;
}

void EnergyMinimizer::improve(
  Points& points, const TargetShapes& targets, int mostSteps, Monitor& monitor)
{
  FoldoverDensity density;
  density.epsilon = Valid;
  this->minimise(points, targets, density, mostSteps, monitor);
}

void EnergyMinimizer::stiffen(Points& points, const TargetShapes& targets, Monitor& monitor)
{
  constexpr int Rounds = 12, Steps = 2;
  FoldoverDensity density;
  density.epsilon = Valid;
  MeshEnergy::State state = this->evaluate(points, targets, density, monitor);
  if (!(state.leastDeterminant > 0 && state.mostDistortion > 0))
  {
    return;
  }
  density.stiffness = (1 - 1e-3) / state.mostDistortion;
  for (int round = 0; round < Rounds; ++round)
  {
    const double start = this->evaluate(points, targets, density, monitor).energy;
    const double worst = state.mostDistortion;
    state = this->minimise(points, targets, density, Steps, monitor);
    if (std::abs(worst - state.mostDistortion) < 1e-3 * worst)
    {
      break;
    }
    const double sigma = std::max(1 - state.energy / start, 0.1);
    density.stiffness += sigma * (1 - density.stiffness * state.mostDistortion) / state.mostDistortion;
  }
}
}
