// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/PolyhedralMorpher.h"

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/PolyhedronPieces.h"
#include "Morpher/Morpher.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
/// A method, prepared on the pieces of a mesh.
template <typename Method>
class OnPieces
{
public:
  OnPieces(std::unique_ptr<Method> method, bool cutsAll, HangingNodes hanging)
    : method_(std::move(method))
    , cutsAll_(cutsAll)
    , hanging_(std::move(hanging))
  {
    if (const auto* stiff = dynamic_cast<const StiffMethod*>(this->method_.get()))
    {
      this->stiffness_ = stiff->stiffness();
    }
  }

  Method& method() const { return *this->method_; }
  void setReference(Points reference) { this->reference_ = std::move(reference); }

  void prepare(const Mesh& rest, const NodePartition& partition, const Communicator& processes,
    Monitor& monitor)
  {
    if (processes.bodies()) // the method's message would count pieces
    {
      requirePrescribedBodies(*processes.bodies(), partition, processes);
    }
    this->nodes_ = rest.numberOfNodes();
    this->copies_ = processes.rows();
    this->findTies(rest, partition, processes);
    this->pieces_ = cutCells(rest, this->hanging_, processes, std::max(1, this->method_->layers()),
      monitor, this->cutsAll_);
    if (!processes.all(this->reference_.rows() == 0))
    {
      this->method_->setReference(this->pieces_->extend(this->reference_));
    }
    if (auto* stiff = dynamic_cast<StiffMethod*>(this->method_.get()))
    {
      this->setStiffness(*stiff, processes);
    }
    this->method_->prepare(this->pieces_->mesh(),
      this->pieces_->extend(this->ties_.extend(partition)), monitor, this->pieces_->processes());
  }

  EvaluateReport displace(
    const NodePartition& partition, const Points& prescribed, Points& free, Monitor& monitor) const
  {
    Points displacement = Points::Zero(this->nodes_, 3);
    displacement(partition.prescribed, allColumns) = prescribed;
    this->ties_.apply(displacement);
    const Points all = this->pieces_->extend(displacement);
    const std::vector<Index>& ids = this->method_->partition().prescribed;
    const Points& rest = this->method_->restPoints();
    Points targets(static_cast<Index>(ids.size()), 3), moved;
    for (Index i = 0; i < targets.rows(); ++i)
    {
      targets.row(i) = rest.row(ids[i]) + all.row(ids[i]);
    }
    const EvaluateReport report = this->method_->evaluate(targets, moved, monitor);
    displacement = this->pieces_->reduce(moved - rest, std::move(displacement));
    displacement(partition.prescribed, allColumns) = prescribed;
    this->ties_.apply(displacement);
    free = displacement(partition.free, allColumns);
    return report;
  }

  EvaluateReport displaceFields(const NodePartition& partition, const FourFields& prescribed,
    FourFields& free, Monitor& monitor) const
  {
    Points three = Points::Zero(this->nodes_, 3), fourth = three;
    three(partition.prescribed, allColumns) = prescribed.leftCols<3>();
    fourth(partition.prescribed, 0) = prescribed.col(3);
    this->ties_.apply(three);
    this->ties_.apply(fourth);
    Points all = this->pieces_->extend(three), other = this->pieces_->extend(fourth);
    const std::vector<Index>& ids = this->method_->partition().prescribed;
    FourFields given(static_cast<Index>(ids.size()), 4);
    given << all(ids, allColumns), Points(other(ids, allColumns)).col(0);
    EvaluateReport report;
    const FourFields found = this->method_->fields(given, monitor, &report);
    all = found.leftCols<3>();
    other.setZero();
    other.col(0) = found.col(3);
    three = this->pieces_->reduce(all, std::move(three));
    fourth = this->pieces_->reduce(other, std::move(fourth));
    this->ties_.apply(three);
    this->ties_.apply(fourth);
    free << three(partition.free, allColumns), Points(fourth(partition.free, allColumns)).col(0);
    return report;
  }

