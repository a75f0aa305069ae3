// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"
#include "Support/Simd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr int Memory = 10;         // steps
constexpr int Slots = Memory + 1;  // the newest pair is made before the oldest is forgotten
constexpr double FirstStep = 1e-3; // of the mesh's size
// Rows in a block: its part of the newest pair stays in cache while it meets all others.
constexpr Index BlockRows = 512;
constexpr Index Grain = 8; // blocks; waking a thread takes as long as some of them

Index blocksOf(const Points& points)
{
  return (points.rows() + BlockRows - 1) / BlockRows;
}

/// Adds the products of `count` numbers.
MORPH_SIMD_INLINE void addProduct(const double* a, const double* b, Index count, double& result)
{
  SimdDouble4 sum[2] = {};
  Index k = 0;
  for (; k + 2 * SimdWidth <= count; k += 2 * SimdWidth)
  {
    for (int half = 0; half < 2; ++half)
    {
      const Index at = k + half * SimdWidth;
      sum[half] += load(a + at) * load(b + at);
    }
  }
  for (; k < count; ++k)
  {
    result += a[k] * b[k];
  }
  const SimdDouble4 both = sum[0] + sum[1];
  result += (both[0] + both[1]) + (both[2] + both[3]);
}

/// A step and the gradient's difference over it.
struct Pair
{
  Points step, difference;
};
using Pairs = std::array<Pair, Slots>;
using Numbers = std::array<double, Slots>; ///< one a slot

/// A list of slots, from the oldest pair to the newest.
struct Order
{
  std::array<int, Slots> slot{};
  int count = 0;
  const int* begin() const { return this->slot.data(); }
  const int* end() const { return this->slot.data() + this->count; }
};

/// Products of the gradient, and of the newest difference, with themselves and with the pairs.
struct Products
{
  double gradient = 0;
  Numbers stepGradient{}, differenceGradient{}, stepNewest{}, differenceNewest{};

  Products& operator+=(const Products& other)
  {
    this->gradient += other.gradient;
    for (int i = 0; i < Slots; ++i)
    {
      this->stepGradient[i] += other.stepGradient[i];
      this->differenceGradient[i] += other.differenceGradient[i];
      this->stepNewest[i] += other.stepNewest[i];
      this->differenceNewest[i] += other.differenceNewest[i];
    }
    return *this;
  }

  /// Takes out the products of row `r`, of which another process has the copy that counts.
  void takeOut(Index r, const Order& order, const Points& g, const Pairs& pairs)
  {
    const Points& newest = pairs[order.slot[order.count - 1]].difference;
    this->gradient -= g.row(r).squaredNorm();
    for (const int i : order)
    {
      const auto step = pairs[i].step.row(r), difference = pairs[i].difference.row(r);
      this->stepGradient[i] -= step.dot(g.row(r));
      this->differenceGradient[i] -= difference.dot(g.row(r));
      this->stepNewest[i] -= step.dot(newest.row(r));
      this->differenceNewest[i] -= difference.dot(newest.row(r));
    }
  }

  /// Sums over all processes.
  void share(const Communicator& processes)
  {
    std::array<double, 1 + 4 * Slots> all{};
    double* to = all.data();
    *to++ = this->gradient;
    const auto numbers = { &this->stepGradient, &this->differenceGradient, &this->stepNewest,
      &this->differenceNewest };
    for (const Numbers* own : numbers)
    {
      to = std::copy(own->begin(), own->end(), to);
    }
    processes.sum(all.data(), static_cast<int>(all.size()));
    const double* from = all.data();
    this->gradient = *from++;
    for (Numbers* own : numbers)
    {
      std::copy(from, from + Slots, own->begin());
      from += Slots;
    }
  }
};

/// Makes a block of the newest pair, the last in the order, and its products.
struct NewestPair
{
  static MORPH_SIMD_INLINE void run(Index block, const Order& order, const Points& gradient,
    const Points& old, const Points& direction, double length, Pairs& pairs,
    std::vector<Products>& products)
  {
    const Index first = 3 * block * BlockRows;
    const Index count = std::min<Index>(3 * BlockRows, gradient.size() - first);
    Pair& newest = pairs[order.slot[order.count - 1]];
    const double *g = gradient.data() + first, *before = old.data() + first,
                 *d = direction.data() + first;
    double *s = newest.step.data() + first, *y = newest.difference.data() + first;
    for (Index k = 0; k < count; ++k)
    {
      s[k] = length * d[k];
      y[k] = g[k] - before[k];
    }
    Products& own = products[block];
    addProduct(g, g, count, own.gradient);
    for (const int i : order)
    {
      const double* step = pairs[i].step.data() + first;
      const double* difference = pairs[i].difference.data() + first;
      addProduct(step, g, count, own.stepGradient[i]);
      addProduct(difference, g, count, own.differenceGradient[i]);
      addProduct(step, y, count, own.stepNewest[i]);
      addProduct(difference, y, count, own.differenceNewest[i]);
    }
  }
};

