// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Mesh/NodePartition.h"
#include "Session/Session.h"

#include <functional>
#include <memory>

namespace morph::filters
{
/// Validity on several MPI processes. All functions are collective.
class RankValidity
{
public:
  const morph::Session::Options& Options;
  const morph::distributed::DistributedMesh& Mesh; ///< before the motion
  const morph::Points& Reference;                  ///< #local nodes x 3, the undeformed mesh
  const morph::InvertedBefore& Before;             ///< as of Validity, of the local mesh
  const morph::NodePartition& Partition;           ///< of the local mesh
  const morph::Points& Targets;                    ///< #prescribed x 3
  bool NeedsPieces;                                ///< on any process
  /// Makes a method with its options, not prepared yet.
  std::function<std::unique_ptr<morph::Morpher>()> Make;

  /// Returns the number of cells that the targets themselves invert. Throws Validity::Infeasible on
  /// all processes where there are some and Options ask for a valid mesh.
  morph::Index RequireFeasible() const;
  /// Makes `moved`, #local nodes x 3, the mesh that Options ask for; see Validity::ensure(). A
  /// folded boundary is not foreseen: sub-steps end before it inverts cells. Outcome::measured is
  /// empty.
  morph::Validity::Outcome Ensure(morph::Points& moved, morph::Monitor& monitor) const;

private:
  std::vector<morph::Index> DeterminedBy(const morph::Points& targets) const;
  std::vector<morph::Index> ForbiddenBy(
    const morph::Points& targets, morph::Monitor& monitor) const;
  morph::Validity::Outcome SubStep(morph::Points& moved, morph::Monitor& monitor) const;
  morph::Validity::Outcome Remaining(
    const morph::Points& moved, const std::string& reason, morph::Monitor& monitor) const;
};
}
