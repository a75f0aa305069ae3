// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/HugePages.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace morph
{
/// Disjoint sets of the numbers 0 to n - 1 (union-find with path halving). The root of a set is its
/// lowest number, so roots do not depend on the order in which sets are joined.
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
    while (this->parent_[i] != i)
    {
      this->parent_[i] = this->parent_[this->parent_[i]];
      i = this->parent_[i];
    }
    return i;
  }

  /// Makes one set of two, and returns its root. Cheapest where `a` is a root and `b` in its set.
  Number join(Number a, Number b)
  {
    a = this->root(a);
    if (this->parent_[b] == a)
    {
      return a;
    }
    b = this->root(b);
    this->parent_[std::max(a, b)] = std::min(a, b);
    return std::min(a, b);
  }

private:
  std::vector<Number> parent_;
};
}
