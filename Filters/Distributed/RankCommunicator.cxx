// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/RankCommunicator.h"

#include "Support/ReproducibleSum.h"

#include <cstdint>
#include <exception>
#include <unordered_map>
#include <utility>

namespace morph::distributed
{
class RankCommunicator::Votes
{
public:
  explicit Votes(const Ranks& ranks)
    : ranks_(ranks)
  {
  }

  const Ranks& ranks() const { return this->ranks_; }

  void reset()
  {
    this->hasEnded_ = false;
    this->own_ = nullptr;
  }

  /// Returns the sum over the ranks. Throws on all of them if one calls fail().
  double sum(double value) { return this->meet(value, false); }

  /// Tells the other ranks of the exception that this one has caught, and throws it as Error.
  [[noreturn]] void fail()
  {
    const std::exception_ptr failure = std::current_exception();
    if (!this->hasEnded_) // else all ranks have it
    {
      this->own_ = failure;
      this->meet(0, true);
    }
    std::rethrow_exception(failure);
  }

private:
  double meet(double value, bool hasFailed)
  {
    double values[2] = { value, hasFailed ? 1. : 0. };
    this->ranks_.sum(values, 2);
    if (values[1] > 0)
    {
      this->hasEnded_ = true;
      this->ranks_.together(
        [this]
        {
          if (this->own_)
          {
            std::rethrow_exception(this->own_);
          }
        });
    }
    return values[0];
  }

  const Ranks& ranks_;
  bool hasEnded_ = false;
  std::exception_ptr own_;
};

namespace
{
/// A node of the distributed mesh that this rank owns and others have rows of.
struct Slot
{
  Index row = -1; ///< of this rank, or -1
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
};

using RowMap = Eigen::Map<Eigen::RowVector3d>;

/// The owner of a node sums the rows of its copies.
class RankRows : public CopiedRows
{
public:
  RankRows(std::shared_ptr<RankCommunicator::Votes> votes, const DistributedMesh& mesh,
    const std::vector<Index>& nodes)
    : votes_(std::move(votes))
    , counts_(nodes.size(), 1)
  {
    const Ranks& ranks = this->votes_->ranks();
    std::vector<std::vector<std::int64_t>> ids(ranks.count());
    std::vector<std::vector<Index>> rows(ranks.count());
    std::unordered_map<Index, Index> rowOf;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const int owner = mesh.owner(nodes[i]);
      rowOf[nodes[i]] = static_cast<Index>(i);
      if (owner != ranks.rank())
      {
        ids[owner].push_back(mesh.nodeId(nodes[i]));
        rows[owner].push_back(static_cast<Index>(i));
      }
    }
    const auto asked = ranks.exchange(ids);
    std::unordered_map<std::int64_t, Index> slotOf;
    std::vector<std::vector<char>> counts(ranks.count());
    for (int r = 0; r < ranks.count(); ++r)
    {
      if (!rows[r].empty())
      {
        this->owners_.push_back(r);
        this->rows_.push_back(rows[r]);
      }
      if (asked[r].empty())
      {
        continue;
      }
      this->others_.push_back(r);
      std::vector<Index>& list = this->slotsOf_.emplace_back();
      for (const std::int64_t id : asked[r])
      {
        const auto [slot, isNew] = slotOf.emplace(id, static_cast<Index>(this->slots_.size()));
        const auto own = rowOf.find(mesh.nodeOf(id));
        if (isNew)
        {
          this->slots_.emplace_back().row = own == rowOf.end() ? Index(-1) : own->second;
        }
        list.push_back(slot->second);
        // A row counts on its owner, or else on the first rank that has it.
        counts[r].push_back(isNew && own == rowOf.end());
      }
    }
    const auto mine = ranks.exchange(counts);
    for (int r = 0; r < ranks.count(); ++r)
    {
      for (std::size_t i = 0; i < rows[r].size(); ++i)
      {
        this->counts_[rows[r][i]] = mine[r][i];
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      if (this->counts_[i] == 0)
      {
        this->countedElsewhere_.push_back(static_cast<Index>(i));
      }
    }
  }

