// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/WallLayers.h"

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
/// A face of a cell from which the next layer of cells grows, and the face that lies opposite.
struct LayerFront
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

/// Finds the cells through which layers grow: hexahedra and, from triangles, wedges.
class LayerCells
{
public:
  /// `outerNodes`: those of the boundary. `isLayer`: #cells, the only cells that count; none: all.
  /// Holds `mesh` and `isLayer` by reference. Cost: a pass over the mesh.
  LayerCells(const Mesh& mesh, const std::vector<Index>& outerNodes,
    const std::vector<std::uint8_t>& isLayer)
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

  /// The side of `cell` (CellShape::faces) with these nodes, from which a layer grows into it. -1
  /// where the cell has no layer there.
  int sideOf(Index cell, const Index* nodes, Index size) const
  {
    const CellShape& shape = *cellShape(this->mesh_, cell);
    const bool isHex = shape.shape == Shape::Hex && size == 4;
    const bool isWedge = shape.shape == Shape::Wedge && size == 3;
    if ((!isHex && !isWedge) || hasFaces(this->mesh_, cell) ||
        (!this->isLayer_.empty() && !this->isLayer_[cell]))
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

  /// `side`: one that sideOf() tells.
  LayerFront front(Index cell, int side) const
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

  /// The cell beyond the opposite face, or -1 at the boundary.
  Index beyond(const LayerFront& front) const
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
  std::vector<std::uint8_t> isOuter_; ///< #nodes
};

std::vector<Index> onAll(std::vector<Index> nodes, const Communicator& processes)
{
  processes.spread(nodes);
  sortUnique(nodes);
  return nodes;
}

/// Goes outwards, layer by layer. Every process knows the cells of a layer around all nodes of its
/// own cells, so that it decides about these nodes as one process would.
class Search
{
public:
  Search(const Mesh& mesh, const BoundaryFaces& faces, const std::vector<std::uint8_t>& isLayer,
    const Communicator& processes)
    : processes_(processes)
    , cells_(mesh, onAll(faces.nodes, processes), isLayer)
    , rows_(processes.rows())
    , place_(Points::Constant(mesh.numberOfNodes(), 3, -1))
    , sides_(mesh.numberOfCells(), 0)
  {
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (processes.isCopy(c))
      {
        this->copies_.push_back(c);
      }
    }
  }

  void begin(const BoundaryFaces& faces, const std::vector<std::uint8_t>& isWall)
  {
    std::vector<Index> walls;
    for (std::size_t f = 0; f < isWall.size(); ++f)
    {
      if (isWall[f])
      {
        const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
        const Index* nodes = faces.connectivity.data() + first;
        walls.insert(walls.end(), nodes, nodes + size);
        this->enter(faces.cells[f], nodes, size);
      }
    }
    walls = onAll(std::move(walls), this->processes_);
    const std::vector<Index> ids = this->processes_.idsOf(walls);
    for (std::size_t i = 0; i < walls.size(); ++i)
    {
      this->place_.row(walls[i]) << static_cast<double>(ids[i]), 0, 0;
      this->columns_[ids[i]];
    }
  }

  bool isAtEnd() const
  {
    return this->processes_.sum(static_cast<Index>(this->entered_.size())) == 0;
  }

