// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/SpdSolver.h"

#include <vector>

namespace morph
{
/// Solves A X = B as SpdSolver does, after static condensation: rows that keep the matrix sparse
/// are eliminated first. Suited to nodes that lie inside a cell or a face and have few neighbors.
///
/// Rows are eliminated in stages. No two rows of a stage are coupled, so that their block of A is
/// diagonal, D. The others keep A_kk - A_kr D^-1 A_rk. A row is eliminated if it couples at most 16
/// others, and adds at most 16 entries more than it removes. A stage has an eighth of the rows or
/// more.
class CondensedSolver
{
public:
  /// Takes over `matrix` and leaves it empty. `removable`: one flag a row; none: no row is.
  /// `coordinates`: #rows x 3. Throws as SpdSolver::prepare() does, with the rows of `matrix`.
  /// Cost: that of SpdSolver::prepare() for the remaining rows, and a pass over A for each of at
  /// most four stages.
  void prepare(CsrMatrix& matrix, const std::vector<bool>& removable,
    const ConstPoints& coordinates, Monitor& monitor);

  /// As SpdSolver::solve(), for all rows. The tolerance is that of the remaining system.
  ///@{
  SolveReport solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;
  SolveReport solve(const MultiVector& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const;
  ///@}

  /// The solver of the remaining rows: all, in the order of `matrix`, where none was eliminated.
  const SpdSolver& remaining() const { return this->solver_; }
  /// The components of the whole matrix.
  const RowComponents& components() const;
  /// Returns the bytes that prepare() keeps.
  std::size_t memory() const;

private:
  struct Stage
  {
    std::vector<int> kept, removed; ///< rows of the stage's matrix, ascending
    Eigen::ArrayXd inverse;         ///< D^-1
    CsrMatrix coupling;             ///< A_rk, #removed x #kept
    CsrMatrix transposed;           ///< A_kr
  };
  /// Chooses the rows to remove; empty where there are none.
  static std::vector<int> choose(const CsrMatrix& matrix, const std::vector<bool>& removable);
  /// Replaces `matrix` by that of the other rows.
  static Stage condense(CsrMatrix& matrix, const std::vector<int>& removed, Monitor& monitor);

  std::vector<Stage> stages_;
  RowComponents components_; ///< where there are stages
  SpdSolver solver_;
};
}