  void add(Points& rows) const override
  {
    const Ranks& ranks = this->votes_->ranks();
    std::vector<std::vector<double>> copies = buffers(this->rows_), sums = buffers(this->slotsOf_);
    this->votes_->sum(0);
    forAll(this->rows_, copies, [&](Index row, double* value) { RowMap{ value } = rows.row(row); });
    ranks.exchangeNeighbors(this->owners_, copies, this->others_, sums);
    for (Slot& slot : this->slots_)
    {
      slot.sum.setZero();
      if (slot.row >= 0)
      {
        slot.sum = rows.row(slot.row);
      }
    }
    forAll(this->slotsOf_, sums,
      [&](Index slot, const double* value)
      { this->slots_[slot].sum += Eigen::Map<const Eigen::RowVector3d>(value); });
    for (const Slot& slot : this->slots_)
    {
      if (slot.row >= 0)
      {
        rows.row(slot.row) = slot.sum;
      }
    }
    forAll(this->slotsOf_, sums,
      [&](Index slot, double* value) { RowMap{ value } = this->slots_[slot].sum; });
    ranks.exchangeNeighbors(this->others_, sums, this->owners_, copies);
    forAll(this->rows_, copies,
      [&](Index row, const double* value)
      { rows.row(row) = Eigen::Map<const Eigen::RowVector3d>(value); });
  }

  double dot(const Points& a, const Points& b, Monitor& monitor) const override
  {
    return this->votes_->sum(reproducibleSum(a.rows(), monitor, 0.,
      [&](Index i) { return this->counts_[i] != 0 ? a.row(i).dot(b.row(i)) : 0.; }));
  }

  const std::vector<Index>& countedElsewhere() const override { return this->countedElsewhere_; }

private:
  static std::vector<std::vector<double>> buffers(const std::vector<std::vector<Index>>& lists)
  {
    std::vector<std::vector<double>> result;
    for (const std::vector<Index>& list : lists)
    {
      result.emplace_back(3 * list.size());
    }
    return result;
  }

  /// Calls body(item, value) for the items of all lists.
  template <typename Body>
  static void forAll(const std::vector<std::vector<Index>>& lists,
    std::vector<std::vector<double>>& values, const Body& body)
  {
    for (std::size_t r = 0; r < lists.size(); ++r)
    {
      for (std::size_t i = 0; i < lists[r].size(); ++i)
      {
        body(lists[r][i], values[r].data() + 3 * i);
      }
    }
  }

  std::shared_ptr<RankCommunicator::Votes> votes_;
  std::vector<char> counts_;                       ///< #rows: whether it counts in dot()
  std::vector<Index> countedElsewhere_;            ///< the rows that do not
  std::vector<int> owners_, others_;               ///< ranks
  std::vector<std::vector<Index>> rows_, slotsOf_; ///< for each owner, and for each other
  mutable std::vector<Slot> slots_;
};
}

RankCommunicator::RankCommunicator(const DistributedMesh& mesh, std::vector<Index> nodes)
  : mesh_(mesh)
  , nodes_(std::move(nodes))
  , votes_(std::make_shared<Votes>(mesh.ranks()))
{
}

RankCommunicator::RankCommunicator(const RankCommunicator& whole, std::vector<Index> nodes)
  : mesh_(whole.mesh_)
  , nodes_(std::move(nodes))
  , votes_(whole.votes_)
{
}

void RankCommunicator::run(const std::function<void()>& work) const
{
  this->votes_->reset();
  try
  {
    work();
    this->votes_->sum(0); // others may still fail
  }
  catch (...)
  {
    this->votes_->fail();
  }
}

double RankCommunicator::sum(double value) const
{
  return this->votes_->sum(value);
}

void RankCommunicator::sum(double* values, int count) const
{
  this->votes_->sum(0);
  this->mesh_.ranks().sum(values, count);
}

void RankCommunicator::maximum(double* values, int count) const
{
  this->votes_->sum(0);
  this->mesh_.ranks().maximum(values, count);
}

double RankCommunicator::minimum(double value) const
{
  this->votes_->sum(0);
  return this->mesh_.ranks().minimum(value);
}

void RankCommunicator::spread(std::vector<Index>& nodes) const
{
  std::vector<std::int64_t> unmarked(this->mesh_.mesh().numberOfNodes(), 1);
  for (const Index node : nodes)
  {
    unmarked[this->nodes_[node]] = 0;
  }
  this->votes_->sum(0);
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

std::unique_ptr<CopiedRows> RankCommunicator::rows(const std::vector<Index>& nodes) const
{
  this->votes_->sum(0);
  std::vector<Index> ofMesh;
  for (const Index node : nodes)
  {
    ofMesh.push_back(this->nodes_[node]);
  }
  return std::make_unique<RankRows>(this->votes_, this->mesh_, ofMesh);
}

std::unique_ptr<Communicator> RankCommunicator::part(const std::vector<Index>& nodes) const
{
  std::vector<Index> ofMesh;
  for (const Index node : nodes)
  {
    ofMesh.push_back(this->nodes_[node]);
  }
  return std::unique_ptr<Communicator>(new RankCommunicator(*this, std::move(ofMesh)));
}
}
