// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/TriangleTree.h"

#include "Support/Lists.h"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double Never = std::numeric_limits<double>::infinity();

/// What Eigen's search asks for. `least`: the distance of what is found, at first the radius.
struct Search
{
  using Scalar = double;

  const Row& x;
  const std::vector<TriangleTree::Triangle>& triangles;
  const std::function<bool(Index)>& fits;
  double least;
  TriangleTree::Found found;

  /// Less than the distance of a box by the last digit, so that what is as near is searched, too.
  double bound(double distance) const
  {
    return distance > this->least ? Never : std::nextafter(distance, -Never);
  }
  double take(int triangle, double distance, const Row& place)
  {
    if (distance < this->least ||
        (distance == this->least && (this->found.triangle < 0 || triangle < this->found.triangle)))
    {
      this->least = distance;
      this->found = { triangle, place };
    }
    return distance;
  }
};

struct NearestSearch : Search
{
  double minimumOnVolume(const Tree::Volume& box) const
  {
    return this->bound(box.exteriorDistance(this->x.transpose()));
  }
  double minimumOnObject(int triangle)
  {
    if (this->fits && !this->fits(triangle))
    {
      return Never;
    }
    const Row place = nearestOn(this->triangles[static_cast<std::size_t>(triangle)], this->x);
    return this->take(triangle, (place - this->x).norm(), place);
  }
};

struct AlongSearch : Search
{
  const Row& direction;
  double tolerance;

  /// By the part of the line that is inside of the box.
  double minimumOnVolume(const Tree::Volume& box) const
  {
    double first = -Never, last = Never;
    for (int d = 0; d < 3; ++d)
    {
      const double low = box.min()[d] - this->tolerance - this->x[d],
                   high = box.max()[d] + this->tolerance - this->x[d];
      if (this->direction[d] != 0)
      {
        const auto [from, to] =
          std::minmax({ low / this->direction[d], high / this->direction[d] });
        first = std::max(first, from);
        last = std::min(last, to);
      }
      else if (low > 0 || high < 0)
      {
        return Never;
      }
    }
    return first > last ? Never : this->bound(std::max({ 0., first, -last }));
  }
  double minimumOnObject(int triangle)
  {
    const TriangleTree::Triangle& corner = this->triangles[static_cast<std::size_t>(triangle)];
    const Row normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const double across = normal.dot(this->direction);
    if (across == 0 || !this->fits(triangle))
    {
      return Never;
    }
    const double along = (corner[0] - this->x).dot(normal) / across;
    const Row place = this->x + along * this->direction;
    // A place in a steep triangle is the farther off, the steeper it is.
    const double off = this->tolerance / std::abs(across);
    for (int k = 0; k < 3; ++k)
    {
      const Row edge = corner[(k + 1) % 3] - corner[k];
      if (edge.cross(place - corner[k]).dot(normal) < -off * edge.norm())
      {
        return Never;
      }
    }
    return this->take(triangle, std::abs(along), place);
  }
};
}

struct TriangleTree::Implementation
{
  std::vector<Triangle> triangles;
  Tree tree;

  template <typename AnySearch>
  Found found(AnySearch& search) const
  {
    if (!this->triangles.empty())
    {
      Eigen::BVMinimize(this->tree, search);
    }
    return search.found;
  }
};

TriangleTree::TriangleTree(std::vector<Triangle> triangles)
  : implementation_(new Implementation)
{
  Implementation& own = *this->implementation_;
  own.triangles = std::move(triangles);
  std::vector<int> numbers = consecutive<int>(own.triangles.size());
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
  NearestSearch search{ { x, own.triangles, fits, radius, { -1, x } } };
  return own.found(search);
}

TriangleTree::Found TriangleTree::nearestAlong(const Row& x, const Row& direction, double radius,
  double tolerance, const std::function<bool(Index)>& fits) const
{
  const Implementation& own = *this->implementation_;
  AlongSearch search{ { x, own.triangles, fits, radius, { -1, x } }, direction, tolerance };
  return own.found(search);
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
