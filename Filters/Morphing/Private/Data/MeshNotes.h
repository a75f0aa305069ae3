// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <vector>

/// Warnings of a mesh, the same for each filter, and on several MPI processes.
namespace morph::filters::MeshNotes
{
/// Of cells that are there twice, and of nodes where bodies touch; see SharedCorners.h. Ids are
/// those of the whole mesh, ascending.
void WarnOfShared(const std::vector<morph::Index>& repeatedCells,
  const std::vector<morph::Index>& touchingNodes, morph::Monitor& monitor);
/// Of nodes of shells, beams or links that hang on nothing; see AttachedNodes.h. Ids as above.
void WarnOfLoose(const std::vector<morph::Index>& nodes, morph::Monitor& monitor);
}
