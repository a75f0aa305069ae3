// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/InverseDistanceWeights.h"

#include "Geometry/NearestNodes.h"
#include "Geometry/SpatialOrder.h"
#include "Support/Error.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <vector>

namespace morph
{
namespace
{
constexpr Index Grain = 256;
constexpr Index Batch = 64 * Grain; // places between two calls of the monitor

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
  const Index n = places.rows();
  std::vector<Index> ids(n);
  std::iota(ids.begin(), ids.end(), Index(0));
  const std::vector<Index> order = spatialOrder(places, ids);
  const NearestNodes nearest(sites.coordinates());
  monitor.check();
  monitor.progress(.1);

  WeightMatrix weights;
  weights.open(n, sites.size(), std::min(neighbors, sites.size()));
  for (Index begin = 0; begin < n; begin += Batch)
  {
    monitor.check();
    monitor.progress(.1 + .9 * static_cast<double>(begin) / static_cast<double>(n));
    monitor.parallelFor(std::min(Batch, n - begin), Grain,
      [&](Index first, Index last)
      {
        nearest.search(places, order, begin + first, begin + last, neighbors,
          [&](Index row, const NearestNodes::Neighbors& found)
          { writeRow(found, sites.tolerance(), weights.column(row), weights.weight(row)); });
      });
  }
  return weights;
}
}