/// The direction as a sum of the gradient and of the pairs.
struct Coefficients
{
  double gradient = 0;
  Numbers step{}, difference{};
};

struct Combination
{
  static MORPH_SIMD_INLINE void run(Index block, const Order& order, const Coefficients& c,
    const Points& gradient, const Pairs& pairs, Points& result)
  {
    const Index first = 3 * block * BlockRows;
    const Index count = std::min<Index>(3 * BlockRows, gradient.size() - first);
    double* out = result.data() + first;
    const double* g = gradient.data() + first;
    for (Index k = 0; k < count; ++k)
    {
      out[k] = c.gradient * g[k];
    }
    for (const int i : order)
    {
      const double* step = pairs[i].step.data() + first;
      const double* difference = pairs[i].difference.data() + first;
      const double ofStep = c.step[i], ofDifference = c.difference[i];
      for (Index k = 0; k < count; ++k)
      {
        out[k] += ofStep * step[k] + ofDifference * difference[k];
      }
    }
  }
};

/// The inverse Hessian by the last steps. The two-loop recursion runs on coefficients, so that a
/// step takes two passes over the vectors: one for products and one for the direction.
class InverseHessian
{
public:
  /// `first`: how far the first step moves the node with the largest gradient, as nothing else
  /// scales it.
  InverseHessian(const Objective& objective, double first)
    : objective_(objective)
    , first_(first)
  {
  }

  bool empty() const { return this->order_.count == 0; }
  void forget() { this->order_.count = 0; }
  /// Returns the gradient's squared norm.
  double squaredNorm() const { return this->products_.gradient; }

  /// Call it once, at the start.
  void begin(const Points& gradient, Monitor& monitor)
  {
    this->products_.gradient = this->objective_.rows().dot(gradient, gradient, monitor);
  }

  /// Computes the direction and returns its slope.
  double apply(const Points& gradient, Points& direction, Monitor& monitor) const
  {
    const Products& p = this->products_;
    if (this->empty())
    {
      const double most = gradient.rows() > 0 ? gradient.rowwise().norm().maxCoeff() : 0;
      const double factor = -this->first_ / this->objective_.communicator().maximum(most);
      direction = factor * gradient;
      return factor * p.gradient;
    }
    const Coefficients c = this->coefficients();
    direction.resize(gradient.rows(), 3);
    monitor.parallelFor(blocksOf(gradient), Grain,
      [&](Index first, Index last) {
        dispatchedFor<Combination>(first, last, this->order_, c, gradient, this->pairs_, direction);
      });
    double slope = c.gradient * p.gradient;
    for (const int i : this->order_)
    {
      slope += c.step[i] * p.stepGradient[i] + c.difference[i] * p.differenceGradient[i];
    }
    return slope;
  }

  /// Remembers the step `length` times `direction`, from the gradient `old` to `gradient`, unless
  /// its curvature is not positive.
  void remember(const Points& gradient, const Points& old, const Points& direction, double length,
    Monitor& monitor)
  {
    const int newest = this->unusedSlot();
    this->order_.slot[this->order_.count++] = newest;
    Pair& pair = this->pairs_[newest];
    pair.step.resize(gradient.rows(), 3);
    pair.difference.resize(gradient.rows(), 3);
    std::vector<Products> parts(blocksOf(gradient));
    monitor.parallelFor(static_cast<Index>(parts.size()), Grain,
      [&](Index first, Index last)
      {
        dispatchedFor<NewestPair>(
          first, last, this->order_, gradient, old, direction, length, this->pairs_, parts);
      });
    this->products_ = {};
    for (const Products& part : parts)
    {
      this->products_ += part;
    }
    for (const Index row : this->objective_.rows().countedElsewhere())
    {
      this->products_.takeOut(row, this->order_, gradient, this->pairs_);
    }
    this->products_.share(this->objective_.communicator());
    if (!(this->products_.stepNewest[newest] > 0))
    {
      --this->order_.count;
      return;
    }
    for (const int i : this->order_)
    {
      this->stepDifference_[i][newest] = this->products_.stepNewest[i];
      this->differences_[i][newest] = this->products_.differenceNewest[i];
      this->differences_[newest][i] = this->products_.differenceNewest[i];
    }
    if (this->order_.count > Memory)
    {
      std::rotate(
        this->order_.slot.begin(), this->order_.slot.begin() + 1, this->order_.slot.end());
      --this->order_.count;
    }
  }

private:
  int unusedSlot() const
  {
    int slot = 0;
    while (std::find(this->order_.begin(), this->order_.end(), slot) != this->order_.end())
    {
      ++slot;
    }
    return slot;
  }

