// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// Gauss-Seidel sweeps over at most 16 blocks of rows at once, whatever the number of threads. With
/// A = L + D + U + F, where F has the entries that join two blocks, a sweep solves by D* + L, or
/// D* + U. D* is D plus half of the sum of |F| along each row. So D* + L and its transpose converge
/// for every symmetric positive definite A. Source: Baker, Falgout, Kolev, Yang, SIAM J. Scientific
/// Computing 33 (2011) 2864-2887.
class GaussSeidel
{
public:
  using Row = Eigen::Vector4f;

  /// `A`: its columns ascend in each row. Returns false if single precision has no room for an
  /// entry of the diagonal of the size `least` or for its inverse.
  bool prepare(const CsrRows<float>& A, float least, Monitor& monitor);
  /// prepare() for the transpose of `other`'s matrix; the sweeps are then the transposes of its
  /// sweeps.
  void prepareTransposed(const GaussSeidel& other, const CsrRows<float>& A, Monitor& monitor);

  /// The matrix is that of prepare(). `rhs`, `x`, ...: #rows each, no two the same.
  ///@{
  /// Sets x to (D* + L)^-1 rhs.
  void sweep(const CsrRows<float>& A, const Row* rhs, Row* x, Monitor& monitor) const;
  /// Sets `residual` to rhs - A x after that sweep, by half of A.
  void residual(const CsrRows<float>& A, const Row* x, Row* residual, Monitor& monitor) const;
  /// Sets `to` to x + (D* + U)^-1 (rhs - A x).
  void sweepBack(
    const CsrRows<float>& A, const Row* rhs, const Row* x, Row* to, Monitor& monitor) const;
  ///@}

private:
  struct Place
  {
    int first, diagonal, last; ///< of the row's entries in its block: [first, last)
    float added, inverse;      ///< D* - D and 1 / D*
  };
  struct Sweep;
  struct Residual;
  struct SweepBack;
  /// Calls Body for each block.
  template <typename Body, typename... Arguments>
  void forBlocks(Monitor& monitor, const CsrRows<float>& A, Arguments... arguments) const;
  /// Finds the entries of a row, whose block it is in.
  void locate(const CsrRows<float>& A, Index row);
  Index blockSize() const;

  std::vector<Place> places_; ///< #rows
};
}
