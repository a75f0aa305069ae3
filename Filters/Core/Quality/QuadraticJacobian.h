// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Quality/Certificate.h"

#include <Eigen/Core>

#include <cstdint>

namespace morph
{
/// The maximum number of nodes of a volume cell that this library knows.
constexpr int MostNodesOfVolume = 27;

/// Whether the shape is a volume cell with more nodes than its corners.
inline bool isQuadraticVolume(const CellShape& shape)
{
  return shape.extraNodes && shape.numberOfNodes > shape.numberOfCorners;
}

/// The result of a proof about the Jacobian determinant of a quadratic volume cell.
struct QuadraticProof
{
  Certificate certificate = Certificate::Undecided;
  /// If Inverted: parametric coordinates of a point where the determinant is 0 or negative. For a
  /// pyramid, the determinant is taken without its factor (1 - t)^2.
  double at[3] = { 0, 0, 0 };
};

/// Proves the determinant positive, or finds a point where it is not. It subdivides the Bernstein
/// form (QuadraticMap.h) and bounds the rounding of all coefficients and subdivisions. Where that
/// decides nothing, it looks at the nodes and at a lattice of points, with the rounding bound of
/// each point. The result is Undecided if a coordinate is not finite, or if the minimum is too
/// close to 0 for the bound. `type`: one of QuadraticMap.h; `x`: all nodes of the cell in VTK's
/// order. Cost: about 5 microseconds for a well-shaped cell, up to about 5 milliseconds if
/// undecided.
QuadraticProof proveQuadratic(std::uint8_t type, const Eigen::Vector3d* x);

/// Returns the scaled Jacobian of a quadratic cell whose corner cell has the value `ofCorners`:
/// - Inverted inside: the minimum, never positive, of `ofCorners` and the determinants with
///   normalised columns at the nodes and at the proof's point.
/// - Positive everywhere: `ofCorners` if positive, otherwise the minimum of the determinants at the
///   nodes.
/// - Undecided: `ofCorners`.
/// The normalised determinants have the factor of the shape's corners (ScaledJacobian.h).
double quadraticScaledJacobian(std::uint8_t type, const Eigen::Vector3d* x, double ofCorners);

/// Whether all nodes between corners are exactly at the corners' mean, so that the map is the
/// linear cell's.
bool isStraightSided(std::uint8_t type, const Eigen::Vector3d* x);
}
