// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"

#include "Mesh/CellShape.h"
#include "Mesh/FacesOfCells.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/ShapeVolumes.h"
#include "Mesh/SharedCorners.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

namespace morph::distributed
{
namespace
{
/// Above all ids, and a double holds it.
constexpr std::int64_t NoBody = std::int64_t(1) << 52;

bool isVolume(const Mesh& mesh, Index cell)
{
  const CellShape* shape = cellShape(mesh.types[cell]);
  return shape && shape->dimension == 3;
}

/// A copy of `mesh` with a vertex for each ghost.
Mesh withoutGhosts(const Mesh& mesh, const std::vector<std::uint8_t>& isGhost)
{
  Mesh result;
  result.points = mesh.points;
  result.types = mesh.types;
  result.offsets = { 0 };
  if (hasPolyhedra(mesh))
  {
    result.faceOffsets = { 0 };
  }
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const bool ghost = !isGhost.empty() && isGhost[c] != 0 && mesh.cellSize(c) > 0;
    const Index* nodes = mesh.cell(c);
    result.connectivity.insert(
      result.connectivity.end(), nodes, nodes + (ghost ? 1 : mesh.cellSize(c)));
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
    if (ghost)
    {
      result.types[c] = Vertex;
    }
    if (hasPolyhedra(mesh))
    {
      if (!ghost)
      {
        result.faces.insert(result.faces.end(), mesh.faces.begin() + mesh.faceOffsets[c],
          mesh.faces.begin() + mesh.faceOffsets[c + 1]);
      }
      result.faceOffsets.push_back(static_cast<Index>(result.faces.size()));
    }
  }
  return result;
}
}

/// The messages that carry ghost cells.
struct DistributedMesh::Builder
{
  struct Node
  {
    std::int64_t id;
    std::array<double, 3> x;
    std::int64_t owner;
    bool operator<(const Node& other) const { return this->id < other.id; }
    bool operator==(const Node& other) const { return this->id == other.id; }
  };

  DistributedMesh& mesh;
  std::set<std::pair<Index, int>> sent;             ///< cells, by rank
  std::vector<std::vector<Node>> nodes;             ///< for each rank
  std::vector<std::set<Index>> nodesSent;           ///< by rank
  std::vector<std::vector<std::int64_t>> cells;     ///< for each rank
  std::vector<std::vector<Index>> packed, unpacked; ///< cells of all layers, for each rank

  explicit Builder(DistributedMesh& owner)
    : mesh(owner)
    , nodesSent(owner.ranks_->count())
    , packed(owner.ranks_->count())
    , unpacked(owner.ranks_->count())
  {
  }

  void open()
  {
    this->nodes.assign(this->mesh.ranks_->count(), {});
    this->cells.assign(this->mesh.ranks_->count(), {});
  }

  /// Packs a cell of the piece for `rank`, unless it has been sent: its global id, type, nodes,
  /// and the faces of a polyhedron, each list after its length.
  void pack(Index cell, int rank)
  {
    if (!this->sent.emplace(cell, rank).second)
    {
      return;
    }
    const Mesh& m = this->mesh.mesh_;
    this->packed[rank].push_back(cell);
    std::vector<std::int64_t>& stream = this->cells[rank];
    stream.push_back(this->mesh.cellIds_[cell]);
    stream.push_back(m.types[cell]);
    stream.push_back(m.cellSize(cell));
    for (Index k = 0; k < m.cellSize(cell); ++k)
    {
      const Index node = m.cell(cell)[k];
      stream.push_back(this->mesh.nodeIds_[node]);
      if (this->nodesSent[rank].insert(node).second)
      {
        this->nodes[rank].push_back({ this->mesh.nodeIds_[node],
          { m.points(node, 0), m.points(node, 1), m.points(node, 2) }, this->mesh.owner_[node] });
      }
    }
    const std::size_t length = stream.size();
    stream.push_back(0);
    forEachFace(m, cell,
      [&](const Index* face, Index size)
      {
        stream.push_back(size);
        for (Index k = 0; k < size; ++k)
        {
          stream.push_back(this->mesh.nodeIds_[face[k]]);
        }
      });
    stream[length] = static_cast<std::int64_t>(stream.size() - length - 1);
  }