  Coefficients coefficients() const
  {
    const Products& p = this->products_;
    Coefficients c;
    const int* slot = this->order_.slot.data();
    for (int k = this->order_.count; k-- > 0;)
    {
      double along = -p.stepGradient[slot[k]];
      for (int j = k + 1; j < this->order_.count; ++j)
      {
        along += c.difference[slot[j]] * this->stepDifference_[slot[k]][slot[j]];
      }
      c.difference[slot[k]] = -along / this->stepDifference_[slot[k]][slot[k]];
    }
    const int last = slot[this->order_.count - 1];
    const double scale = this->stepDifference_[last][last] / this->differences_[last][last];
    c.gradient = -scale;
    Numbers alpha{};
    for (const int i : this->order_)
    {
      alpha[i] = -c.difference[i];
      c.difference[i] *= scale;
    }
    for (int k = 0; k < this->order_.count; ++k)
    {
      double along = c.gradient * p.differenceGradient[slot[k]];
      for (const int j : this->order_)
      {
        along += c.difference[j] * this->differences_[slot[k]][j];
      }
      for (int j = 0; j < k; ++j)
      {
        along += c.step[slot[j]] * this->stepDifference_[slot[j]][slot[k]];
      }
      c.step[slot[k]] = alpha[slot[k]] - along / this->stepDifference_[slot[k]][slot[k]];
    }
    return c;
  }

  const Objective& objective_;
  double first_;
  Pairs pairs_;
  Order order_;
  Products products_; ///< of the current gradient
  /// Products of pairs: of steps with differences that are as new or newer, and of differences.
  std::array<Numbers, Slots> stepDifference_{}, differences_{};
};

/// The diagonal of the box of all processes' points.
double diagonal(const Points& points, const Communicator& communicator)
{
  double squares = 0;
  for (int j = 0; j < 3; ++j)
  {
    constexpr double None = std::numeric_limits<double>::infinity();
    const bool any = points.rows() > 0;
    const double low = communicator.minimum(any ? points.col(j).minCoeff() : None),
                 high = communicator.maximum(any ? points.col(j).maxCoeff() : -None);
    squares += (high - low) * (high - low);
  }
  return std::sqrt(squares);
}
}

Objective::Value limitedMemoryBfgs(const Objective& objective, Points& points,
  const MinimizerLimits& limits, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  DescentProgress progress(limits);
  LineSearch search(objective, true);
  InverseHessian inverse(objective, FirstStep * diagonal(points, objective.communicator()));
  Points gradient, old, direction;
  Objective::Value value = objective.valueAndGradient(points, gradient, monitor);
  objective.keepTangent(points, gradient);
  inverse.begin(gradient, monitor);
  int settled = 0; // steps in a row
  for (int step = 0; step < limits.steps; ++step)
  {
    monitor.check();
    const double norm = std::sqrt(inverse.squaredNorm());
    if (!(norm > 0 && std::isfinite(norm)))
    {
      break;
    }
    const double before = value.energy;
    bool isScaled = !inverse.empty();
    double slope = inverse.apply(gradient, direction, monitor);
    bool found = search.run(direction, slope, points, value, effort, monitor);
    if (!found && isScaled)
    {
      inverse.forget();
      isScaled = false;
      slope = inverse.apply(gradient, direction, monitor);
      found = search.run(direction, slope, points, value, effort, monitor);
    }
    if (!found)
    {
      break;
    }
    ++effort.steps;
    if (value.enough)
    {
      break;
    }
    old.swap(gradient);
    search.gradient(points, gradient, monitor);
    objective.keepTangent(points, gradient);
    inverse.remember(gradient, old, direction, search.length(), monitor);
    // The length of a step along the gradient is arbitrary, so it proves nothing.
    settled = progress.settled(before, value.energy, norm) && isScaled ? settled + 1 : 0;
    if (settled == limits.settledSteps)
    {
      break;
    }
  }
  return value;
}
}
