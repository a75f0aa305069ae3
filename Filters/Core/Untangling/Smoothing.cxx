// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/Smoothing.h"

#include "Energies/MeshEnergy.h"
#include "Energies/SmoothingTargets.h"
#include "LinearMethods/BodyMotion.h"
#include "Mesh/Topology.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Untangling/KeepMinimum.h"

namespace morph
{
void Smoothing::doPrepare(const Mesh& rest, Monitor&)
{
  const ConnectedComponents parts = connectedComponents(rest);
  requirePrescribedBodies(rest, parts, this->partition());
  this->orientation_ = cellSigns(rest, parts);
  this->mesh_ = rest;
}

bool Smoothing::isIdentity(const Points& prescribed, Monitor& monitor) const
{
  if (this->options_.target != SmoothingTarget::Initial || !(prescribed.array() == 0).all())
  {
    return false;
  }
  MeshEnergy energy(this->mesh_, this->partition().free);
  energy.setTargets(
    smoothingTargets(this->mesh_, this->orientation_, this->options_.target, monitor));
  return energy.evaluate(this->mesh_.points, monitor).minimumDeterminant > 0;
}

Quality Smoothing::measure(Points& points, Monitor& monitor) const
{
  if (!this->higherOrderNodes_.empty())
  {
    Points displacement = points - this->mesh_.points;
    this->higherOrderNodes_.apply(displacement);
    for (Index node : this->partition().higherOrderNodes)
    {
      points.row(node) = this->mesh_.points.row(node) + displacement.row(node);
    }
  }
  return measureQuality(this->mesh_, points, this->orientation_, {}, monitor);
}

bool Smoothing::start(const Points& prescribed, Points& points, Monitor& monitor) const
{
  Points followed = points;
  const bool isAffine = followAffinely(this->mesh_, this->partition(), prescribed, followed);
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
  const NodePartition& partition = this->partition();
  free.setZero();
  SmoothingReport smoothing;
  Index determined = 0, takenBack = 0;
  if (!this->isIdentity(prescribed, monitor))
  {
    Points points = this->mesh_.points;
    for (Index i = 0; i < prescribed.rows(); ++i)
    {
      points.row(partition.prescribed[i]) += prescribed.row(i);
    }
    const std::vector<Index> cells =
      boundaryDeterminedInversions(this->mesh_, partition, this->orientation_, points);
    determined = static_cast<Index>(cells.size());
    if (determined > 0)
    {
      monitor.warn("The boundary itself inverts cells whose corners it prescribes: cell ids " +
                   listIds(cells) +
                   ". No method can repair them; move the boundary less, or leave some of their "
                   "nodes free.");
    }
    const bool isAffine = this->start(prescribed, points, monitor);
    const Points start = points;
    smoothing =
      smoothMesh(this->mesh_, this->orientation_, partition, this->options_, points, monitor);
    if (!smoothing.isValid)
    {
      monitor.warn("Smoothing could not untangle the mesh. Move the boundary in smaller steps, or "
                   "use a method that carries the motion inside.");
    }
    if (isAffine)
    {
      takenBack = keepMinimum(this->mesh_, partition.free, start, points,
        [&](Points& measured) { return this->measure(measured, monitor); });
    }
    for (Index i = 0; i < free.rows(); ++i)
    {
      const Index node = partition.free[i];
      free.row(i) = points.row(node) - this->mesh_.points.row(node);
    }
  }
  EvaluateReport report;
  report.iterations = static_cast<int>(smoothing.untangleSteps + smoothing.newtonSteps);
  report.statistics = { { "UntangleSteps", smoothing.untangleSteps },
    { "NewtonSteps", smoothing.newtonSteps }, { "LinearIterations", smoothing.linearIterations },
    { "EnergyEvaluations", smoothing.evaluations }, { "SmoothingPatches", smoothing.patches },
    { "NodesTakenBack", takenBack }, { "ConditionSteps", smoothing.conditionSteps },
    { "BoundaryDeterminedCells", determined } };
  return report;
}
}
