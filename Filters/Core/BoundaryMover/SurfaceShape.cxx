// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/SurfaceShape.h"

#include "Boundary/FaceQuality.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
using Row = SurfaceShape::Row;

constexpr double Anywhere = std::numeric_limits<double>::infinity();
constexpr double Better = 0.1;    ///< the distance of a shape's nodes, in parts of another shape's
constexpr double OfRadius = 1e-6; ///< the largest distance of a node from what is round

/// Of a symmetric matrix, that of the smallest eigenvalue.
Row smallestEigenvector(const Eigen::Matrix3d& matrix)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors().col(0).transpose();
}

/// The vector areas of some of the faces, #some x 3.
Points areasOf(const Points& points, const BoundaryFaces& faces, const std::vector<Index>& some)
{
  BoundaryFaces taken;
  for (const Index face : some)
  {
    taken.add(faces.connectivity.begin() + faces.offsets[face],
      faces.connectivity.begin() + faces.offsets[face + 1]);
  }
  return faceAreas(points, taken);
}

/// The distance of nodes on the unit sphere from the quadric that is nearest to them, besides the
/// sphere: the root mean square, to first order (G. Taubin, IEEE Trans. Pattern Anal. Mach. Intell.
/// 13 (1991) 1115-1138). On the sphere a quadric is a harmonic q of degree two or less, and a node
/// is |q| / |grad q| away from it, with the gradient along the sphere. Zero where another quadric
/// has all nodes.
double distanceFromOtherQuadrics(const Points& nodes)
{
  using Matrix = Eigen::Matrix<double, 9, 9>;
  using Gradients = Eigen::Matrix<double, 9, 3>;
  Matrix squares = Matrix::Zero(), slopes = Matrix::Zero();
  for (Index i = 0; i < nodes.rows(); ++i)
  {
    const double x = nodes(i, 0), y = nodes(i, 1), z = nodes(i, 2);
    Eigen::Matrix<double, 9, 1> value;
    value << 1, x, y, z, x * y, y * z, z * x, x * x - y * y, 2 * z * z - x * x - y * y;
    Gradients gradient;
    gradient << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, y, x, 0, 0, z, y, z, 0, x, 2 * x, -2 * y, 0,
      -2 * x, -2 * y, 4 * z;
    const Row radial = nodes.row(i);
    gradient -= (gradient * radial.transpose()).eval() * radial;
    squares += value * value.transpose();
    slopes += gradient * gradient.transpose();
  }
  // The largest mean square of the slope over that of the value.
  const Eigen::LLT<Eigen::MatrixXd> factors(squares);
  if (factors.info() != Eigen::Success)
  {
    return 0;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
    slopes, squares, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
  const double most = solver.eigenvalues()[8];
  return most > 0 ? 1 / std::sqrt(most) : 0;
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
  this->fit(points, faces, surface);
  if (this->kind_ == Kind::Facets)
  {
    this->takeFacets(points, faces, surface);
  }
}

std::string SurfaceShape::text(
  const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface)
{
  SurfaceShape shape;
  shape.fit(points, faces, surface);
  if (shape.kind_ == Kind::Plane)
  {
    return "plane";
  }
  if (!shape.isRound())
  {
    return "free form";
  }
  std::ostringstream text;
  text << (shape.kind_ == Kind::Sphere ? "sphere R " : "R ") << std::setprecision(4)
       << shape.radius_;
  return text.str();
}

void SurfaceShape::fit(
  const Points& points, const BoundaryFaces& faces, const GeometrySurface& surface)
{
  constexpr double Fits = 1e-6; // of the nodes' extent
  const Points nodes = points(surface.nodes, allColumns);
  const double ofPlane = this->fitPlane(nodes);
  const double most = Fits * (nodes.rowwise() - this->center_).rowwise().norm().maxCoeff();
  const double ofRound = std::min(most, Better * ofPlane);
  if (ofPlane <= most)
  {
    this->kind_ = Kind::Plane;
  }
  else if (this->fitCylinder(nodes, areasOf(points, faces, surface.faces), ofRound))
  {
    this->kind_ = Kind::Cylinder;
  }
  else if (this->fitSphere(nodes, ofRound))
  {
    this->kind_ = Kind::Sphere;
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

/// `tolerance`: as of a cylinder.
bool SurfaceShape::fitSphere(const Points& nodes, double tolerance)
{
  // |x - m|^2 = 2 (x - m) c + d is linear in the center m + c and in d, and is exact where all
  // nodes are on a sphere. Gauss-Newton's method takes what rounding has left. Unknowns: center,
  // radius.
  const Row middle = nodes.colwise().mean();
  Eigen::MatrixXd matrix(nodes.rows(), 4);
  matrix.leftCols<3>() = 2 * (nodes.rowwise() - middle);
  matrix.col(3).setOnes();
  const Eigen::VectorXd squares = (nodes.rowwise() - middle).rowwise().squaredNorm();
  const Eigen::VectorXd first = Eigen::MatrixXd(matrix.transpose() * matrix)
                                  .completeOrthogonalDecomposition()
                                  .solve(Eigen::VectorXd(matrix.transpose() * squares));
  this->center_ = middle + first.head<3>().transpose();
  this->radius_ = std::sqrt(std::max(0., first[3] + first.head<3>().squaredNorm()));
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    const Points from = nodes.rowwise() - this->center_;
    const Eigen::VectorXd distances = from.rowwise().norm();
    if (!(distances.minCoeff() > 0))
    {
      return false;
    }
    matrix.leftCols<3>() = from.array().colwise() / distances.array();
    const Eigen::VectorXd step =
      Eigen::MatrixXd(matrix.transpose() * matrix)
        .completeOrthogonalDecomposition()
        .solve(Eigen::VectorXd(matrix.transpose() * (distances.array() - this->radius_).matrix()));
    this->center_ += step.head<3>().transpose();
    this->radius_ += step[3];
  }
  const Points from = nodes.rowwise() - this->center_;
  const double worst = (from.rowwise().norm().array() - this->radius_).abs().maxCoeff();
  const double most = std::min(tolerance, OfRadius * this->radius_);
  return worst <= most && // not where it is NaN
         most <= Better * this->radius_ * distanceFromOtherQuadrics(from / this->radius_);
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
  if (this->kind_ == Kind::Sphere)
  {
    const Row from = x - this->center_;
    return from.norm() > 0 ? Row(this->center_ + from * (this->radius_ / from.norm())) : x;
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
  return this->closest(to) +
         (this->isRound() ? Row(height.dot(this->outwards(from)) * this->outwards(to)) : height);
}

Row SurfaceShape::normal(const Row& x) const
{
  if (this->kind_ == Kind::Plane)
  {
    return this->direction_;
  }
  if (this->isRound())
  {
    return this->outwards(x);
  }
  return this->facets_->normal(this->facets_->nearest(x, Anywhere).triangle);
}

Row SurfaceShape::outwards(const Row& x) const
{
  const Row from = x - this->center_;
  const Row out =
    this->kind_ == Kind::Sphere ? from : Row(from - from.dot(this->direction_) * this->direction_);
  return out.norm() > 0 ? Row(out.normalized()) : Row(Row::Zero());
}
}
