// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronQuality.h"

#include "Mesh/Polyhedra.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

/// The length, correct also if its square underflows.
double lengthOf(const Vector& v)
{
  const double length = v.norm();
  return length > 1e-150 ? length : v.stableNorm();
}
}

bool PolyhedronPlaces::take(const Mesh& mesh, Index cell, const std::vector<Vector>& x)
{
  const Index* nodes = mesh.cell(cell);
  const Index size = mesh.cellSize(cell);
  this->place_.resize(size);
  std::iota(this->place_.begin(), this->place_.end(), 0);
  std::sort(this->place_.begin(), this->place_.end(),
    [nodes](int a, int b) { return nodes[a] < nodes[b]; });
  this->sorted_.clear();
  for (const int place : this->place_)
  {
    this->sorted_.push_back(nodes[place]);
  }
  this->nodes_.clear();
  this->weights_.clear();
  this->shares_.clear();
  this->start_.assign(1, 0);
  bool hasLengths = true;
  std::vector<Vector> areas, centers;
  std::vector<double> triangles;
  forEachFace(mesh, cell,
    [&](const Index* face, Index count)
    {
      const std::size_t first = this->nodes_.size();
      const double share = 1 / static_cast<double>(count);
      Vector mean = Vector::Zero();
      for (Index k = 0; k < count; ++k)
      {
        const auto at = std::lower_bound(this->sorted_.begin(), this->sorted_.end(), face[k]);
        this->nodes_.push_back(this->place_[at - this->sorted_.begin()]);
        mean += share * x[this->nodes_.back()];
      }
      const auto corner = [&](Index k) -> const Vector&
      { return x[this->nodes_[first + k % count]]; };
      Vector sum = Vector::Zero();
      triangles.clear();
      for (Index k = 0; k < count; ++k)
      {
        const Vector area = (corner(k + 1) - corner(k)).cross(mean - corner(k));
        sum += area;
        triangles.push_back(lengthOf(area));
        hasLengths = hasLengths && corner(k + 1) != corner(k);
      }
      const double all = std::accumulate(triangles.begin(), triangles.end(), 0.);
      Vector center = Vector::Zero();
      for (Index k = 0; k < count; ++k)
      {
        // Each triangle has two of the nodes, and a third of it is the mean of all.
        const double own = triangles[k] + triangles[(k + count - 1) % count];
        this->weights_.push_back(count > 3 && all > 0 ? own / (3 * all) + share / 3 : share);
        center += this->weights_.back() * corner(k);
      }
      areas.push_back(sum / 2);
      centers.push_back(center);
      this->start_.push_back(this->nodes_.size());
    });
  const double mean = 1 / static_cast<double>(centers.size());
  const Vector estimate = mean * std::accumulate(centers.begin(), centers.end(), Vector(0, 0, 0));
  double volume = 0, extent = 0;
  for (std::size_t f = 0; f < centers.size(); ++f)
  {
    this->shares_.push_back(areas[f].dot(centers[f] - estimate));
    volume += this->shares_[f];
    extent += std::abs(this->shares_[f]);
  }
  for (double& share : this->shares_)
  {
    // The center of a pyramid is at three quarters of the way from its apex.
    share = std::abs(volume) > 1e-12 * extent ? 0.75 * share / volume + 0.25 * mean : mean;
  }
  return hasLengths && !this->shares_.empty();
}

template <typename Act>
bool PolyhedronPlaces::forEachValue(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign, const Act& act)
{
  // Relative to a node: far from the origin, rounding would exceed the cell's size.
  const Index* nodes = mesh.cell(cell);
  this->x_.clear();
  for (Index k = 0; k < mesh.cellSize(cell); ++k)
  {
    this->x_.push_back((points.row(nodes[k]) - points.row(nodes[0])).transpose());
    if (!points.row(nodes[k]).allFinite())
    {
      return false;
    }
  }
  this->take(mesh, cell, this->x_);
  this->forEach(this->x_.data(), [&](const Vector& a, const Vector& b, const Vector& c)
    { act(sign * (a / lengthOf(a)).dot((b / lengthOf(b)).cross(c / lengthOf(c)))); });
  return !this->shares_.empty();
}

double PolyhedronPlaces::scaledJacobian(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign, bool& isCollapsed)
{
  double least = std::numeric_limits<double>::infinity();
  isCollapsed = false;
  const bool isMeasured = this->forEachValue(mesh, cell, points, sign,
    [&](double value)
    {
      isCollapsed = isCollapsed || std::isnan(value);
      least = std::min(least, value);
    });
  return !isMeasured ? std::numeric_limits<double>::quiet_NaN() : isCollapsed ? 0 : least;
}

Certificate PolyhedronPlaces::certify(
  const Mesh& mesh, Index cell, const ConstPoints& points, double sign)
{
  constexpr double Rounding = 1e-13;
  Certificate result = Certificate::Certified;
  const bool isExamined = this->forEachValue(mesh, cell, points, sign,
    [&result](double value)
    {
      result = std::min(result, value > Rounding    ? Certificate::Certified
                                : value < -Rounding ? Certificate::Inverted
                                                    : Certificate::Undecided);
    });
  return isExamined ? result : Certificate::Undecided;
}
}
