// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>

namespace morph
{
/// Calls body(i) for each i in [0, n), perhaps in several threads: Monitor::parallelFor() for a
/// body that needs no range. What one call writes no other may read or write.
template <typename Body>
void parallel(Index n, Index grain, Monitor& monitor, const Body& body)
{
  monitor.parallelFor(n, grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        body(i);
      }
    });
}

/// As above, for a body of some nanoseconds.
template <typename Body>
void parallel(Index n, Monitor& monitor, const Body& body)
{
  constexpr Index Grain = 4096; // waking a thread takes as long
  parallel(n, Grain, monitor, body);
}

/// Monitor::parallelFor() over [0, n), `batch` elements at a time. Threads may not ask whether to
/// stop, so a loop that may take long asks between the batches, and tells its progress. `body`:
/// called with (first, last), as there.
template <typename Body>
void parallelBatches(Monitor& monitor, Index n, Index batch, Index grain, const Body& body)
{
  for (Index begin = 0; begin < n; begin += batch)
  {
    monitor.check();
    monitor.progress(static_cast<double>(begin) / static_cast<double>(n));
    monitor.parallelFor(std::min(batch, n - begin), grain,
      [&](Index first, Index last) { body(begin + first, begin + last); });
  }
}
}
