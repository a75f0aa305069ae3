// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/InversionFree.h"

#include "Distributed/Methods.h"
#include "LinearMethods/SimplexLinear.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <cmath>
#include <limits>
#include <utility>

namespace morph::distributed
{
void InversionFree::takeEvaluateOptions(const Morpher& serial)
{
  const auto& own = static_cast<const morph::InversionFree&>(serial);
  this->femWarp_.setTolerance(own.tolerance());
  this->options_.steps = own.steps();
  this->options_.raisesValid = own.raisesValid();
}

MeshImprovement InversionFree::improvement(const std::vector<Index>& hopeless) const
{
  return { this->own_->mesh(), this->own_->orientation(), this->own_->partition(), this->boundary_,
    this->geometry_, hopeless, this->options_, this->own_->communicator() };
}

void InversionFree::doPrepare(const Mesh& all, Monitor& monitor)
{
  const Points& rest = all.points;
  const Points& reference = this->reference_.rows() > 0 ? this->reference_ : rest;
  this->own_ = std::make_unique<OwnCells>(meshOf(this->processes()), this->partition());
  OwnCells& own = *this->own_;
  ProgressRange first(monitor, 0, 0.2), second(monitor, 0.2, 0.7), third(monitor, 0.7, 1);
  own.mesh().points = own.take(reference);
  this->scale_ = unitEdgeScale(own.mesh(), own.communicator());
  own.mesh().points *= this->scale_;
  const auto minimumAt = [&](const Points& points)
  {
    const morph::Quality quality =
      measureCorners(own.mesh(), own.take(points) * this->scale_, own.orientation(), {}, monitor);
    return own.communicator().minimum(
      quality.measured > 0 ? quality.minimum : std::numeric_limits<double>::infinity());
  };
  this->options_.minimumAtRest = minimumAt(rest);
  if (!(minimumAt(reference) > 0))
  {
    throw Error("The undeformed mesh has inverted or degenerate cells. On several MPI ranks the "
                "inversion-free method needs a valid one: repair it on one rank first.");
  }
  this->boundary_ = own.outerFaces();
  this->geometry_ = classify(own.mesh(), this->boundary_, {}, first);
  const auto processes = std::make_shared<RankCommunicator>(meshOf(this->processes()));
  this->femWarp_.prepare(all, this->partition(), second, processes);
  this->simplexLinear_ = std::make_unique<SiteMethod>(std::make_unique<SimplexLinear>());
  try
  {
    this->simplexLinear_->prepare(all, this->partition(), third, processes);
  }
  catch (const Error& error)
  {
    // A flat boundary has no tessellation, for instance.
    if (error.kind() == Error::Kind::Cancelled)
    {
      throw;
    }
    this->simplexLinear_.reset();
  }
}

void InversionFree::findStart(const Points& target, const std::vector<Index>& hopeless,
  Points& points, EvaluateReport& report, Monitor& monitor) const
{
  Points simplex;
  report.iterations += this->femWarp_.evaluate(target, points, monitor).iterations;
  if (this->simplexLinear_)
  {
    this->simplexLinear_->evaluate(target, simplex, monitor);
  }
  const MovableQuality quality = this->improvement(hopeless).quality();
  const auto at = [&](const Points& start)
  { return quality.measure(this->own_->take(start) * this->scale_, monitor); };
  if (this->simplexLinear_ && at(points) < at(simplex))
  {
    points = simplex;
  }
}

EvaluateReport InversionFree::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const DistributedMesh& mesh = meshOf(this->processes());
  const Ranks& ranks = mesh.ranks();
  const Points& rest = this->restPoints();
  const OwnCells& own = *this->own_;
  Monitor quiet;
  Monitor& speaking = ranks.rank() == 0 ? monitor : quiet;
  if (ranks.sum(Index((prescribed.array() != 0).any())) == 0)
  {
    free.setZero();
    MeshImprovement::Outcome nothing;
    nothing.untangled = true;
    return reportImprovement(nothing, {}, speaking);
  }
  const Points target = rest(this->partition().prescribed, allColumns) + prescribed;
  ProgressRange first(monitor, 0, 0.1), second(monitor, 0.1, 1);
  EvaluateReport guesses;
  Points points = rest;
  points(this->partition().prescribed, allColumns) = target;
  mesh.halo().update(ranks, points);
  Points improved = own.take(points) * this->scale_;
  const std::vector<Index> determined = inversionsByBoundaryMotion(own.mesh(), own.partition(),
    own.orientation(), own.take(rest) * this->scale_, improved, second);
  const std::vector<Index> hopeless =
    boundaryDeterminedInversions(own.mesh(), own.partition(), own.orientation(), improved);
  const Points atRest = points;
  this->findStart(target, hopeless, points, guesses, first);
  improved = own.take(points) * this->scale_;
  const Points guide = improved;
  const MeshImprovement improvement = this->improvement(hopeless);
  MeshImprovement::Outcome outcome =
    improvement.run(guide, TargetConstruction::Stretched, false, improved, second);
  const Points moved = own.take(atRest) * this->scale_;
  const MovableQuality quality = improvement.quality();
  if (!outcome.untangled && quality.measure(improved, second) < quality.measure(moved, second))
  {
    improved = moved;
  }
  points(own.nodes(), allColumns) = improved / this->scale_;
  free = points(this->partition().free, allColumns) - rest(this->partition().free, allColumns);
  outcome.onFolds = own.gatherIds(outcome.onFolds);
  EvaluateReport report = reportImprovement(outcome, own.gatherIds(determined), speaking);
  report.iterations += guesses.iterations;
  return report;
}
}
