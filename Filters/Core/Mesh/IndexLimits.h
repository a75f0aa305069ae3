// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

namespace morph
{
/// Throws Error where a count is 2^31 - 2^20 or more. The methods keep half of their tables in
/// 32-bit numbers and pad batches of cells. requireEntries() checks the entries of matrices when
/// they are made. `corners`: of all cells, including mid-side nodes.
void requireIndexable(Index nodes, Index cells, Index corners);
void requireIndexable(const Mesh& mesh);
}
