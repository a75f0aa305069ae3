// SPDX-License-Identifier: BSD-3-Clause
#include "InversionFree.h"

#include "Error.h"
#include "ScaledJacobian.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
/// Of the volume cells, from node to node around them; 1 where there is none.
double meanEdge(const Mesh& mesh)
{
  double sum = 0;
  Index count = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    for (int f = 0; f < shape.numberOfFaces; ++f)
    {
      const FaceShape& face = shape.faces[f];
      for (int k = 0; k < face.size; ++k)
      {
        const Index a = mesh.cell(c)[shape.cornerNode[face.corner[k]]];
        const Index b = mesh.cell(c)[shape.cornerNode[face.corner[(k + 1) % face.size]]];
        sum += (mesh.points.row(a) - mesh.points.row(b)).norm();
        ++count;
      }
    }
  }
  return sum > 0 ? sum / static_cast<double>(count) : 1;
}
}

void InversionFree::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const Bodies parts = bodies(rest);
  this->orientation_ = orientation(rest, parts);
  this->femWarp_.prepare(rest, this->partition(), monitor);
  this->mesh_ = rest;
  this->scale_ = std::exp2(-std::round(std::log2(meanEdge(rest))));
  this->mesh_.points *= this->scale_;
  MeshEnergy energy(this->mesh_, this->partition().free);
  energy.setTargets(
    targetShapes(this->mesh_, this->orientation_, this->mesh_.points, Target::Initial, monitor));
  this->validAtRest_ = energy.evaluate(this->mesh_.points, monitor).leastDeterminant > 0;
}

Points InversionFree::warped(
  const Points& prescribed, EvaluateReport& report, Monitor& monitor) const
{
  const std::vector<Index>& ids = this->partition().prescribed;
  Points boundary(prescribed.rows(), 3), result;
  for (Index i = 0; i < boundary.rows(); ++i)
  {
    boundary.row(i) = this->restPoints().row(ids[i]) + prescribed.row(i);
  }
  report.iterations += this->femWarp_.evaluate(boundary, result, monitor).iterations;
  result *= this->scale_;
  return result;
}

void InversionFree::minimize(
  MeshEnergy& energy, FoldoverStages& stages, Points& points, Monitor& monitor) const
{
  if (!stages.untangle(points, monitor))
  {
    return;
  }
  monitor.progress(0.6);
  for (int refresh = 0; refresh < this->refreshes_ && this->target_ == Target::Stretched; ++refresh)
  {
    const Points guide = points;
    energy.setTargets(targetShapes(this->mesh_, this->orientation_, guide, this->target_, monitor));
    stages.improve(points, 3, monitor);
  }
  monitor.progress(0.8);
  if (this->stiffening_ && this->target_ != Target::Initial)
  {
    stages.stiffen(points, monitor);
  }
}

double InversionFree::leastScaledJacobian(const Points& points, Monitor& monitor) const
{
  return measureQuality(this->mesh_, points, this->orientation_, {}, monitor).minimum;
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

  const Points warped = this->warped(prescribed, report, monitor);
  monitor.progress(0.1);
  Points points = this->mesh_.points;
  if (this->start_ == Start::FemWarp && this->validAtRest_)
  {
    points = warped;
  }
  for (Index node : partition.prescribed)
  {
    points.row(node) = warped.row(node);
  }

  MeshEnergy energy(this->mesh_, partition.free);
  const TargetShapes targets =
    targetShapes(this->mesh_, this->orientation_, warped, this->target_, monitor);
  energy.setTargets(targets);
  const std::vector<Index> infeasible = energy.infeasibleCells(targets, points);
  if (!infeasible.empty())
  {
    monitor.warn(
      "The boundary itself inverts cells whose corners it prescribes: cell ids " +
      listIds(infeasible) +
      ". No method can repair them; move the boundary less, or leave some of their nodes free.");
  }
  FoldoverStages stages(energy, this->minimizer_);
  this->minimize(energy, stages, points, monitor);

  const double ofWarped = this->leastScaledJacobian(warped, monitor);
  const bool keep = ofWarped > 0 && !(this->leastScaledJacobian(points, monitor) >= ofWarped);
  const Points& result = keep ? warped : points;
  for (Index i = 0; i < free.rows(); ++i)
  {
    const Index node = partition.free[i];
    free.row(i) = (result.row(node) - this->mesh_.points.row(node)) / this->scale_;
  }
  const MinimizerEffort& effort = stages.effort();
  report.iterations += static_cast<int>(effort.steps);
  report.counts = { { "NewtonSteps", effort.steps },
    { "LinearIterations", effort.linearIterations }, { "EnergyEvaluations", effort.evaluations },
    { "InfeasibleCells", static_cast<Index>(infeasible.size()) }, { "KeptFEMWARP", keep ? 1 : 0 } };
  return report;
}
}
