// SPDX-License-Identifier: BSD-3-Clause
#include "Timing.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace benchmark
{
double ThreadStopwatch::now()
{
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  constexpr double Nanosecond = 1e-9;
  return static_cast<double>(time.tv_sec) + Nanosecond * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double logLogSlope(const std::vector<double>& x, const std::vector<double>& y)
{
  const auto n = static_cast<double>(x.size());
  double meanX = 0;
  double meanY = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    meanX += std::log(x[i]) / n;
    meanY += std::log(y[i]) / n;
  }
  double covariance = 0;
  double variance = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    covariance += (std::log(x[i]) - meanX) * (std::log(y[i]) - meanY);
    variance += (std::log(x[i]) - meanX) * (std::log(x[i]) - meanX);
  }
  return covariance / variance;
}
}
