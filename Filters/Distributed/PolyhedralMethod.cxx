// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PolyhedralMethod.h"

#include "Distributed/SystemMethod.h"

#include <utility>

namespace morph::distributed
{
PolyhedralMethod::PolyhedralMethod(std::unique_ptr<Method> method)
  : method_(std::move(method))
{
  if (const auto* system = dynamic_cast<const SystemMethod*>(this->method_.get()))
  {
    this->stiffness_ = system->stiffness();
  }
}

void PolyhedralMethod::takeEvaluateOptions(const Morpher& serial)
{
  this->method_->takeEvaluateOptions(serial);
}

void PolyhedralMethod::setReference(Points reference)
{
  this->reference_ = std::move(reference);
}

void PolyhedralMethod::doPrepare(Monitor& monitor)
{
  const DistributedMesh& whole = this->mesh();
  requirePrescribedBodies(whole, this->partition()); // its message counts cells, not pieces
  this->cut_ = std::make_unique<CutMesh>(whole, this->method_->layers(), monitor);
  if (whole.ranks().sum(static_cast<Index>(this->reference_.rows())) > 0)
  {
    this->method_->setReference(this->cut_->extend(this->reference_));
  }
  if (auto* system = dynamic_cast<SystemMethod*>(this->method_.get()))
  {
    CellStiffness stiffness = this->stiffness_;
    stiffness.values = this->cut_->extend(stiffness.values);
    if (!stiffness.areWallsGlobal)
    {
      for (Index& node : stiffness.walls)
      {
        node = this->cut_->nodeOf(node);
      }
    }
    system->setStiffness(std::move(stiffness));
  }
  this->method_->prepare(this->cut_->mesh(), this->cut_->extend(this->partition()), monitor);
}

EvaluateReport PolyhedralMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points displacement = Points::Zero(this->mesh().mesh().numberOfNodes(), 3);
  displacement(this->partition().prescribed, allColumns) = prescribed;
  const Points all = this->cut_->extend(displacement);
  Points field;
  const EvaluateReport report =
    this->method_->mode(all(this->method_->partition().prescribed, allColumns), field, monitor);
  for (Index i = 0; i < free.rows(); ++i)
  {
    free.row(i) = field.row(this->cut_->nodeOf(this->ownFree()[i]));
  }
  return report;
}

EvaluateReport PolyhedralMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  const Index nodes = this->cut_->mesh().mesh().numberOfNodes();
  Points gradient = Points::Zero(nodes, 3), given;
  for (Index i = 0; i < free.rows(); ++i)
  {
    gradient.row(this->cut_->nodeOf(this->ownFree()[i])) = free.row(i);
  }
  const EvaluateReport report = this->method_->applyTranspose(gradient, given, monitor);
  Points all = Points::Zero(nodes, 3);
  all(this->method_->partition().prescribed, allColumns) = given;
  prescribed += this->cut_->extendTranspose(all)(this->partition().prescribed, allColumns);
  return report;
}
}
