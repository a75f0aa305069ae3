// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearSystem.h"

namespace benchmark
{
/// hypre's conjugate gradients with BoomerAMG, on one MPI rank: one thread, and one right-hand side
/// after the other.
struct HypreResult
{
  double startSeconds = 0; ///< of MPI, in the first call of the process; 0 later
  double setUpSeconds = 0; ///< the copy of the matrix, and BoomerAMG's hierarchy
  double solveSeconds = 0; ///< of the three right-hand sides
  int iterations = 0;      ///< the maximum over the three
  morph::Points x;
};

/// Solves from a guess of zeros. Throws morph::Error where it does not converge.
HypreResult solveByHypre(const LinearSystem& system, double tolerance);
}
