// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SimplexNaturalNeighbor.h"

#include "Geometry/PointOrders.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <atomic>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
constexpr Index BlockLength = 128;
constexpr Index Samples = 64;
// of the transposed product: fixed, so that results do not depend on threads
constexpr Index PartialSums = 32;

/// Calls work(first, last) in parallel on ranges that cover [0, blocks). A block takes microseconds
/// or milliseconds, so the blocks between two chances to cancel go by the clock; the ranges do not
/// show in a result.
template <typename Work>
void inStretches(Index blocks, Monitor& monitor, Work&& work)
{
  Index length = 16;
  for (Index begin = 0, end = 0; begin < blocks; begin = end)
  {
    monitor.check();
    end = std::min(begin + length, blocks);
    const Stopwatch watch;
    monitor.parallelFor(
      end - begin, 1, [&](Index first, Index last) { work(begin + first, begin + last); });
    monitor.progress(static_cast<double>(end) / static_cast<double>(blocks));
    const double taken = watch.seconds();
    length = taken < 0.02 ? 2 * length : taken < 0.05 ? length : (length + 1) / 2;
  }
}

/// Returns the indices in `ids` in spatial order of the nodes.
std::vector<Index> placesInOrder(const Points& points, const std::vector<Index>& ids)
{
  std::vector<Index> places = spatialOrder(points, ids);
  for (Index& place : places)
  {
    place = std::lower_bound(ids.begin(), ids.end(), place) - ids.begin();
  }
  return places;
}
}

Index SimplexNaturalNeighbor::blocks() const
{
  return (static_cast<Index>(this->order_.size()) + BlockLength - 1) / BlockLength;
}

/// Computes the weights into the workspace; returns false if they are barycentric coordinates.
bool SimplexNaturalNeighbor::weightsOf(Index place, Workspace& work) const
{
  const Eigen::RowVector3d x = this->restPoints().row(this->partition().free[place]);
  const int inside = this->enclosing_.tetrahedron[place];
  const auto barycentric = this->enclosing_.barycentric.row(place);
  if (barycentric.minCoeff() >= -PointLocation::InsideTolerance &&
      this->neighbors_.compute(x, inside, work))
  {
    return true;
  }
  const auto& sites = this->delaunay_.tetrahedra()[inside].sites;
  work.sites.assign(sites.begin(), sites.end());
  work.weights.assign(barycentric.data(), barycentric.data() + 4);
  return false;
}

double SimplexNaturalNeighbor::estimateMemory() const
{
  Workspace work(this->neighbors_);
  const Index n = static_cast<Index>(this->order_.size());
  const Index samples = std::min(n, Samples);
  std::size_t entries = 0;
  for (Index i = 0; i < samples; ++i)
  {
    this->weightsOf(this->order_[i * n / samples], work);
    entries += work.sites.size();
  }
  return 12. * static_cast<double>(entries) / static_cast<double>(samples) * static_cast<double>(n);
}

/// Returns the number of the block's nodes with barycentric coordinates.
Index SimplexNaturalNeighbor::computeBlock(
  Index block, Workspace& work, WeightMatrix& weights) const
{
  const Index first = block * BlockLength;
  const Index last = std::min(first + BlockLength, static_cast<Index>(this->order_.size()));
  std::vector<std::int32_t> columns;
  std::vector<double> values;
  std::vector<Index> offsets{ 0 };
  Index barycentric = 0;
  for (Index i = first; i < last; ++i)
  {
    barycentric += this->weightsOf(this->order_[i], work) ? 0 : 1;
    columns.insert(columns.end(), work.sites.begin(), work.sites.end());
    values.insert(values.end(), work.weights.begin(), work.weights.end());
    offsets.push_back(static_cast<Index>(columns.size()));
  }
  weights.open(this->sites_.size(), std::move(offsets));
  std::copy(columns.begin(), columns.end(), weights.column(0));
  std::copy(values.begin(), values.end(), weights.weight(0));
  return barycentric;
}

