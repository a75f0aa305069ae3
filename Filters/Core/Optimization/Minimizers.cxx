// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"

#include "Support/Parallel.h"

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

void Objective::moveAlike(Points& direction) const
{
  for (const auto& [front, back] : this->images_)
  {
    direction.row(front) = direction.row(back) =
      ((direction.row(front) + direction.row(back)) / 2).eval();
  }
}

template <typename Act>
void Objective::forEachNormal(const Points& points, const Act& act) const
{
  const std::vector<Index>& free = this->free();
  for (const auto& [front, back] : this->images_)
  {
    const Eigen::RowVector3d across = points.row(free[back]) - points.row(free[front]);
    act(front, across.stableNormalized());
    act(back, across.stableNormalized());
  }
  for (std::size_t row = 0; !this->normal_.isZero(0) && row < free.size(); ++row)
  {
    act(static_cast<Index>(row), this->normal_);
  }
}

void Objective::keepTangent(const Points& points, Points& gradient) const
{
  this->moveAlike(gradient);
  this->forEachNormal(points, [&](Index row, const Eigen::RowVector3d& normal)
    { gradient.row(row) -= gradient.row(row).dot(normal) * normal; });
}

void Objective::keepTangent(const Points& points, BlockCsr3f& hessian) const
{
  if (this->images_.empty() && this->normal_.isZero(0))
  {
    return;
  }
  using Matrix = Eigen::Matrix3f;
  std::vector<Matrix, Eigen::aligned_allocator<Matrix>> across(hessian.rows(), Matrix::Zero());
  this->forEachNormal(points, [&](Index row, const Eigen::RowVector3d& normal)
    { across[row] = (normal.transpose() * normal).cast<float>(); });
  for (Index row = 0; row < hessian.rows(); ++row)
  {
    for (Index k = 0; k < hessian.numberOfBlocks(row); ++k)
    {
      Eigen::Map<Matrix> block(hessian.blocks(row) + 9 * k);
      const float mean = block.trace() / 3;
      const Index column = hessian.column(row, k);
      block =
        ((Matrix::Identity() - across[row]) * block * (Matrix::Identity() - across[column])).eval();
      if (k == 0) // of the diagonal
      {
        block += mean * across[row];
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
    objective.keepTangent(points, gradient);
    const double norm = std::sqrt(objective.rows().dot(gradient, gradient, monitor));
    if (!(norm > 0 && std::isfinite(norm)))
    {
      break;
    }
    objective.hessian(points, matrix, monitor);
    objective.keepTangent(points, matrix);
    // The diagonal blocks alone need the tolerance: looser steps miss what is smooth.
    effort.linearIterations += matrix.solve(gradient, direction, LinearTolerance,
      MostLinearIterations, monitor, objective.rows(), limits.preconditioner, forcing.next(norm));
    direction *= -1;
    objective.moveAlike(direction); // the gradient's images are alike, so the slope is the same
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

namespace
{
constexpr int MostHalvings = 40;
constexpr double SufficientDecrease = 1e-4;
}

bool LineSearch::run(const Points& direction, double slope, Points& points, Objective::Value& value,
  MinimizerEffort& effort, Monitor& monitor)
{
  if (!(slope < 0)) // also if it is not a number
  {
    return false;
  }
  const std::vector<Index>& free = this->objective_.free();
  if (this->trial_.rows() != points.rows())
  {
    this->trial_ = points;
  }
  const auto goTo = [&](const Points& from, double length, Points& to)
  {
    parallel(direction.rows(), monitor,
      [&](Index i) { to.row(free[i]) = from.row(free[i]) + length * direction.row(i); });
  };
  this->length_ = 1;
  for (int halving = 0; halving < MostHalvings; ++halving, this->length_ /= 2)
  {
    monitor.check();
    goTo(points, this->length_, this->trial_);
    ++effort.evaluations;
    this->hasGradient_ = this->keepsGradient_ && halving == 0;
    const Objective::Value next =
      this->hasGradient_ ? this->objective_.valueAndGradient(this->trial_, this->gradient_, monitor)
                         : this->objective_.value(this->trial_, monitor);
    if (next.allowed && std::isfinite(next.energy) &&
        next.energy <= value.energy + SufficientDecrease * this->length_ * slope)
    {
      points.swap(this->trial_);
      value = next;
      for (int doubling = 0; halving == 0 && doubling < this->doublings_; ++doubling)
      {
        this->farther_ = points;
        goTo(this->trial_, 2 * this->length_, this->farther_);
        ++effort.evaluations;
        const Objective::Value far = this->objective_.value(this->farther_, monitor);
        if (!(far.allowed && far.energy < value.energy))
        {
          break;
        }
        this->length_ *= 2;
        points.swap(this->farther_);
        value = far;
      }
      return true;
    }
  }
  return false;
}

void LineSearch::gradient(const Points& points, Points& result, Monitor& monitor)
{
  if (this->hasGradient_)
  {
    result.swap(this->gradient_);
    this->hasGradient_ = false;
    return;
  }
  this->objective_.gradient(points, result, monitor);
}

bool DescentProgress::settled(double before, double after, double norm)
{
  this->first_ = this->first_ < 0 ? norm : this->first_;
  const double decrease = before - after;
  return decrease <= this->limits_.decrease * std::abs(after) ||
         (decrease <= this->limits_.slowDecrease * std::abs(after) &&
           norm <= this->limits_.gradientDecrease * this->first_);
}
}
