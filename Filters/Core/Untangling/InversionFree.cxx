// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/InversionFree.h"

#include "LinearMethods/GraphLaplace.h"
#include "Mesh/ShellLayer.h"
#include "Mesh/UnknownOrdering.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/MeshImprovement.h"

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
  this->referenceMesh_ = rest;
  if (this->reference_.rows() > 0)
  {
    this->referenceMesh_.points = this->reference_;
    validate(this->referenceMesh_);
  }
  this->orientation_ = cellSigns(this->referenceMesh_, connectedComponents(rest, monitor), monitor);
  this->scale_ = unitEdgeScale(this->referenceMesh_);
  this->referenceMesh_.points *= this->scale_;
  this->referenceMesh_.layer.thickness *= this->scale_;
  const Points atRest = rest.points * this->scale_;
  this->minimumAtRest_ =
    measureCorners(this->referenceMesh_, atRest, this->orientation_, {}, monitor).minimum;
  const MovableQuality quality(this->referenceMesh_, this->orientation_, this->partition().free);
  this->validAtRest_ = quality.measure(atRest, monitor).inverted == 0;
  if (this->nearOnly_)
  {
    this->hasFemWarp_ = false;
    this->hasSimplexLinear_ = false;
    this->preconditioner_.reset();
    return;
  }

  ProgressRange first(monitor, 0, 0.1), second(monitor, 0.1, 0.4), third(monitor, 0.4, 0.9);
  this->boundary_ = boundaryFaces(this->referenceMesh_, first);
  monitor.check();
  this->geometry_ = classify(this->referenceMesh_, this->boundary_, {}, first);
  monitor.check();
  this->prepareFemWarp(rest, second);
  try
  {
    this->hasSimplexLinear_ = false;
    this->simplexLinear_.prepare(rest, this->partition(), third);
    this->hasSimplexLinear_ = true;
  }
  catch (const Error& error)
  {
    if (error.kind() == Error::Kind::Cancelled)
    {
      throw;
    }
  }
}

void InversionFree::prepareFemWarp(const Mesh& rest, Monitor& monitor)
{
  this->hasFemWarp_ = true;
  this->preconditioner_.reset();
  try
  {
    this->femWarp_.prepare(rest, this->partition(), monitor);
    if (this->femWarp_.rows() == unknownOrdering(this->referenceMesh_, this->partition().free))
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
    requirePrescribedBodies(rest, connectedComponents(rest, monitor), this->partition());
    this->hasFemWarp_ = false;
  }
}

