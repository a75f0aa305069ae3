// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cstdint>
#include <optional>
#include <vector>

namespace morph
{
/// Smoothed-aggregation multigrid (Vanek, Mandel, Brezina, Computing 56 (1996) 179-196) as a
/// preconditioner for three right-hand sides at once, in single precision: it only steers the
/// iteration, and half the bytes are half the time. One V-cycle with Chebyshev smoothing, symmetric
/// for a symmetric matrix.
///
/// A matrix that is not symmetric is coarsened as it is, P^T A P. On log-barrier weights that gave
/// 4 BiCGSTAB iterations where a hierarchy of the symmetrised matrix took 4 to 9, and 7 where it
/// took 13 on a mesh graded 1.6 times a layer.
///
/// Nodes are grouped by nearness (1 / distance^2 against the nearest neighbor), not by the size of
/// the matrix entries: a trilinear hexahedron has no entry between nodes that share an edge, and
/// stretched cells still coarsen along their short side first.
class Multigrid
{
public:
  /// Three values and a zero: one SSE register a node.
  using Vector = std::vector<Eigen::Vector4f>;

  enum class Symmetry
  {
    Symmetric, ///< and positive definite
    General    ///< close to an M-matrix
  };

  /// `matrix` must outlive this object and stay where it is: the finest level reads its structure.
  /// It is divided by `unit`, its largest diagonal entry: the unit of length must not show, and
  /// single precision ends at 1e38.
  void prepare(const CsrMatrix& matrix, Symmetry symmetry, double unit,
    const ConstPoints& coordinates, Monitor& monitor);
  /// The transpose of `other`, which must outlive this object and stay where it is.
  void prepareTransposed(const Multigrid& other);

  /// Vectors of all levels, one set per concurrent solve.
  class Workspace
  {
  public:
    explicit Workspace(const Multigrid& multigrid);

  private:
    friend class Multigrid;
    struct Level
    {
      Vector rhs, x, direction, spare;
    };
    std::vector<Level> levels_;
  };

  /// x = B rhs, B fixed; symmetric positive definite for Symmetry::Symmetric.
  void apply(const Vector& rhs, Vector& x, Workspace& workspace, Monitor& monitor) const;

  int numberOfLevels() const { return static_cast<int>(this->levels_.size()); }
  /// Bytes kept by prepare(), those of a Workspace included.
  std::size_t memory() const;
  /// Bytes that one apply() moves when nothing stays in cache.
  double bytesMoved() const;

private:
  /// Compressed rows; structure and values may be another matrix's.
  template <typename Scalar>
  struct Rows
  {
    using Values = Eigen::Array<Scalar, Eigen::Dynamic, 1>;
    int rows = 0;
    const int* start = nullptr;
    const int* column = nullptr;
    const Scalar* value = nullptr;
    std::vector<int> ownStart;
    // Eigen's arrays are not initialised: each thread is the first to touch its part.
    Eigen::ArrayXi ownColumn;
    Values ownValue;

    std::size_t entries() const { return this->start ? this->start[this->rows] : 0; }
    void adopt() ///< points at the own arrays
    {
      this->start = this->ownStart.data();
      this->column = this->ownColumn.data();
      this->value = this->ownValue.data();
    }
  };
  using Matrix = Rows<float>; ///< what a cycle reads
  /// what the next level is made from: next to slivers float would cancel to nothing
  using ExactMatrix = Rows<double>;

  struct Level
  {
    Matrix A;
    Matrix P, R; ///< prolongation to this level from the next, and its transpose
    std::vector<float> inverseDiagonal;
    float eigenvalue = 0; ///< largest of D^-1 A, see largestEigenvalue()
  };

  /// The largest eigenvalue of D^-1 A by ten Lanczos steps, times 1.1, and no more than the largest
  /// row sum, which bounds every eigenvalue. Lanczos comes from below, so this is an estimate: the
  /// smoother damps all eigenvalues up to 1.25 times what it is given. For Symmetry::General the
  /// recurrence is that of a symmetric matrix all the same, and the row sums alone are a bound.
  static float largestEigenvalue(const Level& level, Monitor& monitor);
  /// For each matrix entry, whether its column is a near neighbor of its row.
  static std::vector<std::uint8_t> nearNeighbors(
    const Matrix& A, const Points& coordinates, Monitor& monitor);
  /// Aggregate of every row; returns their number.
  static int aggregate(const Matrix& A, const Points& coordinates,
    const std::vector<std::uint8_t>& near, std::vector<int>& group);
  static Matrix prolongation(const Level& level, const std::vector<std::uint8_t>& near,
    const std::vector<int>& group, int groups, Monitor& monitor);
  static Matrix transpose(const Matrix& A, int columns);
  template <typename ScalarA, typename ScalarB>
  static ExactMatrix product(
    const Rows<ScalarA>& A, const Rows<ScalarB>& B, int columns, Monitor& monitor);
  /// Appends the level of `exact`, divided by `unit`, and takes its structure over. False, and no
  /// level, where the diagonal is not positive and finite.
  bool addLevel(ExactMatrix& exact, double unit, Monitor& monitor);
  void factorizeCoarsest(const ExactMatrix& exact, Symmetry symmetry, double unit);
  bool solveCoarsest(const Vector& rhs, Vector& x) const;
  std::size_t coarsestBytes() const;

  void cycle(std::size_t k, const Vector& rhs, Vector& x, Workspace& workspace, Monitor&) const;
  void smooth(const Level& level, const Vector& rhs, bool fromZero, Vector& x,
    Workspace::Level& work, Monitor& monitor) const;

  std::vector<Level> levels_;
  // Factors of the last level, by symmetry; without either the smoother serves there.
  std::optional<Eigen::LLT<Eigen::MatrixXd>> symmetricCoarsest_;
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> generalCoarsest_;
};
}
