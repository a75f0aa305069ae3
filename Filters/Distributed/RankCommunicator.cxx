// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/RankCommunicator.h"

#include "Distributed/CutMesh.h"
#include "Distributed/HypreSolver.h"
#include "Mesh/Polyhedra.h"
#include "Support/Lists.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace morph::distributed
{
namespace
{
/// The owner of a node sums the rows of its copies.
class RankRows : public CopiedRows
{
public:
  RankRows(const DistributedMesh& mesh, const std::vector<Index>& nodes)
    : ranks_(mesh.ranks())
    , counts_(nodes.size(), 1)
  {
    const Ranks& ranks = this->ranks_;
    std::vector<std::int64_t> ids;
    std::vector<int> owners;
    std::vector<Row> elsewhere;
    std::unordered_map<std::int64_t, Index> rowOf;
    for (const Index node : nodes)
    {
      const auto row = static_cast<Index>(ids.size());
      const int owner = mesh.owner(node);
      if (owner == ranks.rank())
      {
        rowOf[mesh.nodeId(node)] = row;
      }
      else if (owner >= 0)
      {
        elsewhere.push_back({ mesh.nodeId(node), row, owner });
      }
      ids.push_back(mesh.nodeId(node));
      owners.push_back(owner);
    }
    // A row counts on its owner. If that has none, it gets one, and the first that asks counts.
    const auto count = [&](const std::vector<std::vector<Row>>& asked)
    {
      std::vector<std::vector<char>> counts(asked.size());
      for (std::size_t r = 0; r < asked.size(); ++r)
      {
        for (const Row& row : asked[r])
        {
          const bool isNew = rowOf.emplace(row.id, static_cast<Index>(ids.size())).second;
          counts[r].push_back(isNew);
          if (isNew)
          {
            ids.push_back(row.id);
            owners.push_back(ranks.rank());
          }
        }
      }
      return counts;
    };
    const std::vector<char> counts = ranks.ask<char>(
      elsewhere, [](const Row& row) { return row.owner; }, count);
    for (std::size_t i = 0; i < elsewhere.size(); ++i)
    {
      this->counts_[elsewhere[i].row] = counts[i];
      if (counts[i] == 0)
      {
        this->countedElsewhere_.push_back(elsewhere[i].row);
      }
    }
    this->rows_ = static_cast<Index>(ids.size());
    this->halo_ = Halo(ranks, ids, owners, [&](std::int64_t id) { return rowOf.at(id); });
  }

  void add(Points& rows) const override
  {
    const Index own = rows.rows();
    rows.conservativeResize(this->rows_, 3);
    rows.bottomRows(this->rows_ - own).setZero();
    this->halo_.add(this->ranks_, rows);
    this->halo_.update(this->ranks_, rows);
    rows.conservativeResize(own, 3);
  }

  double dot(const Points& a, const Points& b, Monitor& monitor) const override
  {
    return this->ranks_.sum(reproducibleSum(a.rows(), monitor, 0.,
      [&](Index i) { return this->counts_[i] != 0 ? a.row(i).dot(b.row(i)) : 0.; }));
  }

  const std::vector<Index>& countedElsewhere() const override { return this->countedElsewhere_; }

private:
  struct Row
  {
    std::int64_t id;
    Index row;
    int owner;
  };

  const Ranks& ranks_;
  std::vector<char> counts_;            ///< #rows: whether it counts in dot()
  std::vector<Index> countedElsewhere_; ///< the rows that do not
  Index rows_ = 0;                      ///< with those of nodes that others alone have
  Halo halo_;                           ///< of these
};
}

RankCommunicator::RankCommunicator(const DistributedMesh& mesh)
  : RankCommunicator(mesh, consecutive(mesh.mesh().numberOfNodes()))
{
  this->isPart_ = false;
}

RankCommunicator::RankCommunicator(const DistributedMesh& mesh, std::vector<Index> nodes)
  : mesh_(mesh)
  , nodes_(std::move(nodes))
{
}

std::vector<Index> RankCommunicator::ofMesh(std::vector<Index> nodes) const
{
  for (Index& node : nodes)
  {
    node = this->nodes_[node];
  }
  return nodes;
}

void RankCommunicator::together(const std::function<void()>& work) const
{
  this->mesh_.ranks().together(work);
}

std::vector<Index> RankCommunicator::idsOf(const std::vector<Index>& nodes) const
{
  return this->mesh_.idsOfNodes(this->ofMesh(nodes));
}

double RankCommunicator::sum(double value) const
{
  return this->mesh_.ranks().sum(value);
}

void RankCommunicator::sum(double* values, int count) const
{
  this->mesh_.ranks().sum(values, static_cast<std::size_t>(count));
}

void RankCommunicator::maximum(double* values, int count) const
{
  this->mesh_.ranks().maximum(values, static_cast<std::size_t>(count));
}

double RankCommunicator::minimum(double value) const
{
  return this->mesh_.ranks().minimum(value);
}

void RankCommunicator::spread(std::vector<Index>& nodes) const
{
  std::vector<double> unmarked(this->mesh_.mesh().numberOfNodes(), 1);
  for (const Index node : nodes)
  {
    unmarked[this->nodes_[node]] = 0;
  }
  this->mesh_.halo().minimum(this->mesh_.ranks(), unmarked);
  nodes.clear();
  for (std::size_t i = 0; i < this->nodes_.size(); ++i)
  {
    if (unmarked[this->nodes_[i]] == 0)
    {
      nodes.push_back(static_cast<Index>(i));
    }
  }
}

std::unique_ptr<CopiedRows> RankCommunicator::rows() const
{
  return std::make_unique<RankRows>(this->mesh_, this->nodes_);
}

std::unique_ptr<Communicator> RankCommunicator::part(const std::vector<Index>& nodes) const
{
  return std::make_unique<RankCommunicator>(this->mesh_, this->ofMesh(nodes));
}

std::vector<Index> RankCommunicator::idsOfCells(const std::vector<Index>& cells) const
{
  std::vector<Index> ids;
  std::transform(cells.begin(), cells.end(), std::back_inserter(ids),
    [&](Index cell) { return this->mesh_.cellId(cell); });
  return ids;
}

std::vector<Index> RankCommunicator::cellsOf(const std::vector<Index>& ids) const
{
  std::vector<Index> cells;
  for (Index c = 0; c < this->mesh_.mesh().numberOfCells(); ++c)
  {
    if (!this->isCopy(c) && std::binary_search(ids.begin(), ids.end(), this->mesh_.cellId(c)))
    {
      cells.push_back(c);
    }
  }
  return cells;
}

std::vector<Index> RankCommunicator::gatherNodes(const std::vector<Index>& nodes) const
{
  return this->mesh_.ranks().gatherSorted(this->idsOf(nodes));
}

std::vector<Index> RankCommunicator::gatherCells(const std::vector<Index>& cells) const
{
  std::vector<Index> own;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(own),
    [this](Index cell) { return !this->isCopy(cell); });
  return this->mesh_.ranks().gatherSorted(this->idsOfCells(own));
}

