// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SystemMethod.h"

#include "Distributed/Methods.h"
#include "Distributed/Stiffness.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/FemWarpSystem.h"
#include "LinearMethods/LogBarrierSystem.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Support/Error.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
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
  return ranks.gatherSorted(
    std::vector<Index>(mine.begin(), mine.begin() + std::min(Most, mine.size())));
}

std::string noVolume(const std::vector<Index>& ids)
{
  return "Every cell around node ids " + listIds(ids) +
         " has zero volume, so nothing says where they go. Prescribe them or repair the cells.";
}

/// rowComponents() of all ranks' rows. `ghosts`: the nodes of the columns of `others`.
RowComponents componentsOf(const DistributedMesh& mesh, const std::vector<Index>& rows,
  const CsrMatrix& interior, const CsrMatrix& others, const std::vector<Index>& ghosts)
{
  const auto count = static_cast<int>(rows.size());
  UnionFind<int> parts(count + static_cast<int>(ghosts.size()));
  for (int i = 0; i < count; ++i)
  {
    for (CsrMatrix::InnerIterator entry(interior, i); entry; ++entry)
    {
      parts.join(i, static_cast<int>(entry.col()));
    }
    for (CsrMatrix::InnerIterator entry(others, i); entry; ++entry)
    {
      parts.join(i, count + static_cast<int>(entry.col()));
    }
  }
  std::vector<Index> ofNode(mesh.mesh().numberOfNodes(), -1);
  int next = 0;
  for (const std::vector<Index>* nodes : { &rows, &ghosts })
  {
    for (const Index node : *nodes)
    {
      ofNode[node] = parts.root(next++);
    }
  }
  RowComponents result;
  result.count = mesh.join(ofNode);
  std::transform(rows.begin(), rows.end(), std::back_inserter(result.ofRow),
    [&](Index node) { return static_cast<int>(ofNode[node]); });
  return result;
}
}

void SystemMethod::setTolerance(double tolerance)
{
  requireTolerance(tolerance);
  this->tolerance_ = tolerance;
}

void SystemMethod::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const DistributedMesh& mesh = meshOf(this->processes());
  const Ranks& ranks = mesh.ranks();
  requirePrescribedBodies(mesh, this->partition());
  const std::vector<Index>& prescribed = this->partition().prescribed;
  std::vector<Index> columns = prescribed, ghosts;
  for (Index n = 0; n < rest.numberOfNodes(); ++n)
  {
    const bool isCorner = mesh.bodies().ofNode[n] >= 0;
    if (isCorner && !mesh.owns(n) && !std::binary_search(prescribed.begin(), prescribed.end(), n))
    {
      ghosts.push_back(n);
    }
  }
  columns.insert(columns.end(), ghosts.begin(), ghosts.end());
  this->transposed_.reset();
  const std::vector<double> factors = stiffnessFactors(mesh, prescribed, this->stiffness_, monitor);
  this->isUniform_ = ranks.sum(Index(!factors.empty())) == 0;
  Rows rows = this->assemble(columns, factors, monitor);

  const Index count = static_cast<Index>(this->partition().free.size());
  std::vector<Index> singular;
  for (Index i = 0; i < count; ++i)
  {
    if (!(rows.interior.coeff(i, i) > 0))
    {
      singular.push_back(mesh.nodeId(this->partition().free[i]));
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
    number[this->partition().free[i]] = first + i;
  }
  mesh.halo().update(ranks, number);
  std::vector<std::int64_t> ghostNumbers;
  for (Index node : ghosts)
  {
    ghostNumbers.push_back(number[node]);
  }
  const Index held = static_cast<Index>(prescribed.size());
  this->coupling_ = rows.coupling.middleCols(0, held);
  LinearEquations equations;
  equations.ghosts = rows.coupling.middleCols(held, static_cast<Index>(ghosts.size()));
  const RowComponents parts =
    componentsOf(mesh, this->partition().free, rows.interior, equations.ghosts, ghosts);
  this->guess_ = AffineGuess(rest.points, this->partition(), this->partition().free, parts,
    this->coupling_, this->processes());
  // Here, as hypre takes the matrix.
  this->affineResidual_ = this->processes().maximum(affineResidual(
    rest.points, this->partition().free, columns, rows.interior, rows.coupling, monitor));
  equations.matrix.swap(rows.interior);
  equations.ghostNumbers = std::move(ghostNumbers);
  monitor.progress(0.5);
  this->solver_ = std::make_unique<HypreSolver>(ranks, this->kind_);
  this->solver_->prepare(std::move(equations), monitor);
}

