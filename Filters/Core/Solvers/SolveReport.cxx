// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/SolveReport.h"

#include <algorithm>
#include <sstream>

namespace morph
{
void reportRounding(const SolveReport& report, double tolerance, Monitor& monitor)
{
  // Within a factor of ten, and below 1e-13, the difference is not visible.
  if (report.relativeResidual > std::max(10 * tolerance, 1e-13))
  {
    std::ostringstream text;
    text << "Rounding kept the relative residual at " << report.relativeResidual << " where "
         << tolerance << " is asked for: the undeformed mesh has cells that are nearly flat.";
    monitor.warn(text.str());
  }
}
}
