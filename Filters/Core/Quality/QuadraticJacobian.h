// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Quality/Certificate.h"

#include <Eigen/Core>

#include <cstdint>

namespace morph
{
/// The most nodes of a volume cell that this library knows.
constexpr int MostNodesOfVolume = 27;

/// Whether it is a volume cell with nodes besides its corners.
inline bool isQuadraticVolume(const CellShape& shape)
{
  return shape.extraNodes && shape.numberOfNodes > shape.numberOfCorners;
}

/// What is proved about the Jacobian determinant of a quadratic volume cell, and where.
struct QuadraticProof
{
  Certificate certificate = Certificate::Undecided;
  /// Inverted: the parametric coordinates of a point at which the determinant is 0 or negative. Of
  /// a pyramid it is the determinant without its factor (1 - t)^2.
  double at[3] = { 0, 0, 0 };
};

/// Proves the determinant positive, or finds a point where it is not, by subdivision of its
/// Bernstein form (QuadraticMap.h); the rounding of the coefficients and of every subdivision is
/// bounded. Undecided where a coordinate is not finite, and where the smallest determinant is too
/// close to 0 for the bound. `type`: one of those of QuadraticMap.h; `x`: all nodes of the cell in
/// VTK's order. Cost: about 5 microseconds for a well-shaped cell, at most about 5 milliseconds for
/// one that stays undecided.
QuadraticProof proveQuadratic(std::uint8_t type, const Eigen::Vector3d* x);

/// The scaled Jacobian of a quadratic cell whose corners alone have `ofCorners`:
/// - inverted inside: the minimum of `ofCorners` and of the determinants with normalised columns at
///   the nodes and at the point of the proof, never positive;
/// - positive everywhere: `ofCorners` where it is positive, else the minimum of those at the nodes;
/// - undecided: `ofCorners`.
/// The normalised determinants have the factor of the shape's corners (ScaledJacobian.h).
double quadraticScaledJacobian(std::uint8_t type, const Eigen::Vector3d* x, double ofCorners);

/// Whether all nodes between corners are exactly at their mean, so that the map is that of the
/// corner cell.
bool isStraightSided(std::uint8_t type, const Eigen::Vector3d* x);
}
