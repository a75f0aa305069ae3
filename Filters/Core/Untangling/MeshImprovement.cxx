// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/MeshImprovement.h"

#include "Boundary/FoldedFaces.h"
#include "Mesh/CellEdges.h"
#include "Mesh/KRing.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/ProgressRange.h"
#include "Untangling/QualityRaising.h"
#include "Untangling/Untangling.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace morph
{
namespace
{
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
}

MeshImprovement::MeshImprovement(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const BoundaryFaces& boundary, const Classification& geometry,
  const std::vector<Index>& hopeless, const ImprovementOptions& options,
  const Communicator& communicator)
  : mesh_(mesh)
  , orientation_(orientation)
  , partition_(partition)
  , boundary_(boundary)
  , geometry_(geometry)
  , hopeless_(hopeless)
  , options_(options)
  , communicator_(communicator)
{
}

MovableQuality MeshImprovement::quality() const
{
  return { this->mesh_, this->orientation_, this->partition_.free, this->communicator_,
    this->hopeless_ };
}

double MeshImprovement::goal(const MovableQuality& quality, const Points& points) const
{
  // One place that the boundary spoils does not set the goal for the rest.
  constexpr double OfUndeformed = 0.2;
  const MovableQuality::Bounds bounds = quality.bounds(points);
  const bool spoilt = !(bounds.fixed > OfUndeformed * this->options_.minimumAtRest);
  return spoilt ? bounds.movable : std::min(bounds.fixed, bounds.movable);
}

std::vector<Index> MeshImprovement::untangle(const Aim& aim, const std::vector<Index>& inverted,
  const Points& start, const Keep& keepBetter, MinimizerEffort& effort, Monitor& monitor) const
{
  const Untangling untangling(this->mesh_, this->orientation_, this->partition_.free,
    this->options_.preconditioner, this->communicator_);
  std::vector<char> isFixed(this->mesh_.numberOfNodes(), 0);
  for (const Index node : this->partition_.prescribed)
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
  const std::vector<Index> folded =
    this->options_.nearOnly
      ? std::vector<Index>()
      : foldedFaces(this->mesh_.points, start, this->boundary_, this->geometry_, isFixed);
  const bool isFolded = !this->communicator_.all(folded.empty());
  Points trial = start;
  bool done = !isFolded && run(inverted, aim.included, this->options_.nearOnly, trial);
  if (done || this->options_.nearOnly)
  {
    return {};
  }
  TargetMatrices targets = untangling.targets(aim, monitor);
  excludeOnFoldedFaces(this->mesh_, this->boundary_, folded, targets);
  for (int round = isFolded ? 0 : 1; round <= Rounds && !done; ++round)
  {
    // Behind a fold some tetrahedra cannot be positive.
    if (round > 0 && this->communicator_.all(
                       excludeInvertedAtFixedNodes(this->mesh_, isFixed, trial, targets) == 0))
    {
      break;
    }
    done = run(tangledCells(this->mesh_, trial, targets), targets.included, false, trial);
  }
  targets.included = aim.included;
  run(tangledCells(this->mesh_, trial, targets), aim.included, true, trial);
  std::vector<Index> cells;
  for (const Index f : folded)
  {
    cells.push_back(this->boundary_.cells[f]);
  }
  sortUnique(cells);
  return cells;
}

MeshImprovement::Outcome MeshImprovement::run(const Points& guide, TargetConstruction target,
  bool isRepair, Points& points, Monitor& monitor) const
{
  monitor.check();
  const MovableQuality quality = this->quality();
  MovableQuality::Result best = quality.measure(points, monitor);
  const std::vector<Index> inverted = notPositive(best.scaledJacobian);
  const bool wasValid = best.inverted == 0;
  Outcome outcome;
  const Keep keepBetter = [&](const Points& trial)
  { return quality.keepBetter(trial, points, best, monitor); };
  std::vector<std::uint32_t> included(this->mesh_.numberOfCells(), ~0u);
  for (const Index c : this->hopeless_)
  {
    included[c] = 0;
  }
  const Points start = points;
  std::vector<Index> onFolds;
  for (const TargetConstruction aim : { target, TargetConstruction::IdealSkew })
  {
    // Of a valid undeformed mesh the shapes are worth aiming for.
    const bool isWorthwhile = aim == target || !(this->options_.minimumAtRest > 0);
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
  const bool raises =
    wasValid ? !isRepair && this->options_.raisesValid : !isRepair || outcome.untangled;
  if (this->options_.steps == 0 || !raises)
  {
    return outcome;
  }
  const std::vector<Index> free =
    isRepair ? kRingOfCells(this->mesh_, nodeToCells(this->mesh_), this->partition_.free, inverted,
                 RaisedRings, this->communicator_)
                 .nodes
             : this->partition_.free;
  // What stays inverted does not keep the others down.
  std::vector<Index> hopeless = notPositive(best.scaledJacobian);
  hopeless.insert(hopeless.end(), this->hopeless_.begin(), this->hopeless_.end());
  const MovableQuality others(this->mesh_, this->orientation_, free, this->communicator_, hopeless);
  ProgressRange raise(monitor, 0.6, 0.95);
  add(raiseQuality(others, this->goal(quality, points), this->options_.steps, points, raise),
    outcome.effort);
  return outcome;
}

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

EvaluateReport reportImprovement(
  const MeshImprovement::Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor)
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
}