  EvaluateReport displaceTranspose(
    const NodePartition& partition, const Points& free, Points& prescribed, Monitor& monitor) const
  {
    // What hangs gives to copies, which give to the nodes that count.
    const auto give = [&](Points& rows)
    {
      this->ties_.applyTranspose(rows);
      this->copies_->collect(rows);
      prescribed += rows(partition.prescribed, allColumns);
    };
    Points own = Points::Zero(this->nodes_, 3);
    own(partition.free, allColumns) = free;
    give(own);
    Points gradient = Points::Zero(this->method_->restPoints().rows(), 3), given;
    for (const Index node : partition.free)
    {
      if (const Index place = this->pieces_->nodeOf(node); place >= 0)
      {
        gradient.row(place) = own.row(node);
      }
    }
    const EvaluateReport report = this->method_->applyTranspose(gradient, given, monitor);
    Points all = Points::Zero(gradient.rows(), 3);
    all(this->method_->partition().prescribed, allColumns) = given;
    own = this->pieces_->extendTranspose(all);
    this->copies_->collect(own);
    give(own);
    return report;
  }

private:
  void findTies(const Mesh& rest, const NodePartition& partition, const Communicator& processes)
  {
    this->ties_ = this->hanging_;
    if (processes.all(this->hanging_.empty()))
    {
      return;
    }
    // A process that does not have all cells around a node may take it for a follower, or has
    // other weights of it.
    Points follows = Points::Zero(this->nodes_, 3);
    follows(partition.higherOrderNodes, allColumns).setOnes();
    this->copies_->update(follows);
    std::vector<Index> nodes;
    for (Index n = 0; n < this->nodes_; ++n)
    {
      if (follows(n, 0) != 0)
      {
        nodes.push_back(n);
      }
    }
    std::map<Index, std::map<Index, double>> known =
      weightsOf(this->hanging_.tiedTo(nodes), rest, processes);
    this->ties_ = this->hanging_.following([&known](Index node) { return known[node]; });
  }

  /// Returns the weights of these followers, by the process that has all cells around each.
  static std::map<Index, std::map<Index, double>> weightsOf(
    const std::vector<Index>& nodes, const Mesh& rest, const Communicator& processes)
  {
    NodePartition own;
    for (const Index node : processes.nodesOf(processes.idsOf(nodes)))
    {
      if (processes.owns(node))
      {
        own.higherOrderNodes.push_back(node);
      }
    }
    HigherOrderNodes followers;
    followers.prepare(rest, own);
    std::vector<double> rows; // of each follower and corner the ids, and the weight
    for (const Index node : own.higherOrderNodes)
    {
      for (const auto& [corner, weight] : followers.weightsOf(node))
      {
        const std::vector<Index> ids = processes.idsOf({ node, corner });
        rows.insert(
          rows.end(), { static_cast<double>(ids[0]), static_cast<double>(ids[1]), weight });
      }
    }
    rows = processes.gather(rows);
    std::vector<Index> corners;
    for (std::size_t k = 1; k < rows.size(); k += 3)
    {
      corners.push_back(static_cast<Index>(rows[k]));
    }
    const auto byId = [&processes](const std::vector<Index>& local)
    {
      const std::vector<Index> ids = processes.idsOf(local);
      std::map<Index, Index> result;
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        result[ids[k]] = local[k];
      }
      return result;
    };
    const std::map<Index, Index> cornerOf = byId(processes.nodesOf(corners)),
                                 followerOf = byId(nodes);
    std::map<Index, std::map<Index, double>> result;
    std::vector<Index> missing;
    for (std::size_t k = 0; k < rows.size(); k += 3)
    {
      const auto follower = followerOf.find(static_cast<Index>(rows[k]));
      const auto corner = cornerOf.find(static_cast<Index>(rows[k + 1]));
      if (follower != followerOf.end() && corner != cornerOf.end())
      {
        result[follower->second][corner->second] = rows[k + 2];
      }
      else if (follower != followerOf.end())
      {
        missing.push_back(follower->first);
      }
    }
    if (!missing.empty())
    {
      sortUnique(missing);
      throw Error("Nodes hang on middle nodes of quadratic faces, which follow corners that an MPI "
                  "process does not have: ids of these middle nodes " +
                  listIds(missing) + ". Run on one process.");
    }
    return result;
  }

  void setStiffness(StiffMethod& method, const Communicator& processes) const
  {
    CellStiffness stiffness = this->stiffness_;
    if (!stiffness.values.empty())
    {
      stiffness.values = this->pieces_->extend(stiffness.values);
    }
    for (Index& node : stiffness.walls)
    {
      node = stiffness.areWallsGlobal ? node : this->pieces_->nodeOf(node);
    }
    method.setStiffness(std::move(stiffness));
    if (!processes.bodies())
    {
      method.setFirstCenter(this->nodes_);
    }
  }

  std::unique_ptr<Method> method_;
  CellStiffness stiffness_; ///< with values of the cells that the pieces are cut from
  bool cutsAll_;
  HangingNodes hanging_;
  HangingNodes ties_; ///< of hanging_, to nodes that are given or solved for
  std::shared_ptr<const CopiedRows> copies_;
  std::shared_ptr<const CellPieces> pieces_;
  Points reference_;
  Index nodes_ = 0;
};

