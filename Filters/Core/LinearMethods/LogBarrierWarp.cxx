// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierWarp.h"

#include "LinearMethods/LogBarrierSystem.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <sstream>
#include <utility>

namespace morph
{
namespace
{
constexpr int MaxIterations = 3000;

void requireWeights(const LogBarrierSystem& system, bool relax)
{
  if (system.empty.empty())
  {
    return;
  }
  if (relax)
  {
    throw Error(Error::Kind::Singular,
      "Every cell around node ids " + listIds(system.empty) +
        " has zero volume, so nothing says where they go. Prescribe them or repair the cells.");
  }
  std::ostringstream text;
  text
    << system.empty.size() << (system.empty.size() == 1 ? " free node does" : " free nodes do")
    << " not lie inside the hull of the neighbors, at inverted or strongly concave cells, and so "
    << "cannot be a convex combination of them: node ids " << listIds(system.empty)
    << ". Repair the undeformed mesh, prescribe those nodes, or set `OutsideHull` to Relax.";
  throw Error(text.str());
}
}

void LogBarrierWarp::setTolerance(double tolerance)
{
  requireTolerance(tolerance);
  this->tolerance_ = tolerance;
}

void LogBarrierWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  requirePrescribedBodies(rest, connectedComponents(rest, monitor), partition);
  this->rows_ = unknownOrdering(rest, partition.free);
  if (this->rows_ == partition.free)
  {
    this->rows_ = {};
  }
  const bool relax = this->outsideHull_ == OutsideHull::Relax;
  LogBarrierSystem system =
    logBarrierSystem(rest, this->rows(), partition.prescribed, relax, monitor);
  requireWeights(system, relax);
  this->meanWeightIterations_ = system.meanIterations;
  this->mostWeightIterations_ = system.mostIterations;
  this->outsideCounts_ = { { "OutsideHullNodes", static_cast<Index>(system.outside.size()) },
    { "TwoRingNodes", system.twoRing }, { "AffineNodes", system.affine },
    { "StiffnessNodes", system.stiffness } };
  if (!system.outside.empty())
  {
    monitor.warn("Free nodes outside the hull of their neighbors: node ids " +
                 listIds(system.outside) + ". " + std::to_string(system.twoRing) +
                 " took weights among a second ring of neighbors, " +
                 std::to_string(system.affine) + " affine weights, " +
                 std::to_string(system.stiffness) + " FEMWARP's row.");
  }
  monitor.check();
  monitor.progress(0.6);

  LinearEquations equations;
  equations.matrix.swap(system.interior);
  equations.coordinates = rest.points(this->rows(), allColumns);
  this->coupling_.swap(system.coupling);
  this->affineResidual_.reset();
  ProgressRange last(monitor, 0.6, 1);
  this->solver_.prepare(std::move(equations), last);
  this->guess_ =
    AffineGuess(rest.points, partition, this->rows(), this->solver_.components(), this->coupling_);
}

EvaluateReport LogBarrierWarp::report(const SolveReport& solved, Monitor& monitor) const
{
  reportRounding(solved, this->tolerance_, monitor);
  EvaluateReport result;
  result.iterations = solved.iterations;
  result.relativeResidual = solved.relativeResidual;
  result.statistics = this->outsideCounts_;
  return result;
}

EvaluateReport LogBarrierWarp::solve(
  const MultiVector& prescribed, MultiVector& x, Monitor& monitor) const
{
  SolveReport solved;
  const NodePartition& partition = this->partition();
  const DirichletEquations equations = { this->restPoints(), partition, this->rows(),
    this->coupling_, this->guess_, true,
    [&]
    {
      return this->affineResidual_.of(this->restPoints(), this->rows(), partition.prescribed,
        this->solver_.matrix(), this->coupling_, monitor);
    } };
  equations.solve(prescribed, this->tolerance_, x, monitor,
    [&](const RightHandSide& rhs, MultiVector& solution)
    { solved = this->solver_.solve(rhs, solution, this->tolerance_, MaxIterations, monitor); });
  return this->report(solved, monitor);
}

EvaluateReport LogBarrierWarp::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  MultiVector x;
  const EvaluateReport report = this->solve(toRows(prescribed, monitor), x, monitor);
  unpermute(x, this->rows(), this->partition(), free, monitor);
  return report;
}

EvaluateReport LogBarrierWarp::displaceFields(
  const FourFields& prescribed, FourFields& free, Monitor& monitor) const
{
  MultiVector x;
  const EvaluateReport report = this->solve(toRows(prescribed), x, monitor);
  unpermute(x, this->rows(), this->partition(), free, monitor);
  return report;
}

EvaluateReport LogBarrierWarp::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // M = (I - W_I)^-1 W_B, so M^T g = W_B^T (I - W_I)^-T g.
  const Points rhs = permute(free, this->rows(), this->partition());
  Points solution = Points::Zero(free.rows(), 3);
  const SolveReport solved =
    this->solver_.solveTransposed(rhs, solution, this->tolerance_, MaxIterations, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  return this->report(solved, monitor);
}
}
