// SPDX-License-Identifier: BSD-3-Clause
#include "CgalBaseline.h"

#include "Timing.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/natural_neighbor_coordinates_3.h>

#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

namespace benchmark
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;

Point pointAt(const Eigen::RowVector3d& x)
{
  return Point(x[0], x[1], x[2]);
}
}

struct CgalBaseline::Implementation
{
  Triangulation triangulation;
  double seconds = 0;
  std::map<Point, morph::Index> number;
};

CgalBaseline::CgalBaseline(const morph::Points& sites)
  : implementation_(std::make_unique<Implementation>())
{
  std::vector<Point> points;
  for (morph::Index i = 0; i < sites.rows(); ++i)
  {
    points.push_back(pointAt(sites.row(i)));
    this->implementation_->number[points.back()] = i;
  }
  const Stopwatch watch;
  this->implementation_->triangulation.insert(points.begin(), points.end());
  this->implementation_->seconds = watch.seconds();
}

CgalBaseline::~CgalBaseline() = default;

double CgalBaseline::delaunaySeconds() const
{
  return this->implementation_->seconds;
}

double CgalBaseline::locate(const morph::Points& places) const
{
  const Stopwatch watch;
  Triangulation::Cell_handle cell;
  for (morph::Index i = 0; i < places.rows(); ++i)
  {
    cell = this->implementation_->triangulation.locate(pointAt(places.row(i)), cell);
  }
  return watch.seconds();
}

CgalBaseline::Sibson CgalBaseline::sibson(const Eigen::RowVector3d& x) const
{
  Sibson result;
  std::vector<std::pair<Triangulation::Vertex_handle, double>> coordinates;
  double norm = 0;
  const Stopwatch watch;
  const bool found = CGAL::sibson_natural_neighbor_coordinates_3(
    this->implementation_->triangulation, pointAt(x), std::back_inserter(coordinates), norm)
                       .third;
  result.seconds = watch.seconds();
  if (!found)
  {
    throw std::runtime_error("CGAL finds no natural neighbors of a node inside.");
  }
  for (const auto& [vertex, weight] : coordinates)
  {
    result.sites.push_back(this->implementation_->number.at(vertex->point()));
    result.weights.push_back(weight / norm);
  }
  return result;
}
}
