// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrRows.h"
#include "Solvers/DampedJacobi.h"
#include "Solvers/MixedPrecisionMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cstddef>
#include <optional>
#include <vector>

namespace morph
{
/// A smoothed-aggregation multigrid preconditioner for three right-hand sides at once. It is one
/// V-cycle with damped Jacobi smoothing, symmetric for a symmetric matrix. It has single precision,
/// which halves memory traffic; the finest level is the matrix as rounded, not a copy. Source:
/// Vanek, Mandel, Brezina, Computing 56 (1996) 179-196.
///
/// A matrix that is not symmetric is coarsened by P^T A P. On log-barrier weights this took 4
/// BiCGSTAB iterations, and a hierarchy of the symmetrised matrix 4 to 9. On a mesh graded 1.6
/// times a layer it took 7 against 13. Aggregates consist of near nodes, see nearNeighbors().
class Multigrid
{
public:
  using Row = Eigen::Vector4f;

  enum class Symmetry
  {
    Symmetric, ///< and positive definite
    General    ///< close to an M-matrix
  };

  /// Makes the levels. `matrix` must outlive this object and stay in place: it is the finest level.
  /// Its columns may become narrow afterwards, not before. `coordinates`: #rows x 3. Throws Error
  /// of kind Singular where a diagonal entry is about 1e38 times smaller than the largest entry. A
  /// matrix of no rows has no level, and apply() returns zero.
  void prepare(const MixedPrecisionMatrix& matrix, Symmetry symmetry,
    const ConstPoints& coordinates, Monitor& monitor);
  /// Makes the transpose of `other`. `matrix`: the transpose of its matrix. Both must outlive this
  /// object and stay in place.
  void prepareTransposed(const Multigrid& other, const MixedPrecisionMatrix& matrix);

  /// The vectors of all levels but the finest, one set per concurrent solve.
  class Workspace
  {
  public:
    explicit Workspace(const Multigrid& multigrid);

  private:
    friend class Multigrid;
    struct Level
    {
      FloatMultiVector rhs, work, x;
    };
    std::vector<Level> levels_;
  };

  /// The size that right-hand sides should have. Solutions are then as far below 1 as these are
  /// above it, since entries of the matrix have the square of this size.
  static constexpr double Size = 1 << MixedPrecisionMatrix::LargestExponent / 2;
  /// Computes x = B rhs with a fixed B near the inverse of the matrix in its own units, symmetric
  /// positive definite for Symmetry::Symmetric. `rhs`, `work`, `x`: #rows each; the content of
  /// `work` is lost. Returns the products rhs^T x of the columns.
  Eigen::Vector4d apply(
    const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor& monitor) const;

  int numberOfLevels() const { return static_cast<int>(this->levels_.size()); }
  /// Returns the bytes of the levels, without the finest matrix.
  std::size_t memory() const;
  /// Returns the bytes of a Workspace.
  std::size_t workspaceBytes() const;
  /// Returns the bytes that one apply() moves if nothing stays in cache.
  double bytesMoved() const;

private:
  using Matrix = CsrRows<float>; ///< for cycles
  /// to make the next level: next to slivers float would cancel completely
  using ExactMatrix = CsrRows<double>;

  struct Level
  {
    int rows = 0;
    Matrix A;    ///< empty in the finest level
    Matrix P, R; ///< prolongation to this level from the next, and its transpose
    DampedJacobi smoother;
  };

  /// Appends a level without its matrix. Returns the largest eigenvalue of D^-1 A. Where single
  /// precision cannot smooth by the diagonal, appends nothing and returns 0.
  float addLevel(const Matrix& A, Monitor& monitor);
  const Matrix& matrix(std::size_t level) const
  {
    return level == 0 ? *this->finest_ : this->levels_[level].A;
  }
  /// `A`: the last level's matrix in double precision.
  void factorizeCoarsest(const Eigen::MatrixXd& A, Symmetry symmetry);
  bool solveCoarsest(const Row* rhs, Row* x) const;
  std::size_t coarsestBytes() const;

  /// apply() from level k down.
  Eigen::Vector4d cycle(
    std::size_t k, const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor&) const;

  const Matrix* finest_ = nullptr;
  std::vector<Level> levels_;
  // Factors of the coarsest level, by symmetry; without either, its smoother is used.
  std::optional<Eigen::LLT<Eigen::MatrixXd>> symmetricCoarsest_;
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> generalCoarsest_;
};
}
