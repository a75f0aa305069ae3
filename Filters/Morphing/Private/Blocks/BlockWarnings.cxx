// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockWarnings.h"

#include <algorithm>

namespace morph::filters::BlockWarnings
{
std::string Contradiction(morph::Index id)
{
  return "The blocks' global ids do not number one mesh: points with the id " + std::to_string(id) +
         " are at different positions. Points of blocks are one node where their positions are "
         "equal.";
}

std::string Coinciding(morph::Index count)
{
  return std::to_string(count) +
         " points are at the place of another block's, with other global ids, and stay apart from "
         "them as bodies in contact do. If the blocks are one body, set `CoincidentPoints` to "
         "merge "
         "by position.";
}

std::string Missing(const std::string& block, morph::Index missing, morph::Index points)
{
  return block + ": " + std::to_string(missing) + " of its " + std::to_string(points) +
         " points are on no node of the mesh, and stay where they are.";
}

std::string Unchanged(const std::vector<std::string>& blocks)
{
  constexpr std::size_t Most = 5;
  if (blocks.empty())
  {
    return {};
  }
  std::string text = std::to_string(blocks.size()) +
                     (blocks.size() == 1 ? " block has no point" : " blocks have no point") +
                     " on a node of the mesh, and pass unchanged: ";
  for (std::size_t i = 0; i < std::min(blocks.size(), Most); ++i)
  {
    text += (i > 0 ? ", " : "") + blocks[i];
  }
  return text + (blocks.size() > Most ? ", ..." : ".");
}
}
