// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkMorphAlgorithm.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

namespace soak
{
/// Seconds by the clock on the wall, or of the processor time of the calling thread. The latter
/// tells what a busy machine would take if it were idle, as far as the calling thread takes part in
/// all that is done.
class Clock
{
public:
  static void setThreadTime(bool isThreadTime);
  static double now();
};

/// When to stop a filter: as if the user did at that time, whatever the filter does then.
struct Abort
{
  bool armed = false;
  double at = 0;        ///< by Clock
  double progress = -1; ///< of the filter when it first asked and was told to stop; negative before

  bool isDue(double now)
  {
    const bool due = this->armed && Clock::now() >= this->at;
    if (due && this->progress < 0)
    {
      this->progress = now;
    }
    return due;
  }
};

struct Method
{
  std::string name;
  /// `abort` has to outlive the filter; null for a filter that nobody stops.
  std::function<vtkSmartPointer<vtkMorphAlgorithm>(Abort* abort)> make;
};

/// The seven methods, with their default options, but that LBWARP relaxes nodes outside a hull.
const std::vector<Method>& methods();
}
