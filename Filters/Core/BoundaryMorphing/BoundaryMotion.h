// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// What moves a closed curve without a vertex, or a closed surface without a curve, on which
/// nothing is given.
enum class UnattachedMotion : std::uint8_t
{
  FollowAffinely, ///< the affine map nearest to the motion around it
  FollowRigidly,  ///< the rotation and shift nearest to it: keeps its shape
  Stay
};

/// The boundary on its way, one geometric dimension after the other: vertices, curves, surfaces
/// (Staten et al., IMR 2011).
struct BoundaryMotion
{
  /// How a node came by its displacement. What is settled in one step stays fixed in the later
  /// ones.
  enum State : std::uint8_t
  {
    Unknown = 0,
    Given,   ///< by the caller
    Held,    ///< a vertex that nobody gave
    OnCurve, ///< by its curve
    OnSurface
  };

  Points rest;                     ///< #nodes x 3
  Points displacement;             ///< #nodes x 3; zero where unknown
  std::vector<std::uint8_t> state; ///< #nodes
  std::vector<Index> givenIds;     ///< as given
  Points givenTargets;             ///< #givenIds x 3
  std::vector<Index> bodyOfNode;   ///< #nodes, -1 for a node that is no corner of a volume cell

  Index count(State state) const;
  /// Ids of all nodes whose displacement is known, ascending.
  std::vector<Index> known() const;
  /// #nodes x 3: given nodes exactly where they were given, nodes without displacement where they
  /// were, bit for bit.
  Points moved() const;
};

/// Starts with the given nodes; vertices that are not among them are held in place. `ids`: of
/// boundary nodes; `targets`: #ids x 3, their new positions. Throws Error naming ids that do not
/// exist, come twice or are not on the boundary, targets that are not finite or not as many, and
/// where nothing is given at all.
BoundaryMotion beginMotion(const Mesh& rest, const BoundaryFaces& faces,
  const Classification& geometry, const std::vector<Index>& ids, const ConstPoints& targets);

/// The same for a boundary whose volume cells are not at hand. `rest`: #nodes x 3; `bodyOfNode`:
/// #nodes, as in BoundaryMotion.
BoundaryMotion beginMotion(const ConstPoints& rest, const std::vector<Index>& bodyOfNode,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<Index>& ids,
  const ConstPoints& targets);
}
