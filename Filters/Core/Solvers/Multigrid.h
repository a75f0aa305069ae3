// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <cstddef>
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
  /// Calls body(first, last) for each block of rows.
  template <typename Body>
  void forBlocks(Index rows, Monitor& monitor, const Body& body) const;
  /// Finds the entries of a row, whose block it is in.
  void locate(const CsrRows<float>& A, Index row);
  Index blockSize() const;

  std::vector<Place> places_; ///< #rows
};

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
