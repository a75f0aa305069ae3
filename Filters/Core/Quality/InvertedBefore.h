// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Quality/ScaledJacobian.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The cells that are inverted, degenerate or flat before a motion, so that the motion is judged by
/// what it does. A motion that keeps the orientation, an affine one for instance, keeps the signs
/// of all determinants, but not their values. So a cell counts as no worse as long as no place that
/// was positive is 0 or negative: a corner, a hexahedron's center, or a place of a polyhedron. A
/// place with an edge that rounding of the coordinates alone makes was not positive. Between the
/// corners of such a quadratic cell nothing is judged.
class InvertedBefore
{
public:
  /// A scaled Jacobian that rounding alone keeps from 0.
  static constexpr double Flat = 1e-10;

  /// None.
  InvertedBefore() = default;
  /// `mesh`: undeformed, held by reference; `orientation`: #cells (Topology.h), or empty; `atRest`:
  /// measureQuality() of the mesh. Cells that are not measured do not count. Cost: a pass over the
  /// values.
  InvertedBefore(
    const Mesh& mesh, const std::vector<std::int8_t>& orientation, const Quality& atRest);

  /// Their ids, ascending.
  const std::vector<Index>& cells() const { return this->cells_; }
  /// For each place where the cell is measured whether it is positive in the undeformed mesh, in
  /// the order of forEachMeasuredPlace() and PolyhedronPlaces::forEach(); null for a cell that is
  /// not one of these.
  const std::vector<bool>* positivePlaces(Index cell) const;
  /// Of `inverted` cells, ascending, those that the motion to `points`, #nodes x 3, has inverted:
  /// all but the ones that were so before and are no worse.
  std::vector<Index> added(const ConstPoints& points, const std::vector<Index>& inverted) const;
  /// Returns `cells`, ascending, without these.
  std::vector<Index> without(const std::vector<Index>& cells) const;

private:
  /// Whether the scaled Jacobian is above `least`, and edges are longer than `leastEdge`.
  std::vector<bool> placesOf(
    Index cell, double sign, const ConstPoints& points, double least, double leastEdge) const;

  const Mesh* mesh_ = nullptr; ///< null without cells
  std::vector<Index> cells_;
  std::vector<double> signs_;               ///< #cells_
  std::vector<std::vector<bool>> positive_; ///< #cells_
};
}
