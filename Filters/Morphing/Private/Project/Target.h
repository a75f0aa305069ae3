// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

#include <memory>

class vtkPolyData;

namespace morph::filters
{
/// Polygonal data as a surface onto which boundary nodes are projected. Polygons and strips are cut
/// into triangles. Points in one place (within 1e-7 of the target's size) are merged, so that the
/// triangles of an STL file are connected. Triangles that are there twice, or lower than that, have
/// no effect.
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

  /// A target in single precision is known up to its rounding: what is as near as that is on it.
  /// Takes the precision of the target that this one is, aligned.
  void TakePrecision(const Target& original);
  /// Warns where the rounding shows. `size`: of the mesh.
  void WarnOfRounding(double size, morph::Monitor& monitor) const;

  /// The triangles: points in one place are merged.
  vtkPolyData* Surface() const;
  /// Finds the nearest vertex of the target, where its feature edges meet or end. Returns false if
  /// none is within reach.
  bool ClosestOnVertices(const Row& x, Row& y) const;

  bool closestOnSurface(
    morph::Index surface, const Row& x, const Row& normal, Row& y) const override;
  bool closestOnFeatures(morph::Index node, const Row& x, Row& y) const override;
  /// Finds the point of the target nearest to `x` on the line through it. `direction`: of the line,
  /// unit length; `normal`: as of closestOnSurface(). Returns false if there is none within reach.
  bool ClosestAlong(const Row& x, const Row& direction, const Row& normal, Row& y) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Internals;
};
}
