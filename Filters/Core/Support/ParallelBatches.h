// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <algorithm>

namespace morph
{
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
