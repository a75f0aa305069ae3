// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ExactPredicates.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <CGAL/boost_mp.h>
#include <CGAL/box_intersection_d.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace morph
{
int orientationSign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [](const Eigen::Vector3d& x) { return Kernel::Point_3(x[0], x[1], x[2]); };
  return CGAL::orientation(point(a), point(b), point(c), point(d));
}

std::vector<std::array<Index, 2>> overlappingBoxes(const std::vector<Eigen::AlignedBox3d>& boxes,
  const std::vector<std::uint8_t>& isChosen, const std::function<bool(Index, Index)>& isWanted)
{
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Index>;
  std::vector<Box> chosen, others;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    Eigen::Vector3d lowest = boxes[i].min(), highest = boxes[i].max();
    (isChosen[i] ? chosen : others)
      .emplace_back(lowest.data(), highest.data(), static_cast<Index>(i));
  }
  std::vector<std::array<Index, 2>> pairs;
  const auto take = [&](const Box& a, const Box& b)
  {
    if (isWanted(a.info(), b.info()))
    {
      pairs.push_back({ std::min(a.info(), b.info()), std::max(a.info(), b.info()) });
    }
  };
  CGAL::box_self_intersection_d(chosen.begin(), chosen.end(), take);
  CGAL::box_intersection_d(chosen.begin(), chosen.end(), others.begin(), others.end(), take);
  std::sort(pairs.begin(), pairs.end()); // the order of the search is no part of the result
  return pairs;
}

namespace
{
constexpr int Projections = 200;
constexpr double Margin =
  1e-9; // minimum depth of a point found in double, relative to the half-spaces' size

/// A plane with unit normal: its inner side is normal . v > offset.
struct Plane
{
  Eigen::RowVector3d normal;
  double offset;
};

/// Projects a point repeatedly onto the half-space that it violates most.
bool findByProjection(const std::vector<HalfSpace>& halfSpaces)
{
  Eigen::RowVector3d v = Eigen::RowVector3d::Zero(), low = halfSpaces[0][0], high = low;
  for (const HalfSpace& h : halfSpaces)
  {
    for (const Eigen::RowVector3d& corner : h)
    {
      v += corner / (3. * static_cast<double>(halfSpaces.size()));
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const double size = (high - low).norm();
  std::vector<Plane> planes;
  for (const HalfSpace& h : halfSpaces)
  {
    const Eigen::RowVector3d outward = (h[1] - h[0]).cross(h[2] - h[0]);
    const double length = outward.norm();
    if (!(length > 0))
    {
      return false;
    }
    const Eigen::RowVector3d normal = -outward / length;
    planes.push_back({ normal, normal.dot(h[0]) });
  }
  for (int step = 0; step < Projections; ++step)
  {
    const Plane* worst = nullptr;
    double depth = 0;
    for (const Plane& plane : planes)
    {
      const double inside = plane.normal.dot(v) - plane.offset;
      if (!worst || inside < depth)
      {
        worst = &plane;
        depth = inside;
      }
    }
    if (depth > Margin * size)
    {
      return true;
    }
    // Steps slightly beyond the plane.
    v += (-depth + 0.01 * size) * worst->normal;
  }
  return false;
}

using Exact = boost::multiprecision::cpp_rational;
using ExactVector = std::array<Exact, 3>;

ExactVector minus(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b)
{
  ExactVector result;
  for (int j = 0; j < 3; ++j)
  {
    result[j] = Exact(a[j]) - Exact(b[j]);
  }
  return result;
}

/// Maximizes the slack s <= 1 in n . v - s >= n . p over all half-spaces.
bool findByLinearProgram(const std::vector<HalfSpace>& halfSpaces)
{
  CGAL::Quadratic_program<Exact> program(CGAL::LARGER, false, Exact(0), false, Exact(0));
  constexpr int Room = 3;
  int row = 0;
  for (const HalfSpace& h : halfSpaces)
  {
    const ExactVector a = minus(h[1], h[0]), b = minus(h[2], h[0]);
    Exact offset(0);
    for (int j = 0; j < 3; ++j)
    {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      const Exact normal = a[l] * b[k] - a[k] * b[l];
      program.set_a(j, row, normal);
      offset += normal * Exact(h[0][j]);
    }
    program.set_a(Room, row, Exact(-1));
    program.set_b(row, offset);
    ++row;
  }
  program.set_u(Room, true, Exact(1));
  program.set_c(Room, Exact(-1));
  const auto solution = CGAL::solve_linear_program(program, Exact());
  return CGAL::sign(solution.objective_value_numerator()) *
           CGAL::sign(solution.objective_value_denominator()) <
         0;
}
}

bool haveCommonPoint(const std::vector<HalfSpace>& halfSpaces)
{
  const auto isFinite = [](const HalfSpace& h)
  { return h[0].allFinite() && h[1].allFinite() && h[2].allFinite(); };
  if (halfSpaces.empty() || !std::all_of(halfSpaces.begin(), halfSpaces.end(), isFinite))
  {
    return true;
  }
  return findByProjection(halfSpaces) || findByLinearProgram(halfSpaces);
}
}
