// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Solvers/CsrMatrix.h"
#include "Solvers/SolveReport.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// Solves A X = B with rows distributed over ranks, by hypre: conjugate gradients for a symmetric
/// positive definite matrix, BiCGSTAB for any other, both preconditioned by one V-cycle of
/// BoomerAMG. Source: Henson and Yang, Applied Numerical Mathematics 41 (2002) 155-177.
class HypreSolver
{
public:
  enum class Kind
  {
    Symmetric, ///< and positive definite
    General
  };

  HypreSolver();
  ~HypreSolver();

  /// Copies the matrix and sets up the preconditioner. `own`: #rows x #rows, the columns of this
  /// rank's unknowns; `ghosts`: #rows x #ghosts, those of other ranks' unknowns, whose global
  /// numbers are `ghostNumbers`. The rows of all ranks are numbered rank by rank. Throws Error on
  /// all ranks where there are more unknowns than hypre's integers hold. Collective.
  void prepare(const Ranks& ranks, Kind kind, const CsrMatrix& own, const CsrMatrix& ghosts,
    const std::vector<std::int64_t>& ghostNumbers);

  /// Solves for three right-hand sides, #rows x 3, from the guess `x`, until each residual is below
  /// `tolerance` times |b| (Euclidean norms). Throws Error on all ranks where `maxIterations` are
  /// too few. A right-hand side of zeros gives zeros. Collective.
  SolveReport solve(
    const Ranks& ranks, const Points& rhs, Points& x, double tolerance, int maxIterations) const;

  /// Returns A x, #rows x 3. Collective.
  Points product(const Ranks& ranks, const Points& x) const;
  /// Returns what one V-cycle makes of each column of residuals, #rows x 3. Collective.
  Points precondition(const Ranks& ranks, const Points& residual) const;

  /// Returns a solver of the transposed matrix, prepared. Collective. Cost: messages of the
  /// entries in other ranks' columns, and prepare().
  std::unique_ptr<HypreSolver> transposed(const Ranks& ranks) const;

  /// Wall-clock seconds in hypre since construction, for benchmarks.
  struct Seconds
  {
    double setUp = 0, solve = 0;
  };
  const Seconds& seconds() const { return this->seconds_; }

  /// The number of unknowns that hypre's integers can number.
  static std::int64_t mostUnknowns();
  /// Returns the sum of `rows` over the ranks. Throws Error on all of them where that is more than
  /// mostUnknowns(). Collective.
  static std::int64_t countUnknowns(const Ranks& ranks, std::int64_t rows);
  /// The number of unknowns of all ranks.
  std::int64_t unknowns() const { return this->unknowns_; }

private:
  struct Handles;
  /// Calls action(column, result), vectors of hypre, for each column.
  template <typename Action>
  Points byColumns(const Ranks& ranks, const Points& columns, const Action& action) const;

  std::unique_ptr<Handles> handles_;
  mutable Seconds seconds_;
  std::int64_t rows_ = 0, first_ = 0, unknowns_ = 0;
};
}
