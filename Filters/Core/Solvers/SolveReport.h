// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

namespace morph
{
/// The effort of an iterative solution.
struct SolveReport
{
  int iterations = 0; ///< of all right-hand sides together
  /// maximum of |b - A x| / |b| over the right-hand sides, computed from x
  double relativeResidual = 0;
};

/// Warns if rounding kept the residual above the `tolerance`.
void reportRounding(const SolveReport& report, double tolerance, Monitor& monitor);
}
