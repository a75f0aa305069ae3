// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace morph
{
/// The nodes of a boundary that move, and those that are held.
struct Choice
{
  std::vector<Index> moving;              ///< ascending
  std::vector<Index> held;                ///< ascending, none of them moving
  std::vector<std::uint8_t> isMovingFace; ///< #faces: with patches theirs, else those whose corners
                                          ///< all move

  bool operator==(const Choice& other) const;
};

/// Where nodes go that move.
using TargetOfNode = std::map<Index, Eigen::RowVector3d>;
/// `targets`: of choice.moving.
TargetOfNode targetsOf(const Choice& choice, const Points& targets);
/// Makes these the nodes that move, and `targets` theirs.
void setMoving(const TargetOfNode& moving, Choice& choice, Points& targets);

/// Adds the faces all of whose corners move to the moving ones.
void markMovingFaces(const BoundaryFaces& faces, Choice& choice);

/// Chooses the patches of these names, and holds others; see findPatches(). Nodes of a held patch
/// that are chosen to move, move. Nodes between corners (of quadratic cells) that all move, move
/// too. Options are named in messages: "Surfaces" and "FixedSurfaces". Throws Error for a name that
/// does not exist.
Choice choosePatches(const BoundaryModel& model, const std::set<std::string>& moving,
  const std::set<std::string>& held);
/// The same for nodes, #nodes flags: those on the boundary count. Sheets inside move by their names
/// alone.
Choice chooseNodes(const BoundaryModel& model, std::vector<std::uint8_t> isMoving,
  const std::set<std::string>& held);
}
