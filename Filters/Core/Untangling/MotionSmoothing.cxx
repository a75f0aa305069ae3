// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/MotionSmoothing.h"

#include "Energies/MeshEnergy.h"
#include "Energies/SmoothingTargets.h"
#include "LinearMethods/BodyMotion.h"
#include "Mesh/Extent.h"
#include "Quality/BoundaryDetermined.h"
#include "Support/Error.h"
#include "Untangling/KeepMinimum.h"

#include <limits>

namespace morph
{
namespace
{
constexpr double Affine = 1e-9; // of the mesh's size: rounding of an affine motion
}

MotionSmoothing::MotionSmoothing(const Mesh& rest, const ConnectedComponents& bodies,
  const std::vector<std::int8_t>& orientation, const NodePartition& partition,
  const SharedHigherOrderNodes& followers, const SmoothingOptions& options,
  const Membrane* membrane, const Communicator& communicator)
  : rest_(rest)
  , bodies_(bodies)
  , orientation_(orientation)
  , partition_(partition)
  , followers_(followers)
  , options_(options)
  , membrane_(membrane)
  , communicator_(communicator)
{
}

bool MotionSmoothing::isIdentity(const Points& prescribed, Monitor& monitor) const
{
  if (this->options_.target != SmoothingTarget::Initial ||
      !this->communicator_.all((prescribed.array() == 0).all()))
  {
    return false;
  }
  MeshEnergy energy(this->rest_, this->partition_.free, this->communicator_);
  energy.setTargets(smoothingTargets(
    this->rest_, this->orientation_, this->options_.target, monitor, this->communicator_));
  return energy.evaluate(this->rest_.points, monitor).minimumDeterminant > 0;
}

Quality MotionSmoothing::measure(Points& points, Monitor& monitor) const
{
  if (!this->followers_.empty())
  {
    Points displacement = points - this->rest_.points;
    this->followers_.apply(displacement);
    for (Index node : this->partition_.higherOrderNodes)
    {
      points.row(node) = this->rest_.points.row(node) + displacement.row(node);
    }
  }
  Quality quality = measureQuality(this->rest_, points, this->orientation_, {}, monitor);
  quality.inverted = this->communicator_.sum(quality.inverted);
  quality.degenerate = this->communicator_.sum(quality.degenerate);
  quality.minimum = this->communicator_.minimum(
    quality.measured > 0 ? quality.minimum : std::numeric_limits<double>::infinity());
  return quality;
}

bool MotionSmoothing::start(const Points& prescribed, Points& points, Monitor& monitor) const
{
  if (this->membrane_)
  {
    this->membrane_->warp.evaluate(
      Points(points(this->partition_.prescribed, allColumns)), points, monitor);
    Points left = prescribed;
    this->membrane_->fits.takeOff(left);
    return left.cwiseAbs().maxCoeff() <= Affine * meshSize(this->rest_);
  }
  Points followed = points;
  const bool isAffine = followAffinely(
    this->rest_, this->bodies_, this->partition_, prescribed, followed, this->communicator_);
  const auto bad = [](const Quality& quality) { return quality.inverted + quality.degenerate; };
  const Index inverted = bad(this->measure(followed, monitor));
  if (inverted == 0 || inverted <= bad(this->measure(points, monitor)))
  {
    points.swap(followed);
    return isAffine;
  }
  return false;
}

MotionSmoothing::Outcome MotionSmoothing::run(
  const Points& prescribed, Points& points, Monitor& monitor) const
{
  Outcome outcome;
  points = this->rest_.points;
  if (this->isIdentity(prescribed, monitor))
  {
    outcome.smoothing.isValid = true;
    return outcome;
  }
  for (Index i = 0; i < prescribed.rows(); ++i)
  {
    points.row(this->partition_.prescribed[i]) += prescribed.row(i);
  }
  outcome.determined = inversionsByBoundaryMotion(
    this->rest_, this->partition_, this->orientation_, this->rest_.points, points, monitor);
  const bool isAffine = this->start(prescribed, points, monitor);
  const Points start = points;
  outcome.smoothing = smoothMesh(this->rest_, this->orientation_, this->partition_, this->options_,
    points, monitor, this->communicator_);
  if (isAffine)
  {
    outcome.takenBack = keepMinimum(
      this->rest_, this->partition_.free, start, points,
      [&](Points& measured) { return this->measure(measured, monitor); }, this->communicator_);
  }
  return outcome;
}

EvaluateReport reportSmoothing(
  const MotionSmoothing::Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor)
{
  if (!determined.empty())
  {
    monitor.warn(
      "The boundary itself inverts cells whose corners it prescribes: cell ids " +
      listIds(determined) +
      ". No method can repair them; move the boundary less, or leave some of their nodes free.");
  }
  const SmoothingReport& smoothing = outcome.smoothing;
  if (!smoothing.isValid)
  {
    monitor.warn("Smoothing could not untangle the mesh. Move the boundary in smaller steps, or "
                 "use a method that carries the motion inside.");
  }
  EvaluateReport report;
  report.iterations = static_cast<int>(smoothing.untangleSteps + smoothing.newtonSteps);
  report.statistics = { { "UntangleSteps", smoothing.untangleSteps },
    { "NewtonSteps", smoothing.newtonSteps }, { "LinearIterations", smoothing.linearIterations },
    { "EnergyEvaluations", smoothing.evaluations }, { "SmoothingPatches", smoothing.patches },
    { "NodesTakenBack", outcome.takenBack }, { "ConditionSteps", smoothing.conditionSteps },
    { "BoundaryDeterminedCells", static_cast<Index>(determined.size()) } };
  return report;
}
}
