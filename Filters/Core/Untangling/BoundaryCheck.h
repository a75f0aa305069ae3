// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/InvertedBefore.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Cells that no method can make valid with the prescribed positions.
struct ForbiddenCells
{
  std::vector<Index> determined;              ///< see boundaryDeterminedInversions()
  std::vector<NodeWithoutPlace> withoutPlace; ///< see nodesWithoutPlace()
  std::vector<Index> folded;   ///< behind prescribed faces that are folded, see foldedFaces()
  std::vector<Index> crossing; ///< see crossingCells()

  /// Returns all of these, ascending, each once: those that do not come from cells of `before`.
  std::vector<Index> all(const InvertedBefore& before = {}) const;
};

/// Returns the cells behind faces of prescribed corners alone that run into others of these,
/// ascending; see crossingFaces(). `mesh`: before the motion, `faces`: of it. `points`: #nodes x 3.
std::vector<Index> crossingCells(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, const Points& points,
  Monitor& monitor);

/// Finds such cells of one mesh for any positions of one set of prescribed nodes. Holds its
/// arguments by reference.
class BoundaryCheck
{
public:
  /// `mesh`: before the motion; `faces`: its boundaryFaces(). Cost: that of classify().
  BoundaryCheck(const Mesh& mesh, const NodePartition& partition,
    const std::vector<std::int8_t>& orientation, const BoundaryFaces& faces, Monitor& monitor);

  /// `boundary`: #prescribed x 3. Cost: passes over the cells and over the boundary's faces, and
  /// crossingFaces().
  ForbiddenCells at(const Points& boundary) const;

private:
  const Mesh& mesh_;
  const NodePartition& partition_;
  const std::vector<std::int8_t>& orientation_;
  const BoundaryFaces& faces_;
  Monitor& monitor_;
  Classification geometry_;
  std::vector<char> isPrescribed_; ///< #nodes
};
}
