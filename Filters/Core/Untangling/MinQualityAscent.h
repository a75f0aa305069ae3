// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/MovableQuality.h"
#include "Support/Monitor.h"

namespace morph
{
/// Whether more than half of all processes' cells are tetrahedra. Collective.
bool mostlyTetrahedra(const Mesh& mesh, const Communicator& communicator);

/// Returns the increase of a mesh's minimum scaled Jacobian `least` that counts as a gain. It is
/// the smaller of 0.1 % of `least` and 1 % of 1 - `least`, but 1e-6 or more. A smaller gain is not
/// worth its cost to the other cells.
double significantGain(double least);

/// Whether a minimum is within 0.5 % of the upper bound `goal`, or of 1. Raising it is then not
/// worth its cost.
bool hasReached(double minimum, double goal);

/// What raising a minimum took.
struct AscentEffort
{
  int rounds = 0;             ///< those with a gain
  int squarings = 0;          ///< of the last power
  double cellEvaluations = 0; ///< summed over the evaluations: the cells of each
};

/// Raises the minimum scaled Jacobian over what free nodes can change in a mesh that is valid
/// there, and stays so. Nodes within seven rings of the worst cells (three in a mesh of tetrahedra)
/// move to lower their WorstCornerNorm by L-BFGS, which keeps edges from collapsing. The norm's
/// power begins low, where far corners help the worst ones, but high enough to tell `goal` from the
/// minimum. It doubles whenever a round gains little, has converged or is near `goal`. In a mesh of
/// tetrahedra it doubles twice, and ends at 64 instead of 128. Each power starts where the last one
/// ended, even if its minimum is lower. A round ends as soon as its cells are at `goal`, and all
/// end there. A mesh that has reached it, see hasReached(), is left as it is. `points`: #nodes x 3,
/// start and best result. Cost: a pass over the cells a round, and the minimisation near the worst
/// cells.
AscentEffort raiseMinimumQuality(
  const MovableQuality& quality, double goal, Points& points, Monitor& monitor);

/// Raises the next-worst cells of a mesh whose minimum has reached a bound. First the minimum over
/// what free nodes can change is raised as far as prescribed nodes allow. Then the nodes of the
/// cells at the minimum stay, and the minimum over the others is raised, six times at most. It ends
/// where more than 1 % of the cells are at the minimum. No minimum falls. `before`: of raising the
/// minimum, from whose last power it goes on. Cost: 0.3 times that of `before`, or as much as 20
/// passes over the cells; 0.1 times, or 10 passes, in a mesh of tetrahedra.
AscentEffort raiseNextWorst(
  const MovableQuality& quality, const AscentEffort& before, Points& points, Monitor& monitor);
}
