// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/Minimizers.h"
#include "Quality/MovableQuality.h"
#include "Support/Monitor.h"

namespace morph
{
/// Whether a minimum is within 0.25 % of the upper bound `goal`, or of 1. Raising it is then not
/// worth its cost.
bool hasReached(double minimum, double goal);

/// Raises the minimum scaled Jacobian over what free nodes can change in a mesh that is valid
/// there, and stays so, by Gauss-Newton steps on StiffenedDistortion. After each step the barrier
/// follows the worst sample, and comes nearer where steps gain little. Nodes within seven rings of
/// the worst cells move (two in a mesh of tetrahedra), then within twice as many, up to the whole
/// mesh. It ends at `goal`, or where the whole mesh gains less than 0.3 %. Samples that the
/// boundary bounds below the others then count by their bound, so that the others rise, too. The
/// minimum falls by at most 0.25 % for that. The mean of the scaled Jacobian falls only where the
/// minimum rises by more than 10 %. `goal`: as of hasReached(); `steps`: at most so many for the
/// minimum. `points`: #nodes x 3, start and best result. Cost: a pass over the cells a round, and a
/// linear solution of 10 to 30 conjugate-gradient iterations a step.
MinimizerEffort raiseQuality(
  const MovableQuality& quality, double goal, int steps, Points& points, Monitor& monitor);
}
