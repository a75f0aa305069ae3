// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/OverlappingBoxes.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace morph
{
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
}
