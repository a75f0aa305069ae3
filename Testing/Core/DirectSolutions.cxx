// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseLU>

namespace direct
{
Eigen::MatrixXd solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b)
{
  return A.partialPivLu().solve(b);
}

Eigen::MatrixXd solve(const Eigen::SparseMatrix<double>& A, const Eigen::MatrixXd& b)
{
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(A);
  return lu.solve(b);
}

Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b, double threshold)
{
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal;
  orthogonal.setThreshold(threshold);
  orthogonal.compute(A);
  return orthogonal.solve(b);
}

Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b)
{
  return A * b;
}
}
