// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Methods.h"
#include "Process.h"

namespace soak
{
struct MemoryOptions
{
  int morphs = 1000;
  int cells = 12; ///< along each edge of the box
  unsigned seed = 1;
};

/// Morphs one mesh with ever new boundaries through one filter, every fifth time with other free
/// nodes. Prints what the process holds. True if in the second half of them the heap and the
/// resident memory grow by less than 1 %, and handles and threads not at all.
bool staysFlat(const Method& method, const MemoryOptions& options);
}
