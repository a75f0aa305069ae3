// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"

#include "LinearMethods/FemWarpSystem.h"
#include "LinearMethods/StiffnessFactors.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <string>
#include <utility>

namespace morph
{
namespace
{
constexpr int MaxIterations = 3000;

[[noreturn]] void throwSingular(const std::vector<Index>& nodes)
{
  throw Error(Error::Kind::Singular,
    "Every cell around node ids " + listIds(nodes) +
      " has zero volume, so nothing says where they go. Prescribe them or repair the cells.");
}
}

void FemWarp::setTolerance(double tolerance)
{
  requireTolerance(tolerance);
  this->tolerance_ = tolerance;
}

void FemWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const ConnectedComponents parts = connectedComponents(rest, monitor);
  requirePrescribedBodies(rest, parts, partition);
  const std::vector<double> factors =
    stiffnessFactors(rest, partition.prescribed, this->stiffness(), monitor);
  this->isUniform_ = factors.empty();
  Adjacency around = nodeToCells(rest, monitor);
  // Where the stiffness varies, the fit that is taken off would have to be taken off centers, too.
  this->stars_ = this->isUniform_ ? CenterStars(rest, partition.free, this->firstCenter(), around)
                                  : CenterStars();
  if (this->stars_.size() == static_cast<Index>(partition.free.size()))
  {
    this->stars_ = CenterStars(); // a matrix without rows is none
  }
  this->rows_ = unknownOrdering(rest, this->stars_.others(partition.free));
  if (this->rows_ == partition.free)
  {
    this->rows_ = {};
  }
  FemWarpSystem system = femWarpSystem(
    rest, std::move(around), this->rows(), partition.prescribed, factors, this->stars_, monitor);
  this->stars_.assembled(rest.numberOfNodes(), partition);
  if (system.hasBadCells)
  {
    const std::string warning =
      describe(badCells(rest, cellSigns(rest, parts, monitor), system.cellSign, monitor));
    if (!warning.empty())
    {
      monitor.warn(warning);
    }
  }
  if (!system.singularCenters.empty())
  {
    throwSingular(system.singularCenters);
  }
  monitor.check();
  monitor.progress(0.6);

  LinearEquations equations;
  equations.matrix.swap(system.interior);
  equations.coordinates = rest.points(this->rows(), allColumns);
  this->coupling_.swap(system.coupling);
  this->affineResidual_.reset();
  try
  {
    ProgressRange last(monitor, 0.6, 1);
    this->solver_.prepare(std::move(equations), last);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> nodes;
    for (Index row : error.rows())
    {
      nodes.push_back(this->rows()[row]);
    }
    throwSingular(nodes);
  }
  this->guess_ =
    AffineGuess(rest.points, partition, this->rows(), this->solver_.components(), this->coupling_);
}

EvaluateReport FemWarp::solve(const MultiVector& prescribed, MultiVector& x, Monitor& monitor) const
{
  SolveReport report;
  const NodePartition& partition = this->partition();
  const DirichletEquations equations = { this->restPoints(), partition, this->rows(),
    this->coupling_, this->guess_, this->isUniform_,
    [&]
    {
      return this->affineResidual_.of(this->restPoints(), this->rows(), partition.prescribed,
        this->solver_.matrix(), this->coupling_, monitor);
    } };
  equations.solve(prescribed, this->tolerance_, x, monitor,
    [&](const RightHandSide& rhs, MultiVector& solution)
    {
      report = this->solver_.solve(rhs, solution, this->tolerance_, MaxIterations, monitor);
      reportRounding(report, this->tolerance_, monitor);
    });
  return { report.iterations, report.relativeResidual, {} };
}

EvaluateReport FemWarp::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  MultiVector x;
  const EvaluateReport report = this->solve(toRows(prescribed, monitor), x, monitor);
  unpermute(x, this->rows(), this->partition(), free, monitor);
  this->stars_.recover(prescribed, free, monitor);
  return report;
}

EvaluateReport FemWarp::displaceFields(
  const FourFields& prescribed, FourFields& free, Monitor& monitor) const
{
  MultiVector x;
  const EvaluateReport report = this->solve(toRows(prescribed), x, monitor);
  unpermute(x, this->rows(), this->partition(), free, monitor);
  this->stars_.recover(prescribed, free, monitor);
  return report;
}

EvaluateReport FemWarp::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // M = -A_I^-1 A_B and A_I is symmetric, so M^T g = -A_B^T A_I^-1 g.
  Points gradient = free;
  this->stars_.recoverTranspose(gradient, prescribed);
  const Points rhs = permute(gradient, this->rows(), this->partition());
  Points solution = Points::Zero(rhs.rows(), 3);
  const SolveReport report =
    this->solver_.solve(rhs, solution, this->tolerance_, MaxIterations, monitor);
  reportRounding(report, this->tolerance_, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  if (!this->isUniform_)
  {
    this->guess_.addTranspose(this->restPoints(), this->partition(), this->rows(), this->coupling_,
      rhs, solution, prescribed);
  }
  return { report.iterations, report.relativeResidual, {} };
}
}
