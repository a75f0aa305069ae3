// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/TriangleTree.h"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
using Row = TriangleTree::Row;

Row nearestOnSegment(const Row& a, const Row& b, const Row& x)
{
  const Row along = b - a;
  const double square = along.squaredNorm();
  return a + (square > 0 ? std::clamp((x - a).dot(along) / square, 0., 1.) : 0.) * along;
}

Row nearestOn(const TriangleTree::Triangle& corner, const Row& x)
{
  const Row normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double square = normal.squaredNorm();
  bool isInside = square > 0;
  for (int k = 0; k < 3 && isInside; ++k)
  {
    const Row edge = corner[(k + 1) % 3] - corner[k];
    isInside = edge.cross(x - corner[k]).dot(normal) >= 0;
  }
  if (isInside)
  {
    return x - (x - corner[0]).dot(normal) / square * normal;
  }
  Row best = Row::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    const Row place = nearestOnSegment(corner[k], corner[(k + 1) % 3], x);
    const double distance2 = (place - x).squaredNorm();
    if (distance2 < least)
    {
      least = distance2;
      best = place;
    }
  }
  return best;
}

using Tree = Eigen::KdBVH<double, 3, int>;

/// What Eigen's search asks for.
struct Search
{
  using Scalar = double;

  /// Less than the distance by the last digit, so that what is as near is searched, too.
  double minimumOnVolume(const Tree::Volume& box) const
  {
    constexpr double Never = std::numeric_limits<double>::infinity();
    const double distance2 = box.squaredExteriorDistance(this->x.transpose());
    return distance2 > this->least ? Never : std::nextafter(distance2, -Never);
  }
  double minimumOnObject(int triangle)
  {
    if (this->fits && !this->fits(triangle))
    {
      return std::numeric_limits<double>::infinity();
    }
    const Row place = nearestOn(this->triangles[static_cast<std::size_t>(triangle)], this->x);
    const double distance2 = (place - this->x).squaredNorm();
    if (distance2 < this->least ||
        (distance2 == this->least && (this->found.triangle < 0 || triangle < this->found.triangle)))
    {
      this->least = distance2;
      this->found = { triangle, place };
    }
    return distance2;
  }

  const Row& x;
  const std::vector<TriangleTree::Triangle>& triangles;
  const std::function<bool(Index)>& fits;
  double least; ///< squared distance of what is found, or of the radius
  TriangleTree::Found found;
};
}

struct TriangleTree::Implementation
{
  std::vector<Triangle> triangles;
  Tree tree;
};

TriangleTree::TriangleTree(std::vector<Triangle> triangles)
  : implementation_(new Implementation)
{
  Implementation& own = *this->implementation_;
  own.triangles = std::move(triangles);
  std::vector<int> numbers(own.triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  std::vector<Tree::Volume> boxes;
  for (const Triangle& corner : own.triangles)
  {
    Tree::Volume& box = boxes.emplace_back(corner[0].transpose());
    box.extend(corner[1].transpose()).extend(corner[2].transpose());
  }
  own.tree.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
}

TriangleTree::~TriangleTree() = default;

TriangleTree::Found TriangleTree::nearest(
  const Row& x, double radius, const std::function<bool(Index)>& fits) const
{
  const Implementation& own = *this->implementation_;
  Search search{ x, own.triangles, fits, radius * radius, { -1, x } };
  if (!own.triangles.empty())
  {
    Eigen::BVMinimize(own.tree, search);
  }
  return search.found;
}

const std::vector<TriangleTree::Triangle>& TriangleTree::triangles() const
{
  return this->implementation_->triangles;
}

TriangleTree::Row TriangleTree::normal(Index triangle) const
{
  if (triangle < 0)
  {
    return Row::Zero();
  }
  const Triangle& corner = this->triangles()[static_cast<std::size_t>(triangle)];
  return (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
}
}
