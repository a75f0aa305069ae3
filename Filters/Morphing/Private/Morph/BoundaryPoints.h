// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Morph/BoundaryMatch.h"

/// What the points of a displaced boundary say of themselves, on one process: the first half of a
/// match. All throw as BoundaryMatch::Match() does.
namespace morph::filters::BoundaryPoints
{
using Pairs = std::vector<std::pair<morph::Index, morph::Index>>; ///< see morph::NamedPoints

/// Reads all of NamedPoints but its pairs. `precision`: gets that of the points if they are the
/// targets.
morph::NamedPoints Read(
  vtkPointSet* boundary, const BoundaryMatch::Options& options, Precision& precision);

/// How points find their nodes. All processes with points agree on it.
enum class Way
{
  None, ///< this process has no points
  Ids,
  Copies, ///< point i is node i of the process's piece
  Positions
};
/// Returns how the points of this process find their nodes; adds their pairs to `gathered`, unless
/// by positions. `areCopies`: each process has as many points as Count() says.
Way FindWay(vtkPointSet* boundary, const BoundaryMatch::Nodes& nodes, bool areCopies,
  const BoundaryMatch::Options& options, BoundaryMatch::Gathered& gathered);
/// Returns how many points a copy of the grid, or of this process's piece, has.
morph::Index Count(const BoundaryMatch::Nodes& nodes);

/// Returns pairs of a point and its node, by position; `unmatched` counts the points without one.
Pairs ByPosition(const morph::Points& positions, const morph::Mesh& rest,
  const std::vector<morph::Index>& outer, double tolerance, morph::Index& unmatched);

/// Puts coordinates back that differ from those of `rest` by their rounding alone. Returns their
/// number.
morph::Index TakeBackRounding(
  const Precision& precision, const morph::Mesh& rest, morph::NamedPoints& named);
}
