// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/InversionFree.h"

#include "LinearMethods/GraphLaplace.h"
#include "Mesh/CellEdges.h"
#include "Mesh/KRing.h"
#include "Mesh/SubMesh.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/MinQualityAscent.h"
#include "Untangling/Untangling.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace morph
{
namespace
{
constexpr int RefreshSteps = 3;
// A minimum of this part of the undeformed mesh's is enough without the energy, which then rarely
// leads to a higher one.
constexpr double Enough = 0.75;
// A minimum of this part of the best known one may be raised beyond it.
constexpr double WorthRaising = 0.6;

constexpr int RaisedRings = 10; // of cells around repaired ones, whose nodes raise the minimum

/// Returns the cells whose scaled Jacobian is 0 or less.
std::vector<Index> notPositive(const std::vector<double>& scaledJacobian)
{
  std::vector<Index> cells;
  for (std::size_t c = 0; c < scaledJacobian.size(); ++c)
  {
    if (scaledJacobian[c] <= 0)
    {
      cells.push_back(static_cast<Index>(c));
    }
  }
  return cells;
}

/// Returns the mean edge of the volume cells, from node to node around them; 1 if there are none.
double meanEdge(const Mesh& mesh)
{
  double sum = 0;
  Index count = 0;
  forCellEdges(mesh,
    [&](Index a, Index b)
    {
      sum += (mesh.points.row(a) - mesh.points.row(b)).norm();
      ++count;
    });
  return sum > 0 ? sum / static_cast<double>(count) : 1;
}
}

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
  this->orientation_ = cellSigns(this->referenceMesh_, connectedComponents(rest));
  this->scale_ = std::exp2(-std::round(std::log2(meanEdge(this->referenceMesh_))));
  this->referenceMesh_.points *= this->scale_;
  const Points atRest = rest.points * this->scale_;
  this->minimumAtRest_ =
    measureCorners(this->referenceMesh_, atRest, this->orientation_, {}, monitor).minimum;
  if (this->nearOnly_)
  {
    this->validAtRest_ = this->minimumAtRest_ > 0;
    this->hasFemWarp_ = false;
    this->hasSimplexLinear_ = false;
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
  try
  {
    this->femWarp_.prepare(rest, this->partition(), monitor);
  }
  catch (const Error& error)
  {
    // Where all cells around a node are flat, the graph-Laplace mesh replaces FEMWARP's.
    if (error.kind() != Error::Kind::Singular || this->validAtRest_)
    {
      throw;
    }
    requirePrescribedBodies(rest, connectedComponents(rest), this->partition());
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

MovableQuality InversionFree::movableQuality() const
{
  return { this->referenceMesh_, this->orientation_, this->partition().free };
}

Points InversionFree::betterGuess(
  const Points& warped, const Points& boundary, Monitor& monitor) const
{
  // A user who asks for a certain target wants its minimum.
  if (this->hasSimplexLinear_ && this->target_ == TargetConstruction::Stretched)
  {
    EvaluateReport ignored;
    Points simplex = this->moved(this->simplexLinear_, boundary, ignored, monitor);
    const MovableQuality quality = this->movableQuality();
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
  const MovableQuality quality = this->movableQuality();
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

TargetMatrices InversionFree::targets(const Aim& aim, bool isTangled, Monitor& monitor) const
{
  const bool equal = isTangled && aim.target != TargetConstruction::Initial;
  return targetMatrices(this->referenceMesh_, this->orientation_, aim.guide, aim.target,
    equal ? CellWeights::Equal : CellWeights::Volume, monitor);
}

double InversionFree::goal(const MovableQuality& quality, const Points& points) const
{
  // One place that the boundary spoils does not set the goal for the rest.
  constexpr double OfUndeformed = 0.2;
  const MovableQuality::Bounds bounds = quality.bounds(points);
  const bool spoilt = !(bounds.fixed > OfUndeformed * this->minimumAtRest_);
  return spoilt ? bounds.movable : std::min(bounds.fixed, bounds.movable);
}

bool InversionFree::minimizeEnergy(const MovableQuality& quality, double goal, double best,
  const Aim& aim, Points& points, Outcome& outcome, Monitor& monitor) const
{
  MeshEnergy energy(this->referenceMesh_, this->partition().free);
  FoldoverContinuation stages(energy, this->minimizer_);
  const bool isTangled = best <= 0;
  monitor.check();
  ProgressRange untangle(monitor, 0.1, 0.7);
  const Untangling::Result untangling =
    Untangling(
      this->referenceMesh_, this->orientation_, this->partition(), this->boundary_, this->geometry_)
      .run(
        [&] { return this->targets(aim, isTangled, monitor); }, energy, stages, points, untangle);
  outcome.onFolds = untangling.onFolds;
  if (untangling.valid)
  {
    monitor.progress(0.7);
    for (int refresh = 0;
         refresh < this->refreshes_ && this->target_ == TargetConstruction::Stretched; ++refresh)
    {
      energy.setTargets(this->targets({ points, aim.target }, isTangled, monitor));
      stages.improve(points, RefreshSteps, monitor);
    }
    monitor.progress(0.8);
    if (this->raisesMinimum() && quality.measure(points, monitor).minimum >= WorthRaising * best)
    {
      raiseMinimumQuality(quality, goal, points, monitor);
    }
    monitor.progress(0.95);
  }
  stages.include(outcome.effort);
  outcome.effort = stages.effort();
  return untangling.valid;
}

void InversionFree::raiseNear(
  const std::vector<Index>& repaired, double goal, Points& points, Monitor& monitor) const
{
  const KRing ring = kRingOfCells(this->referenceMesh_, nodeToCells(this->referenceMesh_),
    this->partition().free, repaired, RaisedRings);
  const SubMesh part(this->referenceMesh_, ring.cells);
  const std::vector<Index> free = part.numbersOf(ring.nodes);
  std::vector<std::int8_t> signs;
  for (const Index c : part.cells)
  {
    signs.push_back(this->orientation_[c]);
  }
  Points local = points(part.nodes, allColumns);
  raiseMinimumQuality(MovableQuality(part.mesh, signs, free), goal, local, monitor);
  points(part.nodes, allColumns) = local;
}

InversionFree::Outcome InversionFree::improve(
  Points& points, const Aim& aim, const Points& alternative, double enough, Monitor& monitor) const
{
  monitor.check();
  const MovableQuality quality = this->movableQuality();
  const double goal = this->goal(quality, points);
  Points bestPoints = alternative;
  MovableQuality::Result best = quality.measure(alternative, monitor);
  Outcome outcome;
  const std::vector<Index> inverted = notPositive(best.scaledJacobian);
  const bool isRepair = enough == 0;
  const bool raisesFirst = this->raisesMinimum() && this->target_ == TargetConstruction::Stretched;
  if (raisesFirst && !inverted.empty() && this->validAtRest_)
  {
    ProgressRange near(monitor, 0.1, 0.3);
    Points untangled = alternative;
    if (untangleNear(this->referenceMesh_, this->orientation_, this->partition().free, inverted,
          isRepair ? 2 : 5, aim, this->minimizer_, untangled, outcome.effort, near))
    {
      best = quality.measure(untangled, monitor);
      bestPoints = std::move(untangled);
    }
  }
  const bool isValid = best.inverted == 0;
  outcome.untangled = isValid;
  if (isRepair && isValid && raisesFirst && !inverted.empty())
  {
    this->raiseNear(inverted, goal, bestPoints, monitor);
    points = std::move(bestPoints);
    return outcome;
  }
  if (this->nearOnly_)
  {
    points = alternative;
    return outcome;
  }
  // Raising the minimum of a valid mesh costs far less than minimising the energy.
  if (isValid && raisesFirst)
  {
    const AscentEffort raised = raiseMinimumQuality(quality, goal, bestPoints, monitor);
    if (raised.rounds > 0)
    {
      best = quality.measure(bestPoints, monitor);
    }
    // Tetrahedra aim for their undeformed shape, which costs much and rarely raises the minimum.
    const bool isAtGoal = hasReached(best.minimum, goal);
    if (isAtGoal || best.minimum >= enough * this->minimumAtRest_ ||
        mostlyTetrahedra(this->referenceMesh_))
    {
      if (isAtGoal && best.minimum < enough * this->minimumAtRest_)
      {
        raiseNextWorst(quality, raised, bestPoints, monitor);
      }
      points = std::move(bestPoints);
      return outcome;
    }
    if (this->start_ == Start::FemWarp)
    {
      points = bestPoints;
    }
  }
  outcome.untangled = this->minimizeEnergy(
                        quality, goal, isValid ? best.minimum : 0, aim, points, outcome, monitor) ||
                      isValid;
  if (quality.measure(points, monitor) < best)
  {
    points = bestPoints;
    if (isValid)
    {
      outcome.onFolds.clear();
    }
  }
  outcome.kept = outcome.effort.steps > 0 && (points.array() == alternative.array()).all();
  if (outcome.kept && this->target_ == TargetConstruction::IdealSkew && this->raisesMinimum())
  {
    outcome.kept = raiseMinimumQuality(quality, goal, points, monitor).rounds == 0;
  }
  return outcome;
}

EvaluateReport InversionFree::report(
  const Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor) const
{
  if (!determined.empty())
  {
    monitor.warn(
      "The boundary itself inverts cells whose corners it prescribes: cell ids " +
      listIds(determined) +
      ". No method can repair them; move the boundary less, or leave some of their nodes free.");
  }
  std::vector<Index> onFolds;
  std::set_difference(outcome.onFolds.begin(), outcome.onFolds.end(), determined.begin(),
    determined.end(), std::back_inserter(onFolds));
  if (!onFolds.empty())
  {
    monitor.warn("The boundary is folded: it turns over a face of cell ids " + listIds(onFolds) +
                 ", which stay inverted. Mend the boundary there, or move it less.");
  }
  EvaluateReport report;
  report.iterations = static_cast<int>(outcome.effort.steps);
  report.statistics = { { "NewtonSteps", outcome.effort.steps },
    { "LinearIterations", outcome.effort.linearIterations },
    { "EnergyEvaluations", outcome.effort.evaluations },
    { "BoundaryDeterminedCells", static_cast<Index>(determined.size()) },
    { "FoldedBoundaryCells", static_cast<Index>(onFolds.size()) },
    { "KeptLinear", outcome.kept ? 1 : 0 }, { "Untangled", outcome.untangled ? 1 : 0 } };
  return report;
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
    Outcome nothing;
    nothing.untangled = true;
    return this->report(nothing, {}, monitor);
  }
  Points boundary(prescribed.rows(), 3), points = this->restPoints() * this->scale_;
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    const Index node = partition.prescribed[i];
    boundary.row(i) = this->restPoints().row(node) + prescribed.row(i);
    points.row(node) = boundary.row(i) * this->scale_;
  }
  const std::vector<Index> determined =
    boundaryDeterminedInversions(this->referenceMesh_, partition, this->orientation_, points);

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
  const Outcome outcome =
    this->improve(points, { alternative, target }, alternative, Enough, monitor);
  for (Index i = 0; i < free.rows(); ++i)
  {
    const Index node = partition.free[i];
    free.row(i) = points.row(node) / this->scale_ - this->restPoints().row(node);
  }
  EvaluateReport report = this->report(outcome, determined, monitor);
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
    return this->report({}, {}, monitor);
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
  const Outcome outcome = this->improve(points, { guide, this->target_ }, before, 0, monitor);
  if (this->nearOnly_ && !outcome.untangled)
  {
    Outcome failed;
    failed.effort = outcome.effort;
    return this->report(failed, {}, monitor);
  }
  const std::vector<Index> determined =
    boundaryDeterminedInversions(this->referenceMesh_, partition, this->orientation_, points);

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
  return this->report(outcome, determined, monitor);
}
}
