// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"

namespace morph
{
/// Moves each body's free nodes by the affine map that fits the motion of its prescribed corners
/// (AffineFit.h). If these lie in a plane or on a line, a similarity completes the map, so rigid
/// motions stay rigid. `bodies`: of the whole mesh. `displacement`: #prescribed x 3. `points`:
/// #nodes x 3; free nodes are set to their position in `rest` plus the map's displacement. A body
/// with fixed or no prescribed corners stays bit for bit. Returns whether every prescribed corner
/// moves as its body's map, to 1e-9 of the mesh's size or of the largest displacement. On several
/// processes `rest` has the cells of this one. Cost: passes over the nodes; 200 bytes a body.
bool followAffinely(const Mesh& rest, const ConnectedComponents& bodies,
  const NodePartition& partition, const Points& displacement, Points& points,
  const Communicator& communicator = Communicator::alone());
}
