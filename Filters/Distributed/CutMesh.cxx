// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/CutMesh.h"

#include "Distributed/RankCommunicator.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace morph::distributed
{
CutMesh::CutMesh(const DistributedMesh& whole, const Mesh& mesh, int layers, Monitor& monitor)
  : whole_(&whole)
{
  whole.ranks().together(
    [&]
    {
      monitor.check();
      this->cut_ =
        std::make_unique<const PolyhedronPieces>(whole.hanging().conforming(mesh), monitor);
    });
  this->pieces_ =
    std::make_unique<DistributedMesh>(whole.ranks(), this->ownPieces(mesh.points), layers, monitor);
  // Each rank sums up a center in its own order: all take the bits of its owner.
  this->pieces_->setPoints(this->extend(mesh.points));
}

std::shared_ptr<const Communicator> CutMesh::processes() const
{
  return std::make_shared<ProcessesOfPieces<RankCommunicator>>(
    *this, RankCommunicator(*this->pieces_), RankCommunicator(*this->whole_));
}

Piece CutMesh::ownPieces(const Points& points)
{
  const DistributedMesh& whole = *this->whole_;
  const PolyhedronPieces& cut = *this->cut_;
  const Mesh& all = cut.mesh();
  std::vector<std::uint8_t> isUsed(all.numberOfNodes(), 0), isAtGhost(isUsed);
  for (Index p = 0; p < all.numberOfCells(); ++p)
  {
    const bool isOwn = whole.isGhost()[cut.cellOf(p)] == 0;
    for (Index k = 0; k < all.cellSize(p); ++k)
    {
      (isOwn ? isUsed : isAtGhost)[all.cell(p)[k]] = 1;
    }
  }
  std::vector<Index> local(all.numberOfNodes(), -1);
  for (Index n = 0; n < all.numberOfNodes(); ++n)
  {
    if (isUsed[n] != 0)
    {
      local[n] = static_cast<Index>(this->nodes_.size());
      this->nodes_.push_back(n);
    }
  }
  this->nodeOf_.assign(local.begin(), local.begin() + points.rows());
  Piece piece;
  piece.nodeIds = this->idsOfNodes(isAtGhost);
  piece.mesh.points = cut.extend(ConstPoints(points))(this->nodes_, allColumns);
  Index others = 0, highest = -1;
  for (Index c = 0; c < whole.pieceCells(); ++c)
  {
    highest = std::max<Index>(highest, whole.isGhost()[c] == 0 ? whole.cellId(c) : -1);
  }
  piece.mesh.offsets = { 0 };
  for (Index p = 0; p < all.numberOfCells(); ++p)
  {
    const Index cell = cut.cellOf(p);
    if (whole.isGhost()[cell] != 0)
    {
      continue;
    }
    for (Index k = 0; k < all.cellSize(p); ++k)
    {
      piece.mesh.connectivity.push_back(local[all.cell(p)[k]]);
    }
    piece.mesh.offsets.push_back(static_cast<Index>(piece.mesh.connectivity.size()));
    piece.mesh.types.push_back(all.types[p]);
    this->cellOf_.push_back(cell);
    piece.cellIds.push_back(p < whole.mesh().numberOfCells() ? whole.cellId(cell) : -1 - others++);
  }
  const std::int64_t first = whole.ranks().maximum(highest) + 1 + whole.ranks().sumBefore(others);
  for (std::int64_t& id : piece.cellIds)
  {
    id = id < 0 ? first - 1 - id : id;
  }
  return piece;
}

/// The ids of nodes_. `isAtGhost`: of all nodes of cut_.
std::vector<std::int64_t> CutMesh::idsOfNodes(const std::vector<std::uint8_t>& isAtGhost) const
{
  const Ranks& ranks = this->whole_->ranks();
  const Index nodes = this->whole_->mesh().numberOfNodes();
  std::vector<std::int64_t> ids;
  std::vector<Index> shared; // centers of faces whose cells are on two ranks
  Index own = 0, highest = -1;
  for (const Index node : this->nodes_)
  {
    const Index center = node - nodes;
    const bool isShared = center >= 0 && center < this->cut_->faceCenters() && isAtGhost[node] != 0;
    ids.push_back(center < 0 ? this->whole_->nodeId(node) : isShared ? -1 : -2 - own++);
    highest = std::max<Index>(highest, ids.back());
    if (isShared)
    {
      shared.push_back(center);
    }
  }
  const std::int64_t next = ranks.maximum(highest) + 1;
  const std::int64_t first = next + ranks.sumBefore(own);
  const std::vector<std::int64_t> agreed = this->agreeOnFaces(shared, next + ranks.sum(own));
  auto number = agreed.begin();
  for (std::int64_t& id : ids)
  {
    id = id >= 0 ? id : id == -1 ? *number++ : first - 2 - id;
  }
  return ids;
}

/// Numbers the centers of faces between two ranks from `firstId` on, by the ids of the faces'
/// nodes.
std::vector<std::int64_t> CutMesh::agreeOnFaces(
  const std::vector<Index>& centers, std::int64_t firstId) const
{
  using Key = std::vector<std::int64_t>;
  const Ranks& ranks = this->whole_->ranks();
  std::vector<Key> keys;
  for (const Index center : centers)
  {
    Key& key = keys.emplace_back();
    for (PolyhedronPieces::Weights::InnerIterator node(this->cut_->means(), center); node; ++node)
    {
      key.push_back(this->whole_->nodeId(node.col()));
    }
    std::sort(key.begin(), key.end());
  }
  struct Face
  {
    std::int64_t number;
    int ranks = 0;
  };
  return ranks.ask<std::int64_t>(
    keys, [&](const Key& key) { return static_cast<int>(key.front() % ranks.count()); },
    [&](const std::vector<std::vector<Key>>& asked)
    {
      std::map<Key, Face> faces;
      for (const Key& key : joined(asked))
      {
        ++faces.try_emplace(key, Face{ static_cast<std::int64_t>(faces.size()) })
            .first->second.ranks;
      }
      ranks.together(
        [&]
        {
          for (const auto& [key, face] : faces)
          {
            if (face.ranks != 2)
            {
              throw Error(
                "Two MPI ranks cut the face between their polyhedra differently, as one of its "
                "corners is nearly flat: node ids " +
                listIds(std::vector<Index>(key.begin(), key.end())) +
                ". Move one of these nodes a little.");
            }
          }
        });
      const std::int64_t first = firstId + ranks.sumBefore(static_cast<Index>(faces.size()));
      std::vector<std::vector<std::int64_t>> answers(asked.size());
      for (std::size_t r = 0; r < asked.size(); ++r)
      {
        std::transform(asked[r].begin(), asked[r].end(), std::back_inserter(answers[r]),
          [&](const Key& key) { return first + faces.at(key).number; });
      }
      return answers;
    });
}

Points CutMesh::extend(const ConstPoints& points) const
{
  const DistributedMesh& pieces = *this->pieces_;
  Points all = Points::Zero(pieces.mesh().numberOfNodes(), 3);
  all.topRows(pieces.pieceNodes()) = this->cut_->extend(points)(this->nodes_, allColumns);
  pieces.halo().update(pieces.ranks(), all);
  return all;
}

Points CutMesh::reduce(const Points& all, Points points) const
{
  const DistributedMesh& whole = *this->whole_;
  for (std::size_t n = 0; n < this->nodes_.size() && this->nodes_[n] < points.rows(); ++n)
  {
    points.row(this->nodes_[n]) = all.row(static_cast<Index>(n));
  }
  whole.halo().update(whole.ranks(), points);
  whole.copyToDoubles(points);
  return points;
}

Points CutMesh::extendTranspose(const ConstPoints& all) const
{
  Points own = Points::Zero(this->cut_->mesh().numberOfNodes(), 3);
  for (std::size_t n = 0; n < this->nodes_.size(); ++n)
  {
    if (this->pieces_->owns(static_cast<Index>(n)))
    {
      own.row(this->nodes_[n]) = all.row(static_cast<Index>(n));
    }
  }
  return this->cut_->extendTranspose(own);
}

NodePartition CutMesh::extend(const NodePartition& partition) const
{
  const DistributedMesh& pieces = *this->pieces_;
  std::vector<double> isPrescribed(pieces.mesh().numberOfNodes(), 0);
  const std::vector<Index> prescribed = this->cut_->extend(partition).prescribed;
  for (std::size_t n = 0; n < this->nodes_.size(); ++n)
  {
    isPrescribed[n] = std::binary_search(prescribed.begin(), prescribed.end(), this->nodes_[n]);
  }
  pieces.halo().update(pieces.ranks(), isPrescribed);
  NodePartition result;
  pieces.ranks().together(
    [&]
    {
      std::vector<Index> prescribed;
      for (std::size_t n = 0; n < isPrescribed.size(); ++n)
      {
        if (isPrescribed[n] != 0)
        {
          prescribed.push_back(static_cast<Index>(n));
        }
      }
      result = partitionNodes(pieces.mesh(), std::move(prescribed));
    });
  return result;
}

std::vector<double> CutMesh::extend(const std::vector<double>& values) const
{
  std::vector<double> all;
  if (!values.empty())
  {
    for (const Index cell : this->cellOf_)
    {
      all.push_back(values[cell]);
    }
  }
  return all;
}
}
