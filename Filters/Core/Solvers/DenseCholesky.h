// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <Eigen/Core>

namespace morph
{
using DenseMatrixRef = Eigen::Ref<Eigen::MatrixXd>;

/// Factorises a dense, symmetric positive definite matrix as L L^T, in place. Only the lower
/// triangle is read, and becomes L. Returns false if a pivot is not positive: the matrix is
/// then not positive definite, and its content undefined. Blocks have a fixed size, so the result
/// does not depend on threads. Cost: n^3 / 3 multiplications and additions, in parallel.
bool factorizeCholesky(DenseMatrixRef matrix, Monitor& monitor);

/// Solves L L^T X = B in place of B, with what factorizeCholesky() left. Cost: two passes over L.
void solveCholesky(const Eigen::Ref<const Eigen::MatrixXd>& factor, DenseMatrixRef b);
}
