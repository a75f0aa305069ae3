// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"
#include "Timing.h"

#include <klu.h>

#include <stdexcept>

namespace benchmark
{
namespace
{
/// Owns what KLU allocates.
struct Session
{
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

  Session() { klu_defaults(&this->common); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session()
  {
    klu_free_numeric(&this->numeric, &this->common);
    klu_free_symbolic(&this->symbolic, &this->common);
  }

  void require(bool done, const char* step) const
  {
    if (!done || this->common.status != KLU_OK)
    {
      throw std::runtime_error(std::string("KLU: ") + step + " failed with status " +
                               std::to_string(this->common.status) + ".");
    }
  }

  void solve(Eigen::MatrixXd& columns)
  {
    const auto n = static_cast<int>(columns.rows());
    this->require(klu_tsolve(this->symbolic, this->numeric, n, static_cast<int>(columns.cols()),
                    columns.data(), &this->common) != 0,
      "the solution");
  }
};
}

DirectResult solveByKlu(const LinearSystem& system)
{
  // KLU reads columns: it gets the transpose, and solves with the transpose of that. It does not write to the arrays.
  const morph::SparseMatrix& matrix = system.matrix;
  auto* columnStart = const_cast<int*>(matrix.outerIndexPtr());
  auto* row = const_cast<int*>(matrix.innerIndexPtr());
  auto* value = const_cast<double*>(matrix.valuePtr());
  Eigen::MatrixXd columns = system.rightHandSide;

  Session session;
  DirectResult result;
  const Stopwatch cold;
  session.symbolic =
    klu_analyze(static_cast<int>(matrix.rows()), columnStart, row, &session.common);
  session.require(session.symbolic != nullptr, "the analysis");
  session.numeric = klu_factor(columnStart, row, value, session.symbolic, &session.common);
  session.require(session.numeric != nullptr, "the factorisation");
  session.solve(columns);
  result.coldSeconds = cold.seconds();
  result.x = columns;

  columns = system.rightHandSide;
  const Stopwatch warm;
  session.solve(columns);
  result.solveSeconds = warm.seconds();
  result.factorBytes =
    sizeof(double) * (static_cast<double>(session.numeric->lnz) + session.numeric->unz);
  return result;
}
}
