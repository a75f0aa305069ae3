// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/MeshEnergy.h"
#include "Optimization/Minimizers.h"

namespace morph
{
/// Minimizes a mesh's foldover-free energy by continuation in its regularisation, until no
/// tetrahedron is inverted. Source: Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv
/// 2102.03069. It ends after stages without progress, which soon ends it if the boundary admits no
/// valid mesh. Progress means fewer inverted tetrahedra, or a minimum determinant raised by 5 %.
/// `preconditioner`: for Newton's linear systems, by the rows of `energy`; null: none. `points`:
/// #nodes x 3, start and result. `effort`: added to. Returns whether all tetrahedra are positive.
bool minimizeFoldover(MeshEnergy& energy, const NodePreconditioner* preconditioner, Points& points,
  MinimizerEffort& effort, Monitor& monitor);
}
