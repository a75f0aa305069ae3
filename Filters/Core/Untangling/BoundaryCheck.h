// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Boundary/WholeBoundary.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/InvertedBefore.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Cells of this process that no method can make valid with the prescribed positions.
struct ForbiddenCells
{
  std::vector<Index> determined;              ///< see boundaryDeterminedInversions()
  std::vector<NodeWithoutPlace> withoutPlace; ///< see nodesWithoutPlace()
  std::vector<Index> folded;   ///< behind prescribed faces that are folded, see foldedFaces()
  std::vector<Index> crossing; ///< see crossingCells()

  /// Returns all of these, ascending, each once: those that do not come from cells of `before`.
  std::vector<Index> all(const InvertedBefore& before = {}) const;
};

/// Returns the cells behind faces of prescribed corners alone that run into others of these, by
/// their numbers in the whole mesh, ascending; see crossingFaces(). `isPrescribed`: #nodes of the
/// boundary. `points`: of these, #nodes x 3. Collective.
std::vector<Index> crossingCells(const WholeBoundary& boundary,
  const std::vector<char>& isPrescribed, const Points& points, Monitor& monitor);

/// Finds such cells of one mesh for any positions of one set of prescribed nodes. Holds its
/// arguments by reference. On several processes all functions are collective, and the mesh is this
/// process's part.
class BoundaryCheck
{
public:
  /// `mesh`: before the motion; `faces`: the outer ones of its own cells. Cost: that of
  /// WholeBoundary and classify().
  BoundaryCheck(const Mesh& mesh, const NodePartition& partition,
    const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, Monitor& monitor,
    const Communicator& processes = Communicator::alone());

  /// `boundary`: #prescribed x 3. Cost: passes over the cells and over the boundary's faces, and
  /// crossingFaces().
  ForbiddenCells at(const Points& boundary) const;

private:
  const Mesh& mesh_;
  const NodePartition& partition_;
  const std::vector<std::int8_t>& orientation_;
  Monitor& monitor_;
  const Communicator& processes_;
  WholeBoundary whole_;
  Classification geometry_;        ///< of whole_
  std::vector<char> isPrescribed_; ///< its nodes
};
}
