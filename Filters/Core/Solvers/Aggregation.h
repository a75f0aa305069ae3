// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// Groups the rows of A into aggregates of near neighbors, and returns the smoothed prolongation
/// from them, a column for each: P = (I - omega A_F) T. Without a column there is nothing to group:
/// more than 0.8 of the rows would be aggregates. `coordinates`: #rows x 3. `aggregateOf`: becomes
/// the aggregate of each row.
///
/// Near means that 0.4 of the squared distance is not beyond that of the nearest neighbor. It
/// replaces the size of the entries: a trilinear hexahedron has no entry between nodes that share
/// an edge, and stretched cells must coarsen along their short side first. Mutual neighbors make an
/// aggregate, which others join: from the apex of a flat pyramid the four corners of the base are
/// alike, and far from each other. Three passes over A for that are serial.
///
/// T is constant on each aggregate. A_F keeps the near neighbors and adds the other entries to its
/// diagonal. omega is 4/3 of the inverse of the row's sum of |A_F|, which bounds its eigenvalues.
/// It is twice that inverse, which makes the row harmonic, where it has joined neighbors that are
/// nearer to others. Source: Vanek, Mandel, Brezina, Computing 56 (1996) 179-196.
CsrMatrixOf<float> prolongation(const CsrRows<float>& A, const Points& coordinates,
  std::vector<int>& aggregateOf, Monitor& monitor);

/// Returns the factor times R A P in double precision. The result does not depend on threads.
/// Throws Error if an int cannot number its entries. Cost: the products R A and (R A) P. No product
/// is stored but the result.
CsrMatrix tripleProduct(const CsrMatrixOf<float>& R, const CsrMatrix& A,
  const CsrMatrixOf<float>& P, double factor, Monitor& monitor);

/// Rounds a matrix to single precision.
CsrMatrixOf<float> rounded(const CsrMatrix& A);
}
