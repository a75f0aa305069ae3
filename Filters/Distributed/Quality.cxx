// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Quality.h"

#include "Quality/ScaledJacobian.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>

namespace morph::distributed
{
namespace
{
/// Numbers in the order of the doubles.
std::uint64_t keyOf(double value)
{
  constexpr std::uint64_t Sign = std::uint64_t(1) << 63;
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return (bits & Sign) != 0 ? ~bits : bits | Sign;
}
}

double worstMean(const Ranks& ranks, const Quality& mine, double share)
{
  std::vector<double> values;
  std::copy_if(mine.scaledJacobian.begin(), mine.scaledJacobian.end(), std::back_inserter(values),
    [](double value) { return !std::isnan(value); });
  std::sort(values.begin(), values.end());
  const Index all = ranks.sum(static_cast<Index>(values.size()));
  if (all == 0)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Index count = worstCount(all, share);
  const auto below = [&](std::uint64_t key) // on this rank
  {
    return std::partition_point(
             values.begin(), values.end(), [&](double value) { return keyOf(value) < key; }) -
           values.begin();
  };
  // The largest key with fewer than `count` values below is that of the last value that counts.
  std::uint64_t key = 0;
  for (int bit = 63; bit >= 0; --bit)
  {
    const std::uint64_t next = key | std::uint64_t(1) << bit;
    if (ranks.sum(static_cast<Index>(below(next))) < count)
    {
      key = next;
    }
  }
  const auto end = values.begin() + below(key);
  const double sum = ranks.sum(std::accumulate(values.begin(), end, 0.));
  const Index less = ranks.sum(static_cast<Index>(end - values.begin()));
  const double last =
    ranks.minimum(end == values.end() ? std::numeric_limits<double>::infinity() : *end);
  return (sum + static_cast<double>(count - less) * last) / static_cast<double>(count);
}

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
