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
/// Straight motions and turns of all nodes that grow together by one factor f >= 0. The positions
/// are base + f straight + sum of sin(f angle) first + (1 - cos(f angle)) second over the turns.
/// All fields are #nodes x 3.
struct CombinedMotion
{
  struct Turn
  {
    const Points* first = nullptr;
    const Points* second = nullptr;
    double angle = 0; ///< radians at f = 1, of either sign, not 0
  };
  const Points* base = nullptr;
  const Points* straight = nullptr; ///< null: none
  std::vector<Turn> turns;          ///< at least one
};

/// How far a motion may go before a cell is inverted.
struct LargestFactor
{
  /// Up to it, no cell is inverted. Infinite where none is up to one turn of the largest angle; NaN
  /// where a cell is inverted at 0.
  double factor = std::numeric_limits<double>::infinity();
  Index cell = -1; ///< the cell that is inverted first, or at 0; -1: none
};

/// Returns the largest factor of a motion with turns. Motions without turns, or one turn alone, are
/// polynomials: validRange() has their exact roots.
///
/// Valid is what measureQuality() calls so, for polyhedra with the centres of PolyhedronPlaces,
/// which keep their weights at f = 0. A quadratic cell also needs positive Bernstein
/// coefficients (CellMap.h), which is sufficient and not necessary. Each determinant is
/// followed from 0 by steps in which it cannot reach 0: the edges change no faster than |straight|
/// + sum of |angle| sqrt(|first|^2 + |second|^2), and a determinant by no more than the product of
/// the edges' lengths grows. The turn of the whole cell is taken off first where that lowers the
/// sum. So the factor is on the safe side. The search ends where a step is below 1e-9 of a turn,
/// for quadratic cells 1e-5, and after 4000 steps.
///
/// `orientation`: #cells of +1 / -1 (Topology.h), or empty. Left out is what was not positive in
/// the undeformed mesh: the places of cells in `before`, and these between their corners. The
/// result does not depend on the number of threads. Cost: some ten to a hundred times a measure of
/// quality.
LargestFactor largestFactor(const Mesh& mesh, const CombinedMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor);
}
