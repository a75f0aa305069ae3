// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns for each entry of A whether its column is a near neighbor of its row. Near means that
/// `share` of its squared distance is not beyond that of the nearest one. `coordinates`: #rows x 3.
///
/// Nearness replaces the size of the entries: a trilinear hexahedron has no entry between nodes
/// that share an edge, and stretched cells must coarsen along their short side first.
std::vector<std::uint8_t> nearNeighbors(
  const CsrRows<float>& A, const Points& coordinates, double share, Monitor& monitor);

/// Groups the rows of A into aggregates of near neighbors. `near`: #entries, see nearNeighbors().
/// `group` becomes the aggregate of each row. Returns their number. Cost: three serial passes.
int aggregate(const CsrRows<float>& A, const Points& coordinates,
  const std::vector<std::uint8_t>& near, std::vector<int>& group);

/// Returns the smoothed prolongation from aggregates, P = (I - omega D^-1 A_F) T. T is
/// constant on each aggregate. A_F keeps the near neighbors and adds the other entries to its
/// diagonal. `eigenvalue`: the largest one of D^-1 A. `groups`: the number of aggregates. Source:
/// Vanek, Mandel, Brezina, Computing 56 (1996) 179-196.
CsrMatrixOf<float> smoothedProlongation(const CsrRows<float>& A, float eigenvalue,
  const std::vector<std::uint8_t>& near, const std::vector<int>& group, int groups,
  Monitor& monitor);

/// Returns the factor times R A P in double precision. The result does not depend on threads.
/// Throws Error if an int cannot number its entries. Cost: the products R A and (R A) P. No product
/// is stored but the result.
CsrMatrix tripleProduct(const CsrMatrixOf<float>& R, const CsrMatrix& A,
  const CsrMatrixOf<float>& P, double factor, Monitor& monitor);

/// Rounds a matrix to single precision.
CsrMatrixOf<float> rounded(const CsrMatrix& A);
}
