// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Choices.h"

#include "Mesh/Mesh.h"

namespace fuzz
{
/// A small random volume mesh: all cell types, shapes from perfect to tangled, several bodies,
/// places far away and sizes out of bounds. Node ids are right and every cell has the nodes that
/// its type asks for.
morph::Mesh randomMesh(Choices& choices);

/// Nodes on faces that belong to one volume cell alone, mid-side and face nodes included,
/// ascending. Told by the nodes of VTK's own faces, so that it does not depend on what is tested.
std::vector<morph::Index> outerNodes(const morph::Mesh& mesh);
/// Nodes of volume cells, ascending.
std::vector<morph::Index> volumeNodes(const morph::Mesh& mesh);
/// Nodes that no volume cell uses but cells of dimension 1 or 2 do: in parts that such cells hold
/// together apart from volume nodes.
struct AttachedPart
{
  std::vector<morph::Index> nodes;   ///< ascending
  std::vector<morph::Index> anchors; ///< the volume nodes in their cells, ascending
};
std::vector<AttachedPart> attachedParts(const morph::Mesh& mesh);
/// Diagonal of the box of these nodes.
double meshSize(const morph::Mesh& mesh);
}
