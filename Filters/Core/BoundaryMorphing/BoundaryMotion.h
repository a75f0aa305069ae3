// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Boundary/WallLayers.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The motion of a closed curve without a vertex, or a closed surface without a curve, where
/// nothing is given on it.
enum class UnattachedMotion : std::uint8_t
{
  FollowAffinely, ///< by the affine map that fits the surrounding motion
  FollowRigidly,  ///< by the rotation and shift that fit it: keeps the shape
  Stay
};

/// The state of a boundary morph, one geometric dimension after the other: vertices, curves,
/// surfaces. Source: Staten et al. (IMR 2011).
struct BoundaryMotion
{
  /// The origin of a node's displacement. Later steps do not change a known displacement.
  enum State : std::uint8_t
  {
    Unknown = 0,
    Given,   ///< by the caller
    Held,    ///< a vertex that is not given
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
  /// Returns moved positions, #nodes x 3. Given nodes have exactly their given position, nodes
  /// without displacement keep theirs bit for bit.
  Points moved() const;
};

/// Starts with the given nodes and holds all other vertices in place. `ids`: of boundary nodes;
/// `targets`: #ids x 3, their new positions. Throws Error naming ids that do not exist, occur twice
/// or are not on the boundary. Also throws for targets that are not finite or differ in number, and
/// where nothing is given.
BoundaryMotion beginMotion(const Mesh& rest, const BoundaryFaces& faces,
  const Classification& geometry, const std::vector<Index>& ids, const ConstPoints& targets);

/// Starts a boundary without its volume cells. `rest`: #nodes x 3, undeformed; `bodyOfNode`:
/// #nodes, as in BoundaryMotion.
BoundaryMotion beginMotion(const ConstPoints& rest, const std::vector<Index>& bodyOfNode,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<Index>& ids,
  const ConstPoints& targets);

/// Moves the columns of `layers` with the wall: each by its wall node's displacement and local
/// rotation, so that heights and angles to the wall stay. The rotation takes the undeformed normal
/// to the moved one, and is else the nearest one to the motion of the wall's edges at the node.
/// Nodes on the boundary outside the wall then go to the nearest point of the tangent planes of
/// their moved faces there.
///
/// `moved`: #nodes x 3, positions of all boundary nodes, perhaps of others; the columns' rows are
/// set. `isWall`: #faces. Cost: a pass over the wall's faces, and one over the columns.
void moveLayers(const Points& rest, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, const WallLayers& layers, Points& moved);
}
