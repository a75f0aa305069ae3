// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Geometry/TriangleTree.h"
#include "Mesh/Topology.h"

#include <memory>
#include <vector>

namespace morph
{
/// Adds the triangles of a face. A polygon of four corners and more is cut about its middle.
/// `points`: #nodes x 3.
void addTriangles(const Points& points, const BoundaryFaces& faces, Index face,
  std::vector<TriangleTree::Triangle>& triangles);

/// The shape of an undeformed surface, along which its nodes can slide: a plane, a cylinder or, for
/// any other surface, its facets. A plane fits its nodes to 1e-6 of their extent. A cylinder fits
/// them to 1e-6 of their extent and of its radius, and ten times as well as a plane: what is bumpy
/// and nearly flat fits large cylinders, too.
class SurfaceShape
{
public:
  using Row = Eigen::RowVector3d;
  enum class Kind
  {
    Plane,
    Cylinder,
    Facets
  };

  /// `points`: #nodes x 3. Cost: a few passes over the surface's nodes; for facets, a locator.
  SurfaceShape(const Points& points, const BoundaryFaces& faces, const GeometrySurface&);

  Kind kind() const { return this->kind_; }
  double radius() const { return this->radius_; } ///< of a cylinder
  /// The unit vector away from a cylinder's axis, zero on it.
  Row outwards(const Row& x) const;
  /// The nearest point of the shape. Planes and cylinders have no end.
  Row closest(const Row& x) const;
  /// The point near `to` at the height above the shape that `from` has. So a node that slides keeps
  /// its undeformed distance, and stays where it does not move.
  Row slid(const Row& from, const Row& to) const;
  /// The unit normal of the shape at its point nearest to `x`, either way; zero where it has none.
  Row normal(const Row& x) const;

private:
  /// Both set the shape's numbers. The first returns the largest distance of a node from the plane.
  ///@{
  double fitPlane(const Points& nodes);
  bool fitCylinder(const Points& nodes, const Points& areas, double tolerance);
  ///@}
  void takeFacets(const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface);

  Kind kind_ = Kind::Facets;
  Row center_ = Row::Zero();    ///< a point of the plane, or of the axis
  Row direction_ = Row::Zero(); ///< the plane's normal, or the axis
  double radius_ = 0;
  std::unique_ptr<TriangleTree> facets_;
};
}
