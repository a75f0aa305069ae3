// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

namespace morph
{
/// Disjoint sets of the numbers 0 to n - 1 (union-find with path halving). The root of a set is its
/// lowest number, so roots do not depend on the order in which sets are joined. Several threads may
/// call root() and join() at once; what they join is one set when all have returned.
template <typename Number>
class UnionFind
{
public:
  explicit UnionFind(Number n)
    : parent_(n)
  {
    for (Number i = 0; i < n; ++i)
    {
      this->parent_[i].store(i, Relaxed);
    }
  }

  Number root(Number i)
  {
    for (Number parent = this->parent(i); parent != i; parent = this->parent(i))
    {
      // Of two threads that shorten a path the last one wins; both numbers are ancestors.
      const Number above = this->parent(parent);
      this->parent_[i].store(above, Relaxed);
      i = above;
    }
    return i;
  }

  /// Makes one set of two, and returns its root. Cheapest where `a` is a root and `b` in its set.
  Number join(Number a, Number b)
  {
    while (true)
    {
      a = this->root(a);
      if (this->parent(b) == a)
      {
        return a;
      }
      b = this->root(b);
      // The higher root gets a parent, unless another thread has just given it one.
      Number high = std::max(a, b);
      if (a == b || this->parent_[high].compare_exchange_strong(high, std::min(a, b), Relaxed))
      {
        return std::min(a, b);
      }
    }
  }

private:
  static constexpr std::memory_order Relaxed = std::memory_order_relaxed;

  Number parent(Number i) const { return this->parent_[i].load(Relaxed); }

  std::vector<std::atomic<Number>> parent_;
};
}