std::vector<Index> RankCommunicator::nodesOf(const std::vector<Index>& ids) const
{
  std::vector<Index> nodes;
  for (const Index id : this->mesh_.ranks().gather(ids))
  {
    nodes.push_back(this->mesh_.nodeOf(id));
  }
  sortUnique(nodes);
  nodes.erase(nodes.begin(), std::lower_bound(nodes.begin(), nodes.end(), 0)); // -1: not here
  return nodes;
}

Points RankCommunicator::gather(const Points& rows, const std::vector<Index>& nodes) const
{
  struct Row
  {
    std::int64_t id;
    double x[3];
    bool operator<(const Row& other) const { return this->id < other.id; }
  };
  std::vector<Row> mine;
  for (const Index node : nodes)
  {
    if (this->mesh_.owns(node))
    {
      mine.push_back({ this->mesh_.nodeId(node), { rows(node, 0), rows(node, 1), rows(node, 2) } });
    }
  }
  mine = this->mesh_.ranks().gatherSorted(mine);
  Points result(static_cast<Index>(mine.size()), 3);
  for (std::size_t i = 0; i < mine.size(); ++i)
  {
    result.row(static_cast<Index>(i)) = Eigen::Map<const Eigen::RowVector3d>(mine[i].x);
  }
  return result;
}

void RankCommunicator::completeCells(std::vector<double>& values) const
{
  values.resize(this->mesh_.mesh().numberOfCells(), 1);
  this->mesh_.cellHalo().update(this->mesh_.ranks(), values);
}

std::vector<Index> RankCommunicator::numbersOf(
  const std::vector<Index>& nodes, const std::vector<Index>& others) const
{
  std::vector<double> numbers(this->mesh_.mesh().numberOfNodes(), -1);
  Index next = this->mesh_.ranks().sumBefore(static_cast<Index>(nodes.size()));
  for (const Index node : nodes)
  {
    numbers[node] = static_cast<double>(next++);
  }
  this->mesh_.halo().update(this->mesh_.ranks(), numbers);
  std::vector<Index> result;
  std::transform(others.begin(), others.end(), std::back_inserter(result),
    [&](Index node) { return static_cast<Index>(numbers[node]); });
  return result;
}

std::shared_ptr<LinearSolver> RankCommunicator::makeSolver(bool isSymmetric) const
{
  return std::make_shared<HypreSolver>(
    this->mesh_.ranks(), isSymmetric ? HypreSolver::Kind::Symmetric : HypreSolver::Kind::General);
}

std::shared_ptr<CellPieces> RankCommunicator::cut(
  const Mesh& mesh, int layers, Monitor& monitor) const
{
  return std::make_shared<CutMesh>(this->mesh_, mesh, layers, monitor);
}

std::shared_ptr<const UndeformedMesh> undeformedMesh(
  const std::shared_ptr<const DistributedMesh>& mesh, Monitor& monitor)
{
  const auto processes = std::make_shared<const RankCommunicator>(*mesh);
  const bool needsPieces = !processes->all(!hasPolyhedra(mesh->mesh()) && !mesh->hasHanging());
  UndeformedMesh::Part part{ std::shared_ptr<const Mesh>(mesh, &mesh->mesh()), mesh->hanging(),
    needsPieces, mesh->size(), processes };
  return std::make_shared<const UndeformedMesh>(std::move(part), monitor);
}
}
