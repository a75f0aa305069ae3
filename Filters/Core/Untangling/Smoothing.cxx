// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Smoothing.h"

#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "LinearMethods/BodyMotion.h"
#include "Mesh/Mesh.h"
#include "Quality/BoundaryDetermined.h"
#include "Untangling/SmoothMesh.h"

#include <string>

namespace morph
{
namespace
{
constexpr double Affine = 1e-9; // of the mesh's size: rounding of an affine motion

/// Warns of what stays inverted, and returns the counts. `determined`: cells that the boundary
/// itself inverts, ascending, by their ids in the whole mesh.
EvaluateReport reportSmoothing(const SmoothingReport& smoothing, Index takenBack,
  const std::vector<Index>& determined, bool isShell, Monitor& monitor)
{
  warnOfDetermined(determined, monitor);
  if (!smoothing.isValid)
  {
    monitor.warn("Smoothing could not untangle the " +
                 std::string(isShell ? "layer of a shell that is bent so sharply" : "mesh") +
                 ". Move the boundary in smaller steps, or use a method that carries the motion "
                 "inside.");
  }
  EvaluateReport report;
  report.iterations = static_cast<int>(smoothing.untangleSteps + smoothing.newtonSteps);
  report.statistics = { { "UntangleSteps", smoothing.untangleSteps },
    { "NewtonSteps", smoothing.newtonSteps }, { "LinearIterations", smoothing.linearIterations },
    { "EnergyEvaluations", smoothing.evaluations }, { "SmoothingPatches", smoothing.patches },
    { "NodesTakenBack", takenBack }, { "ConditionSteps", smoothing.conditionSteps },
    { "BoundaryDeterminedCells", static_cast<Index>(determined.size()) } };
  return report;
}
}

void Smoothing::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Communicator& processes = this->processes();
  const ConnectedComponents bodies = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(bodies, this->partition(), processes);
  this->own_ = std::make_unique<OwnCells>(
    rest, this->partition(), cellSigns(rest, bodies, monitor, processes), processes);
  const OwnCells& own = *this->own_;
  this->bodies_ = own.bodies(bodies);
  this->followers_.prepare(own.mesh(), own.partition(), own.communicator());
  this->membrane_.reset();
  if (rest.layer.isCurved())
  {
    this->membrane_ = std::make_unique<FemWarp>();
    this->prepareAlike(*this->membrane_, rest, monitor);
    this->membraneFits_ = ShellFits(rest, this->partition(), processes);
  }
}

bool Smoothing::isIdentity(const Points& prescribed, Monitor& monitor) const
{
  if (this->options_.target != SmoothingTarget::Initial ||
      !this->own_->communicator().all((prescribed.array() == 0).all()))
  {
    return false;
  }
  MeshEnergy energy(this->own_->mesh(), this->own_->partition().free, this->own_->communicator());
  energy.setTargets(smoothingTargets(this->own_->mesh(), this->own_->orientation(),
    this->options_.target, monitor, this->own_->communicator()));
  return energy.evaluate(this->own_->mesh().points, monitor).minimumDeterminant > 0;
}

Quality Smoothing::measure(Points& points, Monitor& monitor) const
{
  this->followers_.carry(this->own_->mesh().points, points);
  Quality quality =
    measureQuality(this->own_->mesh(), points, this->own_->orientation(), {}, monitor);
  quality.inverted = this->own_->communicator().sum(quality.inverted);
  quality.degenerate = this->own_->communicator().sum(quality.degenerate);
  quality.minimum = minimumOfAll(quality, this->own_->communicator());
  return quality;
}

bool Smoothing::startOfShell(const Points& prescribed, Points& points, Monitor& monitor) const
{
  const OwnCells& own = *this->own_;
  const Communicator& processes = own.communicator();
  Points moved, left = prescribed;
  this->membrane_->evaluate(
    Points(this->restPoints()(this->partition().prescribed, allColumns) + prescribed), moved,
    monitor);
  points = own.take(moved);
  this->membraneFits_.takeOff(left);
  const double tolerance = Affine * processes.maximum(meshSize(own.mesh())); // or a part of it
  return processes.all((left.array().abs() <= tolerance).all());
}

bool Smoothing::start(const Points& prescribed, Points& points, Monitor& monitor) const
{
  Points followed = points;
  const bool isAffine = followAffinely(this->own_->mesh(), this->bodies_, this->own_->partition(),
    prescribed, followed, this->own_->communicator());
  const auto bad = [](const Quality& quality) { return quality.inverted + quality.degenerate; };
  const Index inverted = bad(this->measure(followed, monitor));
  if (inverted == 0 || inverted <= bad(this->measure(points, monitor)))
  {
    points.swap(followed);
    return isAffine;
  }
  return false;
}

EvaluateReport Smoothing::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const OwnCells& own = *this->own_;
  const Mesh& rest = own.mesh();
  Points displacement = Points::Zero(this->restPoints().rows(), 3), points = rest.points;
  displacement(this->partition().prescribed, allColumns) = prescribed;
  const Points ofOwn = own.take(displacement)(own.partition().prescribed, allColumns);
  SmoothingReport smoothing;
  std::vector<Index> determined;
  Index takenBack = 0; // nodes of the whole mesh; see SmoothMesh.h
  if (this->isIdentity(ofOwn, monitor))
  {
    smoothing.isValid = true;
  }
  else
  {
    for (Index i = 0; i < ofOwn.rows(); ++i)
    {
      points.row(own.partition().prescribed[i]) += ofOwn.row(i);
    }
    determined = inversionsByBoundaryMotion(
      rest, own.partition(), own.orientation(), rest.points, points, monitor);
    const bool isAffine = this->membrane_ ? this->startOfShell(prescribed, points, monitor)
                                          : this->start(ofOwn, points, monitor);
    const Points start = points;
    smoothing = smoothMesh(rest, own.orientation(), own.partition(), this->options_, points,
      monitor, own.communicator());
    if (isAffine)
    {
      takenBack = keepMinimum(
        rest, own.partition().free, start, points,
        [&](Points& measured) { return this->measure(measured, monitor); }, own.communicator());
    }
  }
  displacement(own.nodes(), allColumns) = points - rest.points;
  free = displacement(this->partition().free, allColumns);
  return reportSmoothing(
    smoothing, takenBack, own.gatherIds(determined), rest.layer.isCurved(), monitor);
}
}
