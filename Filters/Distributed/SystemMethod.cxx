// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SystemMethod.h"

#include "LinearMethods/DirichletSystem.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/FemWarpSystem.h"
#include "LinearMethods/LogBarrierSystem.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Support/Error.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

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

/// Sums over prescribed nodes, from which AffineFit is made.
struct Moments
{
  std::array<double, 7> first{};   ///< count, sums of x and of d
  std::array<double, 18> second{}; ///< of (x - c)^T (x - c), and (x - c)^T (d - m)
};
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
  Rows rows = this->assemble(columns, monitor);

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
  const CsrMatrix others = rows.coupling.middleCols(held, static_cast<Index>(ghosts.size()));
  monitor.progress(0.5);
  ranks.together([&] { monitor.check(); });
  this->solver_.prepare(ranks, this->kind_, rows.interior, others, ghostNumbers);
}

/// The affine displacement of each body that fits its prescribed nodes best: affine motions solve
/// the equations, so the iteration finds only the remainder.
std::vector<AffineFit> SystemMethod::fits(const Points& prescribed) const
{
  const DistributedMesh& mesh = this->mesh();
  const std::vector<Index>& nodes = this->partition().prescribed;
  const Points& rest = mesh.mesh().points;
  const ConnectedComponents& bodies = mesh.bodies();
  std::vector<Moments> sums(bodies.count);
  const auto forEach = [&](const auto& visit)
  {
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const Index body = bodies.ofNode[nodes[i]];
      if (body >= 0 && mesh.owns(nodes[i]))
      {
        visit(sums[body], Eigen::RowVector3d(rest.row(nodes[i])),
          Eigen::RowVector3d(prescribed.row(static_cast<Index>(i))));
      }
    }
  };
  const auto reduce = [&](auto member)
  {
    std::vector<double> flat;
    for (Moments& sum : sums)
    {
      flat.insert(flat.end(), (sum.*member).begin(), (sum.*member).end());
    }
    mesh.ranks().sum(flat.data(), flat.size());
    const double* value = flat.data();
    for (Moments& sum : sums)
    {
      std::copy_n(value, (sum.*member).size(), (sum.*member).begin());
      value += (sum.*member).size();
    }
  };
  forEach(
    [](Moments& sum, const Eigen::RowVector3d& x, const Eigen::RowVector3d& d)
    {
      sum.first[0] += 1;
      Eigen::Map<Eigen::RowVector3d>(sum.first.data() + 1) += x;
      Eigen::Map<Eigen::RowVector3d>(sum.first.data() + 4) += d;
    });
  reduce(&Moments::first);
  const auto mean = [](const Moments& sum, int at)
  {
    return Eigen::RowVector3d(
      Eigen::Map<const Eigen::RowVector3d>(sum.first.data() + at) / std::max(sum.first[0], 1.));
  };
  forEach(
    [&](Moments& sum, const Eigen::RowVector3d& x, const Eigen::RowVector3d& d)
    {
      const Eigen::RowVector3d arm = x - mean(sum, 1);
      Eigen::Map<Eigen::Matrix3d>(sum.second.data()) += arm.transpose() * arm;
      Eigen::Map<Eigen::Matrix3d>(sum.second.data() + 9) += arm.transpose() * (d - mean(sum, 4));
    });
  reduce(&Moments::second);
  std::vector<AffineFit> result;
  for (const Moments& sum : sums)
  {
    result.emplace_back(mean(sum, 1), mean(sum, 4),
      Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(sum.second.data())),
      Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(sum.second.data() + 9)));
  }
  return result;
}

EvaluateReport SystemMethod::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  const Points rhs = -(this->coupling_ * prescribed);
  const std::vector<AffineFit> fits = this->fits(prescribed);
  for (Index i = 0; i < free.rows(); ++i)
  {
    const Index node = this->ownFree()[i];
    free.row(i) = fits[mesh.bodies().ofNode[node]].displacement(mesh.mesh().points.row(node));
  }
  ranks.together([&] { monitor.check(); });
  const SolveReport solved = this->solver_.solve(ranks, rhs, free, this->tolerance_, MaxIterations);
  EvaluateReport report;
  report.iterations = solved.iterations;
  report.relativeResidual = solved.relativeResidual;
  report.statistics = this->counts();
  if (ranks.rank() == 0)
  {
    reportRounding(solved, this->tolerance_, monitor);
  }
  return report;
}

void FemWarp::takeEvaluateOptions(const Morpher& serial)
{
  this->setTolerance(static_cast<const morph::FemWarp&>(serial).tolerance());
}

SystemMethod::Rows FemWarp::assemble(const std::vector<Index>& columns, Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  FemWarpSystem system;
  BadCells bad;
  ranks.together(
    [&]
    {
      system = femWarpSystem(mesh.mesh(), this->ownFree(), columns, {}, monitor);
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
  return { std::move(system.interior), std::move(system.coupling) };
}

void LogBarrierWarp::takeEvaluateOptions(const Morpher& serial)
{
  this->setTolerance(static_cast<const morph::LogBarrierWarp&>(serial).tolerance());
}

SystemMethod::Rows LogBarrierWarp::assemble(const std::vector<Index>& columns, Monitor& monitor)
{
  const DistributedMesh& mesh = this->mesh();
  const Ranks& ranks = mesh.ranks();
  LogBarrierSystem system;
  ranks.together(
    [&] {
      system = logBarrierSystem(mesh.mesh(), this->ownFree(), columns, this->relax_, {}, monitor);
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
           << ". Repair the undeformed mesh, prescribe those nodes, or set OutsideHull to Relax.";
    }
    throw Error(this->relax_ ? Error::Kind::Singular : Error::Kind::InvalidInput, text.str());
  }
  Index counts[4] = { static_cast<Index>(system.outside.size()), system.twoRing, system.affine,
    system.stiffness };
  ranks.sum(counts, 4);
  this->counts_ = { { "OutsideHullNodes", counts[0] }, { "TwoRingNodes", counts[1] },
    { "AffineNodes", counts[2] }, { "StiffnessNodes", counts[3] }, { "FallBackIterations", 0 } };
  if (counts[0] > 0 && ranks.rank() == 0)
  {
    monitor.warn("Free nodes outside the hull of their neighbors: node ids " + listIds(outside) +
                 ". " + std::to_string(counts[1]) +
                 " took weights among a second ring of neighbors, " + std::to_string(counts[2]) +
                 " affine weights, " + std::to_string(counts[3]) + " FEMWARP's row.");
  }
  return { std::move(system.interior), std::move(system.coupling) };
}
}
