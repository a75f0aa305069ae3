// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/WallLayers.h"

#include "Boundary/LayerCells.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace morph
{
namespace
{
constexpr Index Conflict = -2;
}

WallLayers findWallLayers(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, Index most, const std::vector<std::uint8_t>& isLayer)
{
  const LayerCells search(mesh, faces.nodes, isLayer);
  WallLayers result;
  struct Face
  {
    Index cell;
    int size;
    Index nodes[4];
  };
  std::vector<Face> faceFront;
  for (std::size_t f = 0; f < isWall.size(); ++f)
  {
    if (isWall[f])
    {
      const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
      Face face = { faces.cells[f], static_cast<int>(size), {} };
      const Index* nodes = faces.connectivity.data() + first;
      result.walls.insert(result.walls.end(), nodes, nodes + size);
      std::copy_n(nodes, std::min<Index>(size, 4), face.nodes);
      faceFront.push_back(face);
    }
  }
  sortUnique(result.walls);

  // Where the column of each node at the front begins, and which nodes some column has.
  std::unordered_map<Index, Index> columnOf;
  std::vector<std::uint8_t> isTaken(mesh.numberOfNodes(), 0);
  for (std::size_t i = 0; i < result.walls.size(); ++i)
  {
    columnOf[result.walls[i]] = static_cast<Index>(i);
    isTaken[result.walls[i]] = 1;
  }
  std::vector<std::vector<Index>> columns(result.walls.size());
  for (Index layer = 0; layer < most && !faceFront.empty(); ++layer)
  {
    std::unordered_map<Index, Index> above; // of each node at the front, or Conflict
    std::vector<std::pair<LayerFront, Index>> fronts;
    for (const Face& face : faceFront)
    {
      LayerFront front{};
      Index next = -1;
      const bool grows = search.makeFront(face.cell, face.nodes, face.size, front) &&
                         (next = search.beyond(front)) >= 0;
      for (int k = 0; k < std::min(face.size, 4); ++k)
      {
        const Index node = grows ? front.nodes[k] : face.nodes[k];
        const Index to = grows ? front.opposite[k] : Conflict;
        const auto [found, isNew] = above.emplace(node, to);
        if (!isNew && found->second != to)
        {
          found->second = Conflict;
        }
      }
      if (grows)
      {
        fronts.emplace_back(front, next);
      }
    }
    // A node of two columns is in neither, and one on the boundary only above one of it.
    std::unordered_map<Index, Index> count;
    for (const auto& [node, to] : above)
    {
      ++count[to];
    }
    std::unordered_map<Index, Index> nextColumn;
    for (const auto& [node, to] : above)
    {
      const auto column = columnOf.find(node);
      if (to != Conflict && column != columnOf.end() && count[to] == 1 && !isTaken[to] &&
          (!search.isOuter(to) || search.isOuter(node)))
      {
        columns[column->second].push_back(to);
        nextColumn[to] = column->second;
      }
    }
    for (const auto& entry : nextColumn)
    {
      isTaken[entry.first] = 1;
    }
    columnOf.swap(nextColumn);
    faceFront.clear();
    for (const auto& [front, next] : fronts)
    {
      if (std::all_of(front.opposite, front.opposite + front.size,
            [&](Index node) { return columnOf.count(node) > 0; }))
      {
        Face face = { next, front.size, {} };
        std::copy_n(front.opposite, front.size, face.nodes);
        faceFront.push_back(face);
      }
    }
  }
  result.columns.offsets = { 0 };
  for (const std::vector<Index>& column : columns)
  {
    result.columns.values.insert(result.columns.values.end(), column.begin(), column.end());
    result.columns.offsets.push_back(static_cast<Index>(result.columns.values.size()));
  }
  return result;
}
}
