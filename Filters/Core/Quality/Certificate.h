// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

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

/// A proof for one cell from its nodes in VTK's order. Rounding errors are bounded throughout, so
/// Certified and Inverted hold for the coordinates as given.
///
/// - Tetrahedron: the determinant is constant and its sign exact (OrientationPredicate.h).
/// - Pyramid: with the base Q(r, s) = q + r u + s v + r s w and the apex a, VTK's map is (1 - t) Q
///   + t a and its determinant (1 - t)^2 g, where g = det [Q_r, Q_s, a - Q] is the determinant of
///   the rational map of the pyramid. With Q_r x Q_s = u x v + r u x w + s w x v the terms in r^2
///   and s^2 vanish and g is bilinear: its minimum is at a corner of the base. The exact signs
///   of the four base-corner tetrahedra decide.
/// - Wedge: linear over the triangle and quadratic along the third coordinate, so the minimum
///   is on one of the three edges between the triangles. On such an edge, with the Bernstein
///   coefficients b0, b1, b2, it is positive throughout if and only if b0 > 0, b2 > 0 and b1 >
///   -sqrt(b0 b2). b0 and b2 are corner determinants.
/// - Hexahedron: of degree two in each coordinate. It lies between the minimum and the maximum of
///   its 27 Bernstein coefficients, which close in on it as the cell is halved (de Casteljau; A.
///   Johnen, J.-C. Weill, J.-F. Remacle, "Robust and efficient validation of the linear hexahedral
///   element", Procedia Engng 203 (2017) 271-283). The eight corner signs are exact.
/// - Quadratic cells (types 24 to 27, 29, 31 to 33): the determinant of VTK's own map through all
///   nodes, by its Bernstein coefficients and subdivision (QuadraticMap.h; A. Johnen, J.-F.
///   Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", J. Comput. Phys.
///   233 (2013) 359-372). Its corner signs are bounded, not exact. With nodes exactly in the middle
///   of their corners the cell is proved as the linear one that it is.
///
/// - Polyhedron (certify() alone): OpenFOAM's test of face pyramids, see PolyhedronQuality.h. It is
///   a test of volumes, not of a map.
///
/// Undecided are hexahedra and wedges with a determinant within about 1e-13 of zero, but no corner
/// at or below zero. This is relative to the product of the longest edges in the three directions.
/// Also undecided are quadratic cells within about 1e-11 of zero, even if exactly zero (a node at a
/// quarter of its edge). So are coordinates that are not finite and shapes that are not volumes.
///
/// `nodes`: n x 3, all n nodes of the cell, those of a voxel in a hexahedron's order. Cost: 0.1
/// microseconds for a tetrahedron, 1.5 for a hexahedron, 5 for a curved quadratic cell. An
/// undecided cell takes up to about a millisecond if linear, 5 if quadratic.
Certificate certifyCell(std::uint8_t type, const double (*nodes)[3]);

struct CertificateReport
{
  std::vector<Certificate> cells; ///< #cells; Undecided where not examined
  Index certified = 0;
  Index inverted = 0;
  Index undecided = 0; ///< among the examined cells
};

/// Certifies all volume cells in parallel. Cells of an unknown type stay undecided. Cells of lower
/// dimension and cells with a nonzero `skip` entry are not examined. `points`: #nodes x 3, the
/// positions to examine, instead of the mesh's own. `orientation`: #cells of +1 / -1 (Topology.h),
/// or empty for VTK's order throughout.
CertificateReport certify(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);
}
