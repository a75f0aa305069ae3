// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/InversionFree.h"

#include "LinearMethods/SimplexLinear.h"
#include "Quality/MovableQuality.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"
#include "Untangling/MinQualityAscent.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace morph::distributed
{
namespace
{
constexpr int RaisingRounds = 8;
constexpr double NoMinimum = std::numeric_limits<double>::infinity();
}

InversionFree::InversionFree(const morph::InversionFree& serial)
  : raising_(serial.raises())
{
  if (serial.start() != morph::InversionFree::Start::FemWarp ||
      serial.target() != TargetConstruction::Stretched)
  {
    throw Error("On several MPI ranks the inversion-free method starts from FEMWARP and aims for "
                "stretched cells. Set InitialGuess to FEMWARP and TargetShape to Stretched, or run "
                "on one rank.");
  }
}

void InversionFree::takeEvaluateOptions(const Morpher& serial)
{
  this->femWarp_.setTolerance(static_cast<const morph::InversionFree&>(serial).tolerance());
}

void InversionFree::doPrepare(Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Points& reference = this->reference_.rows() > 0 ? this->reference_ : mesh.mesh().points;
  if (this->measure(reference, monitor).inverted > 0)
  {
    throw Error("The undeformed mesh has inverted or degenerate cells. On several MPI ranks the "
                "inversion-free method needs a valid one: repair it on one rank first.");
  }
  ProgressRange first(monitor, 0, 0.6), second(monitor, 0.6, 1);
  this->femWarp_.prepare(mesh, this->partition(), first);
  this->simplexLinear_ = std::make_unique<SiteMethod>(std::make_unique<SimplexLinear>());
  try
  {
    this->simplexLinear_->prepare(mesh, this->partition(), second);
  }
  catch (const Error& error)
  {
    // A flat boundary has no tessellation, for instance.
    if (error.kind() == Error::Kind::Cancelled)
    {
      throw;
    }
    this->simplexLinear_.reset();
  }
}

InversionFree::Quality InversionFree::measure(const Points& points, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  MovableQuality::Result found;
  ranks.together(
    [&]
    {
      found = MovableQuality(mesh.mesh(), mesh.orientation(), this->partition().free)
                .measure(points, monitor);
    });
  Quality quality;
  quality.minimum = NoMinimum;
  const auto forOwn = [&](const auto& visit)
  {
    for (std::size_t c = 0; c < found.scaledJacobian.size(); ++c)
    {
      if (mesh.isGhost()[c] == 0 && found.scaledJacobian[c] == found.scaledJacobian[c]) // no NaN
      {
        visit(static_cast<Index>(c), found.scaledJacobian[c]);
      }
    }
  };
  forOwn(
    [&](Index, double value)
    {
      quality.minimum = std::min(quality.minimum, value);
      quality.inverted += !(value > 0);
    });
  quality.minimum = ranks.minimum(quality.minimum);
  quality.inverted = ranks.sum(quality.inverted);
  // As MinQualityAscent.h: above the minimum m by at most these shares of m and of 1 - m.
  const double least = quality.minimum;
  const double limit = least + std::min(0.5 * least, 0.1 * (1 - least));
  forOwn(
    [&](Index cell, double value)
    {
      if (value <= limit)
      {
        quality.worst.push_back(cell);
      }
    });
  return quality;
}

void InversionFree::raise(const Points& reference, Points& points, Monitor& monitor) const
{
  Quality best = this->measure(points, monitor);
  for (int round = 0; round < RaisingRounds; ++round)
  {
    Points trial = points;
    const PatchReport report =
      repairPatches(this->mesh(), reference, this->partition(), best.worst, {}, trial, monitor);
    if (report.isTooLarge || report.patches == 0)
    {
      return;
    }
    Quality next = this->measure(trial, monitor);
    if (next.inverted > 0 || !(next.minimum > best.minimum + significantGain(best.minimum)))
    {
      return;
    }
    points.swap(trial);
    best = std::move(next);
  }
}

EvaluateReport InversionFree::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  const Points& rest = mesh.mesh().points;
  EvaluateReport report;
  report.statistics = { { "Untangled", 1 } };
  if (ranks.sum(Index((prescribed.array() != 0).any())) == 0)
  {
    free.setZero();
    return report;
  }
  const Points target = rest(this->partition().prescribed, allColumns) + prescribed;
  Points points;
  ProgressRange first(monitor, 0, 0.3), second(monitor, 0.3, 0.7), third(monitor, 0.7, 1);
  report.iterations = this->femWarp_.evaluate(target, points, first).iterations;
  if (this->simplexLinear_)
  {
    Points simplex;
    this->simplexLinear_->evaluate(target, simplex, first);
    if (this->measure(points, first) < this->measure(simplex, first))
    {
      points.swap(simplex);
    }
  }
  const Points& reference = this->reference_.rows() > 0 ? this->reference_ : rest;
  const RepairReport repaired = repairInverted(mesh, reference, this->partition(), points, second);
  if (repaired.tooLarge > 0 && ranks.rank() == 0)
  {
    monitor.warn("On MPI ranks bad cells are repaired in patches, each on one rank. The patches "
                 "would have " +
                 std::to_string(repaired.tooLarge) + " cells of " +
                 std::to_string(mesh.volumeCells()) +
                 "; at most a quarter may be gathered. Run on one rank, or move the boundary in "
                 "steps.");
  }
  report.statistics[0].value = this->measure(points, second).inverted == 0;
  if (report.statistics[0].value == 1 && this->raising_)
  {
    this->raise(reference, points, third);
  }
  free = points(this->ownFree(), allColumns) - rest(this->ownFree(), allColumns);
  return report;
}

EvaluateReport InversionFree::displaceTranspose(const Points&, Points&, Monitor&) const
{
  throw Error("The inversion-free method is not linear, so it has no adjoint that is the same for "
              "all motions. Use one that is, FEMWARP for instance.");
}
}
