// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Methods.h"

namespace soak
{
struct AbortOptions
{
  int aborts = 100;
  int checkEvery = 1;  ///< runs to the end after every such abort
  int cells = 46;      ///< along each edge of the box: 46 gives 10^5 nodes
  double seconds = 30; ///< in which a filter has to be back; generous, as the machine may be busy
  unsigned seed = 1;
};

/// Stops a filter at random moments of its run, half of them with a method to prepare. Prints how
/// long it took to come back. True if it was back in time, with the undeformed mesh and the status
/// Cancelled, and the next run gave the same bits as a fresh filter.
bool stopsRight(const Method& method, const AbortOptions& options);
}
