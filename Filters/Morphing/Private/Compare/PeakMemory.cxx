// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Compare/PeakMemory.h"

#include <fstream>
#include <limits>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace morph::filters
{
namespace
{
/// A line of /proc/self/status, in megabytes; NaN where there is none.
double status(const std::string& name)
{
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
  {
    double kibibytes = 0;
    if (word == name && file >> kibibytes)
    {
      return kibibytes * 1024 / 1e6;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}
}

PeakMemory::PeakMemory()
{
#ifdef __GLIBC__
  malloc_trim(0); // freed memory would be reused without a new peak
#endif
  std::ofstream reset("/proc/self/clear_refs");
  reset << "5" << std::flush; // the peak is now the current size
  this->Start = reset ? status("VmRSS:") : std::numeric_limits<double>::quiet_NaN();
}

double PeakMemory::Megabytes() const
{
  const double more = status("VmHWM:") - this->Start;
  return more < 0 ? 0 : more;
}
}
