// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronQuality.h"

#include "Mesh/Polyhedra.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

Vector at(const ConstPoints& points, Index node, double sign)
{
  return nodeAt(points, node, sign);
}
}

void PolyhedronCenters::compute(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  this->areas.clear();
  this->centers.clear();
  this->triangles.clear();
  this->shares.clear();
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
        this->triangles.push_back(weight);
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
    this->shares.push_back(pyramid);
  }
  const bool hasVolume = std::abs(volume) > 1e-12 * size;
  this->cell = origin + (hasVolume ? Vector(weighted / volume) : estimate);
  const double mean = 1 / static_cast<double>(this->centers.size());
  for (double& share : this->shares)
  {
    share = hasVolume ? 0.75 * share / volume + 0.25 * mean : mean;
  }
  for (Vector& center : this->centers)
  {
    center += origin;
  }
}

double PolyhedronMeasure::leastCorner(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  double least = std::numeric_limits<double>::infinity();
  for (const PolyhedronCorner& corner : this->corners_.find(mesh, cell, sign))
  {
    const Vector x = at(points, corner.node, sign);
    const double value = determinantOfDirections(at(points, corner.last, sign) - x,
      at(points, corner.next, sign) - x, at(points, corner.other, sign) - x);
    if (std::isnan(value))
    {
      return value;
    }
    least = std::min(least, value);
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
        const double value =
          determinantOfDirections(b - a, center - (a + b) / 2, center - this->centers_.cell);
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
