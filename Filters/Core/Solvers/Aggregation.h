// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// How near the column of an entry is to its row. Near means that 0.4 of its squared distance is
/// not beyond that of the nearest neighbor.
enum class Nearness : std::uint8_t
{
  Far,
  OneSided, ///< near as seen from the row, not from the column
  Mutual
};

/// Returns the nearness of each entry of A; Far for the diagonal. `coordinates`: #rows x 3.
///
/// Nearness replaces the size of the entries: a trilinear hexahedron has no entry between nodes
/// that share an edge, and stretched cells must coarsen along their short side first.
std::vector<Nearness> nearNeighbors(
  const CsrRows<float>& A, const Points& coordinates, Monitor& monitor);

/// The aggregate of each row.
struct Aggregates
{
  std::vector<int> of; ///< #rows
  int count = 0;
  int ofMutual = 0; ///< so many, the first ones, started from mutual neighbors
};

/// Groups the rows of A into aggregates of near neighbors. `near`: #entries, see nearNeighbors().
/// Mutual neighbors make an aggregate, which others join: from the apex of a flat pyramid the four
/// corners of the base are alike, and far from each other. Cost: three serial passes.
Aggregates aggregate(
  const CsrRows<float>& A, const Points& coordinates, const std::vector<Nearness>& near);

/// Returns the smoothed prolongation from aggregates, P = (I - omega A_F) T. T is constant on each
/// aggregate. A_F keeps the near neighbors and adds the other entries to its diagonal. omega is 4/3
/// of the inverse of the row's sum of |A_F|, which bounds its eigenvalues. It is twice that
/// inverse, which makes the row harmonic, where it has joined neighbors that are nearer to others.
/// Source: Vanek, Mandel, Brezina, Computing 56 (1996) 179-196.
CsrMatrixOf<float> smoothedProlongation(const CsrRows<float>& A, const std::vector<Nearness>& near,
  const Aggregates& aggregates, Monitor& monitor);

/// Returns the factor times R A P in double precision. The result does not depend on threads.
/// Throws Error if an int cannot number its entries. Cost: the products R A and (R A) P. No product
/// is stored but the result.
CsrMatrix tripleProduct(const CsrMatrixOf<float>& R, const CsrMatrix& A,
  const CsrMatrixOf<float>& P, double factor, Monitor& monitor);

/// Rounds a matrix to single precision.
CsrMatrixOf<float> rounded(const CsrMatrix& A);
}
