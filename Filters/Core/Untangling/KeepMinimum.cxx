// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/KeepMinimum.h"

#include "Mesh/CellShape.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr int Layers = 30;
}

Index keepMinimum(const Mesh& mesh, const std::vector<Index>& free, const Points& start,
  Points& points, const std::function<Quality(Points&)>& measure, const Communicator& communicator)
{
  Points copy = start;
  const double minimum = measure(copy).minimum;
  if (!(minimum > 0))
  {
    return 0;
  }
  std::vector<char> movable(mesh.numberOfNodes(), 0);
  for (Index node : free)
  {
    movable[node] = 1;
  }
  std::vector<Index> back;
  const auto takeBack = [&](Index node)
  {
    if (movable[node])
    {
      points.row(node) = start.row(node);
      movable[node] = 0;
      back.push_back(node);
    }
  };
  for (int layer = 0; layer <= Layers; ++layer)
  {
    const Quality quality = measure(points);
    if (quality.minimum >= minimum)
    {
      break;
    }
    std::vector<Index> corners;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      // Cells that are not measured are NaN.
      if (quality.scaledJacobian[c] < minimum)
      {
        corners.insert(
          corners.end(), mesh.cell(c), mesh.cell(c) + cellShape(mesh, c)->numberOfCorners);
      }
    }
    communicator.spread(corners);
    std::for_each(corners.begin(), corners.end(), takeBack);
    if (layer == Layers)
    {
      std::for_each(free.begin(), free.end(), takeBack);
    }
  }
  const std::unique_ptr<CopiedRows> rows = communicator.rows(back);
  return communicator.sum(static_cast<Index>(back.size() - rows->countedElsewhere().size()));
}
}
