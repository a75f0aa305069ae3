// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"

#include <vector>

namespace morph
{
/// The affine part of the motion of a curved layer, of each body: the fit of its prescribed nodes.
/// On a curved surface the Laplacian of the position is the curvature normal, so the equations of a
/// membrane do not reproduce affine motions. The fit is taken off before they are solved for the
/// rest, and added to what they find. Images count as at their nodes. Of several processes, all
/// functions but empty() are collective.
class ShellFits
{
public:
  ShellFits() = default;
  /// Of another mesh there are none. `processes`: that have the mesh, with copies of cells; held by
  /// reference. Cost: passes over the mesh.
  ShellFits(const Mesh& rest, const NodePartition& partition, const Communicator& processes);

  bool empty() const { return this->bodies_.empty(); }
  /// Takes the fits off displacements of the prescribed nodes, #prescribed x 3, and returns them.
  std::vector<AffineFit> takeOff(Points& prescribed) const;
  /// Adds fits to displacements of the free nodes, #free x 3.
  void addTo(const std::vector<AffineFit>& fits, Points& free) const;
  /// The adjoint of both. `free`: the derivative by the displacements of free nodes. `prescribed`:
  /// that by the rest, which becomes that by the prescribed displacements.
  void transpose(const Points& free, Points& prescribed) const;

private:
  struct Body
  {
    std::vector<Index> prescribed, free; ///< places in the lists of the partition
    std::vector<Index> counted; ///< those of the prescribed nodes that count on this process
    Points prescribedPlaces, freePlaces;
    AffineLeastSquares leastSquares;
    const Communicator* processes;
  };
  std::vector<Body> bodies_;
};

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
