// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Morph/BoundaryMatch.h"

#include <vtkType.h>

#include <cstdint>
#include <functional>
#include <vector>

class vtkDoubleArray;
class vtkPointSet;

namespace morph::distributed
{
class DistributedMesh;
class Ranks;
}

/// Matches the points of a boundary, wherever they are, to the nodes of a distributed mesh.
namespace morph::filters::RankMatch
{
/// BoundaryMatch::Match() on all MPI processes. `boundary`: the points on this process, perhaps
/// none. All processes get all of them, 120 bytes a point, and find their nodes; ids are global. Of
/// BoundaryMatch::Match()'s ways to find nodes it has BoundaryIdArray, MorphPointId, a moved copy
/// of each process's piece, and positions. Returns the prescribed nodes of the local mesh, as their
/// owners have them; Sources has 0 for a node that a point names, -1 for one that is held.
/// Collective.
///
/// `followers`: null, or becomes the points that the nodes of this process follow: for each process
/// with such a point the first of them.
morph::BoundaryTargets Match(vtkPointSet* boundary, const morph::distributed::DistributedMesh& mesh,
  const BoundaryMatch::Options& options, std::vector<BoundaryMatch::Follower>* followers);

/// Sums the derivatives of prescribed nodes for each boundary point, as Gradient::Gather() does.
/// `ids`: of Result, `prescribed`: #ids x 3. `points`: of the boundary on this process. Collective.
void SendBack(const morph::distributed::Ranks& ranks, const std::vector<morph::Index>& ids,
  const morph::Points& prescribed, const std::vector<BoundaryMatch::Follower>& followers,
  vtkIdType points, vtkDoubleArray* result);

/// The points of a boundary of all processes, the same on each of them.
struct Gathered
{
  /// Pairs of a point and its node's global id, which some process has; none where ByPosition.
  morph::NamedPoints Points;
  Precision PointPrecision; ///< of all processes' points, as ReadPoints() gives it
  bool ByPosition = false;
};
/// Where points may find their nodes.
struct Nodes
{
  const morph::Mesh& Rest;
  const morph::BoundaryFaces& Outer;                   ///< nodes and what is between them alone
  double Size;                                         ///< of the whole mesh
  const std::vector<std::int64_t>& Ids;                ///< #nodes, global
  std::function<morph::Index(std::int64_t id)> NodeOf; ///< or -1
};
/// findTargets() of the points that find one of these nodes, whose pairs `all` has then. `rounded`:
/// becomes the number that TakeBackRounding() gives.
morph::BoundaryTargets TargetsOf(
  Gathered& all, const Nodes& nodes, const BoundaryMatch::Options& options, morph::Index& rounded);
/// Gathers the boundary. It finds ids as Match() does, and throws as that does. 120 bytes a point.
/// Collective.
Gathered Gather(vtkPointSet* boundary, const morph::distributed::DistributedMesh& mesh,
  const BoundaryMatch::Options& options);
}
