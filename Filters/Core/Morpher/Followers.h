// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Morpher/ShellFits.h"

namespace morph
{
/// Moves nodes between the corners of quadratic cells that are not prescribed, by their corners. In
/// a curved layer they follow the rest that the affine fits leave: as images move alike, an affine
/// motion of the shell is not one of its prisms.
class Followers
{
public:
  /// `processes`: see ShellFits. Cost: as HigherOrderNodes, and ShellFits in a curved layer.
  /// Collective, as apply() and applyTranspose() are in a curved layer.
  void prepare(const Mesh& rest, const NodePartition& partition, const Communicator& processes);
  bool empty() const { return this->nodes_.empty(); }
  /// Fills the followers' rows of `displacement`, #nodes x 3, from all others.
  void apply(Points& displacement) const;
  /// The adjoint of apply(): `gradient` becomes that of the displacements of the other nodes.
  void applyTranspose(Points& gradient) const;

private:
  HigherOrderNodes nodes_;
  ShellFits fits_;      ///< empty but of curved layers with followers
  NodePartition moved_; ///< of those: followers are free, too
};
}
