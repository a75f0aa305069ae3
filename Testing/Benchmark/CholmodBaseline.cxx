// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"
#include "Timing.h"

#include <cblas.h>
#include <cholmod.h>

#include <stdexcept>

namespace benchmark
{
namespace
{
/// Owns CHOLMOD's workspace and everything allocated through it.
struct Session
{
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;
  cholmod_dense* workY = nullptr;
  cholmod_dense* workE = nullptr;

  Session()
  {
    cholmod_start(&this->common);
    this->common.supernodal = CHOLMOD_SUPERNODAL;
    this->common.nmethods = 1;
    this->common.method[0].ordering = CHOLMOD_METIS;
    this->common.postorder = true;
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session()
  {
    cholmod_free_dense(&this->workE, &this->common);
    cholmod_free_dense(&this->workY, &this->common);
    cholmod_free_dense(&this->solution, &this->common);
    cholmod_free_factor(&this->factor, &this->common);
    cholmod_finish(&this->common);
  }

  void require(bool done, const char* step) const
  {
    if (!done || this->common.status != CHOLMOD_OK)
    {
      throw std::runtime_error(std::string("CHOLMOD: ") + step + " failed with status " +
                               std::to_string(this->common.status) + ".");
    }
  }

  void solve(cholmod_dense& rightHandSide)
  {
    this->require(cholmod_solve2(CHOLMOD_A, this->factor, &rightHandSide, nullptr, &this->solution,
                    nullptr, &this->workY, &this->workE, &this->common) != 0,
      "the solution");
  }
};
}

DirectResult solveByCholmod(const LinearSystem& system)
{
  // Rows of a symmetric matrix are its columns, so the arrays serve as they are. CHOLMOD does not
  // write to them.
  const morph::CsrMatrix& matrix = system.matrix;
  const auto n = static_cast<std::size_t>(matrix.rows());
  cholmod_sparse a = {};
  a.nrow = n;
  a.ncol = n;
  a.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  a.p = const_cast<int*>(matrix.outerIndexPtr());
  a.i = const_cast<int*>(matrix.innerIndexPtr());
  a.x = const_cast<double*>(matrix.valuePtr());
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = false;
  a.packed = true;

  Eigen::MatrixXd columns = system.rightHandSide;
  cholmod_dense b = {};
  b.nrow = n;
  b.ncol = 3;
  b.nzmax = 3 * n;
  b.d = n;
  b.x = columns.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;

  Session session;
  DirectResult result;
  const Stopwatch cold;
  session.factor = cholmod_analyze(&a, &session.common);
  session.require(session.factor != nullptr, "the analysis");
  session.require(cholmod_factorize(&a, session.factor, &session.common) != 0, "the factorisation");
  session.solve(b);
  result.coldSeconds = cold.seconds();

  const Stopwatch warm;
  session.solve(b);
  result.solveSeconds = warm.seconds();

  if (!session.factor->is_super || !session.factor->is_ll ||
      session.factor->ordering != CHOLMOD_METIS)
  {
    throw std::runtime_error("CHOLMOD did not take the supernodal LLT with METIS' ordering.");
  }
  result.factorBytes = sizeof(double) * static_cast<double>(session.factor->xsize);
  result.x =
    Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(session.solution->x), n, 3);
  return result;
}

std::string blasDescription()
{
  return std::string(openblas_get_config()) + ", " + std::to_string(openblas_get_num_threads()) +
         " threads";
}
}
