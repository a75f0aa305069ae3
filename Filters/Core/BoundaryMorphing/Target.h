// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"
#include "Geometry/TriangleTree.h"
#include "Support/Types.h"

#include <array>
#include <memory>
#include <vector>

namespace morph
{
using TargetTriangle = std::array<Index, 3>; ///< ids of points

/// Returns the triangles that are part of a surface, without repeated and flat ones, whose height
/// is within `rounding`. A flat one may join a long edge of one side to the shorter edges of the
/// other side: the triangle at its long edge is divided, so that the surface stays connected. In
/// the order given, the parts of divided ones last. `points`: #points x 3; the corners of a
/// triangle are three points. Cost: a sort, and log n for each flat triangle.
std::vector<TargetTriangle> cleanTriangles(
  const Points& points, const std::vector<TargetTriangle>& triangles, double rounding);

/// A surface of triangles onto which boundary nodes are projected. Points in one place (within 1e-7
/// of the target's size) are merged, so that the triangles of an STL file are connected. Triangles
/// that are there twice, or lower than that, have no effect.
class Target : public ProjectionTarget
{
public:
  struct Options
  {
    double featureAngle = 25; ///< degrees, between the target's faces, for its feature edges
    double normalAngle = 60;  ///< degrees, how far a node's normal and the target's may differ
    double reach = 0;         ///< how far a node may go, in the unit of the points
    /// What is as near as that is on the target: how far rounding has put its points off.
    double rounding = 0;
  };

  /// `points`: #points x 3; `triangles`: any number; `mesh`: the points that it is a target of.
  /// Throws Error where there is no triangle, and for points that are not finite, or farther from
  /// the mesh than 1e5 times its size.
  Target(const Points& points, const std::vector<TargetTriangle>& triangles, const Points& mesh,
    const Options& options, Monitor& monitor);
  ~Target() override;

  /// Reverses the target's normals if they disagree with those of most nodes. `points`, `normals`:
  /// #nodes x 3; zero normals are ignored.
  void orient(const Points& points, const Points& normals);

  /// Assigns one surface of the target to each surface of `geometry`. Feature edges split the
  /// target into its surfaces. The assigned one holds more than half of the nodes on the surface's
  /// curves, at `moved` (#nodes x 3), within 1e-3 of the target's size. Other surfaces project onto
  /// all of the target.
  void assign(const Classification& geometry, const Points& moved);

  bool hasFeatures() const;

  const Options& options() const;
  const Points& points() const; ///< as given
  /// The triangles that count, of merged points.
  ///@{
  const std::vector<TargetTriangle>& triangles() const;
  const TriangleTree& tree() const;
  ///@}

  /// Finds the nearest vertex of the target, where its feature edges meet or end. Returns false if
  /// none is within reach.
  bool closestOnVertices(const Row& x, Row& y) const;

  bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const override;
  bool closestOnFeatures(Index node, const Row& x, Row& y) const override;
  /// Finds the point of the target nearest to `x` on the line through it. `direction`: of the line,
  /// unit length; `normal`: as of closestOnSurface(). Returns false if there is none within reach.
  bool closestAlong(const Row& x, const Row& direction, const Row& normal, Row& y) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
