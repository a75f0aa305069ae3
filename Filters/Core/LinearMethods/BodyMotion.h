// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"

namespace morph
{
/// Moves the free nodes of each body by the affine map nearest to the motion of the body's
/// prescribed corners (AffineFit.h). Corners in a plane or on a line leave the map open across it:
/// a similarity fills it in, so rigid motions come out rigid. `displacement`: #prescribed x 3.
/// `points`: #nodes x 3, set at the free nodes to their places in `rest` plus the map's
/// displacement. A body whose prescribed corners all stay, or which has none, stays bit for bit.
/// Returns whether each prescribed corner moves as its body's map does, to 1e-9 of the mesh's size.
/// Cost: passes over the nodes.
bool followAffinely(
  const Mesh& rest, const NodePartition& partition, const Points& displacement, Points& points);
}
