// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/Precision.h"
#include "Session/BoundaryTargets.h"
#include "Session/Session.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkDataArray;
class vtkPointSet;

/// Matches the points of a displaced boundary to nodes of the undeformed mesh.
namespace morph::filters::BoundaryMatch
{
struct Options : morph::TargetOptions
{
  std::string BoundaryIdArray; ///< empty: none
};

/// A point of the boundary that a node follows.
struct Follower
{
  morph::Index Node;        ///< local, which this process owns
  morph::Index Rank, Point; ///< the process that has the point, and its number there
};

/// Matches the points of `boundary`. `outer`, `size`: of the undeformed mesh; see meshSize(). Ids
/// come from the first of: the array BoundaryIdArray; MorphPointId; the point's own number where
/// the boundary has as many points as the mesh (outer nodes only); PointIds; vtkOriginalPointIds,
/// with a warning; the nearest node within MatchTolerance, if there is a DisplacementArray. The
/// outer nodes within MatchTolerance of that node move with it, unless they have a point of their
/// own. Points that the array MorphFree marks (not 0) are free. So are those without a
/// displacement: it is NaN there, or the array vtkValidPointMask 0. A coordinate that is the
/// undeformed one in the boundary's precision does not move. Throws morph::Error naming ids and the
/// remedy where none of these works, or the boundary's cells are no part of the mesh's by the ids.
/// It throws as findTargets() and conclude() do, too, and for arrays that are not numeric or not as
/// long as the boundary has points. Cost: one pass over the boundary; by position also a point
/// locator over the mesh.
morph::BoundaryTargets Match(vtkPointSet* boundary, const morph::Mesh& rest,
  const morph::BoundaryFaces& outer, double size, const Options& options);

/// The steps of Match() before findTargets(), for the same. They throw as it does.
///@{
/// The boundary's array of node ids that comes first, or null: BoundaryIdArray, MorphPointId.
vtkDataArray* FindIds(vtkPointSet* boundary, const Options& options);
/// Pairs of a point and its id; ids lie between 0 and `nodes` - 1.
std::vector<std::pair<morph::Index, morph::Index>> FindByIds(vtkDataArray* ids, morph::Index nodes);
/// Pairs of a point and its node, by position; `unmatched` counts the points without one.
std::vector<std::pair<morph::Index, morph::Index>> FindByPosition(const morph::Points& positions,
  const morph::Mesh& rest, const std::vector<morph::Index>& outer, double tolerance,
  morph::Index& unmatched);
/// All of NamedPoints but its pairs. `precision`: gets that of the points if they are the targets.
morph::NamedPoints ReadPoints(vtkPointSet* boundary, const Options& options, Precision& precision);
/// Puts coordinates back that differ from those of `rest` by their rounding alone. Returns their
/// number.
morph::Index TakeBackRounding(
  const Precision& precision, const morph::Mesh& rest, morph::NamedPoints& named);
///@}
/// The end of Match(): morph::conclude(), and a warning of a precision that is too low. `rounded`:
/// of TakeBackRounding().
void Conclude(double size, const Options& options, const Precision& precision, morph::Index rounded,
  morph::BoundaryTargets& result);

/// The affine motion of `boundary`, or nothing unless it has AffineArrays that take the nodes to
/// their targets, up to rounding. So arrays do no harm that a filter in between has made stale.
/// `match`: of `boundary`. `scale`: what multiplies its motion. `isFloat`: the result is rounded to
/// single precision, so that the boundary may be. Cost: one pass over the boundary.
std::optional<morph::Session::AffineHandle> FindHandle(vtkPointSet* boundary,
  const morph::BoundaryTargets& match, const morph::Mesh& rest, double scale, bool isFloat);
}

namespace morph::filters
{
/// What vtkMorphAlgorithm asks of a motion.
struct MotionOptions : morph::Session::Options
{
  BoundaryMatch::Options Matching;
};
}
