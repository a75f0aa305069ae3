// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FemWarp.h"
#include "TwistedBrick.h"

namespace benchmark
{
/// The system that FEMWARP solves for one problem: A_I U_I = -A_B U_B, in displacements. Refers to the morpher it
/// was made from.
struct LinearSystem
{
  const morph::SparseMatrix& matrix; ///< #free x #free
  morph::Points rightHandSide;       ///< #free x 3
};
LinearSystem linearSystem(const morph::FemWarp& femWarp, const Problem& problem);

/// Displacements of the free nodes, #free x 3, from the moved mesh.
morph::Points freeDisplacement(const Problem& problem, const morph::Points& moved);

/// Largest over the three columns of |b - A x| / |b|, recomputed from the matrix.
double relativeResidual(const LinearSystem& system, const morph::Points& x);
}
