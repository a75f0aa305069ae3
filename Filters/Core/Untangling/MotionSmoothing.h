// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/FemWarp.h"
#include "Mesh/NodePartition.h"
#include "Mesh/SharedHigherOrderNodes.h"
#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Morpher/ShellFits.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Communicator.h"
#include "Untangling/SmoothMesh.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Where nodes of a curved shell start. They then move in tangent planes, so that the surface has
/// to be where it belongs.
struct Membrane
{
  FemWarp warp;   ///< prepared for the shell
  ShellFits fits; ///< by which an affine motion is known
};

/// Smooths a mesh whose boundary has moved: the stages of Smoothing.h. On several processes each
/// has its own cells, and all take the same steps. Holds its arguments by reference, but for the
/// options.
class MotionSmoothing
{
public:
  /// `rest`: undeformed. `bodies`: those of the whole mesh. `orientation`: #cells, see cellSigns()
  /// in Topology.h. `followers`: prepared for `rest`. `membrane`: that of a curved
  /// shell; null for other meshes.
  MotionSmoothing(const Mesh& rest, const ConnectedComponents& bodies,
    const std::vector<std::int8_t>& orientation, const NodePartition& partition,
    const SharedHigherOrderNodes& followers, const SmoothingOptions& options,
    const Membrane* membrane = nullptr, const Communicator& communicator = Communicator::alone());

  struct Outcome
  {
    SmoothingReport smoothing;
    std::vector<Index> determined; ///< cells of this process that the boundary itself inverts
    Index takenBack = 0;           ///< nodes of the whole mesh; see KeepMinimum.h
  };
  /// `prescribed`: #prescribed x 3 displacements. `points`: becomes #nodes x 3, where higher-order
  /// nodes need not be in place.
  Outcome run(const Points& prescribed, Points& points, Monitor& monitor) const;

private:
  bool isIdentity(const Points& prescribed, Monitor& monitor) const;
  /// Measures `points` after setting their higher-order nodes. The counts and the minimum are those
  /// of the whole mesh.
  Quality measure(Points& points, Monitor& monitor) const;
  /// Sets the free nodes of `points` (#nodes x 3, undeformed, with the prescribed nodes moved) to
  /// the start. Returns whether both the boundary and the start move affinely.
  bool start(const Points& prescribed, Points& points, Monitor& monitor) const;

  const Mesh& rest_;
  const ConnectedComponents& bodies_;
  const std::vector<std::int8_t>& orientation_;
  const NodePartition& partition_;
  const SharedHigherOrderNodes& followers_;
  const SmoothingOptions options_;
  const Membrane* membrane_;
  const Communicator& communicator_;
};

/// Warns of what stays inverted, and returns the counts of Smoothing. `determined`: cells that the
/// boundary itself inverts, ascending. Ids are those of the whole mesh.
EvaluateReport reportSmoothing(
  const MotionSmoothing::Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor);
}
