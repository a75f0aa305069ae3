// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Simd.h"

namespace morph
{
/// Corners of four cells of one shape, for measuring all at once.
struct FourCells
{
  double x[8][3][SimdWidth]; ///< corner, coordinate, cell
};

/// Computes the scaled Jacobians of four hexahedra, or of four tetrahedra. They are bit for bit
/// those of scaledJacobian() (ScaledJacobian.h). Returns false if a coordinate or a length is not
/// finite, or an edge or a hexahedron's mean edge is not longer than 1e-150. The result then has no
/// meaning, and such cells are measured one by one. Cost: about 0.05 microseconds a hexahedron.
///@{
bool measureHexes(const FourCells& cells, double (&scaledJacobian)[SimdWidth]);
bool measureTets(const FourCells& cells, double (&scaledJacobian)[SimdWidth]);
///@}
}
