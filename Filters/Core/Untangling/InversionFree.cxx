// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/InversionFree.h"

#include "Boundary/FaceQuality.h"
#include "LinearMethods/GraphLaplace.h"
#include "LinearMethods/SimplexLinear.h"
#include "Mesh/NodePartition.h"
#include "Mesh/ShellLayer.h"
#include "Mesh/Topology.h"
#include "Morpher/SiteMethod.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/QualityRaising.h"
#include "Untangling/Untangling.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace morph
{
namespace
{
constexpr int Turns = 4;        // of a curved shell's tangent planes
constexpr int RaisedRings = 10; // of cells around repaired ones, whose nodes raise the minimum
// Rounds that leave out what stays inverted at fixed nodes; one leaves 2 % more cells inverted.
constexpr int Rounds = 3;

void add(const MinimizerEffort& own, MinimizerEffort& effort)
{
  effort.steps += own.steps;
  effort.linearIterations += own.linearIterations;
  effort.evaluations += own.evaluations;
}

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

/// Returns the power of two that makes a mesh's edges about 1 long. So no number depends on the
/// unit of length.
double unitEdgeScale(const Mesh& mesh, const Communicator& communicator)
{
  double sum = 0;
  Index count = 0; // an edge counts once for each face of each volume cell
  forCellEdges(mesh,
    [&](Index a, Index b)
    {
      sum += (mesh.points.row(a) - mesh.points.row(b)).norm();
      ++count;
    });
  sum = communicator.sum(sum);
  count = communicator.sum(count);
  const double mean = sum > 0 ? sum / static_cast<double>(count) : 1;
  return std::exp2(-std::round(std::log2(mean)));
}

/// The multigrid cycle that FEMWARP has prepared, on the same nodes.
class WarpPreconditioner : public NodePreconditioner
{
public:
  /// `femWarp`: prepared, and prepared no more while this object lives.
  explicit WarpPreconditioner(const FemWarp& femWarp)
    : femWarp_(femWarp)
    , diagonal_(femWarp.solver().matrix().diagonal())
  {
  }
  void apply(const Points& from, Points& to, Monitor& monitor) const override
  {
    this->femWarp_.solver().precondition(from, to, monitor);
  }
  double diagonal(Index row) const override { return this->diagonal_[row]; }
  Index rows() const override { return this->diagonal_.size(); }

private:
  const FemWarp& femWarp_;
  Eigen::VectorXd diagonal_;
};
}

struct InversionFree::Outcome
{
  bool untangled = false;     ///< no cell is inverted but hopeless ones
  std::vector<Index> onFolds; ///< inverted cells on folded faces of the boundary
  MinimizerEffort effort;
};

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
  this->validAtRest_ = this->quality({}).measure(atRest, monitor).inverted == 0;
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

MovableQuality InversionFree::quality(const std::vector<Index>& hopeless) const
{
  const OwnCells& own = *this->own_;
  return { own.mesh(), own.orientation(), own.partition().free, own.communicator(), hopeless };
}

double InversionFree::goal(const MovableQuality& quality, const Points& points) const
{
  // One place that the boundary spoils does not set the goal for the rest.
  constexpr double OfUndeformed = 0.2;
  const MovableQuality::Bounds bounds = quality.bounds(points);
  const bool spoilt = !(bounds.fixed > OfUndeformed * this->minimumAtRest_);
  return spoilt ? bounds.movable : std::min(bounds.fixed, bounds.movable);
}

std::vector<Index> InversionFree::untangle(const Aim& aim, const std::vector<Index>& inverted,
  const Points& start, const std::function<bool(const Points& trial)>& keepBetter,
  MinimizerEffort& effort, Monitor& monitor) const
{
  const OwnCells& own = *this->own_;
  const Untangling untangling(own, this->preconditioner_.get());
  std::vector<char> isFixed(own.mesh().numberOfNodes(), 0);
  for (const Index node : own.partition().prescribed)
  {
    isFixed[node] = 1;
  }
  const auto run = [&](const std::vector<Index>& seeds, const std::vector<std::uint32_t>& included,
                     bool nearOnly, Points& points)
  {
    const bool done =
      untangling.run(seeds, { aim.guide, aim.target, included }, nearOnly, points, effort, monitor);
    keepBetter(points);
    return done;
  };
  const std::vector<Index> folded = this->nearOnly_ ? std::vector<Index>()
                                                    : foldedFaces(own.mesh().points, start,
                                                        this->boundary_, this->geometry_, isFixed);
  const bool isFolded = !own.communicator().all(folded.empty());
  Points trial = start;
  bool done = !isFolded && run(inverted, aim.included, this->nearOnly_, trial);
  if (done || this->nearOnly_)
  {
    return {};
  }
  TargetMatrices targets = untangling.targets(aim, monitor);
  excludeOnFoldedFaces(own.mesh(), this->boundary_, folded, targets);
  for (int round = isFolded ? 0 : 1; round <= Rounds && !done; ++round)
  {
    // Behind a fold some tetrahedra cannot be positive.
    if (round > 0 && own.communicator().all(
                       excludeInvertedAtFixedNodes(own.mesh(), isFixed, trial, targets) == 0))
    {
      break;
    }
    done = run(tangledCells(own.mesh(), trial, targets), targets.included, false, trial);
  }
  targets.included = aim.included;
  run(tangledCells(own.mesh(), trial, targets), aim.included, true, trial);
  std::vector<Index> cells;
  for (const Index f : folded)
  {
    cells.push_back(this->boundary_.cells[f]);
  }
  sortUnique(cells);
  return cells;
}

InversionFree::Outcome InversionFree::improve(const std::vector<Index>& hopeless,
  const Points& guide, TargetConstruction target, bool isRepair, Points& points,
  Monitor& monitor) const
{
  monitor.check();
  const OwnCells& own = *this->own_;
  const MovableQuality quality = this->quality(hopeless);
  MovableQuality::Result best = quality.measure(points, monitor);
  const std::vector<Index> inverted = notPositive(best.scaledJacobian);
  const bool wasValid = best.inverted == 0;
  Outcome outcome;
  const auto keepBetter = [&](const Points& trial)
  { return quality.keepBetter(trial, points, best, monitor); };
  std::vector<std::uint32_t> included(own.mesh().numberOfCells(), ~0u);
  for (const Index c : hopeless)
  {
    included[c] = 0;
  }
  const Points start = points;
  std::vector<Index> onFolds;
  for (const TargetConstruction aim : { target, TargetConstruction::IdealSkew })
  {
    // Of a valid undeformed mesh the shapes are worth aiming for.
    const bool isWorthwhile = aim == target || !(this->minimumAtRest_ > 0);
    if (best.inverted > 0 && isWorthwhile)
    {
      ProgressRange untangling(monitor, 0.1, 0.6);
      onFolds = this->untangle(
        { guide, aim, included }, inverted, start, keepBetter, outcome.effort, untangling);
    }
  }
  const std::vector<Index> left = notPositive(best.scaledJacobian);
  std::set_intersection(
    onFolds.begin(), onFolds.end(), left.begin(), left.end(), std::back_inserter(outcome.onFolds));
  outcome.untangled = best.inverted == 0;
  const bool raises = wasValid ? !isRepair && this->raisesValid_ : !isRepair || outcome.untangled;
  if (this->steps_ == 0 || !raises)
  {
    return outcome;
  }
  const std::vector<Index> free =
    isRepair ? kRingOfCells(own.mesh(), nodeToCells(own.mesh()), own.partition().free, inverted,
                 RaisedRings, own.communicator())
                 .nodes
             : own.partition().free;
  // What stays inverted does not keep the others down.
  std::vector<Index> lost = notPositive(best.scaledJacobian);
  lost.insert(lost.end(), hopeless.begin(), hopeless.end());
  const MovableQuality others(own.mesh(), own.orientation(), free, own.communicator(), lost);
  ProgressRange raise(monitor, 0.6, 0.95);
  add(
    raiseQuality(others, this->goal(quality, points), this->steps_, points, raise), outcome.effort);
  return outcome;
}

InversionFree::Outcome InversionFree::improveInTurns(const std::vector<Index>& hopeless,
  const Points& guide, TargetConstruction target, bool isRepair, Points& points,
  Monitor& monitor) const
{
  Outcome outcome = this->improve(hopeless, guide, target, isRepair, points, monitor);
  // A curved shell's tangent planes are those of the start. The result has others.
  for (int turn = 0; turn < Turns && this->own_->mesh().layer.isCurved(); ++turn)
  {
    placeImages(this->own_->mesh(), points, this->own_->communicator());
    if (this->quality(hopeless).measure(points, monitor).inverted == 0)
    {
      break;
    }
    outcome = this->improve(hopeless, guide, target, isRepair, points, monitor);
  }
  return outcome;
}

EvaluateReport InversionFree::report(
  const Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor)
{
  warnOfDetermined(determined, monitor);
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
    { "Untangled", outcome.untangled ? 1 : 0 } };
  return report;
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
  // If it is the better start, the undeformed cell shapes are no useful target.
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
    return report({ true, {}, {} }, {}, monitor);
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
  const MovableQuality quality = this->quality(hopeless);
  const TargetConstruction target = this->findStart(boundary, quality, points, guesses, monitor);
  const Points guide = points;
  Outcome outcome = this->improveInTurns(hopeless, guide, target, false, points, monitor);
  if (!outcome.untangled && quality.measure(points, monitor) < quality.measure(atRest, monitor))
  {
    points = atRest;
  }
  all(own.nodes(), allColumns) = points / this->scale_;
  free = all(this->partition().free, allColumns) - rest(this->partition().free, allColumns);
  outcome.onFolds = own.gatherIds(outcome.onFolds);
  EvaluateReport result = report(outcome, own.gatherIds(determined), monitor);
  result.iterations += guesses.iterations;
  return result;
}

EvaluateReport InversionFree::repair(Points& moved, Monitor& monitor) const
{
  EvaluateReport result;
  this->processes().together([&] { result = this->repairHere(moved, monitor); });
  return result;
}

EvaluateReport InversionFree::repairHere(Points& moved, Monitor& whole) const
{
  this->requirePrepared();
  const NodePartition& partition = this->partition();
  ProgressRange monitor(whole, 0, 1);
  if (this->processes().all(partition.free.empty()))
  {
    return report({}, {}, monitor);
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
  Outcome outcome =
    this->improveInTurns(hopeless, guide, TargetConstruction::Stretched, true, points, monitor);
  if (this->nearOnly_ && !outcome.untangled)
  {
    return report({ false, {}, outcome.effort }, {}, monitor);
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
  return report(outcome, own.gatherIds(determined), monitor);
}
}
