// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SimplexLinear.h"

#include "Interpolation/PointLocation.h"
#include "LinearMethods/BridgingTetrahedra.h"
#include "Support/Error.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <sstream>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;

std::vector<int> distinct(std::vector<int> values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Warns of extrapolated nodes with large weights: a tetrahedron's weights are unbounded outside
/// the hull.
void warnOfLargeWeights(
  const PointLocation& enclosing, const std::vector<Index>& ids, Monitor& monitor)
{
  constexpr double Large = 10;
  double largest = 0;
  std::vector<Index> nodes;
  for (Index row = 0; row < enclosing.barycentric.rows(); ++row)
  {
    const double weight = enclosing.barycentric.row(row).cwiseAbs().maxCoeff();
    largest = std::max(largest, weight);
    if (weight > Large)
    {
      nodes.push_back(ids[row]);
    }
  }
  if (!nodes.empty())
  {
    std::ostringstream text;
    text.precision(3);
    text << "Free nodes far outside the convex hull of the prescribed nodes take " << largest
         << " times the motion of some of these at worst: node ids " << listIds(nodes)
         << ". Prescribe nodes around them, or choose FEMWARP.";
    monitor.warn(text.str());
  }
}

void fillWeights(
  const Delaunay& delaunay, const PointLocation& enclosing, WeightMatrix& weights, Monitor& monitor)
{
  const Index rows = static_cast<Index>(enclosing.tetrahedron.size());
  weights.open(rows, delaunay.sites().rows(), 4);
  monitor.parallelFor(rows, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const auto& sites = delaunay.tetrahedra()[enclosing.tetrahedron[row]].sites;
        std::copy(sites.begin(), sites.end(), weights.column(row));
        std::copy_n(enclosing.barycentric.row(row).data(), 4, weights.weight(row));
      }
    });
}
}

void SimplexLinear::doPrepare(const Mesh& rest, Monitor& monitor)
{
  this->sites_ = InterpolationSites(rest.points, this->partition().prescribed);
  monitor.progress(0.1);
  this->delaunay_.build(this->sites_.coordinates(), monitor);
  monitor.progress(0.6);
  const PointLocation enclosing =
    locatePoints(this->delaunay_, rest.points, this->partition().free, monitor);
  monitor.progress(0.8);
  warnOfLargeWeights(enclosing, this->partition().free, monitor);
  fillWeights(this->delaunay_, enclosing, this->weights_, monitor);
  this->used_ = distinct(enclosing.tetrahedron);
  this->extrapolated_ = static_cast<Index>(enclosing.extrapolated.size());
  this->bridging_ = static_cast<Index>(bridgingTetrahedra(
    rest, this->partition().prescribed, this->sites_, this->delaunay_, this->used_, monitor)
                                         .size());
}

EvaluateReport SimplexLinear::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  const Points displacement = this->sites_.average(prescribed);
  this->weights_.multiply(displacement, free, monitor);
  monitor.check();

  const Points moved = this->delaunay_.sites() + displacement;
  const Index folded = reproducibleSum(static_cast<Index>(this->used_.size()), monitor, Index(0),
    [&](Index i)
    {
      const Delaunay::Tetrahedron& tetrahedron = this->delaunay_.tetrahedra()[this->used_[i]];
      return Index(!(Delaunay::sixVolumes(tetrahedron, moved) > 0));
    });
  EvaluateReport report;
  report.bytesMoved =
    static_cast<double>(this->weights_.memory()) + 48. * static_cast<double>(free.rows());
  report.statistics = { { "FoldedTetrahedra", folded }, { "BridgingTetrahedra", this->bridging_ },
    { "ExtrapolatedNodes", this->extrapolated_ } };
  return report;
}

EvaluateReport SimplexLinear::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  Points sites;
  this->weights_.multiplyTranspose(free, sites, monitor);
  this->sites_.scatterTranspose(sites, prescribed);
  return {};
}

std::size_t SimplexLinear::memory() const
{
  return this->sites_.memory() + this->weights_.memory() +
         sizeof(Delaunay::Tetrahedron) * this->delaunay_.tetrahedra().size() +
         sizeof(int) * this->used_.size();
}
}
