// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Morpher/Morpher.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Returns the stiffness of each cell, #cells, relative to the stiffest volume cell and at
/// least 1e-10; 1 for cells below dimension 3. Empty for Uniform without values.
/// `prescribed`: the walls where `stiffness` names none. Throws Error for an exponent outside [0,
/// 4], values that are not positive, finite and one a cell, and walls that are no nodes. Cost: a
/// pass over the cells; for WallDistance also a k-d tree of the walls, of which each process gets
/// all: 24 bytes a node. `processes`: of the mesh; values are then those of a process's own cells.
/// Collective.
std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor,
  const Communicator& processes = Communicator::alone());

/// The number of entries in the upper triangle, by rows, of an n x n symmetric matrix.
constexpr int triangleSize(int n)
{
  return n * (n + 1) / 2;
}
/// The index of (a, b) in this triangle.
constexpr int triangleIndex(int n, int a, int b)
{
  return a <= b ? a * n - a * (a - 1) / 2 + b - a : triangleIndex(n, b, a);
}

/// Computes the Laplace stiffness K_ab = integral of grad N_a . grad N_b of one linear cell, in its
/// length unit. Tetrahedra are exact; hexahedra use 2 x 2 x 2 Gauss points, wedges 3 x 2 points.
/// Pyramids use the averaged simplicial decomposition, as their rational shape functions cannot be
/// integrated exactly. With these rules sum_b K_ab x_b vanishes over the cells around an interior
/// node, so affine maps are reproduced.
///
/// `corners`: n x 3 in the shape's order. `K`: triangleSize(n) numbers, always positive
/// semi-definite. Returns the Jacobian's sign at the quadrature points, and in the tetrahedra of a
/// tetrahedron or pyramid. +1: positive at all. -1: negative at all; K is that of the mirrored
/// cell. 0: changes sign or vanishes; K comes from the averaged simplicial decomposition with
/// absolute volumes, bounded away from zero. A hexahedron or wedge with +1 can still be inverted at
/// a corner; K is valid. Cost: 0.2 to 0.4 microseconds for a hexahedron.
int elementStiffness(Shape shape, const double (*corners)[3], double* K);
}