  void addLayer(Index layer)
  {
    std::unordered_map<Index, Index> above; // of each node at the front
    const std::vector<LayerFront> fronts = this->leave(above);
    std::unordered_map<Index, Index> below; // how many columns lead to a node
    for (const auto& entry : above)
    {
      ++below[entry.second];
    }
    std::vector<Index> added;
    for (const auto& [node, to] : above)
    {
      // A node of two columns is in neither, and one on the boundary only above one of it.
      if (below[to] == 1 && this->place_(to, 0) < 0 &&
          (!this->cells_.isOuter(to) || this->cells_.isOuter(node)))
      {
        this->place_.row(to) << this->place_(node, 0), static_cast<double>(layer), 0;
        added.push_back(to);
      }
    }
    this->rows_->update(this->place_);
    const std::vector<Index>& elsewhere = this->rows_->countedElsewhere();
    for (const Index node : added)
    {
      if (!std::binary_search(elsewhere.begin(), elsewhere.end(), node))
      {
        this->columns_[static_cast<Index>(this->place_(node, 0))].push_back(node);
      }
    }
    const auto isNew = [&](Index node)
    { return this->place_(node, 1) == static_cast<double>(layer); };
    for (const LayerFront& front : fronts)
    {
      const Index next = this->cells_.beyond(front);
      if (next >= 0 && !this->processes_.isCopy(next) &&
          std::all_of(front.opposite, front.opposite + front.size, isNew))
      {
        this->enter(next, front.opposite, front.size);
      }
    }
  }

  const std::map<Index, std::vector<Index>>& columns() const { return this->columns_; }

private:
  /// A layer goes through this process's cell from a face, or the columns of its nodes end.
  void enter(Index cell, const Index* nodes, Index size)
  {
    const int side = this->cells_.sideOf(cell, nodes, size);
    if (side < 0 || this->cells_.beyond(this->cells_.front(cell, side)) < 0)
    {
      this->ended_.insert(this->ended_.end(), nodes, nodes + size);
      return;
    }
    if (this->sides_[cell] == 0)
    {
      this->entered_.push_back(cell);
    }
    this->sides_[cell] = static_cast<double>(this->sidesOf(cell) | 1U << side);
  }

  unsigned sidesOf(Index cell) const { return static_cast<unsigned>(this->sides_[cell]); }

  /// Returns where layers go through cells here, of all processes, and the node `above` each one
  /// whose column does not end.
  std::vector<LayerFront> leave(std::unordered_map<Index, Index>& above)
  {
    this->processes_.completeCells(this->sides_);
    std::copy_if(this->copies_.begin(), this->copies_.end(), std::back_inserter(this->entered_),
      [this](Index cell) { return this->sides_[cell] != 0; });
    std::vector<LayerFront> fronts;
    for (const Index cell : this->entered_)
    {
      for (int side = 0; this->sidesOf(cell) >> side != 0; ++side)
      {
        if ((this->sidesOf(cell) >> side & 1U) == 0)
        {
          continue;
        }
        const LayerFront& front = fronts.emplace_back(this->cells_.front(cell, side));
        for (int k = 0; k < front.size; ++k)
        {
          const auto found = above.emplace(front.nodes[k], front.opposite[k]).first;
          if (found->second != front.opposite[k])
          {
            this->ended_.push_back(front.nodes[k]);
          }
        }
      }
      this->sides_[cell] = 0;
    }
    this->entered_.clear();
    this->processes_.spread(this->ended_);
    for (const Index node : this->ended_)
    {
      above.erase(node);
    }
    this->ended_.clear();
    return fronts;
  }

  const Communicator& processes_;
  const LayerCells cells_;
  const std::unique_ptr<CopiedRows> rows_;
  Points place_;              ///< #nodes: the number of the wall node and the layer, or -1
  std::vector<double> sides_; ///< #cells: a bit for each side from which a layer goes through it
  std::vector<Index> copies_; ///< cells
  std::vector<Index> entered_, ended_; ///< cells with sides_, nodes
  std::map<Index, std::vector<Index>> columns_;
};
}

WallLayers wallLayers(const std::map<Index, std::vector<Index>>& columns)
{
  WallLayers layers;
  for (const auto& [wall, column] : columns)
  {
    layers.walls.push_back(wall);
    layers.columns.add(column.begin(), column.end());
  }
  return layers;
}

WallLayers findWallLayers(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, Index most, const std::vector<std::uint8_t>& isLayer,
  const Communicator& processes)
{
  Search search(mesh, faces, isLayer, processes);
  search.begin(faces, isWall);
  for (Index layer = 1; layer <= most && !search.isAtEnd(); ++layer)
  {
    search.addLayer(layer);
  }
  return wallLayers(search.columns());
}
}
