// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/WallLayers.h"

#include "Boundary/LayerCells.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace morph::distributed
{
namespace
{
constexpr std::int64_t None = std::int64_t(1) << 52; // above all ids
constexpr std::int64_t Conflict = -2;

/// A face from which a layer grows into a cell of this rank, by local numbers.
struct Face
{
  Index cell, size;
  Index nodes[4];
};

/// The same by global ids.
struct FaceRecord
{
  std::int64_t cell, size;
  std::int64_t nodes[4];
};

class Search
{
public:
  Search(const DistributedMesh& mesh, const std::vector<std::uint8_t>& isLayer)
    : mesh_(mesh)
    , cells_(mesh.mesh(), mesh.outerNodes().nodes, isLayer)
    , isInner_(mesh.mesh().numberOfNodes(), 1)
    , wall_(isInner_.size(), -1)
  {
    for (const Index node : mesh.outerNodes().nodes)
    {
      this->isInner_[node] = 0;
    }
    mesh.halo().minimum(mesh.ranks(), this->isInner_);
    for (Index c = 0; c < mesh.pieceCells(); ++c)
    {
      if (mesh.isGhost()[c] == 0)
      {
        this->ownCells_.emplace_back(mesh.cellId(c), c);
      }
    }
    std::sort(this->ownCells_.begin(), this->ownCells_.end());
  }

  void begin(const std::vector<std::uint8_t>& isWall)
  {
    const BoundaryFaces& outer = this->mesh_.outerFaces();
    std::vector<std::int64_t> isFree(this->wall_.size(), 1);
    for (std::size_t f = 0; f < isWall.size(); ++f)
    {
      const Index first = outer.offsets[f], size = outer.offsets[f + 1] - first;
      for (Index k = 0; isWall[f] && k < size; ++k)
      {
        isFree[outer.connectivity[first + k]] = 0;
      }
      if (isWall[f])
      {
        Face face{ outer.cells[f], size, {} };
        std::copy_n(outer.connectivity.data() + first, std::min<Index>(size, 4), face.nodes);
        this->faces_.push_back(face);
      }
    }
    this->mesh_.halo().minimum(this->mesh_.ranks(), isFree);
    for (std::size_t n = 0; n < isFree.size(); ++n)
    {
      this->wall_[n] = isFree[n] == 0 ? this->mesh_.nodeId(static_cast<Index>(n)) : -1;
    }
  }

  bool isAtEnd() const
  {
    return this->mesh_.ranks().sum(static_cast<Index>(this->faces_.size())) == 0;
  }

  void addLayer()
  {
    std::vector<std::pair<LayerFront, Index>> fronts;
    const std::vector<std::int64_t> above = this->nodesAbove(fronts);
    const std::vector<std::uint8_t> isNew = this->extend(above);
    this->advance(fronts, isNew);
  }

  const std::vector<std::int64_t>& walls() const { return this->wall_; }

private:
  /// Returns the id of the node above each node at the front, or Conflict; None elsewhere.
  std::vector<std::int64_t> nodesAbove(std::vector<std::pair<LayerFront, Index>>& fronts) const
  {
    // A node of several ranks may have faces on each.
    std::vector<std::int64_t> lowest(this->wall_.size(), None), minusHighest = lowest;
    for (const Face& face : this->faces_)
    {
      LayerFront front{};
      Index next = -1;
      const bool grows = this->cells_.makeFront(face.cell, face.nodes, face.size, front) &&
                         (next = this->cells_.beyond(front)) >= 0;
      for (Index k = 0; k < std::min<Index>(face.size, 4); ++k)
      {
        const Index node = grows ? front.nodes[k] : face.nodes[k];
        const std::int64_t to = grows ? this->mesh_.nodeId(front.opposite[k]) : Conflict;
        lowest[node] = std::min(lowest[node], to);
        minusHighest[node] = std::min(minusHighest[node], -to);
      }
      if (grows)
      {
        fronts.emplace_back(front, next);
      }
    }
    this->mesh_.halo().minimum(this->mesh_.ranks(), lowest);
    this->mesh_.halo().minimum(this->mesh_.ranks(), minusHighest);
    for (std::size_t n = 0; n < lowest.size(); ++n)
    {
      if (lowest[n] != None && lowest[n] != -minusHighest[n])
      {
        lowest[n] = Conflict;
      }
    }
    return lowest;
  }

  /// Adds the nodes above to their columns. Returns which nodes are new.
  std::vector<std::uint8_t> extend(const std::vector<std::int64_t>& above)
  {
    // The number of nodes below, and of a single one the wall and whether it is outside.
    Points below = Points::Zero(this->mesh_.mesh().numberOfNodes(), 3);
    for (std::size_t n = 0; n < above.size(); ++n)
    {
      if (above[n] != None && above[n] != Conflict && this->mesh_.owns(static_cast<Index>(n)))
      {
        below.row(this->mesh_.nodeOf(above[n])) +=
          Eigen::RowVector3d(1, static_cast<double>(this->wall_[n]), this->isInner_[n] == 0);
      }
    }
    this->mesh_.halo().add(this->mesh_.ranks(), below);
    this->mesh_.halo().update(this->mesh_.ranks(), below);
    std::vector<std::uint8_t> isNew(above.size(), 0);
    for (std::size_t n = 0; n < above.size(); ++n)
    {
      const auto row = below.row(static_cast<Index>(n));
      // A node of two columns is in neither, and one on the boundary only above one of it.
      if (row[0] == 1 && this->wall_[n] < 0 && (this->isInner_[n] != 0 || row[2] == 1))
      {
        this->wall_[n] = static_cast<std::int64_t>(row[1]);
        isNew[n] = 1;
      }
    }
    return isNew;
  }

  /// Takes the faces of the next layer.
  void advance(
    const std::vector<std::pair<LayerFront, Index>>& fronts, const std::vector<std::uint8_t>& isNew)
  {
    this->faces_.clear();
    std::vector<FaceRecord> leaving;
    for (const auto& [front, next] : fronts)
    {
      if (!std::all_of(front.opposite, front.opposite + front.size,
            [&](Index node) { return isNew[node] != 0; }))
      {
        continue;
      }
      Face face{ next, front.size, {} };
      std::copy_n(front.opposite, front.size, face.nodes);
      if (this->mesh_.isGhost()[next] == 0)
      {
        this->faces_.push_back(face);
        continue;
      }
      FaceRecord record{ this->mesh_.cellId(next), front.size, {} };
      std::transform(face.nodes, face.nodes + front.size, record.nodes,
        [&](Index node) { return this->mesh_.nodeId(node); });
      leaving.push_back(record);
    }
    for (const FaceRecord& record : this->mesh_.ranks().gather(leaving))
    {
      const auto own = std::lower_bound(
        this->ownCells_.begin(), this->ownCells_.end(), std::pair(record.cell, Index(-1)));
      if (own != this->ownCells_.end() && own->first == record.cell)
      {
        Face face{ own->second, static_cast<Index>(record.size), {} };
        std::transform(record.nodes, record.nodes + record.size, face.nodes,
          [&](std::int64_t id) { return this->mesh_.nodeOf(id); });
        this->faces_.push_back(face);
      }
    }
  }

  const DistributedMesh& mesh_;
  const LayerCells cells_;
  std::vector<std::int64_t> isInner_;                    ///< #nodes: 0 on the boundary
  std::vector<std::int64_t> wall_;                       ///< #nodes: of a column or the wall, or -1
  std::vector<std::pair<std::int64_t, Index>> ownCells_; ///< by id
  std::vector<Face> faces_;                              ///< of this rank, at the front
};
}

std::vector<std::int64_t> findWallLayers(const DistributedMesh& mesh,
  const std::vector<std::uint8_t>& isWall, Index most, std::vector<std::uint8_t> isLayer)
{
  if (!isLayer.empty())
  {
    isLayer.resize(mesh.mesh().numberOfCells(), 0);
  }
  Search search(mesh, isLayer);
  search.begin(isWall);
  for (Index layer = 0; layer < most && !search.isAtEnd(); ++layer)
  {
    search.addLayer();
  }
  std::vector<std::int64_t> walls = search.walls();
  for (std::size_t n = 0; n < walls.size(); ++n)
  {
    if (walls[n] == mesh.nodeId(static_cast<Index>(n)))
    {
      walls[n] = -1;
    }
  }
  return walls;
}
}
