// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/Surroundings.h"
#include "LinearMethods/SlidingWarp.h"
#include "Private/Displace/InnerNodes.h"
#include "Private/Distributed/WholeSurface.h"

#include <memory>
#include <string>
#include <vector>

class vtkFieldData;

namespace morph::filters
{
/// Iterates the nodes of sliding surfaces with the volume: see vtkDisplacementAlgorithm's
/// SlideRounds. A result does not depend on what is kept.
class SlideRounds
{
public:
  /// Moves the nodes of `surfaces` in `result`, which Surroundings made, and gives them the role
  /// Follows. A node slides if all of its surfaces do, and if it neither moves, nor is held, nor is
  /// of a zone or layer. Mid-side nodes move with their corners, and back onto the surface. Throws
  /// morph::Error for a model without cells, and for polyhedra. `whole`: of a mesh on several MPI
  /// processes, of which `inner` has the inner nodes; else null. Then this is collective.
  void Run(const BoundaryModel& model, const std::vector<morph::Index>& held,
    const std::vector<morph::Index>& surfaces, int rounds, Surroundings& shapes,
    const WholeSurface* whole, const InnerNodes& inner, Surroundings::Result& result,
    morph::Monitor& monitor);

  /// Adds what each round has done to the field data: `SlideChange` and `SlideForce`.
  void Write(double size, vtkFieldData* data) const;
  /// A line of text on them; "None" where there was no round.
  std::string Report(double size) const;

private:
  /// Prepares Method, unless it is.
  void Prepare(const BoundaryModel& model, const std::vector<morph::Index>& nodes,
    const Surroundings::Result& result, morph::Monitor& monitor);

  std::unique_ptr<morph::SlidingWarp> Method; ///< prepared, or null
  vtkIdType MethodVersion = -1;
  std::vector<morph::Index> Prescribed, Sliding; ///< that it was prepared for
  std::vector<morph::SlidingWarp::Round> Rounds;
};
}
