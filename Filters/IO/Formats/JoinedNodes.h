// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

namespace morph::io
{
/// Finds nodes that several parts of a mesh have at the very same position, each part its own.
/// `coordinates`: 3 for each node; `parts`: of each node, negative for a node that stays alone.
/// Returns for each node the first one of those that are one with it, or itself. Nodes of one part
/// are never joined. Time: a sort of the nodes.
std::vector<Index> joinedNodes(
  const std::vector<double>& coordinates, const std::vector<Index>& parts);
}
