// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
struct SmoothingOptions
{
  /// Ideal: regular tetrahedra, cubes, ... whatever the mesh looked like at rest. Initial: each
  /// cell's shape at rest.
  TargetConstruction target = TargetConstruction::Ideal;
  /// Most steps of Newton's method, in each of which every node moves once; untangling takes at
  /// most twenty steps of L-BFGS for each. At least 1.
  int iterationLimit = 50;
  /// Ends once no node moves farther in a step than this part of the mean length of its edges.
  /// Above 0.
  double stopMove = 1e-3;
  /// Whether to go back to the start if the result has more inverted cells, or as many and a lower
  /// minimum scaled Jacobian.
  bool neverWorse = false;
};

struct SmoothingReport
{
  Index untangleSteps = 0;
  Index newtonSteps = 0;
  Index patches = 0; ///< rounds in which only the nodes around bad cells moved
  Index linearIterations = 0;
  Index evaluations = 0;
  bool isValid = false; ///< every tetrahedron that a free node can change is positive
  bool wasKept = false; ///< the start came back; see SmoothingOptions::neverWorse
};

/// Moves the free nodes so that the cells come closer to their target shapes. Prescribed nodes
/// stay; mid-side nodes and the like follow where there are any.
///
/// 1. Where tetrahedra of the cells (one a corner) are inverted: untangling (UntangleEnergy.h) with
///    a margin of 0.05 by L-BFGS, which looks every hundred steps whether that is enough. If some
///    stay inverted that is the result: not every mesh can be untangled in this way.
/// 2. Where few cells have a scaled Jacobian below 0.2: the shape measure below on the nodes of
///    three rings of cells round them. Single bad cells would shorten the steps of the whole mesh.
/// 3. The mean inverse mean ratio |T|^2 / (3 det(T)^(2/3)), T the Jacobian relative to the target,
///    of all cells by Newton's method (T. S. Munson, "Mesh shape-quality optimization using the
///    inverse mean-ratio metric", Math. Program. 110 (2007) 561-590), until no node moves far in a
///    step, or it lowers the mean by less than 1e-6 of it. A barrier: what is valid stays valid.
///    Its average may improve at the cost of the worst cell.
///
/// With the target Ideal the measure is taken at the corners and averaged in each cell, as Mesquite
/// does. A graded mesh loses its grading, and a mesh whose boundary does not move changes. With the
/// target Initial it is taken on the averaged simplicial decompositions by volume, so that an
/// affine image of the undeformed mesh is a minimum.
///
/// `rest`: gives the cells, and their shapes (Initial) and sizes (the margin). `points`: #nodes x
/// 3, the start in, the result out. Throws Error of kind Cancelled, leaving `points`. Independent
/// of threads, numbering (up to rounding), position, rotation and scale. Cost: per Newton step
/// about 3 microseconds a tetrahedron (eight a hexahedron, ten with target Initial); about 2.5 kB a
/// hexahedron.
SmoothingReport smoothMesh(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const SmoothingOptions& options, Points& points,
  Monitor& monitor);
}
