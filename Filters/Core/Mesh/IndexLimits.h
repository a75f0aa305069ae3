// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

namespace morph
{
/// What of a mesh the methods number with 32 bits.
struct MeshCounts
{
  Index nodes = 0;
  Index cells = 0;
  Index corners = 0; ///< of all cells together, mid-side nodes included
};

/// Throws Error where a count is too large for the methods: from 2^31 - 2^20 on. They keep half of
/// their tables in 32-bit numbers, and fill up groups of cells. The entries of matrices are counted
/// when these are made, see requireEntries().
void requireIndexable(const MeshCounts& counts);
void requireIndexable(const Mesh& mesh);
}
