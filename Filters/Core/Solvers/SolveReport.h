// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

namespace morph
{
/// What an iterative solution took.
struct SolveReport
{
  int iterations = 0; ///< of all right-hand sides together
  /// largest over the right-hand sides, |b - A x| / |b|, computed from x
  double relativeResidual = 0;
  double bytesMoved = 0; ///< estimate of the memory traffic, for benchmarks
};

/// Warns where rounding kept the residual above what `tolerance` asks for.
void reportRounding(const SolveReport& report, double tolerance, Monitor& monitor);
}
