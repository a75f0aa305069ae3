// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// morph::findWallLayers() of a distributed mesh: the same columns. `isWall`: of mesh.outerFaces().
/// `isLayer`: of the piece's cells, the only ones that count; none: all. Returns for each local
/// node the global id of the wall node whose column it is in, or -1. Collective. Cost: a pass over
/// the cells; for each layer four exchanges of interface nodes, and 48 bytes on every rank for each
/// face of the layer where it enters another rank.
std::vector<std::int64_t> findWallLayers(const DistributedMesh& mesh,
  const std::vector<std::uint8_t>& isWall, Index most, std::vector<std::uint8_t> isLayer);
}
