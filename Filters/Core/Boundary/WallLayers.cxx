// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/WallLayers.h"

#include "Mesh/CellShape.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace morph
{
namespace
{
/// A face of a cell from which the next layer grows, and the face that lies opposite.
struct Front
{
  Index cell;
  int size; ///< 3 or 4
  Index nodes[4];
  Index opposite[4]; ///< of each of `nodes`
};

/// The corner that an edge outside the face joins with `corner`, or -1.
int cornerAbove(const CellShape& shape, const FaceShape& face, int corner)
{
  if (shape.shape == Shape::Wedge)
  {
    return (corner + 3) % 6;
  }
  const auto isInFace = [&](int c)
  { return std::find(face.corner, face.corner + face.size, c) != face.corner + face.size; };
  for (const auto& direction : HexAxisEdges)
  {
    for (const auto& edge : direction)
    {
      const int other = edge[0] == corner ? edge[1] : edge[1] == corner ? edge[0] : -1;
      if (other >= 0 && !isInFace(other))
      {
        return other;
      }
    }
  }
  return -1;
}

class Search
{
public:
  Search(const Mesh& mesh, const BoundaryFaces& faces, const std::vector<std::uint8_t>& isLayer)
    : mesh_(mesh)
    , around_(nodeToCells(mesh))
    , isLayer_(isLayer)
    , isOuter_(mesh.numberOfNodes(), 0)
  {
    for (const Index node : faces.nodes)
    {
      this->isOuter_[node] = 1;
    }
  }

  /// Makes the front on the face of `cell` with these nodes. Returns false where the cell has no
  /// layer there.
  bool makeFront(Index cell, const Index* nodes, int size, Front& front) const
  {
    const CellShape& shape = *cellShape(this->mesh_.types[cell]);
    const bool isHex = shape.shape == Shape::Hex && size == 4;
    const bool isWedge = shape.shape == Shape::Wedge && size == 3;
    if ((!isHex && !isWedge) || (!this->isLayer_.empty() && !this->isLayer_[cell]))
    {
      return false;
    }
    const Index* ids = this->mesh_.cell(cell);
    for (int f = 0; f < shape.numberOfFaces; ++f)
    {
      const FaceShape& face = shape.faces[f];
      const auto isOne = [&](int k) {
        return std::find(nodes, nodes + size, ids[shape.cornerNode[face.corner[k]]]) !=
               nodes + size;
      };
      if (face.size != size || !isOne(0) || !isOne(1) || !isOne(2) || !isOne(size - 1))
      {
        continue;
      }
      front.cell = cell;
      front.size = size;
      for (int k = 0; k < size; ++k)
      {
        const int above = cornerAbove(shape, face, face.corner[k]);
        front.nodes[k] = ids[shape.cornerNode[face.corner[k]]];
        front.opposite[k] = ids[shape.cornerNode[above]];
      }
      return true;
    }
    return false;
  }

  /// The cell beyond the opposite face, or -1 at the boundary.
  Index beyond(const Front& front) const
  {
    const Index first = front.opposite[0];
    for (const Index* cell = this->around_.begin(first); cell != this->around_.end(first); ++cell)
    {
      const bool hasAll = std::all_of(front.opposite, front.opposite + front.size,
        [&](Index node)
        { return std::binary_search(this->around_.begin(node), this->around_.end(node), *cell); });
      if (*cell != front.cell && hasAll)
      {
        return *cell;
      }
    }
    return -1;
  }

  bool isOuter(Index node) const { return this->isOuter_[node] != 0; }

private:
  const Mesh& mesh_;
  Adjacency around_;
  const std::vector<std::uint8_t>& isLayer_;
  std::vector<std::uint8_t> isOuter_;
};

constexpr Index Conflict = -2;
}

WallLayers findWallLayers(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, Index most, const std::vector<std::uint8_t>& isLayer)
{
  const Search search(mesh, faces, isLayer);
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
  std::sort(result.walls.begin(), result.walls.end());
  result.walls.erase(std::unique(result.walls.begin(), result.walls.end()), result.walls.end());

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
    std::vector<std::pair<Front, Index>> fronts;
    for (const Face& face : faceFront)
    {
      Front front{};
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
