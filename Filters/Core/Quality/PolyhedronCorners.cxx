// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolyhedronCorners.h"

#include "Mesh/Polyhedra.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

double angle(const Vector& a, const Vector& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// See PolyhedronMeasure. The edges: of the undeformed mesh, in an order that makes the determinant
/// of a convex corner positive.
bool isCorner(const Vector& a, const Vector& b, const Vector& c)
{
  constexpr double Clear = 0.3, MostAngle = 300 * 3.14159265358979323846 / 180;
  const double value = determinantOfDirections(a, b, c);
  if (!(value > 0) || value >= Clear)
  {
    return value >= Clear;
  }
  const Vector u = a.normalized(), v = b.normalized(), w = c.normalized();
  return angle(u, v) + angle(v, w) + angle(w, u) <= MostAngle;
}
}

double lengthOf(const Vector& v)
{
  const double length = v.norm();
  return length > 1e-150 ? length : v.stableNorm();
}

double determinantOfDirections(const Vector& a, const Vector& b, const Vector& c)
{
  return (a / lengthOf(a)).dot((b / lengthOf(b)).cross(c / lengthOf(c)));
}

const std::vector<PolyhedronCorner>& PolyhedronCorners::find(
  const Mesh& mesh, Index cell, double sign)
{
  this->found_.clear();
  this->inFaces_.clear();
  forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      for (Index k = 0; k < size; ++k)
      {
        this->inFaces_.push_back({ nodes[k], nodes[(k + size - 1) % size], nodes[(k + 1) % size] });
      }
    });
  std::sort(this->inFaces_.begin(), this->inFaces_.end(),
    [](const InFace& a, const InFace& b)
    { return a.node < b.node || (a.node == b.node && a.next < b.next); });
  for (std::size_t first = 0; first < this->inFaces_.size();)
  {
    std::size_t end = first + 1;
    while (end < this->inFaces_.size() && this->inFaces_[end].node == this->inFaces_[first].node)
    {
      ++end;
    }
    if (end - first == 3)
    {
      const InFace& in = this->inFaces_[first];
      const Index second = this->inFaces_[first + 1].next, third = this->inFaces_[first + 2].next;
      const PolyhedronCorner corner = { in.node, in.last, in.next,
        in.last == second ? third : second };
      const Vector x = nodeAt(mesh.points, corner.node, sign);
      if (isCorner(nodeAt(mesh.points, corner.last, sign) - x,
            nodeAt(mesh.points, corner.next, sign) - x,
            nodeAt(mesh.points, corner.other, sign) - x))
      {
        this->found_.push_back(corner);
      }
    }
    first = end;
  }
  return this->found_;
}
}
