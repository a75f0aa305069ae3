// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// Eigen's direct solutions, to compare with. They are compiled once, since their templates take
/// seconds in every source that has them.
namespace direct
{
/// Returns the solution of A x = b. `A`: n x n, regular; `b`: n x k. LU decomposition.
///@{
Eigen::MatrixXd solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);
Eigen::MatrixXd solve(const Eigen::SparseMatrix<double>& A, const Eigen::MatrixXd& b);
///@}

/// Returns the x of least norm among those that minimize |A x - b|. `A`: m x n; `b`: m x k.
/// `threshold`: columns below it, relative to the largest pivot, count as dependent.
Eigen::MatrixXd leastSquares(
  const Eigen::MatrixXd& A, const Eigen::MatrixXd& b, double threshold = 1e-12);

/// Returns A b.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);
}
