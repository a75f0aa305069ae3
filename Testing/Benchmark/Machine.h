// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace benchmark
{
/// "2 cores, Intel Xeon ..., last-level cache 480 MiB, load average 0.21 0.08 0.06".
std::string machineDescription();

/// How many cores went to anyone else since construction: other processes, and the host of a
/// virtual machine. The load average cannot tell, it counts the benchmark too. Reads /proc/stat.
class Interference
{
public:
  Interference();
  /// Cores that other processes and the host took. Throws std::runtime_error where /proc/stat does
  /// not say.
  double cores() const;
  /// "other processes 0.42 cores, host 0.00 cores"; "unknown" where /proc/stat does not say.
  std::string description() const;

private:
  struct Seconds
  {
    double busy = 0;   ///< of all processes
    double stolen = 0; ///< taken by the host
    double own = 0;    ///< of this process and its ended children
    double wall = 0;
    bool known = false;
  };
  static Seconds now();
  static double others(const Seconds& start, const Seconds& end);

  Seconds start_;
};

/// To be called before each competitor: waits until the idle threads of OpenBLAS and OpenMP, which
/// spin for some tens of milliseconds, have gone to sleep, and hands freed memory back so that each
/// pays for its own page faults. Then waits up to `longestWait` seconds for the other processes to
/// leave the machine idle, and returns whether they did.
bool settle(double longestWait);

/// Bytes of the largest cache, 0 where the system does not say.
double lastLevelCacheBytes();

/// Runs `setUp` and then `work` in a child process and returns by how many bytes `work` raised the
/// peak resident set. Linux only: reads /proc/self/status. Call it before the process starts
/// threads. Throws std::runtime_error if the child fails.
double peakMemoryGrowth(const std::function<void()>& setUp, const std::function<void()>& work);
}
