// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "Morpher/AffineModes.h"

#include <array>
#include <vector>

/// Where the moving part of a boundary goes: positions of choice.moving, #moving x 3.
namespace morph
{
/// Scales along the axes, turns about y, x and z in this order, and shifts. Degrees and the unit of
/// the points; a factor of zero is allowed.
struct Placement
{
  std::array<double, 3> translation = { 0, 0, 0 };
  std::array<double, 3> rotation = { 0, 0, 0 }; ///< about x, y, z
  std::array<double, 3> scale = { 1, 1, 1 };
};
/// The displacement of x by that placement about `center`: fields (1, x - center).
AffineMotion affineMotion(const Placement& placement);

/// That part of a motion with the fields (1, x): first of its stretch about `center`, then of a
/// turn about an axis in space and of a way along it (a screw). The whole turns by at most 180
/// degrees. The parts 0 and 1 are nothing and the whole, to rounding. Cost: a decomposition of a
/// matrix of 3 x 3.
AffineMotion partOf(const AffineMotion& whole, const Eigen::RowVector3d& center, double part);

/// Along the normals by `distance`, outwards if positive. Normals are area-weighted over the faces
/// that move or, at nodes without such a face, over all faces. Throws Error as nodeNormals() does.
Points movedAlongNormals(const BoundaryModel& model, const Choice& choice, double distance);

/// Away from the axes of the cylinders and the centers of the spheres that move, by `change` of
/// their radius. Throws Error for surfaces that move and are neither, and where no radius would be
/// left.
Points movedByRadius(const BoundaryModel& model, const Choice& choice, double change);

/// The middle of the box around the nodes that move; the origin where none does.
Eigen::RowVector3d centerOfMoving(const BoundaryModel& model, const Choice& choice);

/// The faces that lose their area at `moved` (#nodes x 3), all of their corners moving. A morph
/// cannot keep the volume cells behind them. Cost: one pass over the faces.
std::vector<Index> collapsedFaces(
  const BoundaryModel& model, const Choice& choice, const Points& moved);
}
