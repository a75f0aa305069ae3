// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/UnknownOrdering.h"

#include "Geometry/SpatialOrder.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"

#include <algorithm>

namespace morph
{
std::vector<Index> unknownOrdering(const Mesh& mesh, const std::vector<Index>& free)
{
  constexpr Index Small = 10000; // fits a cache in any order
  // mean span of a cell, as a share of all ids, that counts as far
  constexpr double FarShare = 1. / 16;
  if (static_cast<Index>(free.size()) <= Small)
  {
    return free;
  }
  const Index cells = mesh.numberOfCells();
  double spans = 0;
  Index count = 0;
  for (Index c = 0; c < cells; ++c)
  {
    const int n = numberOfCorners(cellShape(mesh, c)->shape);
    if (n > 0)
    {
      const auto range = std::minmax_element(mesh.cell(c), mesh.cell(c) + n);
      spans += static_cast<double>(*range.second - *range.first);
      ++count;
    }
  }
  const bool far = spans > FarShare * static_cast<double>(count) * mesh.numberOfNodes();
  return far ? spatialOrder(mesh.points, free) : free;
}

Index indexInFree(const std::vector<Index>& rows, const std::vector<Index>& free, Index row)
{
  if (rows[row] == free[row])
  {
    return row;
  }
  return std::lower_bound(free.begin(), free.end(), rows[row]) - free.begin();
}
}
