// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/WorstMean.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace morph
{
Index worstCount(Index measured, double share)
{
  const double all = static_cast<double>(measured);
  return std::clamp<Index>(static_cast<Index>(std::ceil(share * all)), 1, measured);
}

double worstMean(const Quality& quality, double share)
{
  std::vector<double> values;
  values.reserve(quality.measured);
  std::copy_if(quality.scaledJacobian.begin(), quality.scaledJacobian.end(),
    std::back_inserter(values), [](double value) { return !std::isnan(value); });
  if (values.empty())
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Index count = worstCount(static_cast<Index>(values.size()), share);
  const auto last = values.begin() + count;
  std::nth_element(values.begin(), last - 1, values.end());
  std::sort(values.begin(), last);
  return std::accumulate(values.begin(), last, 0.) / static_cast<double>(count);
}
}
