// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/MeshImprovement.h"

#include "Energies/MeshEnergy.h"
#include "Mesh/CellEdges.h"
#include "Mesh/KRing.h"
#include "Mesh/SubMesh.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/MinQualityAscent.h"
#include "Untangling/Untangling.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

namespace morph
{
namespace
{
constexpr int RefreshSteps = 3;
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
}

MeshImprovement::MeshImprovement(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const NodePartition& partition, const BoundaryFaces& boundary, const Classification& geometry,
  const ImprovementOptions& options, const Communicator& communicator)
  : mesh_(mesh)
  , orientation_(orientation)
  , partition_(partition)
  , boundary_(boundary)
  , geometry_(geometry)
  , options_(options)
  , communicator_(communicator)
{
}

MovableQuality MeshImprovement::quality() const
{
  return { this->mesh_, this->orientation_, this->partition_.free, this->communicator_ };
}

TargetMatrices MeshImprovement::targets(const Aim& aim, bool isTangled, Monitor& monitor) const
{
  const bool equal = isTangled && aim.target != TargetConstruction::Initial;
  return targetMatrices(this->mesh_, this->orientation_, aim.guide, aim.target,
    equal ? CellWeights::Equal : CellWeights::Volume, monitor, this->communicator_);
}

double MeshImprovement::goal(const MovableQuality& quality, const Points& points) const
{
  // One place that the boundary spoils does not set the goal for the rest.
  constexpr double OfUndeformed = 0.2;
  const MovableQuality::Bounds bounds = quality.bounds(points);
  const bool spoilt = !(bounds.fixed > OfUndeformed * this->options_.minimumAtRest);
  return spoilt ? bounds.movable : std::min(bounds.fixed, bounds.movable);
}

bool MeshImprovement::minimizeEnergy(const MovableQuality& quality, double goal, double best,
  const Aim& aim, Points& points, Outcome& outcome, Monitor& monitor) const
{
  MeshEnergy energy(this->mesh_, this->partition_.free, this->communicator_);
  FoldoverContinuation stages(energy, this->options_.minimizer, this->options_.preconditioner);
  const bool isTangled = best <= 0;
  monitor.check();
  ProgressRange untangle(monitor, 0.1, 0.7);
  const Untangling::Result untangling =
    Untangling(this->mesh_, this->orientation_, this->partition_, this->boundary_, this->geometry_,
      this->communicator_)
      .run(
        [&] { return this->targets(aim, isTangled, monitor); }, energy, stages, points, untangle);
  outcome.onFolds = untangling.onFolds;
  if (untangling.valid)
  {
    monitor.progress(0.7);
    for (int refresh = 0; refresh < this->options_.refreshes &&
                          this->options_.target == TargetConstruction::Stretched;
         ++refresh)
    {
      energy.setTargets(this->targets({ points, aim.target }, isTangled, monitor));
      stages.improve(points, RefreshSteps, monitor);
    }
    monitor.progress(0.8);
    if (this->raisesMinimum() && quality.measure(points, monitor).minimum >= WorthRaising * best)
    {
      ProgressRange raise(monitor, 0.8, 0.95);
      raiseMinimumQuality(quality, goal, points, raise);
    }
    monitor.progress(0.95);
  }
  stages.include(outcome.effort);
  outcome.effort = stages.effort();
  return untangling.valid;
}

void MeshImprovement::raiseNear(
  const std::vector<Index>& repaired, double goal, Points& points, Monitor& monitor) const
{
  const KRing ring = kRingOfCells(this->mesh_, nodeToCells(this->mesh_), this->partition_.free,
    repaired, RaisedRings, this->communicator_);
  const SubMesh part(this->mesh_, ring.cells);
  const std::unique_ptr<Communicator> processes = this->communicator_.part(part.nodes);
  const std::vector<Index> free = part.numbersOf(ring.nodes);
  std::vector<std::int8_t> signs;
  for (const Index c : part.cells)
  {
    signs.push_back(this->orientation_[c]);
  }
  Points local = points(part.nodes, allColumns);
  raiseMinimumQuality(MovableQuality(part.mesh, signs, free, *processes), goal, local, monitor);
  points(part.nodes, allColumns) = local;
}

MeshImprovement::Outcome MeshImprovement::run(
  Points& points, const Aim& aim, const Points& alternative, double enough, Monitor& monitor) const
{
  monitor.check();
  const MovableQuality quality = this->quality();
  const double goal = this->goal(quality, points);
  Points bestPoints = alternative;
  MovableQuality::Result best = quality.measure(alternative, monitor);
  Outcome outcome;
  const std::vector<Index> inverted = notPositive(best.scaledJacobian);
  const bool anyInverted = !this->communicator_.all(inverted.empty());
  const bool isRepair = enough == 0;
  const bool raisesFirst =
    this->raisesMinimum() && this->options_.target == TargetConstruction::Stretched;
  if (raisesFirst && anyInverted && this->options_.validAtRest)
  {
    ProgressRange near(monitor, 0.1, 0.3);
    Points untangled = alternative;
    if (untangleNear(this->mesh_, this->orientation_, this->partition_.free, inverted,
          isRepair ? 2 : 5, aim, this->options_.minimizer, untangled, outcome.effort, near,
          this->communicator_))
    {
      best = quality.measure(untangled, monitor);
      bestPoints = std::move(untangled);
    }
  }
  const bool isValid = best.inverted == 0;
  outcome.untangled = isValid;
  if (isRepair && isValid && raisesFirst && anyInverted)
  {
    ProgressRange raise(monitor, 0.3, 0.95);
    this->raiseNear(inverted, goal, bestPoints, raise);
    points = std::move(bestPoints);
    return outcome;
  }
  if (this->options_.nearOnly)
  {
    points = alternative;
    return outcome;
  }
  // Raising the minimum of a valid mesh costs far less than minimising the energy.
  if (isValid && raisesFirst)
  {
    ProgressRange raise(monitor, 0.3, 0.7);
    const AscentEffort raised = raiseMinimumQuality(quality, goal, bestPoints, raise);
    if (raised.rounds > 0)
    {
      best = quality.measure(bestPoints, monitor);
    }
    // Tetrahedra aim for their undeformed shape, which costs much and rarely raises the minimum.
    const bool isAtGoal = hasReached(best.minimum, goal);
    if (isAtGoal || best.minimum >= enough * this->options_.minimumAtRest ||
        mostlyTetrahedra(this->mesh_, this->communicator_))
    {
      if (isAtGoal && best.minimum < enough * this->options_.minimumAtRest)
      {
        ProgressRange next(monitor, 0.7, 0.95);
        raiseNextWorst(quality, raised, bestPoints, next);
      }
      points = std::move(bestPoints);
      return outcome;
    }
    if (this->options_.startsFromBest)
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
  outcome.kept = outcome.effort.steps > 0 &&
                 this->communicator_.all((points.array() == alternative.array()).all());
  if (outcome.kept && this->options_.target == TargetConstruction::IdealSkew &&
      this->raisesMinimum())
  {
    outcome.kept = raiseMinimumQuality(quality, goal, points, monitor).rounds == 0;
  }
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
}