Points InversionFree::moved(
  const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const
{
  Points result;
  report.iterations += method.evaluate(boundary, result, monitor).iterations;
  return result * this->scale_;
}

MeshImprovement InversionFree::improvement(const std::vector<Index>& hopeless) const
{
  ImprovementOptions options;
  options.steps = this->steps_;
  options.raisesValid = this->raisesValid_;
  options.nearOnly = this->nearOnly_;
  options.minimumAtRest = this->minimumAtRest_;
  options.preconditioner = this->preconditioner_.get();
  return { this->referenceMesh_, this->orientation_, this->partition(), this->boundary_,
    this->geometry_, hopeless, options };
}

MeshImprovement::Outcome InversionFree::run(const MeshImprovement& improvement, const Points& guide,
  TargetConstruction target, bool isRepair, Points& points, Monitor& monitor) const
{
  MeshImprovement::Outcome outcome = improvement.run(guide, target, isRepair, points, monitor);
  // A curved shell's tangent planes are those of the start. The result has others.
  for (int turn = 0; turn < Turns && this->referenceMesh_.layer.isCurved(); ++turn)
  {
    placeImages(this->referenceMesh_, points);
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
  best.inverted = this->referenceMesh_.numberOfCells() + 1;
  const auto keepBetter = [&](Points start)
  { return quality.keepBetter(std::move(start), points, best, monitor); };
  ProgressRange first(monitor, 0, 0.05), second(monitor, 0.05, 0.1);
  if (this->hasFemWarp_)
  {
    keepBetter(this->moved(this->femWarp_, boundary, report, first));
  }
  if (this->hasSimplexLinear_)
  {
    keepBetter(this->moved(this->simplexLinear_, boundary, report, second));
  }
  if (this->validAtRest_)
  {
    return TargetConstruction::Stretched;
  }
  keepBetter(atRest);
  // Where it is the better start, the undeformed shapes are worth nothing.
  return keepBetter(graphLaplaceMesh(this->referenceMesh_, this->partition(), atRest, monitor))
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
  const NodePartition& partition = this->partition();
  if (this->validAtRest_ && (prescribed.array() == 0).all())
  {
    free.setZero();
    MeshImprovement::Outcome nothing;
    nothing.untangled = true;
    return reportImprovement(nothing, {}, monitor);
  }
  Points boundary(prescribed.rows(), 3), points = this->restPoints() * this->scale_;
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    const Index node = partition.prescribed[i];
    boundary.row(i) = this->restPoints().row(node) + prescribed.row(i);
    points.row(node) = boundary.row(i) * this->scale_;
  }
  const std::vector<Index> determined = inversionsByBoundaryMotion(this->referenceMesh_, partition,
    this->orientation_, this->restPoints() * this->scale_, points, monitor);
  const std::vector<Index> hopeless =
    boundaryDeterminedInversions(this->referenceMesh_, partition, this->orientation_, points);

  EvaluateReport guesses;
  const Points atRest = points;
  const MeshImprovement improvement = this->improvement(hopeless);
  const TargetConstruction target =
    this->findStart(boundary, improvement.quality(), points, guesses, monitor);
  const Points guide = points;
  const MeshImprovement::Outcome outcome =
    this->run(improvement, guide, target, false, points, monitor);
  if (!outcome.untangled && improvement.quality().measure(points, monitor) <
                              improvement.quality().measure(atRest, monitor))
  {
    points = atRest;
  }
  for (Index i = 0; i < free.rows(); ++i)
  {
    const Index node = partition.free[i];
    free.row(i) = points.row(node) / this->scale_ - this->restPoints().row(node);
  }
  EvaluateReport report = reportImprovement(outcome, determined, monitor);
  report.iterations += guesses.iterations;
  return report;
}

EvaluateReport InversionFree::repair(Points& moved, Monitor& whole) const
{
  this->requirePrepared();
  const NodePartition& partition = this->partition();
  ProgressRange monitor(whole, 0, 1);
  if (partition.free.empty())
  {
    return reportImprovement({}, {}, monitor);
  }
  Points boundary(static_cast<Index>(partition.prescribed.size()), 3);
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    boundary.row(i) = moved.row(partition.prescribed[i]);
  }
  EvaluateReport guesses;
  ProgressRange first(monitor, 0, 0.1);
  Points points = moved * this->scale_;
  const std::vector<Index> hopeless =
    boundaryDeterminedInversions(this->referenceMesh_, partition, this->orientation_, points);
  const Points guide =
    this->hasFemWarp_ ? this->moved(this->femWarp_, boundary, guesses, first) : points;
  // A mesh that is valid again is enough: the rest of it stays as its method made it.
  const MeshImprovement::Outcome outcome = this->run(
    this->improvement(hopeless), guide, TargetConstruction::Stretched, true, points, monitor);
  if (this->nearOnly_ && !outcome.untangled)
  {
    MeshImprovement::Outcome failed;
    failed.effort = outcome.effort;
    return reportImprovement(failed, {}, monitor);
  }
  const std::vector<Index> determined = inversionsByBoundaryMotion(this->referenceMesh_, partition,
    this->orientation_, this->restPoints() * this->scale_, points, monitor);

  Points displacement = Points::Zero(moved.rows(), 3);
  for (Index node : partition.prescribed)
  {
    displacement.row(node) = moved.row(node) - this->restPoints().row(node);
  }
  for (Index node : partition.free)
  {
    moved.row(node) = points.row(node) / this->scale_;
    displacement.row(node) = moved.row(node) - this->restPoints().row(node);
  }
  this->higherOrderNodes_.apply(displacement);
  for (Index node : partition.higherOrderNodes)
  {
    moved.row(node) = this->restPoints().row(node) + displacement.row(node);
  }
  untangleHigherOrder(this->referenceMesh_, partition, this->orientation_, moved, monitor);
  monitor.progress(1);
  return reportImprovement(outcome, determined, monitor);
}
}
