// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"

#include "Optimization/Descent.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double LinearTolerance = 0.03;
constexpr int MostLinearIterations = 100;

/// The relative residual of the next linear system, by the gradients' norms. Source: Eisenstat,
/// Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, choice 2 with its safeguard.
class ForcingTerm
{
public:
  double next(double norm)
  {
    if (this->norm_ > 0)
    {
      const double ratio = norm / this->norm_, safeguard = Gamma * this->term_ * this->term_;
      const double term = std::max(Gamma * ratio * ratio, safeguard > 0.1 ? safeguard : 0);
      this->term_ = std::clamp(term, LinearTolerance, Most);
    }
    this->norm_ = norm;
    return this->term_;
  }

private:
  static constexpr double Gamma = 0.9, Most = 0.3;
  double norm_ = 0, term_ = Most;
};
}

Objective::~Objective() = default;

void Objective::keepInPlane(Points& gradient) const
{
  if (!this->normal_.isZero(0))
  {
    gradient -= (gradient * this->normal_.transpose()).eval() * this->normal_;
  }
}

void Objective::keepInPlane(BlockCsr3f& hessian) const
{
  if (this->normal_.isZero(0))
  {
    return;
  }
  const Eigen::Matrix3f normal = (this->normal_.transpose() * this->normal_).cast<float>();
  const Eigen::Matrix3f inPlane = Eigen::Matrix3f::Identity() - normal;
  for (Index row = 0; row < hessian.rows(); ++row)
  {
    for (Index k = 0; k < hessian.numberOfBlocks(row); ++k)
    {
      Eigen::Map<Eigen::Matrix3f> block(hessian.blocks(row) + 9 * k);
      const float mean = block.trace() / 3;
      block = (inPlane * block * inPlane).eval();
      if (k == 0) // of the diagonal
      {
        block += mean * normal;
      }
    }
  }
}

Objective::Value Objective::valueAndGradient(
  const Points& points, Points& result, Monitor& monitor) const
{
  const Value value = this->value(points, monitor);
  if (std::isfinite(value.energy))
  {
    this->gradient(points, result, monitor);
  }
  return value;
}

Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  Objective::Value value = objective.value(points, monitor);
  DescentProgress progress(limits);
  LineSearch search(objective, false, limits.doublings);
  Points gradient, direction;
  ForcingTerm forcing;
  for (int step = 0; step < limits.steps; ++step)
  {
    monitor.check();
    objective.gradient(points, gradient, monitor);
    objective.keepInPlane(gradient);
    const double norm = std::sqrt(objective.rows().dot(gradient, gradient, monitor));
    if (!(norm > 0 && std::isfinite(norm)))
    {
      break;
    }
    objective.hessian(points, matrix, monitor);
    objective.keepInPlane(matrix);
    // The diagonal blocks alone need the tolerance: looser steps miss what is smooth.
    effort.linearIterations += matrix.solve(gradient, direction, LinearTolerance,
      MostLinearIterations, monitor, objective.rows(), limits.preconditioner, forcing.next(norm));
    direction *= -1;
    const double slope = objective.rows().dot(gradient, direction, monitor);
    const double before = value.energy;
    if (!search.run(direction, slope, points, value, effort, monitor))
    {
      break;
    }
    ++effort.steps;
    if (value.enough || progress.settled(before, value.energy, norm))
    {
      break;
    }
  }
  return value;
}
}
