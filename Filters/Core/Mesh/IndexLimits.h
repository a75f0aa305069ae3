// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

namespace morph
{
/// The counts of a mesh that the methods store in 32 bits.
struct MeshCounts
{
  Index nodes = 0;
  Index cells = 0;
  Index corners = 0; ///< of all cells, including mid-side nodes
};

/// Throws Error where a count is 2^31 - 2^20 or more. The methods keep half of their tables in
/// 32-bit numbers and pad batches of cells. requireEntries() checks the entries of matrices when
/// they are made.
void requireIndexable(const MeshCounts& counts);
void requireIndexable(const Mesh& mesh);
}
