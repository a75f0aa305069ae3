// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/Delaunay.h"

#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>
#include <CGAL/Quotient.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_data_structure_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double FlatVolume =
  1e-4; // 6 V / (longest edge)^3 below which a center takes exact arithmetic

constexpr int LeastSteps = 1000; // of a walk, before all tetrahedra are tried

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<int, Kernel,
  CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

Point toPoint(const double* x)
{
  return Point(x[0], x[1], x[2]);
}

/// Differences from this origin are exact: x - y is exact where y / 2 <= x <= 2 y (Sterbenz).
Eigen::RowVector3d exactOrigin(const Points& sites)
{
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  for (int j = 0; j < 3 && sites.rows() > 0; ++j)
  {
    const double low = sites.col(j).minCoeff(), high = sites.col(j).maxCoeff();
    if (low > 0 && high <= 2 * low)
    {
      origin[j] = low;
    }
    else if (high < 0 && low >= 2 * high)
    {
      origin[j] = high;
    }
  }
  return origin;
}

/// Builds the triangulation with each site's number in its vertex's `info`. Inserts the sites as
/// CGAL inserts a range, but can be cancelled.
Triangulation triangulated(const Points& sites, Monitor& monitor)
{
  std::vector<Point> points;
  points.reserve(sites.rows());
  std::vector<std::size_t> order = consecutive<std::size_t>(sites.rows());
  for (Index i = 0; i < sites.rows(); ++i)
  {
    points.push_back(toPoint(sites.row(i).data()));
  }
  monitor.check();
  using PointOf = CGAL::Pointer_property_map<Point>::type;
  CGAL::spatial_sort(order.begin(), order.end(),
    CGAL::Spatial_sort_traits_adapter_3<Kernel, PointOf>(CGAL::make_property_map(points)));
  Triangulation triangulation;
  Triangulation::Vertex_handle last;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (i % Grain == 0)
    {
      monitor.check();
    }
    last = triangulation.insert(points[order[i]], last);
    last->info() = static_cast<int>(order[i]);
  }
  return triangulation;
}

/// Numbers the cells inside the hull in their `info`, and marks the others Outside. Returns the
/// number inside.
int numberCells(const Triangulation& triangulation)
{
  int count = 0;
  for (auto cell = triangulation.all_cells_begin(); cell != triangulation.all_cells_end(); ++cell)
  {
    cell->info() = triangulation.is_infinite(cell) ? Delaunay::Outside : count++;
  }
  return count;
}

/// Whether the origin is certainly, despite rounding, on the negative side of the triangle a, b, c.
/// The error is below 7.8e-16 times the sum of the absolute products (Shewchuk, Discrete Comput.
/// Geom. 18 (1997) 305-363).
bool isBeyond(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& c)
{
  const double x[3] = { b[1] * c[2], b[2] * c[0], b[0] * c[1] };
  const double y[3] = { b[2] * c[1], b[0] * c[2], b[1] * c[0] };
  double determinant = 0, absolute = 0;
  for (int j = 0; j < 3; ++j)
  {
    determinant += a[j] * (x[j] - y[j]);
    absolute += std::abs(a[j]) * (std::abs(x[j]) + std::abs(y[j]));
  }
  // Seen from the origin, a face's corners have the opposite order: a positive determinant is the
  // negative side.
  return determinant > 1e-15 * absolute;
}

/// Computes a circumcenter in exact arithmetic: for a flat tetrahedron it is a quotient of two
/// differences that nearly cancel. Quotients of long floats need no common divisors, and become
/// doubles whatever their size.
Eigen::RowVector3d exactCircumcenter(const Points& sites, const std::array<int, 4>& corners)
{
  using Exact = CGAL::Simple_cartesian<CGAL::Quotient<CGAL::MP_Float>>;
  Exact::Point_3 p[4];
  for (int k = 0; k < 4; ++k)
  {
    const auto x = sites.row(corners[k]);
    p[k] = Exact::Point_3(x[0], x[1], x[2]);
  }
  const Exact::Point_3 center = CGAL::circumcenter(p[0], p[1], p[2], p[3]);
  return { CGAL::to_double(center.x()), CGAL::to_double(center.y()), CGAL::to_double(center.z()) };
}
}

void Delaunay::build(const Points& absolute, Monitor& monitor)
{
  const Eigen::RowVector3d origin = exactOrigin(absolute);
  Points sites = absolute.rowwise() - origin;
  const Triangulation triangulation = triangulated(sites, monitor);
  if (triangulation.dimension() < 3)
  {
    throw Error(
      Error::Kind::Singular, "The " + std::to_string(sites.rows()) +
                               " distinct places of prescribed nodes lie in one plane, or on one "
                               "line: they span no volume to interpolate in. "
                               "Prescribe nodes on all sides of the mesh, or choose FEMWARP.");
  }
  monitor.check();

  const int count = numberCells(triangulation);
  std::vector<Tetrahedron> tetrahedra(count);
  std::vector<int> atSite(sites.rows(), Outside);
  for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end();
       ++cell)
  {
    Tetrahedron& tetrahedron = tetrahedra[cell->info()];
    for (int k = 0; k < 4; ++k)
    {
      tetrahedron.sites[k] = cell->vertex(k)->info();
      tetrahedron.neighbors[k] = cell->neighbor(k)->info();
      atSite[tetrahedron.sites[k]] = cell->info();
    }
  }
  this->origin_ = origin;
  this->rounding_ = 8 * std::numeric_limits<double>::epsilon() * absolute.cwiseAbs().maxCoeff();
  this->sites_.swap(sites);
  this->tetrahedra_.swap(tetrahedra);
  this->atSite_.swap(atSite);
  this->isDelaunay_ = true;
}

