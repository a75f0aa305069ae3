// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/InverseDistanceWeights.h"

#include "Geometry/ConvexHullTest.h"
#include "Geometry/NearestNodes.h"
#include "Geometry/SpatialOrder.h"
#include "Support/Error.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <numeric>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 256;
constexpr Index Batch = 64 * Grain; // places between two calls of the monitor

/// Places with the same number of neighbors, in the order of a space-filling curve.
struct Group
{
  Index neighbors;
  std::vector<Index> rows;
};

/// Searches a group's neighbors in several threads, which call search(first, last, visitor) for
/// ranges of its rows. `from`, `to`: progress.
template <typename Search>
void searchRanges(const NearestNodes& nearest, const Points& places, const Group& group,
  double from, double to, Monitor& monitor, const Search& search)
{
  const Index n = static_cast<Index>(group.rows.size());
  for (Index begin = 0; begin < n; begin += Batch)
  {
    monitor.check();
    monitor.progress(from + (to - from) * static_cast<double>(begin) / static_cast<double>(n));
    monitor.parallelFor(std::min(Batch, n - begin), Grain,
      [&](Index first, Index last)
      {
        search(last - first,
          [&](const NearestNodes::Visit& visit) {
            nearest.search(places, group.rows, begin + first, begin + last, group.neighbors, visit);
          });
      });
  }
}

/// Whether the neighbors of a place surround it, or a single one decides.
bool surrounded(const InterpolationSites& prescribed, const Eigen::RowVector3d& x,
  const NearestNodes::Neighbors& neighbors)
{
  if (neighbors.leastSquaredDistance() <= prescribed.tolerance() * prescribed.tolerance())
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

/// Moves places that their neighbors do not surround to groups of twice as many neighbors,
/// repeatedly.
std::vector<Group> grownGroups(const NearestNodes& nearest, const InterpolationSites& sites,
  const Points& places, Group all, Monitor& monitor)
{
  std::vector<Group> groups;
  std::vector<std::uint8_t> done(places.rows(), 0);
  Group pending = std::move(all);
  while (!pending.rows.empty())
  {
    if (pending.neighbors < sites.size())
    {
      searchRanges(nearest, places, pending, .1, .5, monitor,
        [&](Index, const auto& search)
        {
          search([&](Index row, const NearestNodes::Neighbors& neighbors)
            { done[row] = surrounded(sites, places.row(row), neighbors) ? 1 : 0; });
        });
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

/// Rows of weights, in any order.
struct Piece
{
  std::vector<Index> rows, counts;
  std::vector<std::int32_t> columns;
  std::vector<double> weights;

  void add(Index row, const NearestNodes::Neighbors& neighbors, double tolerance)
  {
    const Index n = neighbors.count;
    this->rows.push_back(row);
    this->counts.push_back(n);
    this->columns.insert(this->columns.end(), neighbors.nodes, neighbors.nodes + n);
    const Index nearest = neighbors.nearest();
    const double* d = neighbors.squaredDistances;
    const double least = d[nearest];
    const std::size_t first = this->weights.size();
    this->weights.resize(first + n, 0);
    double* weight = this->weights.data() + first;
    if (least <= tolerance * tolerance)
    {
      weight[nearest] = 1;
      return;
    }
    double sum = 0;
    for (Index i = 0; i < n; ++i)
    {
      weight[i] = least / d[i]; // at most one: no overflow near a site
      sum += weight[i];
    }
    const double scale = 1 / sum;
    for (Index i = 0; i < n; ++i)
    {
      weight[i] *= scale;
    }
  }
};

/// The rows' lengths follow from the search alone, as all neighbors at the last one's distance
/// count. So the weights are kept in pieces first.
WeightMatrix join(std::vector<Piece>& pieces, Index rows, Index columns)
{
  std::vector<Index> offsets(rows + 1, 0);
  for (const Piece& piece : pieces)
  {
    for (std::size_t i = 0; i < piece.rows.size(); ++i)
    {
      offsets[piece.rows[i] + 1] = piece.counts[i];
    }
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  WeightMatrix weights;
  weights.open(columns, std::move(offsets));
  for (Piece& piece : pieces)
  {
    Index first = 0;
    for (std::size_t i = 0; i < piece.rows.size(); ++i)
    {
      const Index row = piece.rows[i], count = piece.counts[i];
      std::copy_n(piece.columns.begin() + first, count, weights.column(row));
      std::copy_n(piece.weights.begin() + first, count, weights.weight(row));
      first += count;
    }
    piece = Piece(); // gives its memory back while that of the matrix fills
  }
  return weights;
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

WeightMatrix inverseDistanceWeights(const InterpolationSites& sites, const Points& places,
  const Neighborhood& neighborhood, Monitor& monitor)
{
  requireModerate(sites.coordinates());
  requireModerate(places);
  const Index n = places.rows();
  std::vector<Index> ids(n);
  std::iota(ids.begin(), ids.end(), Index(0));
  Group all{ std::min(neighborhood.count, sites.size()), spatialOrder(places, ids) };
  const NearestNodes nearest(sites.coordinates());
  monitor.check();
  monitor.progress(.1);

  std::vector<Group> groups;
  if (neighborhood.grows)
  {
    groups = grownGroups(nearest, sites, places, std::move(all), monitor);
  }
  else
  {
    groups.push_back(std::move(all));
  }
  Index entries = 0; // at least
  for (const Group& group : groups)
  {
    entries += group.neighbors * static_cast<Index>(group.rows.size());
  }
  WeightMatrix().open(sites.size(), { 0, entries }); // throws where memory does not suffice

  std::vector<Piece> pieces;
  std::mutex mutex;
  double progress = neighborhood.grows ? .5 : .1;
  const double left = (1 - progress) / static_cast<double>(std::max<Index>(1, entries));
  for (const Group& group : groups)
  {
    const double next = progress + left * static_cast<double>(group.neighbors) *
                                     static_cast<double>(group.rows.size());
    searchRanges(nearest, places, group, progress, next, monitor,
      [&](Index rows, const auto& search)
      {
        Piece piece;
        const Index usual = rows * group.neighbors * 5 / 4; // with ties
        piece.columns.reserve(usual);
        piece.weights.reserve(usual);
        search([&](Index row, const NearestNodes::Neighbors& neighbors)
          { piece.add(row, neighbors, sites.tolerance()); });
        const std::lock_guard<std::mutex> lock(mutex);
        pieces.push_back(std::move(piece));
      });
    progress = next;
  }
  return join(pieces, n, sites.size());
}
}
