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
/// A motion of all nodes by one parameter s. Without `second`, the positions are base + s first;
/// with it they are base + sin(s angle) first + (1 - cos(s angle)) second. All #nodes x 3.
struct NodeMotion
{
  const Points* base = nullptr; ///< at s = 0
  const Points* first = nullptr;
  const Points* second = nullptr;
  double angle = 0; ///< radians, positive; of a motion with `second`
};

/// The open interval of a parameter around 0 in which no cell gets inverted.
struct ValidRange
{
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  Index lowestCell = -1, highestCell = -1; ///< the cell that ends the interval there, or -1
  /// Inverted at s = 0: the interval is empty, and both ends are NaN. `lowestCell` is such a cell.
  bool isEmpty = false;
};

/// Returns the interval of s around 0 in which every volume cell is valid as measureQuality() has
/// it: all the determinants at corners, and at the centre of a hexahedron, are positive. Those of a
/// polyhedron are taken with the centres of PolyhedronPlaces, which keep their weights at s = 0.
/// The measure's own weights change on the way, so that its ends differ a little.
///
/// Each determinant is a cubic in s or, for a rotation, a polynomial of degree 6 in tan(s angle /
/// 2) over a positive denominator. The ends are roots of these (PolynomialRoot.h), on the safe side
/// by at most 1e-12 of the root, and rounding. A quadratic cell also needs positive Bernstein
/// coefficients of its determinant (CellMap.h), which are such polynomials, too. This is
/// sufficient and not necessary: its ends are on the safe side by more, and 0 where a coefficient
/// is not positive at s = 0.
///
/// `orientation`: #cells of +1 / -1 (Topology.h), or empty. Left out is what was not positive in
/// the undeformed mesh: the places of cells in `before`, and these between their corners. The
/// result does not depend on the number of threads. Cost: one pass, about as much as ten measures
/// of quality, for a rotation six times that.
ValidRange validRange(const Mesh& mesh, const NodeMotion& motion,
  const std::vector<std::int8_t>& orientation, const InvertedBefore& before, Monitor& monitor);
}
