// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/Objective.h"

namespace morph
{
/// What minimisations took, added up.
struct MinimizerEffort
{
  Index steps = 0;
  Index linearIterations = 0; ///< of Newton's systems
  Index evaluations = 0;      ///< of the objective's value
};

struct MinimizerLimits
{
  int steps = 30;
  double decrease = 1e-6;     ///< stop once a step lowers the energy by less than this part of it,
  double slowDecrease = 1e-4; ///< or by less than this
  /// and the gradient's norm has come down to this part of the first
  double gradientDecrease = 1e-2;
};

/// Newton's method with conjugate gradients and a backtracking line search (Armijo). `points`:
/// #nodes x 3, the start in, the result out; only the objective's free nodes move, and the energy
/// never rises. `matrix`: room for the second derivatives, kept between calls. Returns the value at
/// the end. Throws Error of kind Cancelled, leaving `points` at the last step.
Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor);

/// The limited-memory BFGS method (Liu, Nocedal, Math. Program. 45 (1989) 503-528) with the last
/// ten steps: no matrix, 0.5 kB a free node. Otherwise as newton().
Objective::Value limitedMemoryBfgs(const Objective& objective, Points& points,
  const MinimizerLimits& limits, MinimizerEffort& effort, Monitor& monitor);
}
