// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/Precision.h"
#include "Session/BoundaryTargets.h"
#include "Session/Session.h"
#include "Support/Communicator.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkDoubleArray;
class vtkPointSet;

/// Matches the points of a displaced boundary to nodes of the undeformed mesh.
namespace morph::filters::BoundaryMatch
{
struct Options : morph::TargetOptions
{
  std::string BoundaryIdArray; ///< empty: none
};

/// The nodes that points may stand for: those of a mesh, or of a process's part of one.
struct Nodes
{
  const morph::Mesh& Rest;
  const morph::BoundaryFaces& Outer; ///< its nodes and what is between them
  double Size;                       ///< of the whole mesh; see meshSize()
  /// Of a part the numbers of the nodes in the whole mesh, and the node of one, or -1; else null.
  ///@{
  const std::vector<morph::Index>* Ids = nullptr;
  std::function<morph::Index(morph::Index id)> NodeOf = nullptr;
  ///@}
  /// Of a part, the points of this process's piece, which come first; see also ShellLayer.
  morph::Index Points = 0;
};

/// Which points follow the nodes of a match. On several processes points have the numbers that they
/// have among those of all.
struct Followers
{
  std::vector<std::pair<morph::Index, morph::Index>> Pairs; ///< index in ids, and point; ascending
  morph::Index Points = 0;                                  ///< of all processes
  std::vector<morph::Index> Own; ///< of this process's first points the numbers in the boundary
  morph::Index First = 0;        ///< of these
};

/// The points of a boundary of all processes, the same on each of them.
struct Gathered
{
  /// Pairs of a point and its node's number in the whole mesh; none where ByPosition.
  morph::NamedPoints Points;
  Precision PointPrecision; ///< of all processes' points, as BoundaryPoints::Read() gives it
  bool ByPosition = false;
  std::vector<std::string> Warnings; ///< of the ids
  std::vector<morph::Index> Own;     ///< see Followers
  morph::Index First = 0;
};
/// Finds what says which nodes the points are, as Match() does, and throws as that does. `nodes`:
/// of the volume mesh. Collective.
Gathered Gather(vtkPointSet* boundary, const Nodes& nodes, const morph::Communicator& processes,
  const Options& options);
/// findTargets() of the points that find one of these nodes, whose pairs `all` has then. `rounded`:
/// becomes the number of coordinates that were put back, as they differ from those of the nodes by
/// their rounding alone.
morph::BoundaryTargets TargetsOf(
  Gathered& all, const Nodes& nodes, const Options& options, morph::Index& rounded);
/// The end of Match(): morph::conclude(), and a warning of a precision that is too low.
void Conclude(double size, const Options& options, const Precision& precision, morph::Index rounded,
  morph::BoundaryTargets& result);

/// Matches the points of `boundary`. Ids come from the first of: the array BoundaryIdArray;
/// MorphPointId; the point's own number where the boundary has as many points as the mesh (outer
/// nodes only); PointIds; vtkOriginalPointIds, with a warning; the nearest node within
/// MatchTolerance, if there is a DisplacementArray. The outer nodes within MatchTolerance of that
/// node move with it, unless they have a point of their own. Points that the array MorphFree marks
/// (not 0) are free. So are those without a displacement: it is NaN there, or the array
/// vtkValidPointMask 0. A coordinate that is the undeformed one in the boundary's precision does
/// not move. Throws morph::Error naming ids and the remedy where none of these works, or the
/// boundary's cells are no part of the mesh's by the ids. It throws as findTargets() and conclude()
/// do, too, and for arrays that are not numeric or not as long as the boundary has points. Cost:
/// one pass over the boundary; by position also a point locator over the mesh.
///
/// `processes`: that have parts of the mesh, of which `nodes` is this one's; each has some points,
/// perhaps none. Ids are then those of the whole mesh, and PointIds and vtkOriginalPointIds are
/// errors. The result is that of the process where a node counts; sources are numbers among the
/// points of all. Collective. `followers`: null, or becomes the points that the nodes here follow,
/// of each process the first one.
morph::BoundaryTargets Match(vtkPointSet* boundary, const Nodes& nodes, const Options& options,
  const morph::Communicator& processes = morph::Communicator::alone(),
  Followers* followers = nullptr);

/// Sums the derivatives of prescribed nodes for each point of the boundary on this process, as
/// Gradient::Gather() does. `prescribed`: #ids x 3. Collective.
void SendBack(const Followers& followers, const morph::Points& prescribed,
  const morph::Communicator& processes, vtkPointSet* boundary, vtkDoubleArray* result);

/// The affine motion of `boundary`, or nothing unless it has AffineArrays that take the nodes to
/// their targets, up to rounding. So arrays do no harm that a filter in between has made stale.
/// `match`: of `boundary`. `scale`: what multiplies its motion. `isFloat`: the result is rounded to
/// single precision, so that the boundary may be. Cost: one pass over the boundary; on several
/// processes 32 bytes for each of its points. Collective.
std::optional<morph::Session::AffineHandle> FindHandle(vtkPointSet* boundary,
  const morph::BoundaryTargets& match, const morph::Mesh& rest, double scale, bool isFloat,
  const morph::Communicator& processes);
}

namespace morph::filters
{
/// What vtkMorphAlgorithm asks of a motion.
struct MotionOptions : morph::Session::Options
{
  BoundaryMatch::Options Matching;
};
}
