// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Geometry/TriangleTree.h"
#include "Mesh/Topology.h"

#include <memory>
#include <string>
#include <vector>

namespace morph
{
/// Adds the triangles of a face. A polygon of four corners and more is cut about its middle.
/// `points`: #nodes x 3.
void addTriangles(const Points& points, const BoundaryFaces& faces, Index face,
  std::vector<TriangleTree::Triangle>& triangles);

/// The shape of an undeformed surface, along which its nodes can slide: a plane, a cylinder, a
/// sphere or, for any other surface, its facets. A plane fits its nodes to 1e-6 of their extent. A
/// cylinder and a sphere fit them to 1e-6 of their extent and of the radius, and ten times as well
/// as a plane: what is bumpy and nearly flat fits large cylinders, too. A sphere also fits ten
/// times as well as any other quadric: two rings of nodes, as of a chamfer, are on a cone as well.
class SurfaceShape
{
public:
  using Row = Eigen::RowVector3d;
  enum class Kind
  {
    Plane,
    Cylinder,
    Sphere,
    Facets
  };

  /// `points`: #nodes x 3. Cost: a few passes over the surface's nodes; for facets, a locator.
  SurfaceShape(const Points& points, const BoundaryFaces& faces, const GeometrySurface&);

  /// The shape for a user to read: "plane", "R 0.25" of a cylinder, "sphere R 2", or "free form".
  /// Radii have four digits. Cost: a few passes over the surface's nodes.
  static std::string text(const Points& points, const BoundaryFaces& faces, const GeometrySurface&);

  Kind kind() const { return this->kind_; }
  bool isRound() const { return this->kind_ == Kind::Cylinder || this->kind_ == Kind::Sphere; }
  double radius() const { return this->radius_; } ///< of a cylinder or a sphere
  const Row& center() const { return this->center_; }
  const Row& direction() const { return this->direction_; }
  /// The unit vector away from a cylinder's axis or a sphere's center, zero there.
  Row outwards(const Row& x) const;
  /// The nearest point of the shape. Planes and cylinders have no end.
  Row closest(const Row& x) const;
  /// The point near `to` at the height above the shape that `from` has. So a node that slides keeps
  /// its undeformed distance, and stays where it does not move.
  Row slid(const Row& from, const Row& to) const;
  /// The unit normal of the shape at its point nearest to `x`, either way; zero where it has none.
  Row normal(const Row& x) const;

private:
  SurfaceShape() = default;

  /// Finds the kind and its numbers; facets are not taken yet.
  void fit(const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface);
  /// These set the shape's numbers. The first returns the largest distance of a node from the
  /// plane.
  ///@{
  double fitPlane(const Points& nodes);
  bool fitCylinder(const Points& nodes, const Points& areas, double tolerance);
  bool fitSphere(const Points& nodes, double tolerance);
  ///@}
  void takeFacets(const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface);

  Kind kind_ = Kind::Facets;
  Row center_ = Row::Zero();    ///< the middle of a plane's nodes, of the axis, or of a sphere
  Row direction_ = Row::Zero(); ///< the plane's normal, or the axis
  double radius_ = 0;
  std::unique_ptr<TriangleTree> facets_;
};
}
