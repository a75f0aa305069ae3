// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/GaussSeidel.h"
#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace morph
{
/// A smoothed-aggregation multigrid preconditioner for four right-hand sides at once: one V-cycle,
/// symmetric for a symmetric matrix. It has single precision, which halves memory traffic. Source:
/// Vanek, Mandel, Brezina, Computing 56 (1996) 179-196.
///
/// The smoother is a Gauss-Seidel sweep before the coarse correction, and one backward after it.
/// Flat hexahedra need it: they couple in their plane by a mass matrix, of which Jacobi steps, or
/// Chebyshev's, damp some waves hardly at all.
///
/// A matrix that is not symmetric is coarsened by P^T A P. On log-barrier weights this took 4
/// BiCGSTAB iterations, and a hierarchy of the symmetrised matrix 4 to 9.
class Multigrid
{
public:
  using Row = Eigen::Vector4f;

  enum class Symmetry
  {
    Symmetric, ///< and positive definite
    General    ///< close to an M-matrix
  };

  /// Makes the levels. `matrix` must outlive this object and stay in place. Aggregates consist of
  /// near nodes, see prolongation(); `coordinates`: #rows x 3. Throws Error of kind Singular where
  /// a diagonal entry is about 1e38 times smaller than the largest one. A matrix of no rows has no
  /// level, and apply() does nothing.
  void prepare(
    const CsrMatrix& matrix, Symmetry symmetry, const ConstPoints& coordinates, Monitor& monitor);
  /// Makes the transpose of `other`. `matrix`: the transpose of its matrix, as above.
  void prepareTransposed(const Multigrid& other, const CsrMatrix& matrix);

  struct Vectors
  {
    FloatMultiVector rhs, work, x; ///< of the finest level, `work` alone
  };
  using Workspace = std::vector<Vectors>; ///< of all levels
  /// Returns one for a solve; several may run at once, each with its own.
  Workspace workspace() const;

  /// The matrix in its cycles is in units of this, a power of two. The largest entry has then the
  /// size 2^LargestExponent, which gives entries of very different rows room in single precision.
  double unit() const { return this->unit_; }
  static constexpr int LargestExponent = 60;
  /// The size that right-hand sides should have. Solutions are then as far below 1 as these are
  /// above it, since entries of the matrix have the square of this size.
  static constexpr double Size = 1 << LargestExponent / 2;
  /// Computes x = B rhs with a fixed B near the inverse of matrix / unit(), symmetric positive
  /// definite for Symmetry::Symmetric. `rhs`, `x`: #rows each.
  void apply(const Row* rhs, Row* x, Workspace& workspace, Monitor& monitor) const;

  int numberOfLevels() const { return static_cast<int>(this->levels_.size()); }

private:
  struct Level
  {
    Index rows = 0;
    CsrMatrixOf<float> A;    ///< empty in the finest level
    CsrMatrixOf<float> P, R; ///< prolongation to this level from the next; its transpose
    GaussSeidel smoother;
  };

  CsrRows<float> matrix(std::size_t level) const
  {
    return level == 0 ? CsrRows<float>(*this->finest_, this->finestValues_.data())
                      : CsrRows<float>(this->levels_[level].A);
  }
  /// Sets the finest level's values.
  void round(const CsrMatrix& matrix, Monitor& monitor);
  /// Appends a level without its matrix. Returns false, and appends nothing, if single precision
  /// cannot smooth by the diagonal.
  bool addLevel(const CsrRows<float>& A, Monitor& monitor);

  /// apply() from level k down.
  void cycle(std::size_t k, const Row* rhs, Row* x, Workspace& workspace, Monitor&) const;

  const CsrMatrix* finest_ = nullptr;
  std::vector<float> finestValues_; ///< of its entries, in units of unit()
  double unit_ = 1;
  std::vector<Level> levels_;
  /// Of the coarsest level, in double precision. Empty where its smoother is used.
  Eigen::MatrixXd coarsestInverse_;
};
}
