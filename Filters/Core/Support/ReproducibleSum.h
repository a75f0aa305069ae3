// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// Returns `zero` + the sum of body(first, last) over blocks [first, last) of [0, n); may use
/// several threads. The blocks have a fixed length, so threads cannot change the last bit.
template <typename Value, typename Body>
Value reproducibleSumOfBlocks(Index n, Monitor& monitor, const Value& zero, const Body& body)
{
  constexpr Index Block = 4096;
  const Index blocks = (n + Block - 1) / Block;
  std::vector<Value> part(blocks, zero);
  monitor.parallelFor(blocks, 1,
    [&](Index firstBlock, Index lastBlock)
    {
      for (Index b = firstBlock; b < lastBlock; ++b)
      {
        part[b] = body(b * Block, std::min(n, (b + 1) * Block));
      }
    });
  Value total = zero;
  for (const Value& p : part)
  {
    total += p;
  }
  return total;
}

/// Returns `zero` + the sum of body(i) over i in [0, n), as reproducibleSumOfBlocks().
template <typename Value, typename Body>
Value reproducibleSum(Index n, Monitor& monitor, const Value& zero, const Body& body)
{
  return reproducibleSumOfBlocks(n, monitor, zero,
    [&](Index first, Index last)
    {
      Value sum = zero;
      for (Index i = first; i < last; ++i)
      {
        sum += body(i);
      }
      return sum;
    });
}

/// The sum of the products of all entries.
inline double dot(const Points& a, const Points& b, Monitor& monitor)
{
  return reproducibleSum(a.rows(), monitor, 0., [&](Index i) { return a.row(i).dot(b.row(i)); });
}
}