/// Returns the number of nodes with barycentric coordinates if it computes the weights.
Index SimplexNaturalNeighbor::forEachBlock(
  Index first, Index last, const std::function<void(Index, const WeightMatrix&)>& use) const
{
  Index barycentric = 0;
  if (!this->stored_.empty())
  {
    for (Index block = first; block < last; ++block)
    {
      use(block, this->stored_[block]);
    }
    return barycentric;
  }
  Workspace work(this->neighbors_);
  for (Index block = first; block < last; ++block)
  {
    WeightMatrix weights;
    barycentric += this->computeBlock(block, work, weights);
    use(block, weights);
  }
  return barycentric;
}

void SimplexNaturalNeighbor::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const std::vector<Index>& free = this->partition().free;
  this->stored_.clear();
  this->sites_ = InterpolationSites(rest.points, this->partition().prescribed);
  this->delaunay_.build(this->sites_.coordinates(), monitor);
  this->enclosing_ = locatePoints(this->delaunay_, rest.points, free, monitor);
  this->neighbors_ = NaturalNeighbors(this->delaunay_, monitor);
  this->order_ = placesInOrder(rest.points, free);
  monitor.progress(0.05);

  const double estimate = this->estimateMemory();
  const bool store = estimate <= static_cast<double>(this->memoryLimit_);
  if (!store)
  {
    std::ostringstream text;
    text.precision(3);
    text << "The natural-neighbor weights would take about " << estimate / 1e9
         << " GB, more than the memory limit of " << static_cast<double>(this->memoryLimit_) / 1e9
         << " GB: each motion recomputes them, which is slow. Raise the limit if the "
            "memory is there.";
    monitor.warn(text.str());
  }

  std::vector<WeightMatrix> stored(store ? this->blocks() : 0);
  std::atomic<Index> barycentric{ 0 };
  ProgressRange weighting(monitor, 0.05, 1);
  inStretches(static_cast<Index>(stored.size()), weighting,
    [&](Index first, Index last)
    {
      Workspace work(this->neighbors_);
      for (Index block = first; block < last; ++block)
      {
        barycentric += this->computeBlock(block, work, stored[block]);
      }
    });
  this->barycentric_ = barycentric;
  this->stored_.swap(stored);
}

EvaluateReport SimplexNaturalNeighbor::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const WeightMatrix::PaddedPoints displacement =
    WeightMatrix::padded(this->sites_.average(prescribed, monitor), monitor);
  std::atomic<Index> barycentric{ this->barycentric_ };
  inStretches(this->blocks(), monitor,
    [&](Index first, Index last)
    {
      Monitor serial;
      Points moved;
      barycentric += this->forEachBlock(first, last,
        [&](Index block, const WeightMatrix& weights)
        {
          weights.multiplyPadded(displacement, moved, serial);
          for (Index i = 0; i < moved.rows(); ++i)
          {
            free.row(this->order_[block * BlockLength + i]) = moved.row(i);
          }
        });
    });
  EvaluateReport report;
  report.statistics = { { "BarycentricNodes", barycentric },
    { "ExtrapolatedNodes", static_cast<Index>(this->enclosing_.extrapolated.size()) },
    { "WeightsStored", this->stored_.empty() ? 0 : 1 } };
  return report;
}

EvaluateReport SimplexNaturalNeighbor::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  const Index blocks = this->blocks();
  const Index length = (blocks + PartialSums - 1) / PartialSums;
  std::vector<Points> part(PartialSums);
  monitor.parallelFor(PartialSums, 1,
    [&](Index firstSum, Index lastSum)
    {
      Monitor serial;
      for (Index k = firstSum; k < lastSum; ++k)
      {
        part[k].setZero(this->sites_.size(), 3);
        Points gradient, sites;
        this->forEachBlock(std::min(blocks, k * length), std::min(blocks, (k + 1) * length),
          [&](Index block, const WeightMatrix& weights)
          {
            gradient.resize(weights.rows(), 3);
            for (Index i = 0; i < gradient.rows(); ++i)
            {
              gradient.row(i) = free.row(this->order_[block * BlockLength + i]);
            }
            weights.multiplyTranspose(gradient, sites, serial);
            part[k] += sites;
          });
      }
    });
  monitor.check();
  for (Index k = 1; k < PartialSums; ++k)
  {
    part[0] += part[k];
  }
  this->sites_.scatterTranspose(part[0], prescribed);
  return {};
}
}
