// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InnerFaces.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"

#include <algorithm>
#include <map>

namespace morph
{
namespace
{
using Corners = std::vector<Index>; ///< ascending

Corners sorted(const Index* begin, const Index* end)
{
  Corners corners(begin, end);
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// How many of the cells have these corners; none that are those of an outer face.
std::map<Corners, int> cellsInside(
  const Mesh& mesh, const BoundaryFaces& outer, const std::vector<std::uint8_t>& isMarked)
{
  std::map<Corners, int> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = isMarked[c] ? cellShape(mesh.types[c]) : nullptr;
    if (shape && shape->dimension == 2)
    {
      const Index size = shape->numberOfCorners > 0 ? shape->numberOfCorners : mesh.cellSize(c);
      ++cells[sorted(mesh.cell(c), mesh.cell(c) + size)];
    }
  }
  const Index* all = outer.connectivity.data();
  for (std::size_t f = 0; f + 1 < outer.offsets.size() && !cells.empty(); ++f)
  {
    cells.erase(sorted(all + outer.offsets[f], all + outer.offsets[f + 1]));
  }
  return cells;
}
}

InnerFaces innerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<std::uint8_t>& isMarked, Monitor& monitor)
{
  const std::map<Corners, int> cells = cellsInside(mesh, outer, isMarked);
  InnerFaces result;
  if (cells.empty())
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
      const auto found = cells.find(sorted(table.corners.begin(f), table.corners.end(f)));
      if (found != cells.end())
      {
        InnerFaces::Places& places = found->second > 1 ? result.baffles : result.sheets;
        places.emplace_back(c, static_cast<int>(f - table.start[c]));
      }
    }
  }
  return result;
}
}
