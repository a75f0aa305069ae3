// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace morph
{
/// Measures the time since it was made.
class Stopwatch
{
public:
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->start_).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};
}
