// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

namespace morph
{
/// Calls body(i) for i in [0, n), perhaps in several threads, for bodies of some nanoseconds.
template <typename Body>
void parallel(Index n, Monitor& monitor, const Body& body)
{
  constexpr Index Grain = 4096;
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        body(i);
      }
    });
}
}
