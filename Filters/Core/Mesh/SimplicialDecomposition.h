// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

namespace morph
{
/// One tetrahedron of an averaged simplicial decomposition: four corners of the cell and a weight.
struct WeightedTet
{
  int corner[4];
  double weight;
};

/// The weights of a cell's tetrahedra cover it once: hexahedron, the mean of its two splits into
/// five; wedge, of its six into three; pyramid, of its two into two. See cornerTetrahedra() for
/// those that are positive in every valid cell. On a bilinear quadrilateral the mean of the two
/// splits integrates the shape functions exactly, so decomposed cells conform with their
/// undecomposed neighbors.
struct SimplicialDecomposition
{
  int count;
  const WeightedTet* tets;
};

/// Empty for shapes that are not volumes.
SimplicialDecomposition simplicialDecomposition(Shape shape);

/// How many of the decomposition's tetrahedra, the first ones, lie at a corner with its neighbors
/// along the edges. They are positive in a valid cell; the others need not be. (Of a pyramid, those
/// at the base.)
int cornerTetrahedra(Shape shape);

/// Number of corners of a volume shape (4, 8, 6, 5), 0 for the others.
int numberOfCorners(Shape shape);

/// Weighted sum of the tetrahedra's volumes, negative for a mirrored cell; the exact volume of the
/// cell with bilinear faces. `corners`: numberOfCorners x 3.
double signedVolume(Shape shape, const double (*corners)[3]);
}
