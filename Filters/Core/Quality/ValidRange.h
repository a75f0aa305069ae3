// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Quality/InvertedBefore.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// Straight motions and turns of all nodes that grow together by one factor s. The positions are
/// base + s straight + sum of sin(s angle) first + (1 - cos(s angle)) second over the turns.
/// All fields are #nodes x 3.
struct NodeMotion
{
  struct Turn
  {
    const Points* first = nullptr;
    const Points* second = nullptr;
    double angle = 0; ///< radians at s = 1, of either sign, not 0
  };
  const Points* base = nullptr;     ///< at s = 0
  const Points* straight = nullptr; ///< null: none
  std::vector<Turn> turns;
};

/// The open interval of a factor around 0 in which no cell gets inverted. With turns, an end is
/// infinite where none is up to one turn of the largest angle.
struct ValidRange
{
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  Index lowestCell = -1, highestCell = -1; ///< the cell that ends the interval there, or -1
  /// Inverted at s = 0: the interval is empty, and both ends are NaN. `lowestCell` is such a cell.
  bool isEmpty = false;
};

/// Returns the interval of s around 0 in which every volume cell is valid as measureQuality() has
/// it: all the determinants at corners, and at the center of a hexahedron, are positive.
///
/// Each determinant is followed from 0 by steps in which it cannot reach 0. A step is the first
/// root (Bernstein.h) of a lower bound: the determinant of the edges' tangents, a cubic, less
/// rounding and what the second derivatives can change. Without turns the cubic is the determinant,
/// and a second step finds no more, but where edges vanish together. Else each of the last steps
/// gains two digits. The turn of the whole cell is taken off first where that lowers the second
/// derivatives. So the ends are on the safe side, by at most 1e-11 of them; by more only after 500
/// steps, of slivers that shear without end. A quadratic cell also needs positive Bernstein
/// coefficients of its determinant (CellMap.h), which have such bounds, too. This is sufficient and
/// not necessary: its ends are on the safe side by more, and 0 where a coefficient is not positive
/// at s = 0.
///
/// The centers of a polyhedron change their weights (PolyhedronQuality.h) on the way. A step keeps
/// those at its beginning, and those at its end have to find the cell valid, too. So its ends are
/// the measure's, but an inversion within one step, at first of up to the cell's size, is missed.
///
/// `orientation`: #cells of +1 / -1 (Topology.h), or empty. Left out is what was not positive in
/// the undeformed mesh: the places of cells in `before`, and these between their corners. The
/// result does not depend on the number of threads. Cost: one pass, about as much as ten measures
/// of quality, with turns some forty times that; for polyhedra some forty measures.
ValidRange validRange(const Mesh& mesh, const NodeMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor);
}
