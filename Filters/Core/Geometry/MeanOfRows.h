// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
/// Returns the mean of rows of `points`. `first`, `last`: iterators over at least one row number.
/// Equal rows have that row as their mean, bit for bit.
template <typename Numbers>
Eigen::RowVector3d meanOfRows(const ConstPoints& points, Numbers first, Numbers last)
{
  const Eigen::RowVector3d origin = points.row(*first);
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Numbers number = first; number != last; ++number)
  {
    sum += points.row(*number) - origin;
  }
  return origin + sum / static_cast<double>(last - first);
}
}
