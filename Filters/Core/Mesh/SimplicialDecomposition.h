// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

namespace morph
{
/// A tetrahedron of an averaged simplicial decomposition: four corners of the cell and a weight.
struct WeightedTet
{
  int corner[4];
  double weight;
};

/// The weighted tetrahedra of a cell, whose weights cover it once. A hexahedron has the mean of its
/// two splits into five, a wedge of its six into three, a pyramid of its two into two. See
/// cornerTetrahedra() for the ones that are positive in every valid cell. On a bilinear
/// quadrilateral the mean of the two splits integrates the shape functions exactly. So decomposed
/// cells conform with neighbors that are not.
struct SimplicialDecomposition
{
  int count;
  const WeightedTet* tets;
};

/// Returns an empty decomposition for shapes that are not volumes.
SimplicialDecomposition simplicialDecomposition(Shape shape);

/// Returns how many leading tetrahedra lie at a corner with its neighbors along the edges. They are
/// positive in a valid cell; the others need not be. A pyramid counts its base corners only.
int cornerTetrahedra(Shape shape);

/// Returns the number of corners of a volume shape (4, 8, 6, 5), and 0 for the others.
int numberOfCorners(Shape shape);
/// Whether a cell, of a known type, has any.
inline bool hasCorners(const Mesh& mesh, Index cell)
{
  return numberOfCorners(cellShape(mesh, cell)->shape) > 0;
}

/// Returns the weighted sum of the tetrahedra's volumes: the exact volume of the cell with bilinear
/// faces. It is negative for a mirrored cell. `corners`: numberOfCorners x 3.
double signedVolume(Shape shape, const double (*corners)[3]);
}
