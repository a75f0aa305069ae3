// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// The measure of a valid cell's shape that smoothing lowers.
enum class SmoothingObjective : std::uint8_t
{
  MeanRatio,       ///< the inverse mean ratio, everywhere
  ConditionNumber, ///< the condition number (EnergyState.h), everywhere
  Adaptive         ///< the condition number round bad cells, the inverse mean ratio elsewhere
};

struct SmoothingOptions
{
  SmoothingTarget target = SmoothingTarget::Ideal;
  SmoothingObjective objective = SmoothingObjective::Adaptive;
  /// Maximum number of Newton steps, each of which moves every node once; at least 1. Untangling
  /// takes at most twenty L-BFGS steps for each.
  int iterationLimit = 50;
  /// Stops once no node moves farther in a step than this part of its mean edge length; above 0.
  double stopMove = 1e-3;
  /// Whether to return the start if the result has more inverted cells, or as many and a lower
  /// minimum scaled Jacobian.
  bool neverWorse = false;
};

struct SmoothingReport
{
  Index untangleSteps = 0;
  Index newtonSteps = 0;
  Index patches = 0;        ///< rounds in which only the nodes around bad cells moved
  Index conditionSteps = 0; ///< of the Newton steps, those on the condition number
  Index linearIterations = 0;
  Index evaluations = 0;
  bool isValid = false; ///< every tetrahedron that a free node can change is positive
  bool wasKept = false; ///< the result is the start; see SmoothingOptions::neverWorse
};

/// Moves the free nodes so that cells approach their target shapes. Prescribed nodes stay; mid-side
/// nodes and other higher-order nodes follow.
///
/// 1. If tetrahedra of the cells (one a corner) are inverted: untangling (UntangleEnergy.h) with a
///    margin of 0.05 by L-BFGS, which checks every hundred steps whether the mesh is valid. If some
///    stay inverted, this is the result, or the start if it is no worse by the measure of quality:
///    not every mesh can be untangled in this way, and the layer of a sharply bent shell may be
///    tangled where its faces are not.
/// 2. If few cells have a scaled Jacobian below 0.2: the shape measure below on the nodes of three
///    rings of cells around them. Single bad cells would shorten the steps of the whole mesh.
///    (Also with Adaptive, the measure is that of stage 3.)
/// 3. The mean inverse mean ratio |T|^2 / (3 det(T)^(2/3)) of all cells by Newton's method, where T
///    is the Jacobian relative to the target. It ends when no node moves far in a step, or a step
///    lowers the mean by less than 1e-6, relative. Valid cells stay valid (a barrier). The average
///    may improve at the cost of the worst cell. Source: T. S. Munson, "Mesh shape-quality
///    optimization using the inverse mean-ratio metric", Math. Program. 110 (2007) 561-590. With
///    the objective ConditionNumber it is the mean condition number instead, also a barrier.
/// 4. With the objective Adaptive: the condition number on the nodes of three rings around the
///    cells that are still below 0.2, however many. It takes up to four rounds, each of a fifth of
///    the limit of steps. Nodes around cells that fell below the minimum scaled Jacobian return
///    (SmoothMesh.h), so the result is never below that of the objective MeanRatio.
///
/// With the target Ideal the measure is averaged over the corners of each cell, as Mesquite does. A
/// graded mesh loses its grading, and a mesh whose boundary does not move changes. With the target
/// Initial the measure is averaged by volume over the simplicial decompositions. So an affine image
/// of the undeformed mesh is a minimum.
///
/// `rest`: gives the cells, their shapes (Initial) and sizes (the margin). `points`: #nodes x 3,
/// start and result. Throws Error of kind Cancelled, leaving `points`. The result does not depend
/// on threads, on numbering (up to rounding), position, rotation and scale. Cost: about 3
/// microseconds a tetrahedron and Newton step (eight a hexahedron, ten with target Initial); about
/// 2.5 kB a hexahedron. On several processes `rest` has the cells of this one.
SmoothingReport smoothMesh(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const SmoothingOptions& options, Points& points, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());

/// Reverts moves that lowered the minimum scaled Jacobian. Free corners of cells below the minimum
/// of `start` return to their position there, until no cell is below. Nothing happens if `start` is
/// not valid. `start`, `points`: #nodes x 3, equal at nodes that are not `free` (ids, ascending).
/// `measure`: returns the quality of points, and may set their higher-order nodes. On several
/// processes its minimum is that of all. Returns the number of reverted nodes of the whole mesh.
/// Cost: a measurement for each layer of reverted cells; after 30 layers all nodes are reverted.
Index keepMinimum(const Mesh& mesh, const std::vector<Index>& free, const Points& start,
  Points& points, const std::function<Quality(Points&)>& measure,
  const Communicator& communicator = Communicator::alone());
}
