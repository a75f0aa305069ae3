// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// A surface that boundary nodes are to lie on. Both functions are called from several threads at
/// once.
class ProjectionTarget
{
public:
  using Row = Eigen::RowVector3d;
  virtual ~ProjectionTarget();
  /// The point `y` of the target nearest to `x` for a node of surface number `surface` (see
  /// Classification), among those whose normal fits `normal` (unit length, or zero where unknown).
  /// False where there is none near enough.
  virtual bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const = 0;
  /// The point `y` nearest to `x` on the target's feature edges. False where there is none near
  /// enough.
  virtual bool closestOnFeatures(const Row& x, Row& y) const = 0;
};

struct ProjectionReport
{
  std::vector<Index> projected; ///< node ids, ascending
  /// node ids: the target has no place for them; they stay where their curve or surface took them
  std::vector<Index> missed;
  /// node ids: a face would have folded, or a curve turned back; they stay likewise
  std::vector<Index> kept;
  /// Pieces between neighbors on curves, looked at for a turn: a measure of the cost.
  Index checkedPieces = 0;
};

/// Moves the nodes that their curve moved (state OnCurve) to the target's feature edges. To be
/// called between morphCurves() and morphSurfaces(). Where a piece of a curve would turn back, its
/// nodes are kept. Cost: one search per node; a piece is looked at again only after one of its
/// nodes went back.
ProjectionReport projectCurves(const Classification& geometry, const ProjectionTarget& target,
  BoundaryMotion& motion, Monitor& monitor);

/// Moves the nodes that their surface moved (state OnSurface) to the target, each by the mean
/// normal of the moved faces of its surface around it. Where faces are folded then (see
/// faceQuality()), by the projection or before it, their projected nodes and the neighbors of those
/// go to the mean of their neighbors, and on to the target again, until no face is folded, for up
/// to 100 rounds (Laplacian smoothing constrained to the target). Faces that are folded even then,
/// and were not before, take their nodes back to where they were. To be called after
/// morphSurfaces(). Cost: one search per node, and a few passes over the faces a round.
ProjectionReport projectSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget& target, BoundaryMotion& motion, Monitor& monitor);

/// Unit normals at the nodes of dimension 2, #nodes x 3: of the moved faces of its surface around a
/// corner, at the edge or face that a mid-side or face node is in, weighted by area; those of faces
/// that are folded over are turned back. Zero for other nodes, and where the faces have no area.
/// `rest`, `moved`: #nodes x 3.
Points surfaceNodeNormals(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);
}
