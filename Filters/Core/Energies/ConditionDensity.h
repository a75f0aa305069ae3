// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph
{
/// The condition number of a map's Jacobian J, over 3: from 1 for a rotation upwards,
///
///   kappa(J) = |J| |J^-1| / 3 = |J| |cof J| / (3 det J),
///
/// with Frobenius norms. It is a barrier: infinite where det J is not positive. It does not depend
/// on the size of J. As J becomes flat it grows as 1 / det, and the inverse mean ratio as
/// det^(-2/3) alone, so it pays more for the worst cells. Source: L. A. Freitag, P. M. Knupp,
/// "Tetrahedral mesh improvement via optimization of the element condition number", Int. J. Numer.
/// Meth. Engng 53 (2002) 1377-1391.
struct ConditionDensity
{
};
}
