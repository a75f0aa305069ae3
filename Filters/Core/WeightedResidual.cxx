// SPDX-License-Identifier: BSD-3-Clause
#include "WeightedResidual.h"

#include "ConvexHullTest.h"
#include "Error.h"
#include "SpatialOrder.h"

#include <Eigen/LU>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr Index Batch = 64 * Grain; // free nodes between two looks at the monitor

/// Free nodes with the same number of neighbors, along a space-filling curve.
struct Group
{
  Index neighbors;
  std::vector<Index> rows;
};

/// Searches the neighbors of a group by several threads and calls visit(row, neighbors) from them. `from`, `to`:
/// progress.
void searchGroup(const NearestNodes& nearest, const Points& places, const Group& group, double from,
  double to, Monitor& monitor, const NearestNodes::Visit& visit)
{
  const Index n = static_cast<Index>(group.rows.size());
  for (Index begin = 0; begin < n; begin += Batch)
  {
    monitor.check();
    monitor.progress(from + (to - from) * static_cast<double>(begin) / static_cast<double>(n));
    monitor.parallelFor(std::min(Batch, n - begin), Grain,
      [&](Index first, Index last)
      { nearest.search(places, group.rows, begin + first, begin + last, group.neighbors, visit); });
  }
}

/// Whether the neighbors of a place surround it, or one of them alone decides.
bool surrounded(const PrescribedSites& prescribed, const Eigen::RowVector3d& x,
  const NearestNodes::Neighbors& neighbors)
{
  const double* d = neighbors.squaredDistances;
  if (*std::min_element(d, d + neighbors.count) <= prescribed.tolerance() * prescribed.tolerance())
  {
    return true;
  }
  const Points& sites = prescribed.coordinates();
  Points around(neighbors.count, 3);
  for (Index i = 0; i < neighbors.count; ++i)
  {
    around.row(i) = sites.row(neighbors.nodes[i]);
  }
  return insideConvexHull(x, around);
}

/// Moves the nodes that their neighbors do not surround on to groups of twice as many neighbors, and so on.
std::vector<Group> grownGroups(const NearestNodes& nearest, const PrescribedSites& sites,
  const Points& places, Group all, Monitor& monitor)
{
  std::vector<Group> groups;
  std::vector<std::uint8_t> done(places.rows(), 0);
  Group pending = std::move(all);
  while (!pending.rows.empty())
  {
    if (pending.neighbors < sites.size())
    {
      searchGroup(nearest, places, pending, .1, .5, monitor,
        [&](Index row, const NearestNodes::Neighbors& neighbors)
        { done[row] = surrounded(sites, places.row(row), neighbors) ? 1 : 0; });
    }
    else
    {
      std::fill(done.begin(), done.end(), std::uint8_t(1));
    }
    Group rest{ std::min(2 * pending.neighbors, sites.size()), {} };
    const auto isDone = [&](Index row) { return done[row] != 0; };
    std::copy_if(pending.rows.begin(), pending.rows.end(), std::back_inserter(rest.rows),
      [&](Index row) { return !isDone(row); });
    pending.rows.erase(std::remove_if(pending.rows.begin(), pending.rows.end(),
                         [&](Index row) { return !isDone(row); }),
      pending.rows.end());
    groups.push_back(std::move(pending));
    pending = std::move(rest);
  }
  return groups;
}

void writeRow(
  const NearestNodes::Neighbors& neighbors, double tolerance, std::int32_t* column, double* weight)
{
  const double* d = neighbors.squaredDistances;
  const Index n = neighbors.count;
  std::copy(neighbors.nodes, neighbors.nodes + n, column);
  const double* least = std::min_element(d, d + n);
  if (*least <= tolerance * tolerance)
  {
    std::fill(weight, weight + n, 0.);
    weight[least - d] = 1;
    return;
  }
  double sum = 0;
  for (Index i = 0; i < n; ++i)
  {
    weight[i] = *least / d[i]; // at most one: no overflow near a site
    sum += weight[i];
  }
  const double scale = 1 / sum;
  for (Index i = 0; i < n; ++i)
  {
    weight[i] *= scale;
  }
}

