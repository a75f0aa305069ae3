// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

#include <memory>

class vtkPolyData;

namespace morph::filters
{
/// Polygonal data as a surface onto which boundary nodes are projected. Polygons and strips are cut
/// into triangles. Points in one place (within 1e-7 of the target's size) are merged, so that the
/// triangles of an STL file are connected.
class Target : public morph::ProjectionTarget
{
public:
  /// `featureAngle`, degrees: between the target's faces, for its feature edges. `normalAngle`,
  /// degrees: how far a node's normal and the target's may differ. `reach`: how far a node may
  /// go, in the unit of the points. `mesh`: the points that it is a target of. Throws morph::Error
  /// where there is no polygon, and for points that are not finite, or farther from the mesh than
  /// 1e5 times its size.
  Target(vtkPolyData* surface, const morph::Points& mesh, double featureAngle, double normalAngle,
    double reach, morph::Monitor& monitor);
  ~Target() override;

  /// Reverses the target's normals if they disagree with those of most nodes. `points`, `normals`:
  /// #nodes x 3; zero normals are ignored.
  void Orient(const morph::Points& points, const morph::Points& normals);

  /// Assigns one surface of the target to each surface of `geometry`. Feature edges split the
  /// target into its surfaces. The assigned one holds more than half of the nodes on the surface's
  /// curves, at `moved` (#nodes x 3), within 1e-3 of the target's size. Other surfaces project onto
  /// all of the target.
  void Assign(const morph::Classification& geometry, const morph::Points& moved);

  bool HasFeatures() const;

  /// The triangles: points in one place are merged.
  vtkPolyData* Surface() const;
  /// Finds the nearest vertex of the target, where its feature edges meet or end. Returns false if
  /// none is within reach.
  bool ClosestOnVertices(const Row& x, Row& y) const;

  bool closestOnSurface(
    morph::Index surface, const Row& x, const Row& normal, Row& y) const override;
  bool closestOnFeatures(const Row& x, Row& y) const override;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Internals;
};
}
