// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InnerFaces.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"

#include <algorithm>

namespace morph
{
Corners sortedCorners(const Index* begin, const Index* end)
{
  Corners corners(begin, end);
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::map<Corners, int> flatCells(const Mesh& mesh, const std::vector<std::uint8_t>& isMarked)
{
  std::map<Corners, int> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = isMarked[c] ? cellShape(mesh.types[c]) : nullptr;
    if (shape && shape->dimension == 2)
    {
      const Index size = shape->numberOfCorners > 0 ? shape->numberOfCorners : mesh.cellSize(c);
      ++cells[sortedCorners(mesh.cell(c), mesh.cell(c) + size)];
    }
  }
  return cells;
}

InnerFaces innerFaces(const Mesh& mesh, const BoundaryFaces& outer,
  const std::vector<std::uint8_t>& isMarked, Monitor& monitor)
{
  std::map<Corners, int> cells = flatCells(mesh, isMarked);
  const Index* all = outer.connectivity.data();
  for (std::size_t f = 0; f + 1 < outer.offsets.size() && !cells.empty(); ++f)
  {
    cells.erase(sortedCorners(all + outer.offsets[f], all + outer.offsets[f + 1]));
  }
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
      const auto found = cells.find(sortedCorners(table.corners.begin(f), table.corners.end(f)));
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