void warnIfInsideOut(const AffineFit& fit, Monitor& monitor)
{
  const double determinant = (Eigen::Matrix3d::Identity() + fit.gradient()).determinant();
  if (!(determinant > 0))
  {
    std::ostringstream text;
    text << "The affine map fitted to the boundary's motion has determinant " << determinant
         << ": it reflects or flattens the mesh. Move the boundary in smaller steps, or use a "
            "method that follows "
            "the mesh's cells.";
    monitor.warn(text.str());
  }
}
}

void WeightedResidual::setNumberOfNeighbors(Index count)
{
  if (count < 1)
  {
    throw Error("The number of neighbors must be at least 1; it is " + std::to_string(count) + ".");
  }
  this->numberOfNeighbors_ = count;
}

void WeightedResidual::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const std::vector<Index>& free = this->partition().free;
  const Index rows = static_cast<Index>(free.size());
  this->sites_ = PrescribedSites(rest.points, this->partition().prescribed);
  const Points& sites = this->sites_.coordinates();
  this->fit_ = AffineLeastSquares(sites);
  this->freePlaces_.resize(rows, 3);
  for (Index i = 0; i < rows; ++i)
  {
    this->freePlaces_.row(i) = rest.points.row(free[i]);
  }
  monitor.check();

  std::vector<Index> ids(rows);
  std::iota(ids.begin(), ids.end(), Index(0));
  Group all{ std::min(this->numberOfNeighbors_, sites.rows()),
    spatialOrder(this->freePlaces_, ids) };
  const NearestNodes nearest(sites);
  monitor.progress(.1);

  std::vector<Group> groups;
  if (this->adaptiveNeighbors_)
  {
    groups = grownGroups(nearest, this->sites_, this->freePlaces_, std::move(all), monitor);
  }
  else
  {
    groups.push_back(std::move(all));
  }
  std::vector<Index> offsets(rows + 1, 0);
  for (const Group& group : groups)
  {
    for (Index row : group.rows)
    {
      offsets[row + 1] = group.neighbors;
    }
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  this->weights_.open(sites.rows(), std::move(offsets));

  double progress = this->adaptiveNeighbors_ ? .5 : .1;
  for (const Group& group : groups)
  {
    double entries = static_cast<double>(group.neighbors) * static_cast<double>(group.rows.size());
    const double next = progress + .5 * entries / static_cast<double>(this->weights_.entries());
    searchGroup(nearest, this->freePlaces_, group, progress, next, monitor,
      [this](Index row, const NearestNodes::Neighbors& neighbors)
      {
        writeRow(neighbors, this->sites_.tolerance(), this->weights_.column(row),
          this->weights_.weight(row));
      });
    progress = next;
  }
}

EvaluateReport WeightedResidual::report() const
{
  EvaluateReport report;
  report.bytesMoved = static_cast<double>(this->weights_.memory()) +
                      sizeof(double) * static_cast<double>(4 * this->freePlaces_.size());
  return report;
}

EvaluateReport WeightedResidual::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points residual = this->sites_.average(prescribed);
  const AffineFit fit = this->fit_.fit(residual);
  warnIfInsideOut(fit, monitor);
  for (Index s = 0; s < residual.rows(); ++s)
  {
    residual.row(s) -= fit.displacement(this->sites_.coordinates().row(s));
  }
  monitor.check();
  this->weights_.multiply(residual, free, monitor);
  monitor.parallelFor(free.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        free.row(i) += fit.displacement(this->freePlaces_.row(i));
      }
    });
  return this->report();
}

EvaluateReport WeightedResidual::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // u = L_x U + W (U - L_b U), hence the adjoint W^T g + L_x^T g - L_b^T W^T g.
  Points onSites;
  monitor.check();
  this->weights_.multiplyTranspose(free, onSites, monitor);
  Points result = onSites;
  this->fit_.fitTranspose(this->freePlaces_, free, result);
  this->fit_.fitTranspose(this->sites_.coordinates(), -onSites, result);
  this->sites_.scatterTranspose(result, prescribed);
  return this->report();
}

std::size_t WeightedResidual::memory() const
{
  // The fit keeps an arm per site.
  return this->sites_.memory() + this->weights_.memory() +
         sizeof(double) * (this->freePlaces_.size() + this->sites_.coordinates().size());
}
}
