// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrRows.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The degree of the smoother's polynomial; each degree takes one pass over the matrix.
constexpr int ChebyshevDegree = 2;

/// Estimates the largest eigenvalue of D^-1 A by ten Lanczos steps, times 1.1. The result is at
/// most the largest row sum, which bounds every eigenvalue. Lanczos converges from below, so this
/// is no bound; the smoother damps all eigenvalues up to 1.25 times its argument. For a matrix that
/// is not symmetric the recurrence is the same, and only the row sums are a bound.
float largestEigenvalue(
  const CsrRows<float>& A, const std::vector<float>& inverseDiagonal, Monitor& monitor);

/// Smooths A x = rhs by a Chebyshev polynomial of D^-1 A over [largest / 4, largest]. It is a fixed
/// linear map, so a cycle stays symmetric. `fromZero`: takes x as 0. `largest`: see
/// largestEigenvalue(). `direction`, `spare`: work vectors of #rows. Cost: a pass over the matrix a
/// degree, one fewer from zero.
void chebyshevSmooth(const CsrRows<float>& A, const std::vector<float>& inverseDiagonal,
  float largest, const FloatMultiVector& rhs, bool fromZero, FloatMultiVector& x,
  FloatMultiVector& direction, FloatMultiVector& spare, Monitor& monitor);
}
