// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"
#include "Timing.h"

#include <Eigen/IterativeLinearSolvers>

#include <stdexcept>

namespace benchmark
{
IterativeResult solveByJacobiCg(const LinearSystem& system, double tolerance)
{
  const Eigen::MatrixXd columns = system.rightHandSide;
  Eigen::MatrixXd x(columns.rows(), columns.cols());
  IterativeResult result;
  const Stopwatch watch;
  Eigen::ConjugateGradient<morph::CsrMatrix, Eigen::Lower | Eigen::Upper,
    Eigen::DiagonalPreconditioner<double>>
    gradients(system.matrix);
  gradients.setTolerance(tolerance);
  for (int c = 0; c < columns.cols(); ++c)
  {
    x.col(c) = gradients.solve(columns.col(c));
    result.iterations += static_cast<int>(gradients.iterations());
    if (gradients.info() != Eigen::Success)
    {
      throw std::runtime_error("Jacobi-preconditioned conjugate gradients did not converge.");
    }
  }
  result.seconds = watch.seconds();
  result.x = x;
  return result;
}
}