/// What methodOf() asks for.
class Wrapper
{
public:
  virtual ~Wrapper() = default;
  virtual Morpher& wrapped() = 0;
};

template <typename Method>
class PolyhedralMorpher
  : public Method
  , public Wrapper
{
public:
  PolyhedralMorpher(std::unique_ptr<Method> method, bool cutsAll, HangingNodes hanging)
    : onPieces_(std::move(method), cutsAll, std::move(hanging))
  {
  }
  void setReference(Points reference) override
  {
    this->onPieces_.setReference(std::move(reference));
  }
  int layers() const override { return std::min(1, this->onPieces_.method().layers()); }
  Morpher& wrapped() override { return this->onPieces_.method(); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override
  {
    this->onPieces_.prepare(rest, this->partition(), this->processes(), monitor);
  }
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override
  {
    return this->onPieces_.displace(this->partition(), prescribed, free, monitor);
  }

  OnPieces<Method> onPieces_;
};

class PolyhedralLinearMorpher : public PolyhedralMorpher<LinearMorpher>
{
  using PolyhedralMorpher<LinearMorpher>::PolyhedralMorpher;

  double tolerance() const override { return this->onPieces_.method().tolerance(); }
  EvaluateReport displaceFields(
    const FourFields& prescribed, FourFields& free, Monitor& monitor) const override
  {
    return this->onPieces_.displaceFields(this->partition(), prescribed, free, monitor);
  }
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override
  {
    return this->onPieces_.displaceTranspose(this->partition(), free, prescribed, monitor);
  }
};
}

std::unique_ptr<Morpher> morpherForPolyhedra(
  std::unique_ptr<Morpher> method, bool cutsAll, HangingNodes hanging)
{
  if (auto* linear = dynamic_cast<LinearMorpher*>(method.get()))
  {
    method.release();
    return std::make_unique<PolyhedralLinearMorpher>(
      std::unique_ptr<LinearMorpher>(linear), cutsAll, std::move(hanging));
  }
  return std::make_unique<PolyhedralMorpher<Morpher>>(
    std::move(method), cutsAll, std::move(hanging));
}

bool needsPieces(const Mesh& mesh, const HangingNodes& hanging)
{
  return hasPolyhedra(mesh) || !hanging.empty();
}

Morpher& methodOf(Morpher& morpher)
{
  auto* wrapper = dynamic_cast<Wrapper*>(&morpher);
  return wrapper ? wrapper->wrapped() : morpher;
}
}
