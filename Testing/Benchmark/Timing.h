// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <vector>

namespace benchmark
{
/// Wall-clock seconds since construction.
class Stopwatch
{
public:
  double seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->start_).count();
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor seconds of the calling thread since construction: what its own work took, whatever
/// else ran beside it.
class ThreadStopwatch
{
public:
  ThreadStopwatch()
    : start_(now())
  {
  }
  double seconds() const { return now() - this->start_; }

private:
  static double now();

  double start_;
};

/// The middle value; the mean of the two middle ones for an even count. `values` is not empty.
double median(std::vector<double> values);

/// Least-squares slope of log(y) against log(x).
double logLogSlope(const std::vector<double>& x, const std::vector<double>& y);
}
