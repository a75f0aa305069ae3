// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearSystem.h"

#include <optional>

namespace benchmark
{
/// What a direct solver took for a system with three right-hand sides.
struct DirectResult
{
  double coldSeconds = 0;  ///< ordering, factorisation and solution
  double solveSeconds = 0; ///< solution with the factors at hand
  double factorBytes = 0;  ///< values of the factors
  morph::Points x;
};

/// Supernodal Cholesky factorisation L L^T, METIS ordering, on OpenBLAS with its default threads
/// (all cores). Throws std::runtime_error if the factorisation fails.
DirectResult solveByCholmod(const LinearSystem& system);

/// KLU with its default options, as in the measurements of Staten et al.; the matrix need not be
/// symmetric. Nothing where it takes more than `limit` seconds: it works in a child process, which
/// is ended then. Throws std::runtime_error if it fails.
std::optional<DirectResult> solveByKlu(const LinearSystem& system, double limit);

struct IterativeResult
{
  double seconds = 0;
  int iterations = 0; ///< summed over the three columns
  morph::Points x;
};

/// Plain conjugate gradients, diagonal preconditioner, column after column on one thread. Throws
/// std::runtime_error if a column does not reach the relative residual `tolerance`.
IterativeResult solveByJacobiCg(const LinearSystem& system, double tolerance);

/// Log-barrier weights of one node by Newton's method in three unknowns, whitened, written with
/// Eigen's matrices. `offsets`: from the node to its neighbors, k x 3.
Eigen::VectorXd weightsByEigen(const morph::Points& offsets);

/// "OpenBLAS 0.3.21 ..., 2 threads": the library that CHOLMOD's dense kernels run on.
std::string blasDescription();
}
