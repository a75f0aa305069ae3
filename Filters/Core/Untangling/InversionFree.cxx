// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/InversionFree.h"

#include "LinearMethods/GraphLaplace.h"
#include "LinearMethods/SimplexLinear.h"
#include "Mesh/ShellLayer.h"
#include "Mesh/UnknownOrdering.h"
#include "Morpher/SiteMethod.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/MeshImprovement.h"

#include <limits>
#include <utility>

namespace morph
{
namespace
{
constexpr int Turns = 4; // of a curved shell's tangent planes
}

void InversionFree::takeEvaluateOptions(const Morpher& other)
{
  const auto& settings = static_cast<const InversionFree&>(other);
  this->setTolerance(settings.tolerance());
  this->steps_ = settings.steps_;
  this->raisesValid_ = settings.raisesValid_;
}

void InversionFree::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Communicator& processes = this->processes();
  Mesh reference = rest;
  if (this->reference_.rows() > 0)
  {
    reference.points = this->reference_;
    validate(reference);
  }
  const std::vector<std::int8_t> signs =
    cellSigns(reference, connectedComponents(rest, monitor, processes), monitor, processes);
  this->own_ =
    std::make_unique<OwnCells>(std::move(reference), this->partition(), signs, processes);
  OwnCells& own = *this->own_;
  this->scale_ = unitEdgeScale(own.mesh(), own.communicator());
  own.mesh().points *= this->scale_;
  own.mesh().layer.thickness *= this->scale_;
  const Points atRest = own.take(rest.points) * this->scale_;
  const auto minimumAt = [&](const Points& points)
  {
    return minimumOfAll(
      measureCorners(own.mesh(), points, own.orientation(), {}, monitor), own.communicator());
  };
  this->minimumAtRest_ = minimumAt(atRest);
  const MovableQuality quality(
    own.mesh(), own.orientation(), own.partition().free, own.communicator());
  this->validAtRest_ = quality.measure(atRest, monitor).inverted == 0;
  if (this->nearOnly_)
  {
    this->hasFemWarp_ = false;
    this->simplexLinear_.reset();
    this->preconditioner_.reset();
    return;
  }

  ProgressRange first(monitor, 0, 0.1), second(monitor, 0.1, 0.4), third(monitor, 0.4, 0.9);
  this->boundary_ = own.outerFaces(rest, first);
  monitor.check();
  this->geometry_ = classify(own.mesh(), this->boundary_, {}, first);
  monitor.check();
  this->prepareFemWarp(rest, second);
  this->simplexLinear_ = std::make_unique<SimplexLinear>();
  if (!own.isWhole())
  {
    this->simplexLinear_ = std::make_unique<SiteMethod>(std::move(this->simplexLinear_));
  }
  try
  {
    this->prepareAlike(*this->simplexLinear_, rest, third);
  }
  catch (const Error& error)
  {
    if (error.kind() == Error::Kind::Cancelled)
    {
      throw;
    }
    this->simplexLinear_.reset();
  }
}

void InversionFree::prepareFemWarp(const Mesh& rest, Monitor& monitor)
{
  this->hasFemWarp_ = true;
  this->preconditioner_.reset();
  try
  {
    this->prepareAlike(this->femWarp_, rest, monitor);
    if (this->own_->isWhole() &&
        this->femWarp_.rows() == unknownOrdering(this->own_->mesh(), this->partition().free))
    {
      this->preconditioner_ = std::make_unique<WarpPreconditioner>(this->femWarp_);
    }
  }
  catch (const Error& error)
  {
    // Where all cells around a node are flat, the graph-Laplace mesh replaces FEMWARP's.
    if (error.kind() != Error::Kind::Singular || this->validAtRest_)
    {
      throw;
    }
    requirePrescribedBodies(
      connectedComponents(rest, monitor, this->processes()), this->partition(), this->processes());
    this->hasFemWarp_ = false;
  }
}