  /// Packs the cells around nodes for the ranks that ask for them.
  void packAround(const std::vector<Directory::Request>& requests)
  {
    const Mesh& m = this->mesh.mesh_;
    std::unordered_map<Index, std::vector<int>> ranksOf;
    for (const Directory::Request& request : requests)
    {
      ranksOf[this->mesh.nodeOf(request.id)].push_back(static_cast<int>(request.rank));
    }
    for (Index c = 0; c < this->mesh.pieceCells_ && !ranksOf.empty(); ++c)
    {
      if (this->mesh.isGhost_[c] != 0 || !isVolume(m, c))
      {
        continue;
      }
      for (Index k = 0; k < m.cellSize(c); ++k)
      {
        const auto found = ranksOf.find(m.cell(c)[k]);
        if (found != ranksOf.end())
        {
          for (int rank : found->second)
          {
            this->pack(c, rank);
          }
        }
      }
    }
  }

  /// Appends nodes that are not here yet.
  void append(const std::vector<Node>& added)
  {
    Mesh& m = this->mesh.mesh_;
    Index n = m.numberOfNodes();
    m.points.conservativeResize(n + static_cast<Index>(added.size()), 3);
    for (const auto& [id, x, owner] : added)
    {
      m.points.row(n) << x[0], x[1], x[2];
      this->mesh.nodeIds_.push_back(id);
      this->mesh.owner_.push_back(static_cast<int>(owner));
      this->mesh.byId_.emplace_back(id, n++);
    }
    std::sort(this->mesh.byId_.begin(), this->mesh.byId_.end());
  }

  /// Sends what is packed, and appends what comes. Returns the ids of the new nodes. Collective.
  std::vector<std::int64_t> exchange()
  {
    const std::vector<Node> met = joined(this->mesh.ranks_->exchange(this->nodes));
    std::vector<Node> missing;
    std::copy_if(met.begin(), met.end(), std::back_inserter(missing),
      [this](const Node& node) { return this->mesh.nodeOf(node.id) < 0; });
    sortUnique(missing);
    this->append(missing);
    this->unpack(this->mesh.ranks_->exchange(this->cells));
    std::vector<std::int64_t> ids;
    std::transform(missing.begin(), missing.end(), std::back_inserter(ids),
      [](const Node& node) { return node.id; });
    return ids;
  }

  /// Appends the cells that other ranks have packed.
  void unpack(const std::vector<std::vector<std::int64_t>>& newCells)
  {
    Mesh& m = this->mesh.mesh_;
    for (std::size_t rank = 0; rank < newCells.size(); ++rank)
    {
      const std::vector<std::int64_t>& stream = newCells[rank];
      for (std::size_t at = 0; at < stream.size();)
      {
        this->unpacked[rank].push_back(static_cast<Index>(m.types.size()));
        this->mesh.cellIds_.push_back(stream[at++]);
        const auto type = static_cast<std::uint8_t>(stream[at++]);
        m.types.push_back(type);
        this->mesh.isGhost_.push_back(1);
        for (std::int64_t k = stream[at++]; k > 0; --k)
        {
          m.connectivity.push_back(this->mesh.nodeOf(stream[at++]));
        }
        m.offsets.push_back(static_cast<Index>(m.connectivity.size()));
        const std::size_t end = at + 1 + stream[at];
        ++at;
        if (type == Polyhedron && m.faceOffsets.empty())
        {
          m.faceOffsets.assign(m.types.size(), 0); // the cells before have none
        }
        while (at < end)
        {
          m.faces.push_back(stream[at]);
          for (std::int64_t k = stream[at++]; k > 0; --k)
          {
            m.faces.push_back(this->mesh.nodeOf(stream[at++]));
          }
        }
        if (hasPolyhedra(m))
        {
          m.faceOffsets.push_back(static_cast<Index>(m.faces.size()));
        }
      }
    }
  }
};

