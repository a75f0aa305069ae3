// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/PhongSurface.h"

#include "Support/Lists.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace morph
{
namespace
{
constexpr double Flat = 1e-9;        // of the extent
constexpr double Curvature = 0.5;    // of Phong tessellation
constexpr Index MostSteps = 1000000; // of a walk: only a guard, as each step comes nearer

using Row = Eigen::RowVector3d;

/// Sets the weights of the point of the segment from a to b that is nearest to x.
double onSegment(const Row& a, const Row& b, const Row& x, double& ofA, double& ofB)
{
  const Row along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((x - a).dot(along) / square, 0., 1.) : 0;
  ofA = 1 - t;
  ofB = t;
  return (a + t * along - x).squaredNorm();
}
}

PhongSurface::PhongSurface(
  const ConstPoints& points, const BoundaryFaces& faces, const std::vector<Index>& faceIds)
{
  const auto first = [&](Index f) { return faces.connectivity.begin() + faces.offsets[f]; };
  for (const Index f : faceIds)
  {
    this->nodes_.insert(this->nodes_.end(), first(f), first(f + 1));
  }
  sortUnique(this->nodes_);
  const auto local = [this](Index node) {
    return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node) - this->nodes_.begin();
  };
  this->points_ = points(this->nodes_, allColumns);
  for (const Index f : faceIds)
  {
    const auto corner = first(f);
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    // A quadrilateral is cut along its shorter diagonal.
    const bool turn = size == 4 && (points.row(corner[1]) - points.row(corner[3])).squaredNorm() <
                                     (points.row(corner[0]) - points.row(corner[2])).squaredNorm();
    for (Index k = 2; k < size; ++k)
    {
      const auto at = [&](Index i) { return local(corner[(i + turn) % size]); };
      this->triangles_.push_back({ { at(0), at(k - 1), at(k) } });
    }
  }
  this->around_ = gatherMap(static_cast<Index>(3 * this->triangles_.size()), this->points_.rows(),
    [this](Index place) { return this->triangles_[place / 3][place % 3]; });
  this->normals_ = Points::Zero(this->points_.rows(), 3);
  for (Index& use : this->around_.values)
  {
    use /= 3;
  }
  for (const std::array<Index, 3>& t : this->triangles_)
  {
    const Row a = this->points_.row(t[0]);
    const Row area = (Row(this->points_.row(t[1])) - a).cross(Row(this->points_.row(t[2])) - a);
    this->planeNormal_ += area;
    for (const Index node : t)
    {
      this->normals_.row(node) += area;
    }
  }
  for (Index i = 0; i < this->normals_.rows(); ++i)
  {
    this->normals_.row(i).normalize(); // zero stays zero
  }
  this->isPlane_ = this->fitPlane();
}

bool PhongSurface::fitPlane()
{
  this->center_ = this->points_.colwise().mean();
  const Points from = this->points_.rowwise() - this->center_;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
    Eigen::Matrix3d(from.transpose() * from));
  const Row normal = axes.eigenvectors().col(0).transpose();
  this->planeNormal_ = normal.dot(this->planeNormal_) < 0 ? Row(-normal) : normal;
  const double size = from.rowwise().norm().maxCoeff();
  return (from * normal.transpose()).cwiseAbs().maxCoeff() <= Flat * size;
}

Index PhongSurface::triangleAt(Index node) const
{
  const auto place = std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node);
  return *this->around_.begin(place - this->nodes_.begin());
}

struct PhongSurface::Place
{
  double weight[3];
  double distance2;
};

PhongSurface::Place PhongSurface::nearestIn(Index triangle, const Row& x) const
{
  const std::array<Index, 3>& node = this->triangles_[triangle];
  const Row p[3] = { this->points_.row(node[0]), this->points_.row(node[1]),
    this->points_.row(node[2]) };
  const Row normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double square = normal.squaredNorm();
  Place inside{ { 0, 0, 0 }, std::numeric_limits<double>::infinity() };
  if (square > 0)
  {
    bool isInside = true;
    for (int k = 0; k < 3; ++k)
    {
      const Row &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
      inside.weight[k] = (b - a).cross(x - a).dot(normal) / square;
      isInside = isInside && inside.weight[k] >= 0;
    }
    if (isInside)
    {
      const double distance = (x - p[0]).dot(normal);
      inside.distance2 = distance * distance / square;
      return inside;
    }
  }
  Place best{ { 0, 0, 0 }, std::numeric_limits<double>::infinity() };
  for (int k = 0; k < 3; ++k)
  {
    const int l = (k + 1) % 3;
    Place edge{ { 0, 0, 0 }, 0 };
    edge.distance2 = onSegment(p[k], p[l], x, edge.weight[k], edge.weight[l]);
    best = edge.distance2 < best.distance2 ? edge : best;
  }
  return best;
}

Row PhongSurface::closest(const Row& x, Index& triangle) const
{
  if (this->isPlane_)
  {
    return x - (x - this->center_).dot(this->planeNormal_) * this->planeNormal_;
  }
  Place place = this->nearestIn(triangle, x);
  for (Index step = 0; step < MostSteps; ++step)
  {
    const Index from = triangle;
    for (int k = 0; k < 3; ++k)
    {
      const Index node = this->triangles_[from][k];
      for (const Index* t = this->around_.begin(node); t != this->around_.end(node); ++t)
      {
        const Place there = this->nearestIn(*t, x);
        if (there.distance2 < place.distance2)
        {
          place = there;
          triangle = *t;
        }
      }
    }
    if (triangle == from)
    {
      break;
    }
  }
  const std::array<Index, 3>& node = this->triangles_[triangle];
  Row flat = Row::Zero(), lift = Row::Zero();
  for (int k = 0; k < 3; ++k)
  {
    flat += place.weight[k] * this->points_.row(node[k]);
  }
  for (int k = 0; k < 3; ++k)
  {
    const Row normal = this->normals_.row(node[k]);
    lift -= place.weight[k] * (flat - this->points_.row(node[k])).dot(normal) * normal;
  }
  return flat + Curvature * lift;
}
}
