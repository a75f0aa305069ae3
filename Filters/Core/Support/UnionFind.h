// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/HugePages.h"

#include <algorithm>
#include <numeric>
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
    : parent_(largeVector<Number>(n))
  {
    std::iota(this->parent_.begin(), this->parent_.end(), Number(0));
  }

  Number root(Number i)
  {
    for (Number parent = this->parent(i); parent != i; parent = this->parent(i))
    {
      // Of two threads that shorten a path the last one wins; both numbers are ancestors.
      const Number above = this->parent(parent);
      __atomic_store_n(&this->parent_[i], above, __ATOMIC_RELAXED);
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
      if (a == b || __atomic_compare_exchange_n(&this->parent_[high], &high, std::min(a, b), false,
                      __ATOMIC_RELAXED, __ATOMIC_RELAXED))
      {
        return std::min(a, b);
      }
    }
  }

private:
  Number parent(Number i) const { return __atomic_load_n(&this->parent_[i], __ATOMIC_RELAXED); }

  std::vector<Number> parent_;
};
}
