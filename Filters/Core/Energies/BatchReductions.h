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
constexpr Index GroupGrain = 128;
}

/// What Body::run(group, groups, arguments..., sum) adds to a Sum for each group, see SimdDispatch.h. Sums of fixed blocks, in their
/// order: no thread shows.
template <typename Body, typename Sum, typename... Arguments>
Sum sumOverGroups(const CellGroups& groups, Monitor& monitor, const Arguments&... arguments)
{
  const Index count = groups.size();
  const Index blocks = (count + detail::GroupGrain - 1) / detail::GroupGrain;
  std::vector<Sum> part(blocks);
  monitor.parallelFor(blocks, 1,
    [&](Index first, Index last)
    {
      for (Index b = first; b < last; ++b)
      {
        vectorLoop<Body>(b * detail::GroupGrain, std::min(count, (b + 1) * detail::GroupGrain),
          groups, arguments..., part[b]);
      }
    });
  Sum sum{};
  for (const Sum& p : part)
  {
    sum += p;
  }
  return sum;
}

/// Body::run(group, groups, arguments..., parts) writes what the group gives to its corners at their places in `parts`, whose room is
/// used again; `result` becomes each row's sum over its places, in their order.
template <typename Body, typename... Arguments>
void gatherFromGroups(const CellGroups& groups, Points& parts, Points& result, Monitor& monitor,
  const Arguments&... arguments)
{
  parts.resize(groups.places(), 3);
  monitor.parallelFor(groups.size(), detail::GroupGrain,
    [&](Index first, Index last) { vectorLoop<Body>(first, last, groups, arguments..., parts); });
  sumOverPlaces(groups.uses(), parts, result, monitor);
}
}
