// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Scaled Jacobian of one cell from its corners in VTK's hexahedron, wedge, ... order: the
/// determinant of the Jacobian matrix with normalised edges, 1 for the ideal cell, <= 0 for an
/// inverted one (Knupp, IJNME 48 (2000) 1165-1185; the conventions are Verdict's, Sandia report
/// SAND2007-1751):
///   tet      sqrt(2) J / max over the four corners of the product of its three edge lengths
///   hex      minimum of the eight corners and the centre
///   wedge    minimum of the six corners, times 2/sqrt(3)
///   pyramid  minimum of the four base-corner tets, times sqrt(2), at most 1
///   tri      2/sqrt(3) times twice the area / largest product of two edge lengths (never negative)
///   quad     minimum corner, signed by the normal at the centre
/// Where a corner's edges have no length the result is 0 (Verdict: 1e30); for a pyramid below 0 the
/// value itself (Verdict: 0). Of quadratic cells this is the corner cell's alone; measureQuality()
/// looks inside them. `corners`: numberOfCorners x 3.
double scaledJacobian(std::uint8_t type, const double (*corners)[3]);

/// True only where scaledJacobian() of a hexahedron or wedge is positive beyond rounding. False
/// says nothing. Cost: a third of scaledJacobian()'s, by determinants that are not normalised.
bool areCornersSurelyPositive(Shape shape, const double (*corners)[3]);

struct Quality
{
  std::vector<double> scaledJacobian; ///< #cells; NaN where not measured
  double minimum = 0;                 ///< NaN if no cell was measured
  double mean = 0;                    ///< NaN if no cell was measured
  Index measured = 0;
  Index inverted = 0;   ///< scaled Jacobian < 0 (or 0 with positive edges)
  Index degenerate = 0; ///< a corner whose edges have no length; not counted as inverted
  Index worstCell = -1; ///< the lowest id among the cells at the minimum
};

/// Measures the cells of the highest dimension in the mesh (3 or 2); the others, and cells whose
/// `skip` entry is not zero (ghosts), get NaN and are not counted. A quadratic volume cell has its
/// corners' value unless its true map proves otherwise (quadraticScaledJacobian()): at most 0 where
/// its determinant is negative somewhere inside. `orientation`: #cells of +1 / -1 (Topology.h), or
/// empty for VTK's order throughout. `points`: #nodes x 3, the positions to measure at; the mesh's
/// own are not read. Threads over cells; the sums are taken in a fixed order. Cost: one pass, about
/// 0.1 microseconds a cell, 5 for a quadratic volume cell.
Quality measureQuality(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);

/// measureQuality() by the corners alone, also of quadratic cells: for what moves corners while the
/// nodes between them still stand where they were. Cost: about 0.1 microseconds a cell.
Quality measureCorners(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor);

/// Ids of the cells with a scaled Jacobian of 0 or less: inverted and degenerate ones, in ascending
/// order.
std::vector<Index> invertedCells(const Quality& quality);

/// Ids of the cells whose scaled Jacobian is not positive, degenerate ones included, ascending.
std::vector<Index> invertedCells(const Mesh& mesh, const Points& points,
  const std::vector<std::int8_t>& orientation, Monitor& monitor);
}
