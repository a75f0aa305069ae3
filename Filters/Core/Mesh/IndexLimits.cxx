// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/IndexLimits.h"

#include "Support/Error.h"

#include <string>

namespace morph
{
void requireIndexable(Index nodes, Index cells, Index corners)
{
  constexpr Index Limit = (Index(1) << 31) - (Index(1) << 20);
  const auto require = [](Index count, const char* of)
  {
    if (count >= Limit)
    {
      throw Error("The mesh is too large: it has " + std::to_string(count) + " " + of +
                  ", and the methods can number fewer than " + std::to_string(Limit) +
                  ". Morph it in parts.");
    }
  };
  require(nodes, "nodes");
  require(cells, "cells");
  require(corners, "corners of cells");
}

void requireIndexable(const Mesh& mesh)
{
  requireIndexable(
    mesh.numberOfNodes(), mesh.numberOfCells(), static_cast<Index>(mesh.connectivity.size()));
}
}
