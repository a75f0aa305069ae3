// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/CutMesh.h"

#include "Distributed/RankCommunicator.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <map>
#include <utility>

namespace morph::distributed
{
namespace
{
/// In whose messages pieces are the cells that they are cut from.
class PiecesOnRanks : public RankCommunicator
{
public:
  explicit PiecesOnRanks(const CutMesh& cut)
    : RankCommunicator(cut.pieces())
    , cut_(cut)
  {
  }

  std::vector<Index> gatherCells(const std::vector<Index>& pieces) const override
  {
    std::vector<Index> cells;
    for (const Index piece : pieces)
    {
      if (!this->isCopy(piece))
      {
        cells.push_back(this->cut_.cellOf(piece));
      }
    }
    sortUnique(cells);
    return this->cut_.whole().gatherCells(cells);
  }

private:
  const CutMesh& cut_;
};
}

CutMesh::CutMesh(const DistributedMesh& whole, const Mesh& mesh, int layers, Monitor& monitor)
  : whole_(&whole)
{
  std::unique_ptr<PolyhedronPieces> cut;
  whole.ranks().together(
    [&]
    {
      monitor.check();
      cut = std::make_unique<PolyhedronPieces>(whole.hanging().conforming(mesh), monitor);
    });
  Piece piece = this->ownPieces(*cut, mesh.points);
  this->pieces_ =
    std::make_unique<DistributedMesh>(whole.ranks(), std::move(piece), layers, monitor);
  // Each rank sums up a center in its own order: all take the bits of its owner.
  this->pieces_->setPoints(this->extend(mesh.points));
}

std::shared_ptr<const Communicator> CutMesh::processes() const
{
  return std::make_shared<PiecesOnRanks>(*this);
}

Piece CutMesh::ownPieces(const PolyhedronPieces& cut, const Points& points)
{
  const DistributedMesh& whole = *this->whole_;
  const Mesh& all = cut.mesh();
  const Index nodes = whole.mesh().numberOfNodes();
  std::vector<std::uint8_t> isUsed(all.numberOfNodes(), 0), isAtGhost(isUsed);
  for (Index p = 0; p < all.numberOfCells(); ++p)
  {
    const bool isOwn = whole.isGhost()[cut.cellOf(p)] == 0;
    for (Index k = 0; k < all.cellSize(p); ++k)
    {
      (isOwn ? isUsed : isAtGhost)[all.cell(p)[k]] = 1;
    }
  }
  Piece piece;
  std::vector<Index> local(all.numberOfNodes(), -1), centers;
  for (Index n = 0; n < all.numberOfNodes(); ++n)
  {
    if (isUsed[n] == 0)
    {
      continue;
    }
    local[n] = static_cast<Index>(this->wholeNode_.size() + centers.size());
    if (n < nodes)
    {
      this->wholeNode_.push_back(n);
      piece.nodeIds.push_back(whole.nodeId(n));
      continue;
    }
    this->faceCenters_ += n - nodes < cut.faceCenters();
    centers.push_back(n - nodes);
  }
  this->nodeOf_.assign(local.begin(), local.begin() + nodes);
  this->takeMeans(cut, centers);
  this->numberCenters(cut, centers, isAtGhost, piece.nodeIds);

  const Index plain = static_cast<Index>(this->wholeNode_.size());
  piece.mesh.points.resize(plain + this->means_.rows(), 3);
  piece.mesh.points.topRows(plain) = points(this->wholeNode_, allColumns);
  piece.mesh.points.bottomRows(this->means_.rows()) = this->means_ * points;
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

/// `centers`: rows of the means of all local cells, those of faces first.
void CutMesh::takeMeans(const PolyhedronPieces& cut, const std::vector<Index>& centers)
{
  std::vector<Eigen::Triplet<double, Index>> means;
  for (std::size_t k = 0; k < centers.size(); ++k)
  {
    for (Means::InnerIterator node(cut.means(), centers[k]); node; ++node)
    {
      means.emplace_back(static_cast<Index>(k), node.col(), node.value());
    }
  }
  this->means_.resize(static_cast<Index>(centers.size()), this->whole_->mesh().numberOfNodes());
  this->means_.setFromTriplets(means.begin(), means.end());
}

/// Appends the ids of the centers.
void CutMesh::numberCenters(const PolyhedronPieces& cut, const std::vector<Index>& centers,
  const std::vector<std::uint8_t>& isAtGhost, std::vector<std::int64_t>& ids) const
{
  const Ranks& ranks = this->whole_->ranks();
  const Index nodes = this->whole_->mesh().numberOfNodes();
  Index highest = -1;
  for (const std::int64_t id : ids)
  {
    highest = std::max<Index>(highest, id);
  }
  // Its cells are on two ranks.
  std::vector<Index> shared;
  Index own = 0;
  for (const Index center : centers)
  {
    const bool isShared = center < cut.faceCenters() && isAtGhost[nodes + center] != 0;
    own += isShared ? 0 : 1;
    if (isShared)
    {
      shared.push_back(center);
    }
  }
  std::int64_t next = ranks.maximum(highest) + 1;
  const std::int64_t firstShared = next + ranks.sum(own);
  next += ranks.sumBefore(own);
  std::vector<std::int64_t> idOfRow(cut.means().rows(), -1);
  this->agreeOnFaces(shared, cut, firstShared, idOfRow);
  for (const Index center : centers)
  {
    ids.push_back(idOfRow[center] >= 0 ? idOfRow[center] : next++);
  }
}

/// Numbers the centers `rows` of faces between two ranks, by the ids of the faces' nodes.
void CutMesh::agreeOnFaces(const std::vector<Index>& rows, const PolyhedronPieces& cut,
  std::int64_t firstId, std::vector<std::int64_t>& idOfRow) const
{
  const Ranks& ranks = this->whole_->ranks();
  std::vector<std::vector<std::int64_t>> to(ranks.count());
  std::vector<std::vector<Index>> asked(ranks.count());
  for (const Index row : rows)
  {
    std::vector<std::int64_t> key;
    for (Means::InnerIterator node(cut.means(), row); node; ++node)
    {
      key.push_back(this->whole_->nodeId(node.col()));
    }
    std::sort(key.begin(), key.end());
    const auto place = static_cast<std::size_t>(key.front() % ranks.count());
    to[place].push_back(static_cast<std::int64_t>(key.size()));
    to[place].insert(to[place].end(), key.begin(), key.end());
    asked[place].push_back(row);
  }
  const auto from = ranks.exchange(to);
  struct Face
  {
    std::int64_t number;
    int ranks = 0;
  };
  std::map<std::vector<std::int64_t>, Face> faces;
  std::vector<std::vector<std::int64_t>> answers(ranks.count());
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (auto at = from[r].begin(); at != from[r].end();)
    {
      const auto end = at + 1 + *at;
      Face& face = faces
                     .try_emplace(std::vector<std::int64_t>(at + 1, end),
                       Face{ static_cast<std::int64_t>(faces.size()) })
                     .first->second;
      ++face.ranks;
      answers[r].push_back(face.number);
      at = end;
    }
  }
  ranks.together(
    [&]
    {
      for (const auto& [key, face] : faces)
      {
        if (face.ranks != 2)
        {
          throw Error("Two MPI ranks cut the face between their polyhedra differently, as one of "
                      "its corners is nearly flat: node ids " +
                      listIds(std::vector<Index>(key.begin(), key.end())) +
                      ". Move one of these nodes a little.");
        }
      }
    });
  const std::int64_t offset = firstId + ranks.sumBefore(static_cast<Index>(faces.size()));
  for (std::vector<std::int64_t>& answer : answers)
  {
    for (std::int64_t& number : answer)
    {
      number += offset;
    }
  }
  const auto answered = ranks.exchange(answers);
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (std::size_t i = 0; i < asked[r].size(); ++i)
    {
      idOfRow[asked[r][i]] = answered[r][i];
    }
  }
}

