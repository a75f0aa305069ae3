// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SystemMethod.h"

#include "Distributed/Stiffness.h"
#include "LinearMethods/DirichletSystem.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/FemWarpSystem.h"
#include "LinearMethods/LogBarrierSystem.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Support/Error.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace morph::distributed
{
namespace
{
constexpr int MaxIterations = 2000;

/// Gathers node or cell ids of all ranks, ascending, for a message.
std::vector<Index> gatherIds(const Ranks& ranks, const std::vector<Index>& mine)
{
  constexpr std::size_t Most = 100; // of a rank: a message names no more
  std::vector<Index> ids(mine.begin(), mine.begin() + std::min(Most, mine.size()));
  ids = ranks.gather(ids);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::string noVolume(const std::vector<Index>& ids)
{
  return "Every cell around node ids " + listIds(ids) +
         " has zero volume, so nothing says where they go. Prescribe them or repair the cells.";
}
}

void SystemMethod::setTolerance(double tolerance)
{
  requireTolerance(tolerance);
  this->tolerance_ = tolerance;
}

void SystemMethod::doPrepare(Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  requirePrescribedBodies(mesh, this->partition());
  const std::vector<Index>& prescribed = this->partition().prescribed;
  std::vector<Index> columns = prescribed, ghosts;
  for (Index node : this->partition().free)
  {
    if (!mesh.owns(node))
    {
      ghosts.push_back(node);
    }
  }
  columns.insert(columns.end(), ghosts.begin(), ghosts.end());
  this->transposed_.reset();
  const std::vector<double> factors = stiffnessFactors(mesh, prescribed, this->stiffness_, monitor);
  this->isUniform_ = ranks.sum(Index(!factors.empty())) == 0;
  Rows rows = this->assemble(columns, factors, monitor);

  const Index count = static_cast<Index>(this->ownFree().size());
  std::vector<Index> singular;
  for (Index i = 0; i < count; ++i)
  {
    if (!(rows.interior.coeff(i, i) > 0))
    {
      singular.push_back(mesh.nodeId(this->ownFree()[i]));
    }
  }
  singular = gatherIds(ranks, singular);
  if (!singular.empty())
  {
    throw Error(Error::Kind::Singular, noVolume(singular));
  }

  const std::int64_t first = ranks.sumBefore(count);
  std::vector<std::int64_t> number(mesh.mesh().numberOfNodes(), -1);
  for (Index i = 0; i < count; ++i)
  {
    number[this->ownFree()[i]] = first + i;
  }
  mesh.halo().update(ranks, number);
  std::vector<std::int64_t> ghostNumbers;
  for (Index node : ghosts)
  {
    ghostNumbers.push_back(number[node]);
  }
  const Index held = static_cast<Index>(prescribed.size());
  this->coupling_ = rows.coupling.middleCols(0, held);
  this->parts_ =
    AffineParts(mesh, this->ownFree(), rows.interior, rows.coupling, prescribed, ghosts);
  LinearEquations equations;
  equations.ghosts = rows.coupling.middleCols(held, static_cast<Index>(ghosts.size()));
  equations.matrix.swap(rows.interior);
  equations.ghostNumbers = std::move(ghostNumbers);
  monitor.progress(0.5);
  ranks.together([&] { monitor.check(); });
  this->solver_ = std::make_unique<HypreSolver>(ranks, this->kind_);
  this->solver_->prepare(std::move(equations), monitor);
}

SolveReport SystemMethod::solveEach(
  const HypreSolver& solver, Points rhs, Points& x, Monitor& monitor) const
{
  const Ranks& ranks = this->mesh().ranks();
  const std::vector<Index>& part = this->parts_.ofRow();
  std::vector<double> size(this->parts_.count(), 0);
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    size[part[i]] += rhs.row(i).squaredNorm();
  }
  ranks.sum(size.data(), size.size());
  for (double& value : size)
  {
    value = size.size() > 1 && value > 0 && std::isfinite(value) ? std::sqrt(value) : 1;
  }
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    rhs.row(i) /= size[part[i]];
    x.row(i) /= size[part[i]];
  }
  const double count = std::max(1., static_cast<double>(size.size()));
  const SolveReport solved =
    solver.solve(rhs, x, this->tolerance_ / std::sqrt(count), MaxIterations, monitor);
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    x.row(i) *= size[part[i]];
  }
  return solved;
}

EvaluateReport SystemMethod::report(const SolveReport& solved, Monitor& monitor) const
{
  EvaluateReport report;
  report.iterations = solved.iterations;
  report.relativeResidual = solved.relativeResidual;
  report.statistics = this->counts();
  if (this->mesh().ranks().rank() == 0)
  {
    reportRounding(solved, this->tolerance_, monitor);
  }
  return report;
}

EvaluateReport SystemMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  const Points& rest = mesh.mesh().points;
  // Affine motions solve the equations of a uniform stiffness, so the iteration finds only the
  // remainder. With another stiffness the solution is the fit plus the answer to the rest.
  const std::vector<AffineFit> fits = this->parts_.fits(mesh, prescribed);
  Points fitted(free.rows(), 3);
  for (Index i = 0; i < free.rows(); ++i)
  {
    fitted.row(i) = fits[this->parts_.ofRow()[i]].displacement(rest.row(this->ownFree()[i]));
  }
  Points rhs = Points::Zero(free.rows(), 3);
  const std::vector<Index>& held = this->partition().prescribed;
  for (Index i = 0; i < free.rows(); ++i)
  {
    const AffineFit& fit = fits[this->parts_.ofRow()[i]];
    for (CsrMatrix::InnerIterator entry(this->coupling_, static_cast<int>(i)); entry; ++entry)
    {
      Eigen::RowVector3d motion = prescribed.row(entry.col());
      if (!this->isUniform_)
      {
        motion -= fit.displacement(rest.row(held[entry.col()]));
      }
      rhs.row(i) -= entry.value() * motion;
    }
  }
  ranks.together([&] { monitor.check(); });
  if (this->isUniform_)
  {
    free = fitted;
  }
  else
  {
    free.setZero();
  }
  const SolveReport solved = this->solveEach(*this->solver_, std::move(rhs), free, monitor);
  if (!this->isUniform_)
  {
    free += fitted;
  }
  return this->report(solved, monitor);
}

