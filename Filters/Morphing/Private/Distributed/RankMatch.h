// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Morph/BoundaryMatch.h"

class vtkPointSet;

namespace morph::distributed
{
class DistributedMesh;
}

/// Matches the points of a boundary, wherever they are, to the nodes of a distributed mesh.
namespace morph::filters::RankMatch
{
/// BoundaryMatch::Match() on all MPI processes. `boundary`: the points on this process, perhaps
/// none. The points go to the processes that have their nodes; ids are global. Of
/// BoundaryMatch::Match()'s ways to find nodes it has BoundaryIdArray, MorphPointId, a moved copy
/// of each process's piece, and positions. Returns the prescribed nodes of the local mesh, as their
/// owners have them; Sources is empty. Collective.
BoundaryMatch::Result Match(vtkPointSet* boundary, const morph::distributed::DistributedMesh& mesh,
  const BoundaryMatch::Options& options);

/// The points of a boundary of all processes, the same on each of them.
struct Gathered
{
  /// Pairs of a point and its node's global id, which some process has; none where ByPosition.
  BoundaryMatch::NamedPoints Points;
  bool ByPosition = false;
};
/// Gathers the boundary. It finds ids as Match() does, and throws as that does. 120 bytes a point.
/// Collective.
Gathered Gather(vtkPointSet* boundary, const morph::distributed::DistributedMesh& mesh,
  const BoundaryMatch::Options& options);
}
