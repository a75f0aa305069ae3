// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"

#include "Distributed/RankCommunicator.h"
#include "Mesh/CellShape.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/Topology.h"
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

int dimension(const Mesh& mesh, Index cell)
{
  const CellShape* shape = cellShape(mesh.types[cell]);
  return shape ? shape->dimension : 0;
}

/// A copy of `mesh` with a vertex for each ghost.
Mesh withoutGhosts(const Mesh& mesh, const std::vector<std::uint8_t>& isGhost)
{
  Mesh result;
  result.points = mesh.points;
  result.layer = mesh.layer;
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

  const DistributedMesh& from;
  DistributedMesh& mesh;                            ///< that gets the cells
  std::set<std::pair<Index, int>> sent;             ///< cells, by rank
  std::vector<std::vector<Node>> nodes;             ///< for each rank
  std::vector<std::set<Index>> nodesSent;           ///< by rank
  std::vector<std::vector<std::int64_t>> cells;     ///< for each rank
  std::vector<std::vector<Index>> packed, unpacked; ///< cells of all layers, for each rank

  Builder(const DistributedMesh& source, DistributedMesh& target)
    : from(source)
    , mesh(target)
    , nodesSent(source.ranks_->count())
    , packed(source.ranks_->count())
    , unpacked(source.ranks_->count())
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
    const Mesh& m = this->from.mesh_;
    this->packed[rank].push_back(cell);
    std::vector<std::int64_t>& stream = this->cells[rank];
    stream.push_back(this->from.cellIds_[cell]);
    stream.push_back(m.types[cell]);
    stream.push_back(m.cellSize(cell));
    for (Index k = 0; k < m.cellSize(cell); ++k)
    {
      const Index node = m.cell(cell)[k];
      stream.push_back(this->from.nodeIds_[node]);
      if (this->nodesSent[rank].insert(node).second)
      {
        this->nodes[rank].push_back({ this->from.nodeIds_[node],
          { m.points(node, 0), m.points(node, 1), m.points(node, 2) }, this->from.owner_[node] });
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
          stream.push_back(this->from.nodeIds_[face[k]]);
        }
      });
    stream[length] = static_cast<std::int64_t>(stream.size() - length - 1);
  }

  /// Packs the cells around nodes for the ranks that ask for them.
  void packAround(const std::vector<Directory::Request>& requests)
  {
    const Mesh& m = this->from.mesh_;
    std::unordered_map<Index, std::vector<int>> ranksOf;
    for (const Directory::Request& request : requests)
    {
      ranksOf[this->from.nodeOf(request.id)].push_back(static_cast<int>(request.rank));
    }
    for (Index c = 0; c < this->from.pieceCells_ && !ranksOf.empty(); ++c)
    {
      if (this->from.isGhost_[c] != 0 || dimension(m, c) < this->from.dimension_)
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
        if (at < end && m.faceOffsets.empty())
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

Index DistributedMesh::nodeOf(std::int64_t id) const
{
  const auto found =
    std::lower_bound(this->byId_.begin(), this->byId_.end(), std::pair(id, Index(-1)));
  return found != this->byId_.end() && found->first == id ? found->second : -1;
}

/// The highest dimension of cells, the box of the nodes of these, and the number of volume cells.
void DistributedMesh::measure()
{
  Eigen::AlignedBox3d box;
  Index cells = 0, highest = 0;
  for (Index c = 0; c < this->pieceCells_; ++c)
  {
    highest = std::max<Index>(highest, dimension(this->mesh_, c)); // a ghost has 0
  }
  this->dimension_ = static_cast<int>(this->ranks_->maximum(highest));
  for (Index c = 0; c < this->pieceCells_; ++c)
  {
    const bool isOwn = this->isGhost_[c] == 0 && dimension(this->mesh_, c) == this->dimension_;
    cells += isOwn && this->dimension_ == 3 ? 1 : 0;
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
  Builder builder(*this, *this);
  for (int layer = 0; layer < layers; ++layer)
  {
    const std::vector<Directory::Request> requests = this->directory_->requests(wanted);
    builder.open();
    builder.packAround(requests);
    wanted = builder.exchange();
  }
  // Who has one of several cells with the same corners has all of them.
  this->ranks_->together([&] { keepFirstCopies(this->mesh_, this->cellIds_, monitor); });
  this->findHanging(builder, monitor);
  this->cellHalo_ = Halo(builder.packed, builder.unpacked);
}

/// A node may hang on a face of another rank's cell, of which it has no node. So every rank gets
/// the faces that one cell alone has, and finds the same ties as one process.
void DistributedMesh::findHanging(Builder& builder, Monitor& monitor)
{
  const Ranks& ranks = *this->ranks_;
  std::vector<std::array<std::int64_t, 2>> sides; // ids of cells, and their sides
  std::vector<Index> ofSides;                     // own cells
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
          sides.push_back({ this->cellIds_[faces.cells[f]], faces.sides[f] });
          ofSides.push_back(faces.cells[f]);
        }
      }
    });
  if (ranks.sum(Index(mayBe)) == 0)
  {
    return;
  }
  DistributedMesh all(ranks); // of the cells with faces that one cell alone has, of all ranks
  Builder ofAll(*this, all);
  ofAll.open();
  for (int r = 0; r < ranks.count(); ++r)
  {
    std::for_each(ofSides.begin(), ofSides.end(), [&](Index cell) { ofAll.pack(cell, r); });
  }
  ofAll.exchange();
  std::map<std::int64_t, Index> numberOf; // of a cell's id
  for (Index c = 0; c < all.mesh_.numberOfCells(); ++c)
  {
    numberOf.emplace(all.cellIds_[c], c);
  }
  std::vector<std::pair<Index, int>> places;
  for (const auto& [cell, side] : ranks.gather(sides))
  {
    places.emplace_back(numberOf.at(cell), static_cast<int>(side));
  }
  std::sort(places.begin(), places.end());
  HangingNodes hanging;
  Mesh conforming;
  ranks.together(
    [&]
    {
      hanging.find(all.mesh_, facesAt(all.mesh_, places), monitor);
      conforming = hanging.conforming(all.mesh_);
    });
  this->hasHanging_ = !hanging.empty();
  if (!this->hasHanging_)
  {
    return;
  }
  // Cells and the nodes that lie on them, but are not theirs: each rank gets all around its nodes.
  std::vector<std::int64_t> wanted;
  std::vector<std::vector<Index>> asked(ranks.count()); // by their places in what a rank sent
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (std::size_t k = 0; k < ofAll.unpacked[r].size(); ++k)
    {
      const Index c = ofAll.unpacked[r][k];
      const Index *begin = all.mesh_.cell(c), *end = begin + all.mesh_.cellSize(c);
      bool isAround = false;
      for (Index n = 0; n < conforming.cellSize(c); ++n)
      {
        const Index node = conforming.cell(c)[n];
        if (std::find(begin, end, node) == end)
        {
          const Index local = this->nodeOf(all.nodeIds_[node]);
          isAround =
            isAround || (local >= 0 && local < this->pieceNodes_ && this->isUsed_[local] != 0);
          if (r == ranks.rank())
          {
            wanted.push_back(all.nodeIds_[node]);
          }
        }
      }
      if (isAround && r != ranks.rank())
      {
        asked[r].push_back(static_cast<Index>(k));
      }
    }
  }
  sortUnique(wanted);
  builder.open();
  builder.packAround(this->directory_->requests(wanted));
  const auto requests = ranks.exchange(asked);
  for (int r = 0; r < ranks.count(); ++r)
  {
    std::for_each(requests[r].begin(), requests[r].end(),
      [&](Index k) { builder.pack(ofAll.packed[r][k], r); });
  }
  builder.exchange();

  std::vector<Index> nodeOf, cellOf(all.cellIds_.size(), -1), known, cells;
  for (const std::int64_t id : all.nodeIds_)
  {
    nodeOf.push_back(this->nodeOf(id));
    if (nodeOf.back() >= 0)
    {
      known.push_back(static_cast<Index>(nodeOf.size()) - 1);
    }
  }
  for (std::size_t c = 0; c < this->cellIds_.size(); ++c)
  {
    const auto found = numberOf.find(this->cellIds_[c]);
    const bool isCopy = static_cast<Index>(c) < this->pieceCells_ && this->isGhost_[c] != 0;
    if (!isCopy && found != numberOf.end())
    {
      cellOf[found->second] = static_cast<Index>(c);
      cells.push_back(found->second);
    }
  }
  std::sort(cells.begin(), cells.end());
  std::vector<Builder::Node> missing;
  for (const Index node : hanging.reach(known, cells))
  {
    if (nodeOf[node] < 0)
    {
      const auto x = all.mesh_.points.row(node);
      nodeOf[node] = this->mesh_.numberOfNodes() + static_cast<Index>(missing.size());
      missing.push_back({ all.nodeIds_[node], { x[0], x[1], x[2] }, all.owner_[node] });
    }
  }
  builder.append(missing);
  this->hanging_ = hanging.renumbered(nodeOf, cellOf, this->mesh_.numberOfNodes());
}

Index DistributedMesh::join(std::vector<Index>& ofNode) const
{
  // The label of a component is the lowest id of its nodes.
  std::vector<double> label(ofNode.size(), NoBody);
  for (std::size_t n = 0; n < ofNode.size(); ++n)
  {
    label[n] = static_cast<double>(ofNode[n] < 0 ? NoBody : this->nodeIds_[n]);
  }
  const Index parts = ofNode.empty() ? 0 : 1 + *std::max_element(ofNode.begin(), ofNode.end());
  std::vector<double> lowest(parts, NoBody);
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

/// By what the ranks tell one another, not what this mesh knows.
void DistributedMesh::findBodies(Monitor& monitor)
{
  struct Processes : RankCommunicator
  {
    using RankCommunicator::RankCommunicator;
    const ConnectedComponents* bodies() const override { return nullptr; }
    const std::vector<std::int8_t>* orientation() const override { return nullptr; }
  };
  const Processes processes(*this);
  this->bodies_ = connectedComponents(this->mesh_, monitor, processes);
  this->orientation_ = cellSigns(this->mesh_, this->bodies_, monitor, processes);
}
}
