// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// Returns `zero` + the sum of body(i) over i in [0, n); may use several threads. It first sums
/// blocks of fixed length, then their sums, so threads cannot change the last bit.
template <typename Value, typename Body>
Value reproducibleSum(Index n, Monitor& monitor, const Value& zero, const Body& body)
{
  constexpr Index Block = 4096;
  const Index blocks = (n + Block - 1) / Block;
  std::vector<Value> part(blocks, zero);
  monitor.parallelFor(blocks, 1,
    [&](Index firstBlock, Index lastBlock)
    {
      for (Index b = firstBlock; b < lastBlock; ++b)
      {
        Value sum = zero;
        const Index last = std::min(n, (b + 1) * Block);
        for (Index i = b * Block; i < last; ++i)
        {
          sum += body(i);
        }
        part[b] = sum;
      }
    });
  Value total = zero;
  for (const Value& p : part)
  {
    total += p;
  }
  return total;
}

/// The sum of the products of all entries.
inline double dot(const Points& a, const Points& b, Monitor& monitor)
{
  return reproducibleSum(a.rows(), monitor, 0., [&](Index i) { return a.row(i).dot(b.row(i)); });
}
}
