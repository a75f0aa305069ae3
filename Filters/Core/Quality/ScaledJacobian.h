// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The scaled Jacobian of one cell: the determinant of its Jacobian matrix with normalized edges.
/// It is 1 for the ideal cell and <= 0 for an inverted one. Source: Knupp, IJNME 48 (2000)
/// 1165-1185, with the conventions of Verdict (Sandia report SAND2007-1751):
///
///   tet      sqrt(2) J / max over the four corners of the product of its three edge lengths
///   hex      minimum of the eight corners and the center
///   wedge    minimum of the six corners, times 2/sqrt(3)
///   pyramid  minimum of the four base-corner tets, times sqrt(2), at most 1
///   tri      2/sqrt(3) times twice the area / largest product of two edge lengths (never negative)
///   quad     minimum corner, signed by the normal at the center
///
/// measureQuality() also has polyhedra (PolyhedronQuality.h).
///
/// Two values differ from Verdict: 0 where a corner's edges have no length (Verdict: 1e30), and a
/// pyramid's negative values (Verdict: 0). Only the corners of a quadratic cell count here;
/// measureQuality() looks inside it. `corners`: numberOfCorners x 3, in VTK's hexahedron, wedge,
/// ... order. `samples`: of a volume cell, those that count (samplesOf()); NaN if there are none.
double scaledJacobian(const CellShape& shape, const double (*corners)[3], unsigned samples = ~0u);

/// The samples of a volume cell of which its scaled Jacobian is the minimum, as a set of bits: its
/// corners, in the order of the formula, then a hexahedron's center; one for a tetrahedron. Returns
/// those that depend on a corner node k with bit k in `nodes`.
unsigned samplesOf(Shape shape, unsigned nodes);

/// Returns an upper bound of the scaled Jacobian over the samples that depend on a corner node
/// without a bit in `nodes`, for any position of these. It is the sine of an angle between edges of
/// a face, in the scale of the cell; infinite without such a face corner.
double scaledJacobianBound(Shape shape, const double (*corners)[3], unsigned nodes);

struct Quality
{
  std::vector<double> scaledJacobian; ///< #cells; NaN where not measured
  double minimum = 0;                 ///< NaN if no cell was measured
  double mean = 0;                    ///< NaN if no cell was measured
  Index measured = 0;
  Index inverted = 0;   ///< scaled Jacobian < 0 (or 0 with positive edges)
  Index degenerate = 0; ///< a corner has edges without length; not counted as inverted
  Index worstCell = -1; ///< lowest id of the cells at the minimum
};

/// Measures the cells of the highest dimension in the mesh (3 or 2). Other cells and cells with a
/// nonzero `skip` entry (ghosts) get NaN and are not counted. A quadratic volume cell has its
/// corners' value unless its true map proves otherwise (quadraticScaledJacobian()). It is then at
/// most 0 if the determinant is negative somewhere inside.
///
/// `points`: #nodes x 3, the positions to measure, instead of the mesh's own.
/// `orientation`: #cells of +1 / -1 (Topology.h), or empty for VTK's order throughout. Runs in
/// parallel; sums have a fixed order. Cost: one pass, about 0.1 microseconds a cell, 3 for a
/// polyhedron, 5 for a quadratic volume cell.
Quality measureQuality(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);

/// Measures by the corners alone, also quadratic cells. For methods that move corners before the
/// nodes between them. Cost: about 0.1 microseconds a cell.
Quality measureCorners(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);

/// Returns the ids, ascending, of cells with a scaled Jacobian of 0 or less: inverted and
/// degenerate ones.
std::vector<Index> invertedCells(const Quality& quality);

/// Measures `mesh` at `points` and returns the ids, ascending, of cells without a positive value.
std::vector<Index> invertedCells(const Mesh& mesh, const Points& points,
  const std::vector<std::int8_t>& orientation, Monitor& monitor);

/// Returns the numbers of the whole mesh, without the values of single cells; `worstCell` is the
/// lowest number in it. `mine`: of this process's own cells. Collective.
Quality ofAll(const Quality& mine, const Communicator& processes);

/// Returns the minimum over all processes; infinite where none has measured a cell. Collective.
double minimumOfAll(const Quality& mine, const Communicator& processes);

/// Returns the mean scaled Jacobian of the worst `share` of the measured cells of all processes,
/// one cell at least. `mine`: of this process's own cells. `share`: in (0, 1]. NaN if no cell was
/// measured. It does not depend on the cells' numbering. Collective. Cost: a pass over the cells,
/// and 64 sums of one count.
double worstMean(
  const Quality& mine, double share = 0.01, const Communicator& processes = Communicator::alone());
}
