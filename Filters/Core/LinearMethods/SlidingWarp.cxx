// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SlidingWarp.h"

#include "LinearMethods/FemWarpSystem.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Support/Error.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double Tolerance = 1e-11;
constexpr int MaxIterations = 5000;
constexpr int MostHalvings = 4;
}

void SlidingWarp::prepare(const Mesh& rest, const std::vector<Index>& prescribed,
  const std::vector<Index>& sliding, Monitor& monitor)
{
  const NodePartition partition = partitionNodes(rest, prescribed);
  requirePrescribedBodies(rest, connectedComponents(rest), partition);
  this->points_ = rest.points;
  this->prescribed_ = partition.prescribed;
  this->rows_ = unknownOrdering(rest, partition.free);
  FemWarpSystem system = femWarpSystem(rest, this->rows_, partition.prescribed, {}, monitor);
  this->coupling_.swap(system.coupling);
  const Points coordinates = rest.points(this->rows_, allColumns);
  try
  {
    this->solver_.prepare(system.interior, coordinates, monitor);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> nodes;
    for (const Index row : error.rows())
    {
      nodes.push_back(this->rows_[row]);
    }
    throw Error(Error::Kind::Singular,
      "Every cell around node ids " + listIds(nodes) +
        " has zero volume, so nothing says where they slide. Repair the cells.");
  }
  std::vector<int> rowOfNode(rest.numberOfNodes(), -1);
  for (std::size_t i = 0; i < this->rows_.size(); ++i)
  {
    rowOfNode[this->rows_[i]] = static_cast<int>(i);
  }
  this->sliding_.clear();
  this->slidingRow_.clear();
  for (const Index node : sliding)
  {
    if (rowOfNode[node] >= 0)
    {
      this->sliding_.push_back(node);
      this->slidingRow_.push_back(rowOfNode[node]);
    }
  }
}

SlidingWarp::Row SlidingWarp::place(Index i, const Points& x) const
{
  return this->points_.row(this->sliding_[i]) + x.row(this->slidingRow_[i]);
}

void SlidingWarp::settle(
  const Surfaces& surfaces, const Points& b, State& state, Monitor& monitor) const
{
  const RowConstraints held = { this->slidingRow_,
    std::vector<Eigen::Matrix3d>(this->slidingRow_.size(), Eigen::Matrix3d::Zero()) };
  this->solver_.solveConstrained(b, held, state.x, Tolerance, MaxIterations, monitor);
  state.force = b - this->solver_.product(state.x, monitor);
  double sum = 0;
  for (std::size_t k = 0; k < this->sliding_.size(); ++k)
  {
    const auto i = static_cast<Index>(k);
    sum += (surfaces.directions(i, this->place(i, state.x)) *
            state.force.row(this->slidingRow_[k]).transpose())
             .squaredNorm();
  }
  state.pull = std::sqrt(sum);
}

std::vector<SlidingWarp::Round> SlidingWarp::slide(
  const Surfaces& surfaces, int rounds, Points& moved, Monitor& monitor) const
{
  const auto count = static_cast<Index>(this->sliding_.size());
  if (count == 0 || rounds <= 0)
  {
    return {};
  }
  const Points prescribed =
    moved(this->prescribed_, allColumns) - this->points_(this->prescribed_, allColumns);
  const Points b = -(this->coupling_ * prescribed);
  State now;
  now.x = Points::Zero(static_cast<Index>(this->rows_.size()), 3);
  for (Index i = 0; i < count; ++i)
  {
    now.x.row(this->slidingRow_[i]) =
      moved.row(this->sliding_[i]) - this->points_.row(this->sliding_[i]);
  }
  this->settle(surfaces, b, now, monitor);
  const double before = now.pull;
  const double rounding = 10 * Tolerance * std::max(b.norm(), now.force.norm());

  std::vector<Round> result;
  for (int round = 0; round < rounds && now.pull > rounding; ++round)
  {
    monitor.check();
    RowConstraints along = { this->slidingRow_, {} };
    for (Index i = 0; i < count; ++i)
    {
      along.directions.push_back(surfaces.directions(i, this->place(i, now.x)));
    }
    Points wanted = now.x;
    this->solver_.solveConstrained(b, along, wanted, Tolerance, MaxIterations, monitor);

    Round done;
    bool isBetter = false;
    State next;
    for (int halvings = 0; halvings <= MostHalvings && !isBetter; ++halvings)
    {
      next.x = now.x + std::ldexp(1., -halvings) * (wanted - now.x);
      done.change = 0;
      for (Index i = 0; i < count; ++i)
      {
        const int row = this->slidingRow_[i];
        const Row from = this->place(i, now.x);
        const Row to =
          next.x.row(row) == now.x.row(row) ? from : surfaces.closest(i, this->place(i, next.x));
        next.x.row(row) += to - this->place(i, next.x);
        done.change = std::max(done.change, (to - from).norm());
      }
      this->settle(surfaces, b, next, monitor);
      isBetter = next.pull < now.pull;
    }
    if (!isBetter)
    {
      break;
    }
    now = next;
    done.force = now.pull / before;
    result.push_back(done);
    monitor.progress((round + 1.) / rounds);
  }
  for (Index i = 0; !result.empty() && i < count; ++i)
  {
    const Row displacement = now.x.row(this->slidingRow_[i]);
    if (displacement != moved.row(this->sliding_[i]) - this->points_.row(this->sliding_[i]))
    {
      // Adding the displacement has rounded; the nearest point of a plane is on it.
      moved.row(this->sliding_[i]) = surfaces.closest(i, this->place(i, now.x));
    }
  }
  return result;
}
}
