// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BaffleFaces.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"

#include <algorithm>

namespace morph
{
namespace
{
using Corners = std::vector<Index>; ///< ascending

/// The places of two or more of the walls.
std::vector<Corners> coincidentWalls(const Mesh& mesh, const std::vector<std::uint8_t>& isWall)
{
  std::vector<Corners> walls, twice;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = isWall[c] ? cellShape(mesh.types[c]) : nullptr;
    if (shape && shape->dimension == 2)
    {
      const Index size = shape->numberOfCorners > 0 ? shape->numberOfCorners : mesh.cellSize(c);
      Corners& wall = walls.emplace_back(mesh.cell(c), mesh.cell(c) + size);
      std::sort(wall.begin(), wall.end());
    }
  }
  std::sort(walls.begin(), walls.end());
  for (std::size_t i = 1; i < walls.size(); ++i)
  {
    if (walls[i] == walls[i - 1] && (twice.empty() || twice.back() != walls[i]))
    {
      twice.push_back(walls[i]);
    }
  }
  return twice;
}
}

std::vector<std::pair<Index, int>> baffleFaces(
  const Mesh& mesh, const std::vector<std::uint8_t>& isWall, Monitor& monitor)
{
  const std::vector<Corners> walls = coincidentWalls(mesh, isWall);
  std::vector<std::pair<Index, int>> result;
  if (walls.empty())
  {
    return result;
  }
  const FaceTable table = faceTable(mesh, monitor);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
    {
      if (table.first[f] != f || table.uses[f] < 2)
      {
        continue;
      }
      Corners corners(table.corners.begin(f), table.corners.end(f));
      std::sort(corners.begin(), corners.end());
      if (std::binary_search(walls.begin(), walls.end(), corners))
      {
        result.emplace_back(c, static_cast<int>(f - table.start[c]));
      }
    }
  }
  return result;
}
}
