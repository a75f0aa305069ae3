// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Mesh/GatherMap.h"
#include "Support/Monitor.h"
#include "Support/SimdDispatch.h"

#include <algorithm>
#include <vector>

namespace morph
{
namespace detail
{
constexpr Index BatchGrain = 128;
}

/// What Body::run(batch, batches, arguments..., sum) adds to a Sum for each batch, see
/// SimdDispatch.h. Sums of fixed blocks, in their order: no thread shows.
template <typename Body, typename Sum, typename... Arguments>
Sum sumOverBatches(const CellBatches& batches, Monitor& monitor, const Arguments&... arguments)
{
  const Index count = batches.size();
  const Index blocks = (count + detail::BatchGrain - 1) / detail::BatchGrain;
  std::vector<Sum> part(blocks);
  monitor.parallelFor(blocks, 1,
    [&](Index first, Index last)
    {
      for (Index b = first; b < last; ++b)
      {
        dispatchedFor<Body>(b * detail::BatchGrain, std::min(count, (b + 1) * detail::BatchGrain),
          batches, arguments..., part[b]);
      }
    });
  Sum sum{};
  for (const Sum& p : part)
  {
    sum += p;
  }
  return sum;
}

/// Body::run(batch, batches, arguments..., parts) writes what the batch gives to its corners at
/// their places in `parts`, whose room is used again; `result` becomes each row's sum over its
/// places, in their order.
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