void Delaunay::replace(Points sites, std::vector<Tetrahedron> tetrahedra)
{
  std::vector<int> atSite(sites.rows(), Outside);
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
  {
    for (const int site : tetrahedra[t].sites)
    {
      atSite[site] = static_cast<int>(t);
    }
  }
  this->sites_.swap(sites);
  this->tetrahedra_.swap(tetrahedra);
  this->atSite_.swap(atSite);
  this->isDelaunay_ = false;
}

int Delaunay::locate(const Eigen::RowVector3d& x, int start) const
{
  constexpr auto& Faces = Tetrahedron::Faces;
  /// Returns a neighbor on whose side x certainly is, but for `before`, or `here`.
  const auto nextOf = [&](int here, int before, std::uint32_t turn)
  {
    const Tetrahedron& tetrahedron = this->tetrahedra_[here];
    Eigen::RowVector3d d[4];
    for (int k = 0; k < 4; ++k)
    {
      d[k] = this->sites_.row(tetrahedron.sites[k]) - x;
    }
    for (std::uint32_t i = 0; i < 4; ++i)
    {
      const std::uint32_t k = (i + turn) % 4;
      const int neighbor = tetrahedron.neighbors[k];
      if (neighbor != Outside && neighbor != before &&
          isBeyond(d[Faces[k][0]], d[Faces[k][1]], d[Faces[k][2]]))
      {
        return neighbor;
      }
    }
    return here;
  };
  const auto count = static_cast<std::int64_t>(this->tetrahedra_.size());
  int before = Outside; // the previous tetrahedron: x is not on its side
  int here = start;
  std::uint32_t random = 0;
  for (std::int64_t step = 0; this->isDelaunay_ || step < LeastSteps + count; ++step)
  {
    const std::uint32_t turn = this->isDelaunay_ ? 0 : random >> 30;
    random = 1664525 * random + 1013904223; // Numerical Recipes' generator
    const int next = nextOf(here, before, turn);
    if (next == here)
    {
      return here;
    }
    before = here;
    here = next;
  }
  for (int t = 0; t < count; ++t)
  {
    if (nextOf(t, Outside, 0) == t)
    {
      return t;
    }
  }
  return here;
}

int Delaunay::startNear(const Eigen::RowVector3d& x) const
{
  // This sample size balances its own cost with that of the walk.
  const Index n = this->sites_.rows();
  const Index step =
    std::max<Index>(1, n / (4 * static_cast<Index>(std::cbrt(static_cast<double>(n))) + 1));
  double best = std::numeric_limits<double>::infinity();
  int start = 0;
  for (Index i = 0; i < n; i += step)
  {
    const double distance = (this->sites_.row(i) - x).squaredNorm();
    if (distance < best && this->atSite_[i] != Outside)
    {
      best = distance;
      start = this->atSite_[i];
    }
  }
  return start;
}

Points Delaunay::circumcenters(Monitor& monitor) const
{
  Points centers(static_cast<Index>(this->tetrahedra_.size()), 3);
  parallel(centers.rows(), Grain, monitor,
    [&](Index t)
    {
      const auto& s = this->tetrahedra_[t].sites;
      const Eigen::RowVector3d origin = this->sites_.row(s[0]);
      const Eigen::RowVector3d a = this->sites_.row(s[1]) - origin;
      const Eigen::RowVector3d b = this->sites_.row(s[2]) - origin;
      const Eigen::RowVector3d c = this->sites_.row(s[3]) - origin;
      const double volume = a.dot(b.cross(c));
      const double longest = std::max({ a.norm(), b.norm(), c.norm() });
      if (volume > FlatVolume * longest * longest * longest)
      {
        centers.row(t) = origin + (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) +
                                    c.squaredNorm() * a.cross(b)) /
                                    (2 * volume);
      }
      else
      {
        centers.row(t) = exactCircumcenter(this->sites_, s);
      }
    });
  return centers;
}

double Delaunay::sixVolumes(const Tetrahedron& tetrahedron, const Points& positions)
{
  const auto& s = tetrahedron.sites;
  const Eigen::RowVector3d a = positions.row(s[1]) - positions.row(s[0]);
  const Eigen::RowVector3d b = positions.row(s[2]) - positions.row(s[0]);
  const Eigen::RowVector3d c = positions.row(s[3]) - positions.row(s[0]);
  return a.dot(b.cross(c));
}
}
