// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/Precision.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

class vtkDataArray;
class vtkPointSet;

/// Matches the points of a displaced boundary to nodes of the undeformed mesh, and computes the
/// nodes' targets.
namespace morph::filters::BoundaryMatch
{
struct Options
{
  std::string BoundaryIdArray;   ///< empty: none
  std::string DisplacementArray; ///< empty: the boundary's points are the targets
  double ScaleFactor = 1;        ///< target = rest + ScaleFactor * (target - rest)
  double MatchTolerance = 1e-6;  ///< of the undeformed mesh's size
  bool FixUnnamedBoundary = true;
};

struct Result
{
  std::vector<morph::Index> Ids;     ///< sorted, unique
  morph::Points Targets;             ///< #Ids x 3, finite
  std::vector<morph::Index> Sources; ///< #Ids, the boundary point that a node follows, -1: held
  std::vector<std::string> Warnings;

  // Numbers that Conclude() judges. On several MPI ranks they are summed first.
  morph::Index Points = 0;    ///< of the boundary
  morph::Index Unmatched = 0; ///< boundary points that stand for no node
  morph::Index Valueless = 0; ///< boundary points that have no displacement
  morph::Index Freed = 0;     ///< points that are free
  morph::Index Following = 0; ///< points that are not
  morph::Index Staying = 0;   ///< nodes in Ids whose target is their place
  morph::Index Open = 0;      ///< corners of outer faces that are not in Ids
  morph::Index Rounded = 0;   ///< coordinates that differ by their rounding alone
  Precision PointPrecision;   ///< of the boundary
};

/// The points of a boundary that stand for nodes.
struct NamedPoints
{
  /// Point and node, in the order of the points; a node may come up again.
  std::vector<std::pair<morph::Index, morph::Index>> Pairs;
  morph::Points Positions;          ///< #points x 3
  morph::Points Rest;               ///< #points x 3, or no rows: unknown
  morph::Points Displacements;      ///< #points x 3, or no rows: Positions are the targets
  std::vector<std::uint8_t> IsFree; ///< #points, or empty: none is
  morph::Index Unmatched = 0;       ///< points that stand for no node
  morph::Index Valueless = 0;       ///< free points that have no displacement
  Precision PointPrecision;         ///< of Positions
};

/// Matches the points of `boundary`. `outer`, `size`: of the undeformed mesh; see GridMesh::Size.
/// Ids come from the first of: the
/// array BoundaryIdArray; MorphPointId; the point's own number where the boundary has as many
/// points as the mesh (outer nodes only); PointIds; vtkOriginalPointIds, with a warning; the
/// nearest node within MatchTolerance, if there is a DisplacementArray. The outer nodes within
/// MatchTolerance of that node move with it, unless they have a point of their own. A node that is
/// named more than once goes where it is named first. Nodes that the array MorphFree marks (not 0)
/// are solved with the interior, unless another point names them. So are those without a
/// displacement: it is NaN there, or the array vtkValidPointMask 0. With FixUnnamedBoundary all
/// other outer nodes are held, except those in the middle of an edge or face one of whose corners
/// moves. A coordinate that is the undeformed one in the boundary's precision does not move. Throws
/// morph::Error naming ids and the remedy where none of these works, where the boundary's cells are
/// no part of the mesh's by the ids, and as Conclude() does. Throws also for arrays that are not
/// numeric or not as long as the boundary has points. Cost: one pass over the boundary; by position
/// also a point locator over the mesh.
Result Match(vtkPointSet* boundary, const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  double size, const Options& options);

/// The part of Match() that follows once nodes are found: it verifies RestPosition, and computes
/// the targets. `globalIds`: of the nodes, for a part of a mesh that is distributed over MPI ranks.
/// Messages name these then.
Result FindTargets(NamedPoints named, const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  double size, const Options& options, const std::vector<std::int64_t>* globalIds = nullptr);

/// Counts the nodes that stay and those that are open. `owns`: whether a node counts here.
void CountStaying(const morph::Mesh& rest, const morph::BoundaryFaces& outer,
  const std::function<bool(morph::Index node)>& owns, Result& result);
/// The end of Match(): adds warnings of the numbers in `result`. Throws morph::Error where all
/// points are free.
void Conclude(double size, const Options& options, Result& result);
/// Warns where all prescribed nodes move, and others of the boundary are open: nothing holds the
/// mesh then.
void WarnIfNothingStays(const Result& result, morph::Monitor& monitor);

/// The steps of Match() before FindTargets(), for the same. They throw as it does.
///@{
/// The boundary's array of node ids that comes first, or null: BoundaryIdArray, MorphPointId.
vtkDataArray* FindIds(vtkPointSet* boundary, const Options& options);
/// Pairs of a point and its id; ids lie between 0 and `nodes` - 1.
std::vector<std::pair<morph::Index, morph::Index>> FindByIds(vtkDataArray* ids, morph::Index nodes);
/// Pairs of a point and its node, by position; `unmatched` counts the points without one.
std::vector<std::pair<morph::Index, morph::Index>> FindByPosition(const morph::Points& positions,
  const morph::Mesh& rest, const std::vector<morph::Index>& outer, double tolerance,
  morph::Index& unmatched);
/// All of NamedPoints but Pairs.
NamedPoints ReadPoints(vtkPointSet* boundary, const Options& options);
///@}
}