Points CutMesh::extend(const ConstPoints& points) const
{
  const DistributedMesh& pieces = *this->pieces_;
  const Index plain = static_cast<Index>(this->wholeNode_.size());
  Points all = Points::Zero(pieces.mesh().numberOfNodes(), 3);
  all.topRows(plain) = points(this->wholeNode_, allColumns);
  all.middleRows(plain, this->means_.rows()) = this->means_ * points;
  pieces.halo().update(pieces.ranks(), all);
  return all;
}

Points CutMesh::reduce(const Points& all, Points points) const
{
  const DistributedMesh& whole = *this->whole_;
  for (std::size_t n = 0; n < this->wholeNode_.size(); ++n)
  {
    points.row(this->wholeNode_[n]) = all.row(static_cast<Index>(n));
  }
  whole.halo().update(whole.ranks(), points);
  whole.copyToDoubles(points);
  return points;
}

Points CutMesh::extendTranspose(const ConstPoints& all) const
{
  const Index plain = static_cast<Index>(this->wholeNode_.size());
  Points own = all.topRows(this->pieces_->pieceNodes());
  for (Index n = 0; n < own.rows(); ++n)
  {
    if (!this->pieces_->owns(n))
    {
      own.row(n).setZero();
    }
  }
  Points result = this->means_.transpose() * own.bottomRows(this->means_.rows());
  for (Index n = 0; n < plain; ++n)
  {
    result.row(this->wholeNode_[n]) += own.row(n);
  }
  return result;
}

NodePartition CutMesh::extend(const NodePartition& partition) const
{
  const DistributedMesh& pieces = *this->pieces_;
  const Index plain = static_cast<Index>(this->wholeNode_.size());
  std::vector<std::uint8_t> isHeld(this->whole_->mesh().numberOfNodes(), 0);
  for (const Index node : partition.prescribed)
  {
    isHeld[node] = 1;
  }
  std::vector<std::int64_t> isPrescribed(pieces.mesh().numberOfNodes(), 0);
  for (Index n = 0; n < plain; ++n)
  {
    isPrescribed[n] = isHeld[this->wholeNode_[n]];
  }
  for (Index f = 0; f < this->faceCenters_; ++f)
  {
    isPrescribed[plain + f] = 1;
    for (Means::InnerIterator node(this->means_, f); node; ++node)
    {
      isPrescribed[plain + f] &= isHeld[node.col()];
    }
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
