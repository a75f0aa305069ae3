// SPDX-License-Identifier: BSD-3-Clause
#include "Process.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
#include <malloc.h>
#define SOAK_HAS_MALLINFO2
#endif

namespace soak
{
namespace
{
/// Entries of a folder; 0 where it does not exist.
int entries(const std::string& folder)
{
  std::error_code error;
  const std::filesystem::directory_iterator first(folder, error);
  return error ? 0 : static_cast<int>(std::distance(begin(first), end(first)));
}
}

bool measure(Process& now)
{
#ifdef __SANITIZE_ADDRESS__
  return false;
#endif
#ifdef SOAK_HAS_MALLINFO2
  malloc_trim(0); // what is free goes back, so that what is resident is held
#endif
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  if (!(statm >> size >> resident))
  {
    return false;
  }
  statm.close(); // before the handles are counted
  now.resident = resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
#ifdef SOAK_HAS_MALLINFO2
  const struct mallinfo2 heap = mallinfo2();
  now.heap = heap.uordblks + heap.hblkhd;
#endif
  now.handles = entries("/proc/self/fd");
  now.threads = entries("/proc/self/task");
  return true;
}
}
