// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// What this process holds, as the kernel counts it.
namespace soak
{
struct Process
{
  std::size_t resident = 0; ///< bytes
  /// bytes that are allocated and not freed; 0 where the C library does not tell
  std::size_t heap = 0;
  int handles = 0; ///< open files, sockets and the like
  int threads = 0;
};

/// False where the system has no /proc, and with the address sanitizer, which keeps what is freed.
bool measure(Process& now);
}
