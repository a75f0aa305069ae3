// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph
{
/// The highest degree of a polynomial here.
constexpr int MostPolynomialDegree = 6;

/// Returns the first root of a polynomial in (0, infinity), a lower bound of it within `precision`
/// of it, or infinity where the polynomial is positive throughout. 0 if its value at 0 is not
/// positive, or a coefficient is not finite. `a`: degree + 1 coefficients, that of power 0 first. A
/// place where the polynomial only touches zero counts as a root. Isolates the root by subdividing
/// the Bernstein form on [0, infinity), u = t / (unit + t) (de Casteljau), the unit being a lower
/// bound of the roots. Cost: some hundred operations.
double firstPositiveRoot(const double* a, int degree, double precision = 1e-12);

/// Whether the polynomial is certainly positive on [0, `last`]: its Bernstein coefficients there
/// are. False proves nothing. `last`: positive, finite or not.
bool isPositiveUntil(const double* a, int degree, double last);
}