DistributedMesh::DistributedMesh(const Ranks& ranks, Piece piece, int layers, Monitor& monitor)
  : ranks_(&ranks)
  , mesh_(withoutGhosts(piece.mesh, piece.isGhost))
  , pieceNodes_(piece.mesh.numberOfNodes())
  , pieceCells_(piece.mesh.numberOfCells())
  , isGhost_(std::move(piece.isGhost))
  , nodeIds_(std::move(piece.nodeIds))
  , cellIds_(std::move(piece.cellIds))
{
  this->isGhost_.resize(this->pieceCells_, 0);
  this->isUsed_ = usedNodes(this->mesh_, this->isGhost_);
  std::vector<Index> wrong;
  for (Index n = 0; n < this->pieceNodes_; ++n)
  {
    if (this->nodeIds_[n] < 0 || this->nodeIds_[n] >= NoBody)
    {
      wrong.push_back(this->nodeIds_[n]);
    }
  }
  ranks.together(
    [&]
    {
      if (!wrong.empty())
      {
        throw Error("Global point ids have to lie between 0 and 2^52: there are " + listIds(wrong) +
                    ". Make the ids again (Generate Global Ids).");
      }
    });
  this->measure();
  this->directory_ = std::make_shared<Directory>(ranks, this->numberNodes(), 1e-6 * this->size_);
  this->owner_ = this->directory_->owners(this->nodeIds_);
  for (const auto& pair : this->doubles_)
  {
    this->owner_[pair.first] = -1;
  }
  this->addGhosts(layers, monitor);
  this->halo_ =
    Halo(ranks, this->nodeIds_, this->owner_, [this](std::int64_t id) { return this->nodeOf(id); });
  this->findBodies(monitor);
  this->findOuter(monitor);
}

