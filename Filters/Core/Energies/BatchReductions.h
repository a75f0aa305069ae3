// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Mesh/GatherMap.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <algorithm>
#include <vector>

namespace morph
{
namespace detail
{
constexpr Index BatchGrain = 128;
constexpr Index BlockGrain = 4; // waking a thread takes as long as a block or more

/// Sums body(first, last, sum) over blocks of batches, in order.
template <typename Sum, typename Body>
Sum sumOfBlocks(const CellBatches& batches, Monitor& monitor, const Body& body)
{
  const Index count = batches.size();
  const Index blocks = (count + BatchGrain - 1) / BatchGrain;
  std::vector<Sum> part(blocks);
  parallel(blocks, BlockGrain, monitor,
    [&](Index b) { body(b * BatchGrain, std::min(count, (b + 1) * BatchGrain), part[b]); });
  Sum sum{};
  for (const Sum& p : part)
  {
    sum += p;
  }
  return sum;
}
}

/// Sums Body::run(batch, batches, arguments..., sum) over all batches, see Simd.h. Batches
/// are summed in fixed blocks in order, so the result does not depend on threads.
template <typename Body, typename Sum, typename... Arguments>
Sum sumOverBatches(const CellBatches& batches, Monitor& monitor, const Arguments&... arguments)
{
  return detail::sumOfBlocks<Sum>(batches, monitor,
    [&](Index first, Index last, Sum& own)
    { dispatchedFor<Body>(first, last, batches, arguments..., own); });
}

/// Sums the contributions of all batches to the rows' corners into `result`, #rows x 3.
/// Body::run(batch, batches, arguments..., parts) writes a batch's contributions to their places in
/// `parts`, whose memory is reused. Each row's sum has the order of its places.
template <typename Body, typename... Arguments>
void gatherFromBatches(const CellBatches& batches, Points& parts, Points& result, Monitor& monitor,
  const Arguments&... arguments)
{
  parts.resize(batches.places(), 3);
  monitor.parallelFor(batches.size(), detail::BatchGrain,
    [&](Index first, Index last)
    { dispatchedFor<Body>(first, last, batches, arguments..., parts); });
  gatherSum(batches.uses(), parts, result, monitor);
}
}
