// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"

#include "Mesh/Mesh.h"

namespace fuzz
{
/// `mesh` with mid-side nodes, and face and body nodes where `order` asks for them: 1 the quadratic
/// forms, 2 the largest forms there are, 3 the wedges that are linear along their axis, other cells
/// quadratic, 4 Lagrange or Bezier cells of order 2 or 3. `part`: of the cells that change.
morph::Mesh quadratic(const morph::Mesh& mesh, int order, double part, Random random);
}
