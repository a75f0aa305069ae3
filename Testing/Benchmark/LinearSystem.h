// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TwistedBrick.h"

#include "Solvers/CsrMatrix.h"

namespace benchmark
{
/// The system that FEMWARP or LBWARP solves for one problem: A_I U_I = -A_B U_B, in displacements.
struct LinearSystem
{
  morph::CsrMatrix matrix;     ///< #free x #free
  morph::Points rightHandSide; ///< #free x 3
};

/// Displacements of the prescribed nodes, #prescribed x 3.
morph::Points prescribedDisplacement(const Problem& problem);

template <typename Method>
LinearSystem linearSystem(const Method& method, const Problem& problem)
{
  return { method.solver().matrix(), -(method.coupling() * prescribedDisplacement(problem)) };
}

/// Displacements of these nodes, #ids x 3, from the moved mesh.
morph::Points displacement(
  const Problem& problem, const std::vector<morph::Index>& ids, const morph::Points& moved);

/// What the method found for the unknowns of its linearSystem(), #free x 3.
template <typename Method>
morph::Points solution(const Method& method, const Problem& problem, const morph::Points& moved)
{
  return displacement(problem, method.rows(), moved);
}

/// Largest over the three columns of |b - A x| / |b|, recomputed from the matrix. |b| is that of a
/// column, but at least 1e-4 of the whole.
double relativeResidual(const LinearSystem& system, const morph::Points& x);
}
