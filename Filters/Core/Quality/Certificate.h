// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace morph
{
/// What is proved about the Jacobian determinant of a cell's parametric map.
enum class Certificate : std::int8_t
{
  Inverted = -1, ///< it is 0 or negative somewhere in the cell, corners included
  Undecided = 0, ///< neither is proved
  Certified = 1  ///< it is positive everywhere in the cell
};

struct CertificateReport
{
  std::vector<Certificate> cells; ///< #cells; Undecided where not examined
  Index certified = 0;
  Index inverted = 0;
  Index undecided = 0; ///< among the examined cells
};

/// Certifies all volume cells in parallel, each from its nodes in VTK's order. Rounding errors are
/// bounded throughout, so Certified and Inverted hold for the coordinates as given.
///
/// - Tetrahedron: the determinant is constant and its sign exact (ExactPredicates.h).
/// - Pyramid: with the base Q(r, s) = q + r u + s v + r s w and the apex a, VTK's map is (1 - t) Q
///   + t a and its determinant (1 - t)^2 g, where g = det [Q_r, Q_s, a - Q] is the determinant of
///   the rational map of the pyramid. With Q_r x Q_s = u x v + r u x w + s w x v the terms in r^2
///   and s^2 vanish and g is bilinear: its minimum is at a corner of the base. The exact signs
///   of the four base-corner tetrahedra decide.
/// - Hexahedron, wedge and quadratic cells (types 24 to 27, 29, 31 to 33): the determinant of VTK's
///   own map through all nodes lies between the minimum and the maximum of its Bernstein
///   coefficients. These close in on it as the cell is halved (CellMap.h). Source: A. Johnen, J.-F.
///   Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", J. Comput. Phys.
///   233 (2013) 359-372. Of hexahedra and wedges the corner signs are exact; of others they are
///   bounded. With nodes exactly in the middle of their corners a cell is proved as the linear one
///   that it is.
/// - Polyhedron: the tetrahedra by which it is measured (PolyhedronQuality.h).
///
/// Undecided are hexahedra and wedges with a determinant within about 1e-13 of zero, but no corner
/// at or below zero. This is relative to the product of the longest edges in the three directions.
/// Also undecided are quadratic cells within about 1e-11 of zero, even if exactly zero (a node at a
/// quarter of its edge). So are coordinates that are not finite and shapes that are not volumes.
///
/// Cells of an unknown type stay undecided. Cells of lower dimension and cells with a nonzero
/// `skip` entry are not examined. `points`: #nodes x 3, the positions to examine, instead of the
/// mesh's own. `orientation`: #cells of +1 / -1 (Topology.h), or empty for VTK's order throughout.
/// Cost: 0.1 microseconds for a tetrahedron, 1.5 for a hexahedron, 5 for a curved quadratic cell.
/// An undecided cell takes up to about 5 milliseconds.
CertificateReport certify(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);

/// The maximum number of nodes of a volume cell that this library knows.
constexpr int MostNodesOfVolume = 27;

/// Whether the shape is a volume cell with more nodes than its corners, whose map is known.
inline bool isQuadraticVolume(const CellShape& shape)
{
  return shape.isMapped && shape.extraNodes && shape.numberOfNodes > shape.numberOfCorners;
}

/// The volume cells with more nodes than their corners whose map is not known, ascending.
std::vector<Index> unmappedCells(const Mesh& mesh);

/// The result of a proof about the Jacobian determinant of a cell.
struct JacobianProof
{
  Certificate certificate = Certificate::Undecided;
  /// If Inverted: parametric coordinates of a point where the determinant is 0 or negative. For a
  /// pyramid, the determinant is taken without its factor (1 - t)^2.
  double at[3] = { 0, 0, 0 };
};

/// Proves the determinant positive, or finds a point where it is not. It subdivides the Bernstein
/// form (CellMap.h) and bounds the rounding of all coefficients and subdivisions. Where that
/// decides nothing, it looks at the nodes and at a lattice of points, with the rounding bound of
/// each point. The result is Undecided if a coordinate is not finite, or if the minimum is too
/// close to 0 for the bound. `type`: one of CellMap.h; `x`: all nodes of the cell in VTK's
/// order. Cost: about 5 microseconds for a well-shaped cell, up to about 5 milliseconds if
/// undecided.
JacobianProof proveJacobian(std::uint8_t type, const Eigen::Vector3d* x);

/// Returns the scaled Jacobian of a quadratic cell whose corner cell has the value `ofCorners`:
/// - Inverted inside: the minimum, never positive, of `ofCorners` and the determinants with
///   normalized columns at the nodes and at the proof's point.
/// - Positive everywhere: `ofCorners` if positive, otherwise the minimum of the determinants at the
///   nodes.
/// - Undecided: `ofCorners`.
/// The normalized determinants have the factor of the shape's corners (ScaledJacobian.h).
double quadraticScaledJacobian(std::uint8_t type, const Eigen::Vector3d* x, double ofCorners);

/// Whether all nodes between corners are exactly at the corners' mean, so that the map is the
/// linear cell's.
bool isStraightSided(std::uint8_t type, const Eigen::Vector3d* x);
}
