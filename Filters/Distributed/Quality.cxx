// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Quality.h"

#include <limits>

namespace morph::distributed
{
Quality reduce(const Ranks& ranks, const Quality& mine, const std::vector<std::int64_t>& cellIds)
{
  constexpr Index NoCell = std::numeric_limits<Index>::max();
  const bool any = mine.measured > 0;
  Quality whole;
  Index counts[3] = { mine.measured, mine.inverted, mine.degenerate };
  ranks.sum(counts, 3);
  whole.measured = counts[0];
  whole.inverted = counts[1];
  whole.degenerate = counts[2];
  whole.minimum = ranks.minimum(any ? mine.minimum : std::numeric_limits<double>::infinity());
  Index worst = NoCell;
  if (any && mine.minimum == whole.minimum)
  {
    for (std::size_t c = 0; c < mine.scaledJacobian.size(); ++c)
    {
      if (mine.scaledJacobian[c] == whole.minimum)
      {
        worst = std::min(worst, cellIds[c]);
      }
    }
  }
  worst = ranks.minimum(worst);
  whole.worstCell = worst == NoCell ? -1 : worst;
  const double sum = ranks.sum(any ? mine.mean * static_cast<double>(mine.measured) : 0.);
  whole.mean = sum / static_cast<double>(whole.measured);
  if (whole.measured == 0)
  {
    whole.minimum = whole.mean = std::numeric_limits<double>::quiet_NaN();
  }
  return whole;
}
}
