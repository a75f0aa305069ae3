// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SlidingWarp.h"

#include "Distributed/RankCommunicator.h"
#include "Support/Error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace morph::distributed
{
namespace
{
void project(const RowConstraints& constraints, Points& rows)
{
  for (std::size_t k = 0; k < constraints.rows.size(); ++k)
  {
    const Eigen::RowVector3d row = rows.row(constraints.rows[k]);
    rows.row(constraints.rows[k]) = row * constraints.directions[k];
  }
}
}

/// As SpdSolver::solveConstrained().
void SlidingWarp::solve(const Points& b, const RowConstraints& constraints,
  const Communicator& communicator, Points& x, Monitor& monitor) const
{
  const Ranks& ranks = this->mesh().ranks();
  const auto residualAt = [&](const Points& at)
  {
    Points residual = b - this->solver().product(ranks, at);
    project(constraints, residual);
    return residual;
  };
  // A sum ends all ranks where one has failed; hypre would wait.
  const double b2 = communicator.sum(b.squaredNorm());
  const double given2 =
    std::max(b2, communicator.sum(this->solver().product(ranks, x).squaredNorm()));
  const double goal2 = std::max(NodeSliding::Tolerance * NodeSliding::Tolerance, 1e-28) * given2;
  Points residual = residualAt(x);
  double norm2 = communicator.sum(residual.squaredNorm());
  int iterations = 0;
  for (double before = HUGE_VAL; norm2 > goal2 && norm2 <= 0.25 * before;)
  {
    before = norm2;
    Points direction;
    double rz = 0;
    for (bool first = true; norm2 > goal2; first = false)
    {
      if (!std::isfinite(norm2) || iterations == NodeSliding::MaxIterations)
      {
        throw Error(Error::Kind::NoConvergence,
          "The equations of nodes that slide did not converge: after " +
            std::to_string(iterations) + " iterations the residual is " +
            std::to_string(std::sqrt(norm2 / given2)) +
            " of the right-hand side. Repair flat cells, or set SlideRounds to 0.");
      }
      monitor.check();
      communicator.sum(0.); // another rank may have been cancelled
      Points step = this->solver().precondition(ranks, residual);
      project(constraints, step);
      const double rzBefore = rz;
      rz = communicator.sum(residual.cwiseProduct(step).sum());
      direction = first ? step : Points(step + rz / rzBefore * direction);
      Points image = this->solver().product(ranks, direction);
      const double alpha = rz / communicator.sum(image.cwiseProduct(direction).sum());
      project(constraints, image);
      x += alpha * direction;
      residual -= alpha * image;
      norm2 = communicator.sum(residual.squaredNorm());
      ++iterations;
    }
    residual = residualAt(x);
    norm2 = communicator.sum(residual.squaredNorm());
  }
}

std::vector<NodeSliding::Round> SlidingWarp::slide(const std::vector<Index>& sliding,
  const NodeSliding::Surfaces& surfaces, int rounds, Points& moved, Monitor& monitor) const
{
  const DistributedMesh& mesh = this->mesh();
  const Points& rest = mesh.mesh().points;
  const std::vector<Index>& unknowns = this->ownFree();
  NodeSliding::Nodes nodes;
  std::vector<Index> own, indices;
  for (std::size_t i = 0; i < sliding.size(); ++i)
  {
    const auto row = std::lower_bound(unknowns.begin(), unknowns.end(), sliding[i]);
    if (row != unknowns.end() && *row == sliding[i])
    {
      nodes.rows.push_back(static_cast<int>(row - unknowns.begin()));
      own.push_back(sliding[i]);
      indices.push_back(static_cast<Index>(i));
    }
  }
  nodes.rest = rest(own, allColumns);
  if (rounds <= 0 || mesh.ranks().sum(static_cast<Index>(own.size())) == 0)
  {
    return {};
  }
  const NodeSliding::Surfaces ofOwn = { [&](Index i, const NodeSliding::Row& x)
    { return surfaces.directions(indices[i], x); },
    [&](Index i, const NodeSliding::Row& x) { return surfaces.closest(indices[i], x); } };
  const RankCommunicator communicator(mesh, {});
  std::vector<NodeSliding::Round> result;
  communicator.run(
    [&]
    {
      const std::vector<Index>& prescribed = this->partition().prescribed;
      NodeSliding::Equations equations;
      equations.b =
        -(this->coupling() * (moved(prescribed, allColumns) - rest(prescribed, allColumns)));
      equations.solve = [&](const RowConstraints& constraints, Points& x)
      { this->solve(equations.b, constraints, communicator, x, monitor); };
      equations.product = [&](const Points& x)
      {
        communicator.sum(0.);
        return this->solver().product(mesh.ranks(), x);
      };
      Points x = Points::Zero(static_cast<Index>(unknowns.size()), 3);
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        x.row(nodes.rows[i]) = moved.row(own[i]) - nodes.rest.row(static_cast<Index>(i));
      }
      result = NodeSliding(equations, nodes, ofOwn, communicator).run(rounds, x, monitor);
      for (std::size_t k = 0; !result.empty() && k < own.size(); ++k)
      {
        const auto i = static_cast<Index>(k);
        const NodeSliding::Row displacement = x.row(nodes.rows[k]);
        if (displacement != moved.row(own[k]) - nodes.rest.row(i))
        {
          moved.row(own[k]) = ofOwn.closest(i, nodes.rest.row(i) + displacement);
        }
      }
    });
  return result;
}
}
