// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/InversionFree.h"

#include "LinearMethods/GraphLaplace.h"
#include "Mesh/UnknownOrdering.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/MeshImprovement.h"

namespace morph
{
void InversionFree::setMethod(std::unique_ptr<Morpher> method)
{
  this->method_ = std::move(method);
  this->start_ = Start::Method;
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
  const Points atRest = rest.points * this->scale_;
  this->minimumAtRest_ =
    measureCorners(this->referenceMesh_, atRest, this->orientation_, {}, monitor).minimum;
  if (this->nearOnly_)
  {
    this->validAtRest_ = this->minimumAtRest_ > 0;
    this->hasFemWarp_ = false;
    this->hasSimplexLinear_ = false;
    this->preconditioner_.reset();
    return;
  }

  ProgressRange first(monitor, 0, 0.1), second(monitor, 0.1, 0.4), third(monitor, 0.4, 0.5),
    last(monitor, 0.5, 0.9);
  this->boundary_ = boundaryFaces(this->referenceMesh_, first);
  monitor.check();
  this->geometry_ = classify(this->referenceMesh_, this->boundary_, {}, first);
  monitor.check();
  MeshEnergy energy(this->referenceMesh_, this->partition().free);
  energy.setTargets(targetMatrices(this->referenceMesh_, this->orientation_, atRest,
    TargetConstruction::Initial, CellWeights::Volume, monitor));
  this->validAtRest_ = energy.evaluate(atRest, monitor).minimumDeterminant > 0;
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
  if (this->method_)
  {
    this->method_->prepare(rest, this->partition(), last);
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

MeshImprovement InversionFree::improvement() const
{
  ImprovementOptions options;
  options.target = this->target_;
  options.minimizer = this->minimizer_;
  options.raising = this->raising_;
  options.startsFromBest = this->start_ == Start::FemWarp;
  options.nearOnly = this->nearOnly_;
  options.refreshes = this->refreshes_;
  options.validAtRest = this->validAtRest_;
  options.minimumAtRest = this->minimumAtRest_;
  options.preconditioner = this->preconditioner_.get();
  return { this->referenceMesh_, this->orientation_, this->partition(), this->boundary_,
    this->geometry_, options };
}

Points InversionFree::betterGuess(
  const Points& warped, const Points& boundary, Monitor& monitor) const
{
  // A user who asks for a certain target wants its minimum.
  if (this->hasSimplexLinear_ && this->target_ == TargetConstruction::Stretched)
  {
    EvaluateReport ignored;
    Points simplex = this->moved(this->simplexLinear_, boundary, ignored, monitor);
    const MovableQuality quality = this->improvement().quality();
    if (quality.measure(warped, monitor) < quality.measure(simplex, monitor))
    {
      return simplex;
    }
  }
  return warped;
}

void InversionFree::startFromGraph(
  Points& points, Points& alternative, TargetConstruction& target, Monitor& monitor) const
{
  const MovableQuality quality = this->improvement().quality();
  const Points graph = graphLaplaceMesh(this->referenceMesh_, this->partition(), points, monitor);
  const MovableQuality::Result drawn = quality.measure(graph, monitor);
  if (drawn.inverted < quality.measure(points, monitor).inverted)
  {
    points = graph;
    target =
      this->target_ == TargetConstruction::Initial ? this->target_ : TargetConstruction::IdealSkew;
    if (quality.measure(alternative, monitor) < drawn)
    {
      alternative = graph;
    }
  }
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
  // Ideal skew differs from the undeformed cells': it changes the mesh without any motion.
  if (this->validAtRest_ && this->target_ != TargetConstruction::IdealSkew &&
      (prescribed.array() == 0).all())
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

  EvaluateReport guesses;
  ProgressRange first(monitor, 0, 0.04), second(monitor, 0.04, 0.08), third(monitor, 0.08, 0.1);
  Points alternative = points;
  if (this->hasFemWarp_)
  {
    alternative = this->moved(this->femWarp_, boundary, guesses, first);
  }
  if (this->start_ == Start::Method && this->method_)
  {
    points = this->moved(*this->method_, boundary, guesses, second);
  }
  alternative = this->betterGuess(alternative, boundary, third);
  TargetConstruction target = this->target_;
  if (this->start_ == Start::FemWarp && this->validAtRest_)
  {
    points = alternative;
  }
  else if (!this->validAtRest_ && this->start_ != Start::Method)
  {
    this->startFromGraph(points, alternative, target, third);
  }
  const MeshImprovement::Outcome outcome =
    this->improvement().run(points, { alternative, target }, alternative, EnoughOfMinimum, monitor);
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
  const Points before = moved * this->scale_;
  const Points guide =
    this->hasFemWarp_ ? this->moved(this->femWarp_, boundary, guesses, first) : before;
  Points points = before;
  // A mesh that is valid again is enough: the rest of it stays as its method made it.
  const MeshImprovement::Outcome outcome =
    this->improvement().run(points, { guide, this->target_ }, before, 0, monitor);
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
