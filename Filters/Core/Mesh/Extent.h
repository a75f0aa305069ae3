// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Numbers between these bounds have sixth powers that neither overflow nor vanish.
constexpr double LargestLength = 1e50, SmallestLength = 1e-50;

/// Whether `x` is finite and not above LargestLength.
bool isModerate(const Eigen::RowVector3d& x);
/// The rows of `x` that are not moderate. `monitor`: has the threads for it, null for none.
std::vector<Index> immoderateRows(const Points& x, Monitor* monitor = nullptr);

/// The diagonal of the bounding box of the nodes that volume cells use.
double meshSize(const Mesh& mesh);
/// Throws Error unless `size` is 0 or at least SmallestLength. `size`: the largest side of a
/// bounding box; `subject`: what it bounds.
void requireExtent(double size, const char* subject);
/// Throws Error unless there are cells of dimension 3, and meshSize() is not too small. All types
/// have to be known to the core.
void requireVolumeCells(const Mesh& mesh);
}