EvaluateReport SystemMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // u_I = -A_I^-1 A_B u_B, so M^T g = -A_B^T y with A_I^T y = g.
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  if (this->kind_ == HypreSolver::Kind::General && !this->transposed_)
  {
    this->transposed_ = this->solver_->transposed(monitor);
  }
  const HypreSolver& solver = this->transposed_ ? *this->transposed_ : *this->solver_;
  ranks.together([&] { monitor.check(); });
  Points solution = Points::Zero(free.rows(), 3);
  const SolveReport solved = this->solveEach(solver, free, solution, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  if (!this->isUniform_)
  {
    // The fit F has F_I^T g + F_B^T A_B^T y.
    const Points& rest = mesh.mesh().points;
    std::vector<AffineParts::Load> loads(this->parts_.count());
    for (Index i = 0; i < free.rows(); ++i)
    {
      const Index part = this->parts_.ofRow()[i];
      this->parts_.add(loads[part], part, rest.row(this->ownFree()[i]), free.row(i));
      for (CsrMatrix::InnerIterator entry(this->coupling_, static_cast<int>(i)); entry; ++entry)
      {
        this->parts_.add(loads[part], part, rest.row(this->partition().prescribed[entry.col()]),
          entry.value() * solution.row(i));
      }
    }
    this->parts_.addTranspose(mesh, std::move(loads), prescribed);
  }
  return this->report(solved, monitor);
}

void FemWarp::takeEvaluateOptions(const Morpher& serial)
{
  this->setTolerance(static_cast<const morph::FemWarp&>(serial).tolerance());
}

SystemMethod::Rows FemWarp::assemble(
  const std::vector<Index>& columns, const std::vector<double>& factors, Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  FemWarpSystem system;
  Rows rows;
  BadCells bad;
  ranks.together(
    [&]
    {
      system = femWarpSystem(mesh.mesh(), this->ownFree(), columns, factors, monitor);
      rows.interior.swap(system.interior); // Eigen 3.4 would copy on a move
      rows.coupling.swap(system.coupling);
      if (system.hasBadCells)
      {
        bad = badCells(mesh.mesh(), mesh.orientation(), system.cellSign, monitor);
      }
    });
  for (std::vector<Index>* list : { &bad.inverted, &bad.flat, &bad.absolute })
  {
    std::vector<Index> ids;
    for (Index cell : *list)
    {
      if (mesh.isGhost()[cell] == 0)
      {
        ids.push_back(mesh.cellId(cell));
      }
    }
    ids = ranks.gather(ids);
    std::sort(ids.begin(), ids.end());
    *list = ids;
  }
  const std::string warning = describe(bad);
  if (!warning.empty() && ranks.rank() == 0)
  {
    monitor.warn(warning);
  }
  return rows;
}

void LogBarrierWarp::takeEvaluateOptions(const Morpher& serial)
{
  this->setTolerance(static_cast<const morph::LogBarrierWarp&>(serial).tolerance());
}

SystemMethod::Rows LogBarrierWarp::assemble(
  const std::vector<Index>& columns, const std::vector<double>& /*factors*/, Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  LogBarrierSystem system;
  Rows rows;
  ranks.together(
    [&]
    {
      system = logBarrierSystem(mesh.mesh(), this->ownFree(), columns, this->relax_, monitor);
      rows.interior.swap(system.interior); // Eigen 3.4 would copy on a move
      rows.coupling.swap(system.coupling);
    });
  const std::vector<Index> outside = gatherIds(ranks, mesh.idsOfNodes(system.outside));
  const std::vector<Index> empty = gatherIds(ranks, mesh.idsOfNodes(system.empty));
  if (!empty.empty())
  {
    std::ostringstream text;
    if (this->relax_)
    {
      text << noVolume(empty);
    }
    else
    {
      text << "Free nodes do not lie inside the hull of the neighbors, at inverted or strongly "
              "concave cells, and so cannot be a convex combination of them: node ids "
           << listIds(empty)
           << ". Repair the undeformed mesh, prescribe those nodes, or set `OutsideHull` to Relax.";
    }
    throw Error(this->relax_ ? Error::Kind::Singular : Error::Kind::InvalidInput, text.str());
  }
  Index counts[4] = { static_cast<Index>(system.outside.size()), system.twoRing, system.affine,
    system.stiffness };
  ranks.sum(counts, 4);
  this->counts_ = { { "OutsideHullNodes", counts[0] }, { "TwoRingNodes", counts[1] },
    { "AffineNodes", counts[2] }, { "StiffnessNodes", counts[3] } };
  if (counts[0] > 0 && ranks.rank() == 0)
  {
    monitor.warn("Free nodes outside the hull of their neighbors: node ids " + listIds(outside) +
                 ". " + std::to_string(counts[1]) +
                 " took weights among a second ring of neighbors, " + std::to_string(counts[2]) +
                 " affine weights, " + std::to_string(counts[3]) + " FEMWARP's row.");
  }
  return rows;
}
}
