// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/InnerNodes.h"
#include "BoundaryMover/Surroundings.h"
#include "LinearMethods/SlidingWarp.h"
#include "Mesh/PolyhedronPieces.h"

#include <memory>
#include <string>
#include <vector>

namespace morph
{
/// Iterates the nodes of sliding surfaces with the volume: see SlidingWarp. A result does not
/// depend on what is kept.
class SlideRounds
{
public:
  /// Moves the nodes of `surfaces` in `result`, which Surroundings made, and gives them the role
  /// Follows. A node slides if all of its surfaces do, and if it neither moves, nor is held, nor is
  /// of a zone or layer. Mid-side nodes move with their corners, and back onto the surface; nodes
  /// that hang, with what they hang on. Centers of outer faces of polyhedra on such a surface slide
  /// for the method. Throws Error for a model without cells. `pieces`: of a mesh on several
  /// processes, of which `inner` has the inner nodes; else null. Then this is collective.
  void run(const BoundaryModel& model, const std::vector<Index>& held,
    const std::vector<Index>& surfaces, const SlidingWarp::Limits& limits, Surroundings& shapes,
    const InnerPieces* pieces, const InnerNodes& inner, Surroundings::Result& result,
    Monitor& monitor);

  void clear() { this->rounds_.clear(); } ///< forgets what was done
  /// What each round has done.
  const std::vector<SlidingWarp::Round>& rounds() const { return this->rounds_; }
  /// A line of text on them; "None" where there was no round.
  std::string report(double size) const;

private:
  /// The mesh of the method; here a part of it if there are several processes.
  struct Volume
  {
    const Mesh& mesh;
    const HangingNodes& hanging;
    bool needsPieces;
    std::shared_ptr<const Communicator> processes; ///< null for one

    const Communicator& all() const;
    /// Nodes that hang are not prescribed, unless all that they hang on are.
    NodePartition partition(const std::vector<Index>& prescribed) const;
  };
  /// Prepares the method for sliding nodes of the mesh, unless it is. Collective.
  void prepare(const Volume& volume, std::int64_t version, const std::vector<Index>& sliding,
    const std::vector<Index>& prescribed, Monitor& monitor);

  std::shared_ptr<const CellPieces> pieces_; ///< that the method works on, or null
  std::vector<Index> centers_; ///< of outer faces of pieces, whose nodes slide or are prescribed
  std::unique_ptr<SlidingWarp> method_; ///< prepared, or null
  std::int64_t methodVersion_ = -1;
  std::shared_ptr<const Communicator> processes_;
  std::vector<Index> prescribed_, sliding_; ///< that it was prepared for
  std::vector<SlidingWarp::Round> rounds_;
};
}