Points InversionFree::moved(
  const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const
{
  Points result;
  report.iterations += method.evaluate(boundary, result, monitor).iterations;
  return this->own_->take(result) * this->scale_;
}

MeshImprovement InversionFree::improvement(const std::vector<Index>& hopeless) const
{
  ImprovementOptions options;
  options.steps = this->steps_;
  options.raisesValid = this->raisesValid_;
  options.nearOnly = this->nearOnly_;
  options.minimumAtRest = this->minimumAtRest_;
  options.preconditioner = this->preconditioner_.get();
  const OwnCells& own = *this->own_;
  return { own.mesh(), own.orientation(), own.partition(), this->boundary_, this->geometry_,
    hopeless, options, own.communicator() };
}

MeshImprovement::Outcome InversionFree::run(const MeshImprovement& improvement, const Points& guide,
  TargetConstruction target, bool isRepair, Points& points, Monitor& monitor) const
{
  MeshImprovement::Outcome outcome = improvement.run(guide, target, isRepair, points, monitor);
  // A curved shell's tangent planes are those of the start. The result has others.
  for (int turn = 0; turn < Turns && this->own_->mesh().layer.isCurved(); ++turn)
  {
    placeImages(this->own_->mesh(), points);
    if (improvement.quality().measure(points, monitor).inverted == 0)
    {
      break;
    }
    outcome = improvement.run(guide, target, isRepair, points, monitor);
  }
  return outcome;
}

TargetConstruction InversionFree::findStart(const Points& boundary, const MovableQuality& quality,
  Points& points, EvaluateReport& report, Monitor& monitor) const
{
  const Points atRest = points;
  MovableQuality::Result best;
  best.inverted = std::numeric_limits<Index>::max();
  const auto keepBetter = [&](Points start)
  { return quality.keepBetter(std::move(start), points, best, monitor); };
  ProgressRange first(monitor, 0, 0.05), second(monitor, 0.05, 0.1);
  if (this->hasFemWarp_)
  {
    keepBetter(this->moved(this->femWarp_, boundary, report, first));
  }
  if (this->simplexLinear_)
  {
    keepBetter(this->moved(*this->simplexLinear_, boundary, report, second));
  }
  if (this->validAtRest_)
  {
    return TargetConstruction::Stretched;
  }
  keepBetter(atRest);
  // Where it is the better start, the undeformed shapes are worth nothing.
  return this->own_->isWhole() &&
             keepBetter(graphLaplaceMesh(this->own_->mesh(), this->partition(), atRest, monitor))
           ? TargetConstruction::IdealSkew
           : TargetConstruction::Stretched;
}

EvaluateReport InversionFree::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  if (this->nearOnly_)
  {
    throw Error(Error::Kind::InvalidInput,
      "The inversion-free morph was prepared to repair another "
      "method's mesh near its inverted cells. To evaluate it, "
      "prepare it without NearOnly.");
  }
  const OwnCells& own = *this->own_;
  if (this->validAtRest_ && this->processes().all((prescribed.array() == 0).all()))
  {
    free.setZero();
    MeshImprovement::Outcome nothing;
    nothing.untangled = true;
    return reportImprovement(nothing, {}, monitor);
  }
  const Points& rest = this->restPoints();
  const Points boundary = rest(this->partition().prescribed, allColumns) + prescribed;
  Points all = rest;
  all(this->partition().prescribed, allColumns) = boundary;
  Points points = own.take(all) * this->scale_;
  const std::vector<Index> determined = inversionsByBoundaryMotion(
    own.mesh(), own.partition(), own.orientation(), own.take(rest) * this->scale_, points, monitor);
  const std::vector<Index> hopeless =
    boundaryDeterminedInversions(own.mesh(), own.partition(), own.orientation(), points);

  EvaluateReport guesses;
  const Points atRest = points;
  const MeshImprovement improvement = this->improvement(hopeless);
  const TargetConstruction target =
    this->findStart(boundary, improvement.quality(), points, guesses, monitor);
  const Points guide = points;
  MeshImprovement::Outcome outcome = this->run(improvement, guide, target, false, points, monitor);
  if (!outcome.untangled && improvement.quality().measure(points, monitor) <
                              improvement.quality().measure(atRest, monitor))
  {
    points = atRest;
  }
  all(own.nodes(), allColumns) = points / this->scale_;
  free = all(this->partition().free, allColumns) - rest(this->partition().free, allColumns);
  outcome.onFolds = own.gatherIds(outcome.onFolds);
  EvaluateReport report = reportImprovement(outcome, own.gatherIds(determined), monitor);
  report.iterations += guesses.iterations;
  return report;
}

EvaluateReport InversionFree::repair(Points& moved, Monitor& monitor) const
{
  EvaluateReport report;
  this->processes().together([&] { report = this->repairHere(moved, monitor); });
  return report;
}

EvaluateReport InversionFree::repairHere(Points& moved, Monitor& whole) const
{
  this->requirePrepared();
  const NodePartition& partition = this->partition();
  ProgressRange monitor(whole, 0, 1);
  if (this->processes().all(partition.free.empty()))
  {
    return reportImprovement({}, {}, monitor);
  }
  const OwnCells& own = *this->own_;
  const Points boundary = moved(partition.prescribed, allColumns);
  EvaluateReport guesses;
  ProgressRange first(monitor, 0, 0.1);
  Points points = own.take(moved) * this->scale_;
  const std::vector<Index> hopeless =
    boundaryDeterminedInversions(own.mesh(), own.partition(), own.orientation(), points);
  const Points guide =
    this->hasFemWarp_ ? this->moved(this->femWarp_, boundary, guesses, first) : points;
  // A mesh that is valid again is enough: the rest of it stays as its method made it.
  MeshImprovement::Outcome outcome = this->run(
    this->improvement(hopeless), guide, TargetConstruction::Stretched, true, points, monitor);
  if (this->nearOnly_ && !outcome.untangled)
  {
    MeshImprovement::Outcome failed;
    failed.effort = outcome.effort;
    return reportImprovement(failed, {}, monitor);
  }
  const std::vector<Index> determined = inversionsByBoundaryMotion(own.mesh(), own.partition(),
    own.orientation(), own.take(this->restPoints()) * this->scale_, points, monitor);

  Points found = moved, displacement = Points::Zero(moved.rows(), 3);
  found(own.nodes(), allColumns) = points / this->scale_;
  moved(partition.free, allColumns) = found(partition.free, allColumns);
  for (const std::vector<Index>* nodes : { &partition.prescribed, &partition.free })
  {
    displacement(*nodes, allColumns) =
      moved(*nodes, allColumns) - this->restPoints()(*nodes, allColumns);
  }
  this->complete(displacement);
  for (Index node : partition.higherOrderNodes)
  {
    moved.row(node) = this->restPoints().row(node) + displacement.row(node);
  }
  this->copies().update(moved);
  points = own.take(moved);
  untangleHigherOrder(
    own.mesh(), own.partition(), own.orientation(), points, monitor, own.communicator());
  moved(own.nodes(), allColumns) = points;
  this->copies().update(moved);
  monitor.progress(1);
  outcome.onFolds = own.gatherIds(outcome.onFolds);
  return reportImprovement(outcome, own.gatherIds(determined), monitor);
}
}
