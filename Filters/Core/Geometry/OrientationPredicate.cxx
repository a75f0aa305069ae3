// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/OrientationPredicate.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace morph
{
int orientationSign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [](const Eigen::Vector3d& x) { return Kernel::Point_3(x[0], x[1], x[2]); };
  return CGAL::orientation(point(a), point(b), point(c), point(d));
}
}
