// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SimplexLinear.h"

#include "Geometry/CosphericalStars.h"
#include "Interpolation/AffineWeights.h"
#include "Interpolation/PointLocation.h"
#include "Support/Error.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;

/// Returns the tetrahedra with nodes in them, ascending, of `count` in all. `far`: rows that do not
/// count, ascending.
std::vector<int> usedTetrahedra(
  const PointLocation& enclosing, const std::vector<Index>& far, std::size_t count)
{
  std::vector<std::uint8_t> isUsed(count, 0);
  auto nextFar = far.begin();
  for (std::size_t row = 0; row < enclosing.tetrahedron.size(); ++row)
  {
    if (nextFar != far.end() && *nextFar == static_cast<Index>(row))
    {
      ++nextFar;
      continue;
    }
    isUsed[enclosing.tetrahedron[row]] = 1;
  }
  std::vector<int> used;
  for (std::size_t t = 0; t < count; ++t)
  {
    if (isUsed[t])
    {
      used.push_back(static_cast<int>(t));
    }
  }
  return used;
}

/// A tetrahedron's weights are unbounded outside the hull. Beyond this, the affine fit of the
/// nearest sites replaces them.
constexpr double MostWeight = 10;

/// Returns the rows with a larger weight, ascending.
std::vector<Index> farRows(const PointLocation& enclosing)
{
  std::vector<Index> rows;
  for (Index row = 0; row < enclosing.barycentric.rows(); ++row)
  {
    if (enclosing.barycentric.row(row).cwiseAbs().maxCoeff() > MostWeight)
    {
      rows.push_back(row);
    }
  }
  return rows;
}

void warnOfFarNodes(const std::vector<Index>& rows, const std::vector<Index>& ids, Monitor& monitor)
{
  std::vector<Index> nodes(rows.size());
  std::transform(rows.begin(), rows.end(), nodes.begin(), [&](Index row) { return ids[row]; });
  if (!nodes.empty())
  {
    monitor.warn("Free nodes far outside the convex hull of the prescribed nodes follow the affine "
                 "fit to the motion of the nearest ones: node ids " +
                 listIds(nodes) + ". Prescribe nodes around them, or choose FEMWARP.");
  }
}

/// `far`: rows, ascending, that take the weights `affine` instead of their tetrahedron's.
void fillWeights(const Delaunay& delaunay, const PointLocation& enclosing,
  const std::vector<Index>& far, const std::vector<AffineRow>& affine, WeightMatrix& weights,
  Monitor& monitor)
{
  const Index rows = static_cast<Index>(enclosing.tetrahedron.size());
  if (far.empty())
  {
    weights.open(rows, delaunay.sites().rows(), 4);
  }
  else
  {
    std::vector<Index> offsets(rows + 1, 4);
    offsets[0] = 0;
    for (std::size_t i = 0; i < far.size(); ++i)
    {
      offsets[far[i] + 1] = static_cast<Index>(affine[i].sites.size());
    }
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    weights.open(delaunay.sites().rows(), std::move(offsets));
  }
  parallel(rows, Grain, monitor,
    [&](Index row)
    {
      const auto& sites = delaunay.tetrahedra()[enclosing.tetrahedron[row]].sites;
      if (enclosing.barycentric.row(row).cwiseAbs().maxCoeff() <= MostWeight)
      {
        std::copy(sites.begin(), sites.end(), weights.column(row));
        std::copy_n(enclosing.barycentric.row(row).data(), 4, weights.weight(row));
      }
    });
  for (std::size_t i = 0; i < far.size(); ++i)
  {
    std::copy(affine[i].sites.begin(), affine[i].sites.end(), weights.column(far[i]));
    std::copy(affine[i].weights.begin(), affine[i].weights.end(), weights.weight(far[i]));
  }
}
}

void SimplexLinear::doPrepare(const Mesh& rest, Monitor& monitor)
{
  this->sites_ = InterpolationSites(rest.points, this->partition().prescribed);
  monitor.progress(0.1);
  this->delaunay_.build(this->sites_.coordinates(), monitor);
  monitor.progress(0.5);
  this->means_ = starCosphericalCells(this->delaunay_, monitor);
  monitor.progress(0.6);
  const PointLocation enclosing =
    locatePoints(this->delaunay_, rest.points, this->partition().free, monitor);
  monitor.progress(0.8);
  const std::vector<Index>& free = this->partition().free;
  const std::vector<Index> far = farRows(enclosing);
  warnOfFarNodes(far, free, monitor);
  Points places(static_cast<Index>(far.size()), 3);
  for (Index i = 0; i < places.rows(); ++i)
  {
    places.row(i) = rest.points.row(free[far[i]]) - this->delaunay_.origin();
  }
  fillWeights(this->delaunay_, enclosing, far,
    far.empty() ? std::vector<AffineRow>()
                : affineWeights(this->delaunay_.sites().topRows(this->sites_.size()), places,
                    MostWeight, monitor),
    this->weights_, monitor);
  this->used_ = usedTetrahedra(enclosing, far, this->delaunay_.tetrahedra().size());
  this->affine_ = static_cast<Index>(far.size());
  this->extrapolated_ = static_cast<Index>(enclosing.extrapolated.size());
}

EvaluateReport SimplexLinear::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const Points displacement =
    withMeans(this->sites_.average(prescribed, monitor), this->means_, monitor);
  this->weights_.multiply(displacement, free, monitor);
  monitor.check();

  Points moved(displacement.rows(), 3);
  monitor.parallelFor(moved.rows(), Grain,
    [&](Index first, Index last)
    {
      const Index count = last - first;
      moved.middleRows(first, count) =
        this->delaunay_.sites().middleRows(first, count) + displacement.middleRows(first, count);
    });
  const Index folded = reproducibleSum(static_cast<Index>(this->used_.size()), monitor, Index(0),
    [&](Index i)
    {
      const Delaunay::Tetrahedron& tetrahedron = this->delaunay_.tetrahedra()[this->used_[i]];
      return Index(!(Delaunay::sixVolumes(tetrahedron, moved) > 0));
    });
  EvaluateReport report;
  report.statistics = { { "FoldedTetrahedra", folded },
    { "ExtrapolatedNodes", this->extrapolated_ }, { "AffineNodes", this->affine_ } };
  return report;
}

EvaluateReport SimplexLinear::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  Points sites;
  this->weights_.multiplyTranspose(free, sites, monitor);
  const Index means = static_cast<Index>(this->means_.offsets.size()) - 1;
  for (Index m = 0; m < means; ++m)
  {
    const Eigen::RowVector3d share =
      sites.row(this->sites_.size() + m) /
      static_cast<double>(this->means_.end(m) - this->means_.begin(m));
    std::for_each(
      this->means_.begin(m), this->means_.end(m), [&](Index site) { sites.row(site) += share; });
  }
  this->sites_.scatterTranspose(sites, prescribed);
  return {};
}
}
