// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Boundary/NodesBetween.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// A target surface for boundary nodes. Both functions are called from several threads at once.
class ProjectionTarget
{
public:
  using Row = Eigen::RowVector3d;
  virtual ~ProjectionTarget();
  /// Whether the target says where nodes of surface number `surface` may be; it is so by default.
  virtual bool holds(Index surface) const;
  /// Finds the point `y` of the target nearest to `x` for a node of surface number `surface` (see
  /// Classification). Its normal must fit `normal` (unit length, or zero where unknown). Returns
  /// false if none is near enough.
  virtual bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const = 0;
  /// Finds the point `y` nearest to `x` on the target's feature edges, for that node. Returns false
  /// if none is near enough.
  virtual bool closestOnFeatures(Index node, const Row& x, Row& y) const = 0;
};

struct ProjectionReport
{
  std::vector<Index> projected; ///< node ids, ascending
  /// node ids without a place on the target; they stay where their curve or surface moved them
  std::vector<Index> missed;
  /// node ids that stay because a face would fold, or a curve turn back
  std::vector<Index> kept;
  /// Number of checks of curve pieces between neighbors, a measure of the cost.
  Index checkedPieces = 0;
};

/// Moves nodes that their curve moved (state OnCurve) to the target's feature edges. Call it
/// between morphCurves() and morphSurfaces(). Where a piece of a curve would turn back, its nodes
/// are kept. Cost: one search a node; a piece is checked again only after one of its nodes went
/// back.
ProjectionReport projectCurves(const Classification& geometry, const ProjectionTarget& target,
  BoundaryMotion& motion, Monitor& monitor);

/// Moves nodes that their surface moved (state OnSurface) to the target. A node's search uses the
/// mean normal of the moved faces of its surface. If faces are folded (see faceQuality()), by the
/// projection or before, constrained Laplacian smoothing follows. It moves their projected nodes
/// and the neighbors to the mean of their own neighbors, then to the target, for up to 100 rounds.
/// Faces that remain folded, and were not before the projection, return their nodes to the position
/// before it. Call it after morphSurfaces(). Cost: one search a node, and a few passes over the
/// faces a round.
ProjectionReport projectSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget& target, BoundaryMotion& motion, Monitor& monitor);

/// Returns unit normals at the nodes of dimension 2, #nodes x 3; zero for other nodes and without
/// area. A corner takes the moved faces of its surface, weighted by area. A mid-side or face node
/// takes the faces at its edge or face. Normals of folded faces are reversed. `rest`, `moved`:
/// #nodes x 3.
Points surfaceNodeNormals(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);

/// Moves mid-side and face nodes that their surface moved (state OnSurface) with their corners: by
/// meanBetween() of the shifts of these since `before` (#nodes x 3, moved positions), and onto the
/// `target`, if not null. `normals`: of surfaceNodeNormals(), read with a target alone.
void carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion);
}
