// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/LayerCells.h"

#include "Mesh/CellShape.h"

#include <algorithm>

namespace morph
{
namespace
{
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
}

LayerCells::LayerCells(
  const Mesh& mesh, const std::vector<Index>& outerNodes, const std::vector<std::uint8_t>& isLayer)
  : mesh_(mesh)
  , around_(nodeToCells(mesh))
  , isLayer_(isLayer)
  , isOuter_(mesh.numberOfNodes(), 0)
{
  for (const Index node : outerNodes)
  {
    this->isOuter_[node] = 1;
  }
}

int LayerCells::sideOf(Index cell, const Index* nodes, Index size) const
{
  const CellShape& shape = *cellShape(this->mesh_, cell);
  const bool isHex = shape.shape == Shape::Hex && size == 4;
  const bool isWedge = shape.shape == Shape::Wedge && size == 3;
  if ((!isHex && !isWedge) || (!this->isLayer_.empty() && !this->isLayer_[cell]))
  {
    return -1;
  }
  const Index* ids = this->mesh_.cell(cell);
  for (int f = 0; f < shape.numberOfFaces; ++f)
  {
    const FaceShape& face = shape.faces[f];
    const auto isOne = [&](int corner)
    { return std::find(nodes, nodes + size, ids[shape.cornerNode[corner]]) != nodes + size; };
    if (face.size == size && std::all_of(face.corner, face.corner + face.size, isOne))
    {
      return f;
    }
  }
  return -1;
}

LayerFront LayerCells::front(Index cell, int side) const
{
  const CellShape& shape = *cellShape(this->mesh_, cell);
  const FaceShape& face = shape.faces[side];
  const Index* ids = this->mesh_.cell(cell);
  LayerFront front = { cell, face.size, {}, {} };
  for (int k = 0; k < face.size; ++k)
  {
    front.nodes[k] = ids[shape.cornerNode[face.corner[k]]];
    front.opposite[k] = ids[shape.cornerNode[cornerAbove(shape, face, face.corner[k])]];
  }
  return front;
}

Index LayerCells::beyond(const LayerFront& front) const
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
}
