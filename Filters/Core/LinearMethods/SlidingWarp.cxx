// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SlidingWarp.h"

#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace morph
{
namespace
{
constexpr int MostHalvings = 4;
constexpr int MaxIterations = 5000;
}

/// The displacements, and the force on all nodes.
struct NodeSliding::State
{
  Points x, force; ///< #rows x 3
  double pull = 0; ///< the norm of the force along the surfaces
};

NodeSliding::NodeSliding(const LinearSolver& solver, const Points& b, const Nodes& nodes,
  const Surfaces& surfaces, const Communicator& communicator)
  : solver_(solver)
  , b_(b)
  , nodes_(nodes)
  , surfaces_(surfaces)
  , communicator_(communicator)
{
}

NodeSliding::Row NodeSliding::place(Index i, const Points& x) const
{
  return this->nodes_.rest.row(i) + x.row(this->nodes_.rows[i]);
}

double NodeSliding::norm(const Points& rows) const
{
  return std::sqrt(this->communicator_.sum(rows.squaredNorm()));
}

void NodeSliding::solve(const RowConstraints& constraints, Points& x, Monitor& monitor)
{
  solveConstrained(this->solver_, this->b_, constraints, x, this->tolerance_, MaxIterations,
    this->work_, monitor, this->communicator_);
}

void NodeSliding::settle(State& state, Monitor& monitor)
{
  const RowConstraints held = { this->nodes_.rows,
    std::vector<Eigen::Matrix3d>(this->nodes_.rows.size(), Eigen::Matrix3d::Zero()) };
  this->solve(held, state.x, monitor);
  this->solver_.product(state.x, state.force, monitor);
  parallel(this->b_.rows(), monitor,
    [&](Index i) { state.force.row(i) = this->b_.row(i) - state.force.row(i); });
  double sum = 0;
  for (std::size_t k = 0; k < this->nodes_.rows.size(); ++k)
  {
    const auto i = static_cast<Index>(k);
    sum += (this->surfaces_.directions(i, this->place(i, state.x)) *
            state.force.row(this->nodes_.rows[k]).transpose())
             .squaredNorm();
  }
  state.pull = std::sqrt(this->communicator_.sum(sum));
}

std::vector<NodeSliding::Round> NodeSliding::run(const Limits& limits, Points& x, Monitor& monitor)
{
  this->tolerance_ = limits.tolerance;
  const auto count = static_cast<Index>(this->nodes_.rows.size());
  std::vector<Round> result;
  State now, next;
  Points wanted;
  now.x = x;
  this->settle(now, monitor);
  const double before = now.pull;
  const double rounding =
    10 * limits.tolerance * std::max(this->norm(this->b_), this->norm(now.force));
  for (int round = 0; round < limits.rounds && now.pull > rounding; ++round)
  {
    monitor.check();
    RowConstraints along = { this->nodes_.rows, {} };
    for (Index i = 0; i < count; ++i)
    {
      along.directions.push_back(this->surfaces_.directions(i, this->place(i, now.x)));
    }
    wanted = now.x;
    this->solve(along, wanted, monitor);

    Round done;
    bool isBetter = false;
    for (int halvings = 0; halvings <= MostHalvings && !isBetter; ++halvings)
    {
      next.x.resize(now.x.rows(), 3);
      parallel(now.x.rows(), monitor,
        [&](Index i) {
          next.x.row(i) = now.x.row(i) + std::ldexp(1., -halvings) * (wanted.row(i) - now.x.row(i));
        });
      done.change = 0;
      for (Index i = 0; i < count; ++i)
      {
        const int row = this->nodes_.rows[i];
        const Row from = this->place(i, now.x);
        const Row to = next.x.row(row) == now.x.row(row)
                         ? from
                         : this->surfaces_.closest(i, this->place(i, next.x));
        next.x.row(row) += to - this->place(i, next.x);
        done.change = std::max(done.change, (to - from).norm());
      }
      done.change = this->communicator_.maximum(done.change);
      this->settle(next, monitor);
      isBetter = next.pull < now.pull;
    }
    if (!isBetter)
    {
      break;
    }
    std::swap(now, next);
    done.force = now.pull / before;
    result.push_back(done);
    monitor.progress((round + 1.) / limits.rounds);
  }
  x = now.x;
  return result;
}

std::vector<SlidingWarp::Round> SlidingWarp::slide(const std::vector<Index>& sliding,
  const Surfaces& surfaces, const Limits& limits, Points& moved, Monitor& monitor) const
{
  const Points& rest = this->restPoints();
  std::vector<int> rowOfNode(rest.rows(), -1);
  for (std::size_t i = 0; i < this->rows().size(); ++i)
  {
    rowOfNode[this->rows()[i]] = static_cast<int>(i);
  }
  NodeSliding::Nodes nodes;
  std::vector<Index> own, indices;
  for (std::size_t i = 0; i < sliding.size(); ++i)
  {
    if (rowOfNode[sliding[i]] >= 0)
    {
      nodes.rows.push_back(rowOfNode[sliding[i]]);
      own.push_back(sliding[i]);
      indices.push_back(static_cast<Index>(i));
    }
  }
  nodes.rest = rest(own, allColumns);
  if (limits.rounds <= 0 || this->processes().all(own.empty()))
  {
    return {};
  }
  const Surfaces ofOwn = { [&](Index i, const Row& x)
    { return surfaces.directions(indices[i], x); },
    [&](Index i, const Row& x) { return surfaces.closest(indices[i], x); } };
  std::vector<Round> result;
  this->processes().together(
    [&]
    {
      const std::vector<Index>& prescribed = this->partition().prescribed;
      const Points given = moved(prescribed, allColumns) - rest(prescribed, allColumns);
      const Points b = -(this->coupling() * given);
      Points x = Points::Zero(b.rows(), 3);
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        x.row(nodes.rows[i]) = moved.row(own[i]) - nodes.rest.row(static_cast<Index>(i));
      }
      result =
        NodeSliding(this->solver(), b, nodes, ofOwn, this->processes()).run(limits, x, monitor);
      for (std::size_t k = 0; !result.empty() && k < own.size(); ++k)
      {
        const auto i = static_cast<Index>(k);
        const Row displacement = x.row(nodes.rows[k]);
        if (displacement != moved.row(own[k]) - nodes.rest.row(i))
        {
          // Adding the displacement has rounded; the nearest point of a plane is on it.
          moved.row(own[k]) = ofOwn.closest(i, nodes.rest.row(i) + displacement);
        }
      }
    });
  return result;
}
}