/// Fills byId_ and doubles_; returns what the directory is to know.
std::vector<NodeRecord> DistributedMesh::numberNodes()
{
  std::vector<Index> order = consecutive(this->pieceNodes_);
  // A node of own cells stands for its copies in ghost cells.
  const auto key = [this](Index n)
  { return std::tuple(this->nodeIds_[n], this->isUsed_[n] == 0, n); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<NodeRecord> records;
  for (Index n : order)
  {
    const std::int64_t id = this->nodeIds_[n];
    if (this->isUsed_[n] == 0 && !this->byId_.empty() && this->byId_.back().first == id)
    {
      this->doubles_.emplace_back(n, this->byId_.back().second);
      continue;
    }
    records.push_back(
      { id, { this->mesh_.points(n, 0), this->mesh_.points(n, 1), this->mesh_.points(n, 2) },
        this->isUsed_[n] });
    this->byId_.emplace_back(id, n);
  }
  return records;
}

void DistributedMesh::copyToDoubles(Points& values) const
{
  for (const auto& [copy, node] : this->doubles_)
  {
    values.row(copy) = values.row(node);
  }
}

std::vector<Index> DistributedMesh::idsOfNodes(const std::vector<Index>& nodes) const
{
  std::vector<Index> ids;
  for (Index node : nodes)
  {
    ids.push_back(this->nodeIds_[node]);
  }
  return ids;
}

std::vector<Index> DistributedMesh::gatherCells(const std::vector<Index>& cells) const
{
  std::vector<Index> ids;
  for (const Index cell : cells)
  {
    if (this->isGhost_[cell] == 0)
    {
      ids.push_back(this->cellIds_[cell]);
    }
  }
  return this->ranks_->gatherSorted(ids);
}

Index DistributedMesh::nodeOf(std::int64_t id) const
{
  const auto found =
    std::lower_bound(this->byId_.begin(), this->byId_.end(), std::pair(id, Index(-1)));
  return found != this->byId_.end() && found->first == id ? found->second : -1;
}

/// The box of the nodes of volume cells, and their number.
void DistributedMesh::measure()
{
  Eigen::AlignedBox3d box;
  Index cells = 0;
  for (Index c = 0; c < this->pieceCells_; ++c)
  {
    const bool isOwn = this->isGhost_[c] == 0 && isVolume(this->mesh_, c);
    cells += isOwn ? 1 : 0;
    for (Index k = 0; isOwn && k < this->mesh_.cellSize(c); ++k)
    {
      box.extend(this->mesh_.points.row(this->mesh_.cell(c)[k]).transpose());
    }
  }
  this->volumeCells_ = this->ranks_->sum(cells);
  this->size_ = diagonal(*this->ranks_, box);
}

double diagonal(const Ranks& ranks, const Eigen::AlignedBox3d& box)
{
  Eigen::Vector3d sides;
  for (int j = 0; j < 3; ++j)
  {
    const double low = ranks.minimum(box.min()[j]);
    sides[j] = std::max(0., ranks.maximum(box.max()[j]) - low);
  }
  return sides.norm();
}

void DistributedMesh::addGhosts(int layers, Monitor& monitor)
{
  // The cells around each node of the piece that other ranks may ask for.
  std::vector<std::int64_t> wanted;
  for (Index n = 0; n < this->pieceNodes_; ++n)
  {
    if (this->isUsed_[n])
    {
      wanted.push_back(this->nodeIds_[n]);
    }
  }
  Builder builder(*this);
  for (int layer = 0; layer < layers; ++layer)
  {
    const std::vector<Directory::Request> requests = this->directory_->requests(wanted);
    builder.open();
    builder.packAround(requests);
    wanted = builder.exchange();
  }
  this->findHanging(builder, monitor);
  this->cellHalo_ = Halo(builder.packed, builder.unpacked);
}

namespace
{
/// The cells with faces that one cell alone has, of all ranks, in the order of their ids.
struct FacesOfRanks
{
  Mesh mesh;                         ///< of these cells; nodes in the order of their ids
  std::vector<std::int64_t> nodeIds; ///< #nodes
  std::vector<std::int64_t> cellIds; ///< #cells
  std::vector<int> ranks;            ///< #cells, that own them
  std::vector<Index> numbers;        ///< #cells, local there
  BoundaryFaces faces;

  /// `sides`: of this rank's own cells. Collective.
  FacesOfRanks(const DistributedMesh& part, const std::map<Index, std::vector<int>>& sides)
  {
    const Mesh& own = part.mesh();
    std::vector<std::int64_t> stream;
    std::map<std::int64_t, NodeRecord> nodes;
    for (const auto& [cell, its] : sides)
    {
      stream.insert(stream.end(), { part.cellId(cell), part.ranks().rank(), cell, own.types[cell],
                                    own.cellSize(cell), static_cast<std::int64_t>(its.size()) });
      for (Index k = 0; k < own.cellSize(cell); ++k)
      {
        const Index node = own.cell(cell)[k];
        const auto x = own.points.row(node);
        stream.push_back(part.nodeId(node));
        nodes[part.nodeId(node)] = { part.nodeId(node), { x[0], x[1], x[2] }, 1 };
      }
      stream.insert(stream.end(), its.begin(), its.end());
    }
    std::vector<NodeRecord> records;
    std::transform(nodes.begin(), nodes.end(), std::back_inserter(records),
      [](const auto& node) { return node.second; });
    stream = part.ranks().gather(stream);
    for (const NodeRecord& node : part.ranks().gather(records))
    {
      nodes.emplace(node.id, node);
    }
    this->mesh.points.resize(static_cast<Index>(nodes.size()), 3);
    for (const auto& [id, node] : nodes)
    {
      const auto [x, y, z] = node.x;
      this->mesh.points.row(static_cast<Index>(this->nodeIds.size())) << x, y, z;
      this->nodeIds.push_back(id);
    }
    this->takeCells(stream);
  }

private:
  void takeCells(const std::vector<std::int64_t>& stream)
  {
    constexpr std::size_t Head = 6;
    std::map<std::int64_t, std::size_t> starts;
    for (std::size_t at = 0; at < stream.size(); at += Head + stream[at + 4] + stream[at + 5])
    {
      starts[stream[at]] = at;
    }
    std::vector<std::pair<Index, int>> places;
    this->mesh.offsets = { 0 };
    for (const auto& [id, at] : starts)
    {
      for (std::int64_t k = 0; k < stream[at + 5]; ++k)
      {
        places.emplace_back(static_cast<Index>(this->cellIds.size()),
          static_cast<int>(stream[at + Head + stream[at + 4] + k]));
      }
      this->cellIds.push_back(id);
      this->ranks.push_back(static_cast<int>(stream[at + 1]));
      this->numbers.push_back(stream[at + 2]);
      this->mesh.types.push_back(static_cast<std::uint8_t>(stream[at + 3]));
      for (std::int64_t k = 0; k < stream[at + 4]; ++k)
      {
        const auto node =
          std::lower_bound(this->nodeIds.begin(), this->nodeIds.end(), stream[at + Head + k]);
        this->mesh.connectivity.push_back(node - this->nodeIds.begin());
      }
      this->mesh.offsets.push_back(static_cast<Index>(this->mesh.connectivity.size()));
    }
    this->faces = facesAt(this->mesh, places);
  }
};
}

/// A node may hang on a face of another rank's cell, of which it has no node. So every rank gets
/// the faces that one cell alone has, and finds the same ties as one process.
void DistributedMesh::findHanging(Builder& builder, Monitor& monitor)
{
  const Ranks& ranks = *this->ranks_;
  if (ranks.sum(Index(hasPolyhedra(this->mesh_))) > 0)
  {
    return;
  }
  std::map<Index, std::vector<int>> sides;
  bool mayBe = false;
  ranks.together(
    [&]
    {
      const BoundaryFaces faces = facesOfOneCell(this->mesh_, monitor);
      std::vector<std::uint8_t> isOwn(this->isGhost_.size());
      std::transform(this->isGhost_.begin(), this->isGhost_.end(), isOwn.begin(),
        [](std::uint8_t ghost) { return ghost == 0; });
      mayBe = HangingNodes::mayBeAmong(this->mesh_, faces, isOwn, monitor);
      for (std::size_t f = 0; f < faces.cells.size(); ++f)
      {
        if (isOwn[faces.cells[f]] != 0)
        {
          sides[faces.cells[f]].push_back(faces.sides[f]);
        }
      }
    });
  if (ranks.sum(Index(mayBe)) == 0)
  {
    return;
  }
  const FacesOfRanks all(*this, sides);
  HangingNodes hanging;
  Mesh conforming;
  ranks.together(
    [&]
    {
      hanging.find(all.mesh, all.faces, monitor);
      conforming = hanging.conforming(all.mesh);
    });
  this->hasHanging_ = !hanging.empty();
  if (!this->hasHanging_)
  {
    return;
  }
  // Cells and the nodes that lie on them, but are not theirs: each rank gets all around its nodes.
  std::vector<std::int64_t> wanted;
  std::vector<std::vector<Index>> asked(ranks.count());
  for (Index c = 0; c < all.mesh.numberOfCells(); ++c)
  {
    const Index *begin = all.mesh.cell(c), *end = begin + all.mesh.cellSize(c);
    bool isAround = false;
    for (Index k = 0; k < conforming.cellSize(c); ++k)
    {
      const Index node = conforming.cell(c)[k];
      if (std::find(begin, end, node) != end)
      {
        continue;
      }
      const Index local = this->nodeOf(all.nodeIds[node]);
      isAround = isAround || (local >= 0 && local < this->pieceNodes_ && this->isUsed_[local] != 0);
      if (all.ranks[c] == ranks.rank())
      {
        wanted.push_back(all.nodeIds[node]);
      }
    }
    if (isAround && all.ranks[c] != ranks.rank())
    {
      asked[all.ranks[c]].push_back(all.numbers[c]);
    }
  }
  sortUnique(wanted);
  builder.open();
  builder.packAround(this->directory_->requests(wanted));
  const auto requests = ranks.exchange(asked);
  for (int r = 0; r < ranks.count(); ++r)
  {
    std::for_each(
      requests[r].begin(), requests[r].end(), [&](Index cell) { builder.pack(cell, r); });
  }
  builder.exchange();

  std::vector<Index> nodeOf, cellOf(all.cellIds.size(), -1), known, cells;
  for (const std::int64_t id : all.nodeIds)
  {
    nodeOf.push_back(this->nodeOf(id));
    if (nodeOf.back() >= 0)
    {
      known.push_back(static_cast<Index>(nodeOf.size()) - 1);
    }
  }
  for (std::size_t c = 0; c < this->cellIds_.size(); ++c)
  {
    const auto found = std::lower_bound(all.cellIds.begin(), all.cellIds.end(), this->cellIds_[c]);
    const bool isCopy = static_cast<Index>(c) < this->pieceCells_ && this->isGhost_[c] != 0;
    if (!isCopy && found != all.cellIds.end() && *found == this->cellIds_[c])
    {
      cellOf[found - all.cellIds.begin()] = static_cast<Index>(c);
      cells.push_back(found - all.cellIds.begin());
    }
  }
  std::sort(cells.begin(), cells.end());
  std::vector<Builder::Node> missing;
  std::vector<std::int64_t> ids;
  for (const Index node : hanging.reach(known, cells))
  {
    if (nodeOf[node] < 0)
    {
      const auto x = all.mesh.points.row(node);
      nodeOf[node] = this->mesh_.numberOfNodes() + static_cast<Index>(ids.size());
      ids.push_back(all.nodeIds[node]);
      missing.push_back({ ids.back(), { x[0], x[1], x[2] }, -1 });
    }
  }
  const std::vector<int> owners = this->directory_->owners(ids);
  for (std::size_t i = 0; i < missing.size(); ++i)
  {
    missing[i].owner = owners[i];
  }
  builder.append(missing);
  this->hanging_ = hanging.renumbered(nodeOf, cellOf, this->mesh_.numberOfNodes());
}

Index DistributedMesh::join(std::vector<Index>& ofNode) const
{
  // The label of a component is the lowest id of its nodes.
  std::vector<std::int64_t> label(ofNode.size(), NoBody);
  for (std::size_t n = 0; n < ofNode.size(); ++n)
  {
    label[n] = ofNode[n] < 0 ? NoBody : this->nodeIds_[n];
  }
  const Index parts = ofNode.empty() ? 0 : 1 + *std::max_element(ofNode.begin(), ofNode.end());
  std::vector<std::int64_t> lowest(parts, NoBody);
  for (Index changes = 1; changes > 0; changes = this->ranks_->sum(changes))
  {
    changes = 0;
    for (std::size_t n = 0; n < ofNode.size(); ++n)
    {
      if (ofNode[n] >= 0 && label[n] < lowest[ofNode[n]])
      {
        lowest[ofNode[n]] = label[n];
        ++changes;
      }
    }
    for (std::size_t n = 0; n < ofNode.size(); ++n)
    {
      if (ofNode[n] >= 0)
      {
        label[n] = lowest[ofNode[n]];
      }
    }
    this->halo_.minimum(*this->ranks_, label);
  }
  sortUnique(lowest);
  lowest = this->ranks_->gather(lowest);
  sortUnique(lowest);
  if (!lowest.empty() && lowest.back() == NoBody) // of numbers that no node has
  {
    lowest.pop_back();
  }
  for (std::size_t n = 0; n < ofNode.size(); ++n)
  {
    if (ofNode[n] >= 0)
    {
      ofNode[n] = std::lower_bound(lowest.begin(), lowest.end(), label[n]) - lowest.begin();
    }
  }
  return static_cast<Index>(lowest.size());
}

void DistributedMesh::findBodies(Monitor& monitor)
{
  const Ranks& ranks = *this->ranks_;
  this->bodies_ = connectedComponents(this->mesh_, monitor);
  this->bodies_.count = this->join(this->bodies_.ofNode);
  for (std::size_t c = 0; c < this->bodies_.ofCell.size(); ++c)
  {
    Index& body = this->bodies_.ofCell[c];
    body = body < 0 ? body : this->bodies_.ofNode[*this->mesh_.cell(static_cast<Index>(c))];
  }

  ShapeVolumes volumes = shapeVolumes(this->mesh_, this->bodies_, this->isGhost_, monitor);
  ranks.sum(volumes.volume.data(), volumes.volume.size());
  ranks.sum(volumes.cells.data(), volumes.cells.size());
  this->orientation_ = cellSigns(this->mesh_, this->bodies_, volumes);
  std::vector<Index> mirrored(this->bodies_.count, 0);
  for (std::size_t c = 0; c < this->orientation_.size(); ++c)
  {
    if (this->orientation_[c] < 0)
    {
      mirrored[this->bodies_.ofCell[c]] = 1;
    }
  }
  ranks.sum(mirrored.data(), mirrored.size());
  this->mirrored_ =
    std::count_if(mirrored.begin(), mirrored.end(), [](Index count) { return count > 0; });
}

void DistributedMesh::findOuter(Monitor& monitor)
{
  BoundaryFaces all;
  this->ranks_->together(
    [&]
    {
      all = facesOfOneCell(this->mesh_, monitor);
      if (!this->hanging_.empty())
      {
        all = boundaryFaces(this->mesh_, all, this->hanging_);
      }
      this->repeated_ = morph::repeatedCells(this->mesh_, monitor);
      this->touching_ = this->hanging_.empty()
                          ? morph::touchingNodes(this->mesh_, all)
                          : morph::touchingNodes(this->hanging_.conforming(this->mesh_), all);
    });
  const auto keepOwn = [](std::vector<Index>& ids, const auto& isOther)
  { ids.erase(std::remove_if(ids.begin(), ids.end(), isOther), ids.end()); };
  keepOwn(this->repeated_, [this](Index cell) { return this->isGhost_[cell] != 0; });
  keepOwn(this->touching_, [this](Index node) { return !this->owns(node); });
  std::vector<std::uint8_t> isOwn(this->isGhost_.size());
  std::transform(this->isGhost_.begin(), this->isGhost_.end(), isOwn.begin(),
    [](std::uint8_t ghost) { return ghost == 0; });
  this->outerFaces_ = facesOfCells(this->mesh_, all, isOwn);
  this->hanging_.divideEdges(this->outerFaces_);
  // All cells around a node of the piece's own cells are here, so that its faces are known.
  this->outerNodes_.between.offsets = { 0 };
  for (std::size_t i = 0; i < all.nodes.size(); ++i)
  {
    const Index node = all.nodes[i];
    if (node >= this->pieceNodes_ || this->isUsed_[node] == 0)
    {
      continue;
    }
    this->outerNodes_.nodes.push_back(node);
    Adjacency& between = this->outerNodes_.between;
    const Index k = static_cast<Index>(i);
    between.add(all.between.begin(k), all.between.end(k));
  }
}

BoundaryFaces DistributedMesh::facesOfPiece() const
{
  const BoundaryFaces& all = this->outerFaces_;
  BoundaryFaces faces =
    facesOfCells(this->mesh_, all, std::vector<std::uint8_t>(this->cellIds_.size(), 1));
  std::vector<Index> offsets = { 0 }, connectivity;
  for (std::size_t f = 0; f < all.cells.size(); ++f)
  {
    std::copy_if(all.connectivity.begin() + all.offsets[f],
      all.connectivity.begin() + all.offsets[f + 1], std::back_inserter(connectivity),
      [this](Index node) { return node < this->pieceNodes_; });
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  if (!this->hanging_.empty())
  {
    setCorners(std::move(offsets), std::move(connectivity), faces);
  }
  return faces;
}
}
