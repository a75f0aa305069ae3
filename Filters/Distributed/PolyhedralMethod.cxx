// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PolyhedralMethod.h"

#include "Distributed/Methods.h"
#include "Distributed/RankCommunicator.h"

#include "Support/Error.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph::distributed
{
PolyhedralMethod::PolyhedralMethod(std::unique_ptr<Morpher> method)
  : method_(std::move(method))
{
  if (const auto* system = dynamic_cast<const StiffMethod*>(this->method_.get()))
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

void PolyhedralMethod::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const DistributedMesh& whole = meshOf(this->processes());
  requirePrescribedBodies(
    whole.bodies(), this->partition(), this->processes()); // its message counts cells, not pieces
  // As their owners have them, who know all cells around them.
  std::vector<std::int64_t> follows(rest.numberOfNodes(), 0);
  for (const Index node : this->partition().higherOrderNodes)
  {
    follows[node] = 1;
  }
  whole.halo().update(whole.ranks(), follows);
  std::vector<Index> followers;
  for (std::size_t n = 0; n < follows.size(); ++n)
  {
    if (follows[n] != 0)
    {
      followers.push_back(static_cast<Index>(n));
    }
  }
  const std::vector<Index> loose = whole.hanging().tiedTo(followers);
  whole.ranks().together(
    [&]
    {
      if (!loose.empty())
      {
        throw Error(
          "Nodes hang on faces of quadratic cells whose middle nodes are no corners of the "
          "small cells, which several MPI processes cannot treat: point ids " +
          listIds(whole.idsOfNodes(loose)) + ". Run on one process.");
      }
    });
  this->cut_ = std::make_unique<CutMesh>(whole, this->method_->layers(), monitor);
  if (whole.ranks().sum(static_cast<Index>(this->reference_.rows())) > 0)
  {
    this->method_->setReference(this->cut_->extend(this->reference_));
  }
  if (auto* system = dynamic_cast<StiffMethod*>(this->method_.get()))
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
  this->method_->prepare(this->cut_->mesh().mesh(), this->cut_->extend(this->partition()), monitor,
    std::make_shared<RankCommunicator>(this->cut_->mesh()));
}

EvaluateReport PolyhedralMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points displacement = Points::Zero(this->restPoints().rows(), 3);
  displacement(this->partition().prescribed, allColumns) = prescribed;
  meshOf(this->processes()).hanging().apply(displacement);
  const Points all = this->cut_->extend(displacement);
  const std::vector<Index>& ids = this->method_->partition().prescribed;
  const Points& places = this->method_->restPoints();
  Points moved;
  const EvaluateReport report =
    this->method_->evaluate(Points(places(ids, allColumns) + all(ids, allColumns)), moved, monitor);
  displacement = this->cut_->reduce(moved - places, std::move(displacement));
  meshOf(this->processes()).hanging().apply(displacement);
  free = displacement(this->partition().free, allColumns);
  return report;
}

EvaluateReport PolyhedralMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // The ties of a rank's own nodes give to ghosts, which give to their owners.
  const DistributedMesh& whole = meshOf(this->processes());
  const auto applyTies = [&](Points& rows)
  {
    whole.hanging().applyTranspose(rows);
    whole.halo().add(whole.ranks(), rows);
  };
  const Index nodes = this->cut_->mesh().mesh().numberOfNodes();
  Points own = Points::Zero(whole.mesh().numberOfNodes(), 3);
  own(this->partition().free, allColumns) = free;
  applyTies(own);
  prescribed += own(this->partition().prescribed, allColumns);
  Points gradient = Points::Zero(nodes, 3), given;
  for (const Index node : this->partition().free)
  {
    if (this->cut_->nodeOf(node) >= 0)
    {
      gradient.row(this->cut_->nodeOf(node)) = own.row(node);
    }
  }
  const EvaluateReport report =
    dynamic_cast<const LinearMorpher&>(*this->method_).applyTranspose(gradient, given, monitor);
  Points all = Points::Zero(nodes, 3);
  all(this->method_->partition().prescribed, allColumns) = given;
  own = this->cut_->extendTranspose(all);
  whole.halo().add(whole.ranks(), own);
  applyTies(own);
  prescribed += own(this->partition().prescribed, allColumns);
  return report;
}
}
