// SPDX-License-Identifier: BSD-3-Clause
#include "Bandwidth.h"
#include "Timing.h"

#include <Eigen/Core>

#include <atomic>
#include <stdexcept>

namespace benchmark
{
namespace
{
/// Small enough for all threads to get a share, large enough that cutting costs nothing.
constexpr morph::Index Grain = 16384;
constexpr int Passes = 7;
}

Bandwidth measureBandwidth(std::size_t bytes, morph::Monitor& monitor)
{
  const auto n = static_cast<morph::Index>(bytes / (3 * sizeof(double)));
  Eigen::VectorXd a(n), b(n), c(n);
  monitor.parallelFor(n, Grain,
    [&](morph::Index first, morph::Index last)
    {
      a.segment(first, last - first).setZero();
      b.segment(first, last - first).setConstant(1);
      c.segment(first, last - first).setConstant(2);
    });

  double triadSeconds = 0;
  double readSeconds = 0;
  for (int pass = 0; pass < Passes; ++pass)
  {
    const Stopwatch triad;
    monitor.parallelFor(n, Grain,
      [&](morph::Index first, morph::Index last)
      {
        const morph::Index size = last - first;
        a.segment(first, size).noalias() = b.segment(first, size) + 3.0 * c.segment(first, size);
      });
    const double triadTime = triad.seconds();

    std::atomic<morph::Index> total{ 0 };
    const auto add = [&](const Eigen::VectorXd& values)
    {
      monitor.parallelFor(n, Grain,
        [&](morph::Index first, morph::Index last)
        { total += static_cast<morph::Index>(values.segment(first, last - first).sum()); });
    };
    const Stopwatch read;
    add(a);
    add(b);
    add(c);
    const double readTime = read.seconds();
    // a = 1 + 3 * 2: the sums are whole numbers, and using them keeps the loops from being dropped.
    if (total != n * (7 + 1 + 2))
    {
      throw std::runtime_error("The bandwidth kernels gave a wrong sum.");
    }
    triadSeconds = pass ? std::min(triadSeconds, triadTime) : triadTime;
    readSeconds = pass ? std::min(readSeconds, readTime) : readTime;
  }
  const double moved = 3.0 * sizeof(double) * static_cast<double>(n);
  return { moved / readSeconds, moved / triadSeconds };
}
}
