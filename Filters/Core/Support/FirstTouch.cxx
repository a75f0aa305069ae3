// SPDX-License-Identifier: BSD-3-Clause
#include "Support/FirstTouch.h"

namespace morph
{
void touchPages(void* data, std::size_t bytes, Monitor& monitor)
{
  constexpr std::size_t Page = 4096;
  constexpr Index Grain = 2048; // 8 MiB: waking a thread costs less than clearing that
  const auto pages = static_cast<Index>(bytes / Page);
  if (pages < 2 * Grain)
  {
    return;
  }
  monitor.parallelFor(pages, Grain,
    [&](Index first, Index last)
    {
      for (Index page = first; page < last; ++page)
      {
        static_cast<volatile char*>(data)[page * Page] = 0;
      }
    });
}
}
