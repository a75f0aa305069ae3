// SPDX-License-Identifier: BSD-3-Clause
#include "InversionFree.h"

#include "EnergyMinimizer.h"
#include "Error.h"
#include "ScaledJacobian.h"

#include <algorithm>
#include <cmath>

namespace morph
{
void InversionFree::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Bodies parts = bodies(rest);
  this->mesh_ = rest;
  this->orientation_ = orientation(rest, parts);
  this->femWarp_.prepare(rest, this->partition(), monitor);
  this->energy_ = std::make_unique<MeshEnergy>(this->mesh_, this->partition().free);
  FoldoverDensity density;
  const TargetShapes own = targetShapes(this->mesh_, this->orientation_, rest.points, Target::Initial, monitor);
  this->validAtRest_ =
    this->energy_->evaluate(rest.points, own, density, monitor).leastDeterminant > 0;
}

EvaluateReport InversionFree::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const NodePartition& partition = this->partition();
  free.setZero();
  EvaluateReport report;
  report.counts = { { "NewtonSteps", 0 }, { "LinearIterations", 0 }, { "EnergyEvaluations", 0 },
    { "InfeasibleCells", 0 }, { "KeptFEMWARP", 0 } };
  if (this->validAtRest_ && (prescribed.array() == 0).all())
  {
    return report;
  }

  Points boundary(prescribed.rows(), 3);
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    boundary.row(i) = this->restPoints().row(partition.prescribed[i]) + prescribed.row(i);
  }
  Points warped;
  report.iterations = this->femWarp_.evaluate(boundary, warped, monitor).iterations;
  monitor.progress(0.1);

  const bool fromRest = this->start_ == Start::Rest || !this->validAtRest_;
  Points points = fromRest ? this->restPoints() : warped;
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    points.row(partition.prescribed[i]) = boundary.row(i);
  }
  TargetShapes targets = targetShapes(this->mesh_, this->orientation_, warped, this->target_, monitor);
  const std::vector<Index> infeasible = this->energy_->infeasibleCells(targets, points);
  if (!infeasible.empty())
  {
    monitor.warn("The boundary itself inverts cells whose corners it prescribes: cell ids " + listIds(infeasible) +
      ". No method can repair them; move the boundary less, or leave some of their nodes free.");
  }

  EnergyMinimizer minimizer(*this->energy_, partition.free);
  const bool valid = minimizer.untangle(points, targets, monitor);
  if (valid)
  {
    for (int refresh = 0; refresh < this->refreshes_ && this->target_ == Target::Stretched; ++refresh)
    {
      const Points guide = points;
      targets = targetShapes(this->mesh_, this->orientation_, guide, this->target_, monitor);
      minimizer.improve(points, targets, 3, monitor);
    }
    if (this->stiffening_ && this->target_ != Target::Initial)
    {
      minimizer.stiffen(points, targets, monitor);
    }
  }

  const auto least = [&](const Points& at) {
    return measureQuality(this->mesh_, at, this->orientation_, {}, monitor).minimum;
  };
  const double ofWarped = least(warped);
  const bool keep = ofWarped > 0 && !(least(points) >= ofWarped);
  const Points& result = keep ? warped : points;
  for (Index i = 0; i < free.rows(); ++i)
  {
    free.row(i) = result.row(partition.free[i]) - this->restPoints().row(partition.free[i]);
  }
  const EnergyMinimizer::Effort& effort = minimizer.effort();
  report.iterations += static_cast<int>(effort.newtonSteps);
  report.counts = { { "NewtonSteps", effort.newtonSteps }, { "LinearIterations", effort.linearIterations },
    { "EnergyEvaluations", effort.evaluations }, { "InfeasibleCells", static_cast<Index>(infeasible.size()) },
    { "KeptFEMWARP", keep ? 1 : 0 } };
  return report;
}
}
