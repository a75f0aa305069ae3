// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <string>
#include <vector>

/// What users are told of blocks that are merged.
namespace morph::filters::BlockWarnings
{
/// `id`: a global id of points at different places.
std::string Contradiction(morph::Index id);
/// `count`: of points at the place of another block's with another id.
std::string Coinciding(morph::Index count);
/// `missing`: of the block's `points` that are on no node.
std::string Missing(const std::string& block, morph::Index missing, morph::Index points);
/// Empty where no block passes unchanged.
std::string Unchanged(const std::vector<std::string>& blocks);
}
