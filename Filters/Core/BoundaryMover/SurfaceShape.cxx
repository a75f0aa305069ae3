// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/SurfaceShape.h"

#include "Boundary/FaceAreas.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
using Row = SurfaceShape::Row;

constexpr double Anywhere = std::numeric_limits<double>::infinity();

/// Of a symmetric matrix, that of the smallest eigenvalue.
Row smallestEigenvector(const Eigen::Matrix3d& matrix)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors().col(0).transpose();
}

/// Two unit vectors that are normal to `axis` and to each other.
std::pair<Row, Row> across(const Row& axis)
{
  const Row first = axis.unitOrthogonal();
  return { first, axis.cross(first) };
}
}

void addTriangles(const Points& points, const BoundaryFaces& faces, Index face,
  std::vector<TriangleTree::Triangle>& triangles)
{
  const std::vector<Index> corners(faces.connectivity.begin() + faces.offsets[face],
    faces.connectivity.begin() + faces.offsets[face + 1]);
  const Points at = points(corners, allColumns);
  const Row middle = at.colwise().mean();
  if (at.rows() == 3)
  {
    triangles.push_back({ at.row(0), at.row(1), at.row(2) });
    return;
  }
  for (Index k = 0; k < at.rows(); ++k)
  {
    triangles.push_back({ at.row(k), at.row((k + 1) % at.rows()), middle });
  }
}

SurfaceShape::SurfaceShape(
  const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface)
{
  constexpr double Fits = 1e-6;  // of the nodes' extent
  constexpr double Better = 0.1; // than a plane
  const Points nodes = points(surface.nodes, allColumns);
  const double ofPlane = this->fitPlane(nodes);
  const double most = Fits * (nodes.rowwise() - this->center_).rowwise().norm().maxCoeff();
  if (ofPlane <= most)
  {
    this->kind_ = Kind::Plane;
  }
  else if (this->fitCylinder(nodes, Points(faceAreas(points, faces)(surface.faces, allColumns)),
             std::min(most, Better * ofPlane)))
  {
    this->kind_ = Kind::Cylinder;
  }
  else
  {
    this->takeFacets(points, faces, surface);
  }
}

double SurfaceShape::fitPlane(const Points& nodes)
{
  this->center_ = nodes.colwise().mean();
  const Points from = nodes.rowwise() - this->center_;
  this->direction_ = smallestEigenvector(from.transpose() * from);
  return (from * this->direction_.transpose()).cwiseAbs().maxCoeff();
}

/// `tolerance`: the largest distance of a node, besides that part of the radius.
bool SurfaceShape::fitCylinder(const Points& nodes, const Points& areas, double tolerance)
{
  // Normals are all across the axis; the normals of facets only nearly, so that Gauss-Newton's
  // method follows. Unknowns: the center and the axis, each in the two directions across the axis,
  // and the radius.
  this->direction_ = smallestEigenvector(areas.transpose() * areas);
  this->center_ = nodes.colwise().mean();
  this->radius_ = 0;
  constexpr double OfRadius = 1e-6;
  double last = std::numeric_limits<double>::infinity(); ///< length of the last step
  for (int iteration = 0; iteration < 30; ++iteration)
  {
    const auto [u, v] = across(this->direction_);
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
    double worst = 0;
    for (Index i = 0; i < nodes.rows(); ++i)
    {
      const Row from = nodes.row(i) - this->center_;
      const double along = from.dot(this->direction_);
      const Row out = from - along * this->direction_;
      const double distance = out.norm();
      if (!(distance > 0))
      {
        return false;
      }
      const double cu = out.dot(u) / distance, cv = out.dot(v) / distance;
      Eigen::Matrix<double, 5, 1> row;
      row << -cu, -cv, -cu * along, -cv * along, -1;
      const double residual = distance - this->radius_;
      normal += row * row.transpose();
      right -= residual * row;
      worst = std::max(worst, std::abs(residual));
    }
    // The last step is that of rounding; beyond it more of them help no more.
    if (worst <= std::min(tolerance, OfRadius * this->radius_) &&
        (last <= 1e-13 * this->radius_ || iteration == 29))
    {
      return true;
    }
    // Of dynamic size: GCC 16 warns of the bounds of a fixed one.
    const Eigen::MatrixXd matrix = normal;
    const Eigen::VectorXd step = matrix.completeOrthogonalDecomposition().solve(right);
    this->center_ += step[0] * u + step[1] * v;
    this->direction_ = (this->direction_ + step[2] * u + step[3] * v).normalized();
    this->radius_ += step[4];
    last = step.norm();
    if (!std::isfinite(this->radius_) || !this->direction_.allFinite())
    {
      return false;
    }
  }
  return false;
}

void SurfaceShape::takeFacets(
  const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface)
{
  std::vector<TriangleTree::Triangle> triangles;
  for (const Index face : surface.faces)
  {
    addTriangles(points, faces, face, triangles);
  }
  this->facets_ = std::make_unique<TriangleTree>(std::move(triangles));
}

Row SurfaceShape::closest(const Row& x) const
{
  if (this->kind_ == Kind::Plane)
  {
    return x - (x - this->center_).dot(this->direction_) * this->direction_;
  }
  if (this->kind_ == Kind::Cylinder)
  {
    const Row from = x - this->center_;
    const Row axial = from.dot(this->direction_) * this->direction_;
    const double distance = (from - axial).norm();
    // On the axis all points of a circle are as near.
    return distance > 0 ? Row(this->center_ + axial + (from - axial) * (this->radius_ / distance))
                        : x;
  }
  return this->facets_->nearest(x, Anywhere).place;
}

Row SurfaceShape::slid(const Row& from, const Row& to) const
{
  if (this->kind_ == Kind::Plane)
  {
    return to - (to - from).dot(this->direction_) * this->direction_;
  }
  const Row height = from - this->closest(from);
  return this->closest(to) + (this->kind_ == Kind::Cylinder
                                 ? Row(height.dot(this->outwards(from)) * this->outwards(to))
                                 : height);
}

Row SurfaceShape::normal(const Row& x) const
{
  if (this->kind_ == Kind::Plane)
  {
    return this->direction_;
  }
  if (this->kind_ == Kind::Cylinder)
  {
    return this->outwards(x);
  }
  return this->facets_->normal(this->facets_->nearest(x, Anywhere).triangle);
}

Row SurfaceShape::outwards(const Row& x) const
{
  const Row from = x - this->center_;
  const Row out = from - from.dot(this->direction_) * this->direction_;
  return out.norm() > 0 ? Row(out.normalized()) : Row(Row::Zero());
}
}
