// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronQuality.h"

#include "Mesh/Polyhedra.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

Vector at(const ConstPoints& points, Index node, double sign)
{
  return { points(node, 0), points(node, 1), sign * points(node, 2) };
}

/// The length, correct also if its square underflows.
double lengthOf(const Vector& v)
{
  const double length = v.norm();
  return length > 1e-150 ? length : v.stableNorm();
}

/// The determinant of the directions; NaN where one has no length.
double determinant(const Vector& a, const Vector& b, const Vector& c)
{
  return (a / lengthOf(a)).dot((b / lengthOf(b)).cross(c / lengthOf(c)));
}

double angle(const Vector& a, const Vector& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The edges of a cell at a node, in an order that makes the determinant of a convex one positive.
using Edges = std::array<Vector, 3>;

double determinant(const Edges& edges)
{
  return determinant(edges[0], edges[1], edges[2]);
}

/// See the header; `edges`: of the undeformed mesh.
bool isCorner(const Edges& edges)
{
  constexpr double Clear = 0.3, MostAngle = 300 * 3.14159265358979323846 / 180;
  const double value = determinant(edges);
  if (!(value > 0) || value >= Clear)
  {
    return value >= Clear;
  }
  const Vector u = edges[0].normalized(), v = edges[1].normalized(), w = edges[2].normalized();
  return angle(u, v) + angle(v, w) + angle(w, u) <= MostAngle;
}
}

void PolyhedronCenters::compute(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  this->areas.clear();
  this->centers.clear();
  // Relative to a node: far from the origin, rounding would exceed the cell's size.
  const Vector origin = at(points, mesh.cell(cell)[0], sign);
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      Vector mean = Vector::Zero();
      for (Index k = 0; k < size; ++k)
      {
        mean += at(points, nodes[k], sign) - origin;
      }
      mean /= static_cast<double>(size);
      Vector sum = Vector::Zero(), weighted = Vector::Zero();
      double weights = 0;
      for (Index k = 0; k < size; ++k)
      {
        const Vector a = at(points, nodes[k], sign) - origin;
        const Vector b = at(points, nodes[(k + 1) % size], sign) - origin;
        const Vector area = (b - a).cross(mean - a);
        const double weight = lengthOf(area);
        sum += area;
        weights += weight;
        weighted += weight * (a + b + mean);
      }
      this->areas.push_back(sum / 2);
      this->centers.push_back(size > 3 && weights > 0 ? Vector(weighted / (3 * weights)) : mean);
    });
  Vector estimate = Vector::Zero();
  for (const Vector& center : this->centers)
  {
    estimate += center / static_cast<double>(this->centers.size());
  }
  Vector weighted = Vector::Zero();
  double volume = 0, size = 0;
  for (std::size_t f = 0; f < this->centers.size(); ++f)
  {
    const double pyramid = this->areas[f].dot(this->centers[f] - estimate);
    weighted += pyramid * (0.75 * this->centers[f] + 0.25 * estimate);
    volume += pyramid;
    size += std::abs(pyramid);
  }
  const bool hasVolume = std::abs(volume) > 1e-12 * size;
  this->cell = origin + (hasVolume ? Vector(weighted / volume) : estimate);
  for (Vector& center : this->centers)
  {
    center += origin;
  }
}

double PolyhedronMeasure::leastCorner(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  this->corners_.clear();
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      for (Index k = 0; k < size; ++k)
      {
        this->corners_.push_back({ nodes[k], nodes[(k + size - 1) % size], nodes[(k + 1) % size] });
      }
    });
  std::sort(this->corners_.begin(), this->corners_.end(),
    [](const Corner& a, const Corner& b)
    { return a.node < b.node || (a.node == b.node && a.next < b.next); });
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first < this->corners_.size();)
  {
    std::size_t end = first + 1;
    while (end < this->corners_.size() && this->corners_[end].node == this->corners_[first].node)
    {
      ++end;
    }
    if (end - first == 3)
    {
      const Corner& corner = this->corners_[first];
      const Index second = this->corners_[first + 1].next, third = this->corners_[first + 2].next;
      const Index other = corner.last == second ? third : second;
      const auto edgesIn = [&](const ConstPoints& positions) -> Edges
      {
        const Vector x = at(positions, corner.node, sign);
        return { at(positions, corner.last, sign) - x, at(positions, corner.next, sign) - x,
          at(positions, other, sign) - x };
      };
      if (isCorner(edgesIn(mesh.points)))
      {
        const double value = determinant(edgesIn(points));
        least = value < least || std::isnan(value) ? value : least;
      }
      if (std::isnan(least))
      {
        return least;
      }
    }
    first = end;
  }
  return least;
}

double PolyhedronMeasure::scaledJacobian(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign, bool& isCollapsed)
{
  isCollapsed = false;
  for (Index k = 0; k < mesh.cellSize(cell); ++k)
  {
    if (!points.row(mesh.cell(cell)[k]).allFinite())
    {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  this->centers_.compute(mesh, cell, points, sign);
  double least = this->leastCorner(mesh, cell, points, sign);
  std::size_t face = 0;
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      const Vector& center = this->centers_.centers[face++];
      for (Index k = 0; k < size; ++k)
      {
        const Vector a = at(points, nodes[k], sign), b = at(points, nodes[(k + 1) % size], sign);
        const double value = determinant(b - a, center - (a + b) / 2, center - this->centers_.cell);
        least = value < least || std::isnan(value) ? value : least;
      }
    });
  if (face == 0)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  isCollapsed = std::isnan(least);
  return isCollapsed ? 0 : least;
}

Certificate PolyhedronMeasure::certify(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  for (Index k = 0; k < mesh.cellSize(cell); ++k)
  {
    if (!points.row(mesh.cell(cell)[k]).allFinite())
    {
      return Certificate::Undecided;
    }
  }
  this->centers_.compute(mesh, cell, points, sign);
  Certificate result =
    this->centers_.areas.empty() ? Certificate::Undecided : Certificate::Certified;
  for (std::size_t f = 0; f < this->centers_.areas.size(); ++f)
  {
    const Vector line = this->centers_.centers[f] - this->centers_.cell;
    const double pyramid = this->centers_.areas[f].dot(line);
    const double error = 1e-13 * this->centers_.areas[f].norm() * line.norm();
    const Certificate found = pyramid > error    ? Certificate::Certified
                              : pyramid < -error ? Certificate::Inverted
                                                 : Certificate::Undecided;
    result = std::min(result, found);
  }
  return result;
}
}
