// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/PolyhedralMorpher.h"

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/PolyhedronPieces.h"
#include "Morpher/CellStiffness.h"

#include <utility>

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
  }

  Method& method() const { return *this->method_; }
  void setReference(Points reference) { this->reference_ = std::move(reference); }

  void prepare(const Mesh& rest, const NodePartition& partition, Monitor& monitor)
  {
    this->pieces_ =
      std::make_unique<PolyhedronPieces>(this->hanging_.conforming(rest), monitor, this->cutsAll_);
    this->nodes_ = rest.numberOfNodes();
    if (this->reference_.rows() > 0)
    {
      this->method_->setReference(this->pieces_->extend(this->reference_));
    }
    auto* stiff = dynamic_cast<StiffMethod*>(this->method_.get());
    if (stiff)
    {
      stiff->setFirstCenter(this->nodes_);
    }
    if (stiff &&
        static_cast<Index>(stiff->stiffness().values.size()) == rest.numberOfCells()) // not yet
    {
      CellStiffness stiffness = stiff->stiffness();
      stiffness.values = this->pieces_->extend(stiffness.values);
      stiff->setStiffness(std::move(stiffness));
    }
    if (!this->hanging_.empty())
    {
      HigherOrderNodes followers;
      followers.prepare(rest, partition);
      this->ties_ = this->hanging_.following(followers);
    }
    const NodePartition ofMesh = this->ties_.extend(partition);
    this->method_->prepare(this->pieces_->mesh(), this->pieces_->extend(ofMesh), monitor);
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
    for (const Index node : partition.free)
    {
      displacement.row(node) = moved.row(node) - rest.row(node);
    }
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
    three = this->pieces_->extend(three);
    fourth = this->pieces_->extend(fourth);
    const std::vector<Index>& ids = this->method_->partition().prescribed;
    FourFields given(static_cast<Index>(ids.size()), 4);
    given << three(ids, allColumns), fourth(ids, 0);
    EvaluateReport report;
    const FourFields all = this->method_->fields(given, monitor, &report);
    three = all.topLeftCorner(this->nodes_, 3);
    fourth.setZero();
    fourth.col(0) = all.col(3).head(this->nodes_);
    this->ties_.apply(three);
    this->ties_.apply(fourth);
    free << three(partition.free, allColumns), fourth(partition.free, 0);
    return report;
  }

  EvaluateReport displaceTranspose(
    const NodePartition& partition, const Points& free, Points& prescribed, Monitor& monitor) const
  {
    Points own = Points::Zero(this->nodes_, 3);
    own(partition.free, allColumns) = free;
    this->ties_.applyTranspose(own);
    prescribed += own(partition.prescribed, allColumns);
    Points gradient = Points::Zero(this->method_->restPoints().rows(), 3), given;
    gradient(partition.free, allColumns) = own(partition.free, allColumns);
    const EvaluateReport report = this->method_->applyTranspose(gradient, given, monitor);
    Points all = Points::Zero(gradient.rows(), 3);
    all(this->method_->partition().prescribed, allColumns) = given;
    own = this->pieces_->extendTranspose(all);
    this->ties_.applyTranspose(own);
    prescribed += own(partition.prescribed, allColumns);
    return report;
  }

private:
  std::unique_ptr<Method> method_;
  bool cutsAll_;
  HangingNodes hanging_;
  HangingNodes ties_; ///< of hanging_, to nodes that are given or solved for
  std::unique_ptr<PolyhedronPieces> pieces_;
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
  Morpher& wrapped() override { return this->onPieces_.method(); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override
  {
    this->onPieces_.prepare(rest, this->partition(), monitor);
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

std::unique_ptr<Morpher> morpherForCells(
  const Mesh& mesh, const HangingNodes& hanging, std::unique_ptr<Morpher> method)
{
  return needsPieces(mesh, hanging) ? morpherForPolyhedra(std::move(method), false, hanging)
                                    : std::move(method);
}

Morpher& methodOf(Morpher& morpher)
{
  auto* wrapper = dynamic_cast<Wrapper*>(&morpher);
  return wrapper ? wrapper->wrapped() : morpher;
}
}
