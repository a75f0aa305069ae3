// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/InverseDistanceWeights.h"

#include "Geometry/NearestNodes.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
constexpr Index BlockLength = 256; // places that are searched together
constexpr Index Batch = 64;        // blocks between two calls of the monitor

/// Fills a row of the weights of a place at the sites of its `columns`.
void writeRow(const InterpolationSites& sites, const Eigen::RowVector3d& place, Index row,
  WeightMatrix& weights)
{
  const std::int32_t* column = weights.column(row);
  double* weight = weights.weight(row);
  const Index n = weights.entries(row);
  for (Index i = 0; i < n; ++i)
  {
    weight[i] = (sites.coordinates().row(column[i]) - place).squaredNorm();
  }
  double* nearest = std::min_element(weight, weight + n);
  const double least = *nearest;
  if (least <= sites.tolerance() * sites.tolerance())
  {
    std::fill(weight, weight + n, 0.);
    *nearest = 1;
    return;
  }
  double sum = 0;
  for (Index i = 0; i < n; ++i)
  {
    weight[i] = least / weight[i]; // at most one: no overflow near a site
    sum += weight[i];
  }
  const double scale = 1 / sum;
  for (Index i = 0; i < n; ++i)
  {
    weight[i] *= scale;
  }
}

/// Throws Error if squares of distances overflow.
void requireModerate(const Points& places)
{
  const double largest = places.size() > 0 ? places.cwiseAbs().maxCoeff() : 0;
  if (!(largest < 1e150))
  {
    std::ostringstream text;
    text << "Coordinates go up to " << largest
         << ", too far for squares of distances. Scale the mesh to a reasonable unit.";
    throw Error(text.str());
  }
}
}

WeightMatrix inverseDistanceWeights(
  const InterpolationSites& sites, const Points& places, Index neighbors, Monitor& monitor)
{
  requireModerate(sites.coordinates());
  requireModerate(places);
  const Index n = places.rows(), blocks = (n + BlockLength - 1) / BlockLength;
  const NearestNodes nodes(sites.coordinates());
  monitor.check();
  monitor.progress(.1);

  const auto endOf = [=](Index block) { return std::min(n, (block + 1) * BlockLength); };
  std::vector<std::vector<std::int32_t>> found(blocks);
  std::vector<Index> offsets(n + 1, 0);
  for (Index begin = 0; begin < blocks; begin += Batch)
  {
    monitor.check();
    monitor.progress(.1 + .9 * static_cast<double>(begin) / static_cast<double>(blocks));
    monitor.parallelFor(std::min(Batch, blocks - begin), 1,
      [&](Index first, Index last)
      {
        std::vector<std::int32_t> near;
        for (Index b = begin + first; b < begin + last; ++b)
        {
          for (Index row = b * BlockLength; row < endOf(b); ++row)
          {
            nodes.nearest(places.row(row), neighbors, near);
            found[b].insert(found[b].end(), near.begin(), near.end());
            offsets[row + 1] = static_cast<Index>(near.size());
          }
        }
      });
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  WeightMatrix weights;
  weights.open(sites.size(), std::move(offsets));
  parallel(blocks, 1, monitor,
    [&](Index b)
    {
      std::copy(found[b].begin(), found[b].end(), weights.column(b * BlockLength));
      found[b] = {};
      for (Index row = b * BlockLength; row < endOf(b); ++row)
      {
        writeRow(sites, places.row(row), row, weights);
      }
    });
  return weights;
}
}
