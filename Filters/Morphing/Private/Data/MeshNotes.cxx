// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/MeshNotes.h"

#include "Support/Error.h"

#include <string>

namespace morph::filters::MeshNotes
{
void WarnOfShared(const std::vector<morph::Index>& repeatedCells,
  const std::vector<morph::Index>& touchingNodes, morph::Monitor& monitor)
{
  if (!repeatedCells.empty())
  {
    monitor.warn("Cells are there twice, which makes the mesh stiffer at one place, and its outer "
                 "faces wrong: cell ids " +
                 morph::listIds(repeatedCells) + ". Remove one of each.");
  }
  if (!touchingNodes.empty())
  {
    monitor.warn(std::to_string(touchingNodes.size()) +
                 " nodes belong to parts of the mesh that share no face there, and so move as one: "
                 "point ids " +
                 morph::listIds(touchingNodes) +
                 ". Give each part a node of its own if they only touch by chance.");
  }
}

void WarnOfLoose(const std::vector<morph::Index>& nodes, morph::Monitor& monitor)
{
  if (!nodes.empty())
  {
    monitor.warn(std::to_string(nodes.size()) +
                 " nodes stay: they belong to cells of lower dimension that share no node with a "
                 "volume cell, directly or by others of their kind. Point ids " +
                 morph::listIds(nodes) +
                 ". Give them nodes of the volume where they are attached to it.");
  }
}
}