SolveReport SystemMethod::solveEach(
  const HypreSolver& solver, Points rhs, Points& x, Monitor& monitor) const
{
  const Ranks& ranks = meshOf(this->processes()).ranks();
  const auto part = [this](Index row) { return this->guess_.component(row); };
  std::vector<double> size(this->guess_.components(), 0);
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    size[part(i)] += rhs.row(i).squaredNorm();
  }
  ranks.sum(size.data(), size.size());
  for (double& value : size)
  {
    value = size.size() > 1 && value > 0 && std::isfinite(value) ? std::sqrt(value) : 1;
  }
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    rhs.row(i) /= size[part(i)];
    x.row(i) /= size[part(i)];
  }
  const double count = std::max(1., static_cast<double>(size.size()));
  const SolveReport solved =
    solver.solve(rhs, x, this->tolerance_ / std::sqrt(count), MaxIterations, monitor);
  for (Index i = 0; i < rhs.rows(); ++i)
  {
    x.row(i) *= size[part(i)];
  }
  return solved;
}

EvaluateReport SystemMethod::report(const SolveReport& solved, Monitor& monitor) const
{
  EvaluateReport report;
  report.iterations = solved.iterations;
  report.relativeResidual = solved.relativeResidual;
  report.statistics = this->counts();
  if (meshOf(this->processes()).ranks().rank() == 0)
  {
    reportRounding(solved, this->tolerance_, monitor);
  }
  return report;
}

EvaluateReport SystemMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  SolveReport solved;
  MultiVector x;
  const DirichletEquations equations = { this->restPoints(), this->partition(),
    this->partition().free, this->coupling_, this->guess_, this->isUniform_,
    [this] { return this->affineResidual_; } };
  equations.solve(toRows(prescribed, monitor), this->tolerance_, x, monitor,
    [&](const RightHandSide& rhs, MultiVector& solution)
    {
      Points b(rhs.rows(), 3), columns;
      for (Index i = 0; i < b.rows(); ++i)
      {
        b.row(i) = rhs[i].head<3>();
      }
      fromRows(solution, columns, monitor);
      solved = this->solveEach(*this->solver_, std::move(b), columns, monitor);
      solution = toRows(columns, monitor);
    });
  fromRows(x, free, monitor);
  return this->report(solved, monitor);
}

EvaluateReport SystemMethod::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // u_I = -A_I^-1 A_B u_B, so M^T g = -A_B^T y with A_I^T y = g.
  if (this->kind_ == HypreSolver::Kind::General && !this->transposed_)
  {
    this->transposed_ = this->solver_->transposed(monitor);
  }
  const HypreSolver& solver = this->transposed_ ? *this->transposed_ : *this->solver_;
  Points solution = Points::Zero(free.rows(), 3);
  monitor.check();
  const SolveReport solved = this->solveEach(solver, free, solution, monitor);
  prescribed -= this->coupling_.transpose() * solution;
  if (!this->isUniform_)
  {
    this->guess_.addTranspose(this->restPoints(), this->partition(), this->partition().free,
      this->coupling_, free, solution, prescribed);
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
  const DistributedMesh& mesh = meshOf(this->processes());
  const Ranks& ranks = mesh.ranks();
  FemWarpSystem system;
  Rows rows;
  BadCells bad;
  ranks.together(
    [&]
    {
      system = femWarpSystem(mesh.mesh(), this->partition().free, columns, factors, monitor);
      rows.interior.swap(system.interior); // Eigen 3.4 would copy on a move
      rows.coupling.swap(system.coupling);
      if (system.hasBadCells)
      {
        bad = badCells(mesh.mesh(), mesh.orientation(), system.cellSign, monitor);
      }
    });
  for (std::vector<Index>* list : { &bad.inverted, &bad.flat, &bad.absolute })
  {
    *list = mesh.gatherCells(*list);
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
  const DistributedMesh& mesh = meshOf(this->processes());
  const Ranks& ranks = mesh.ranks();
  LogBarrierSystem system;
  Rows rows;
  ranks.together(
    [&]
    {
      system =
        logBarrierSystem(mesh.mesh(), this->partition().free, columns, this->relax_, monitor);
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
