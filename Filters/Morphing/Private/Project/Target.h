// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

#include <memory>

class vtkPolyData;

namespace morph::filters
{
/// Polygonal data as a surface to project boundary nodes onto. Polygons and strips are cut into
/// triangles, and points in one place (within 1e-7 of the target's size) are one point, so the
/// triangles of an STL file hang together.
class Target : public morph::ProjectionTarget
{
public:
  /// `featureAngle`, degrees: between the target's faces, for its feature edges. `normalAngle`,
  /// degrees: how far a node's normal and the target's may differ. `reach`: how far a node may
  /// go, in the unit of the points. Throws morph::Error where there is no polygon, or a point is
  /// not finite.
  Target(vtkPolyData* surface, double featureAngle, double normalAngle, double reach,
    morph::Monitor& monitor);
  ~Target() override;

  /// Turns the target's normals round if they disagree with those of most of the nodes: `normals`
  /// and `points`, #nodes x 3; a zero normal has no say.
  void Orient(const morph::Points& points, const morph::Points& normals);

  /// Lets each surface of `geometry` project onto one surface of the target, as its feature edges
  /// part it: that on which most of the nodes on its curves lie, at `moved` (#nodes x 3), within
  /// 1e-3 of the target's size, if that is more than half of them. Other surfaces project onto
  /// all of the target.
  void Assign(const morph::Classification& geometry, const morph::Points& moved);

  bool HasFeatures() const;

  bool closestOnSurface(
    morph::Index surface, const Row& x, const Row& normal, Row& y) const override;
  bool closestOnFeatures(const Row& x, Row& y) const override;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Internals;
};
}
