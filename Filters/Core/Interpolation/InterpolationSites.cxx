// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/InterpolationSites.h"

#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <sstream>

namespace morph
{
namespace
{
constexpr double RelativeTolerance = 1e-12; // of the diagonal

/// A hash table of points by their cell in a regular grid. Its cost does not depend on which cells
/// are occupied.
class HashedGrid
{
public:
  HashedGrid(const Eigen::RowVector3d& low, double cell, Index n)
    : low_(low)
    , cell_(cell)
    , next_(n, -1)
  {
    std::size_t slots = 64;
    while (slots < 2 * static_cast<std::size_t>(n))
    {
      slots *= 2;
    }
    this->head_.assign(slots, -1);
  }

  void insert(const Eigen::RowVector3d& x, Index i)
  {
    Index& head = this->head_[this->slot(this->cellOf(x))];
    this->next_[i] = head;
    head = i;
  }

  /// Calls visit(i) for every point within `reach` of x in each coordinate, and perhaps for others.
  template <typename Visit>
  void near(const Eigen::RowVector3d& x, double reach, const Visit& visit) const
  {
    const Cell low = this->cellOf(x.array() - reach), high = this->cellOf(x.array() + reach);
    for (std::int64_t a = low[0]; a <= high[0]; ++a)
    {
      for (std::int64_t b = low[1]; b <= high[1]; ++b)
      {
        for (std::int64_t c = low[2]; c <= high[2]; ++c)
        {
          for (Index i = this->head_[this->slot({ a, b, c })]; i >= 0; i = this->next_[i])
          {
            visit(i);
          }
        }
      }
    }
  }

private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cellOf(const Eigen::RowVector3d& x) const
  {
    Cell cell;
    for (int j = 0; j < 3; ++j)
    {
      // Half a cell off: lattice points then do not lie on the walls between cells.
      cell[j] = static_cast<std::int64_t>(std::floor((x[j] - this->low_[j]) / this->cell_ + .5));
    }
    return cell;
  }

  std::size_t slot(const Cell& cell) const
  {
    std::uint64_t h = 0;
    for (std::int64_t c : cell)
    {
      h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h) & (this->head_.size() - 1);
  }

  Eigen::RowVector3d low_;
  double cell_;
  std::vector<Index> head_, next_;
};

double diagonal(const Points& places)
{
  const double length = (places.colwise().maxCoeff() - places.colwise().minCoeff()).norm();
  const bool point = (places.rowwise() - places.row(0)).isZero(0);
  const double square = length * length;
  if (!point && !(square >= std::numeric_limits<double>::min() && std::isfinite(square)))
  {
    std::ostringstream text;
    text << "The prescribed nodes extend over " << length
         << ", whose square is no number. Scale the mesh to a reasonable unit.";
    throw Error(text.str());
  }
  return length;
}
}

InterpolationSites::InterpolationSites(const Points& points, const std::vector<Index>& ids)
{
  const Index n = static_cast<Index>(ids.size());
  if (n == 0)
  {
    throw Error(Error::Kind::Singular, "No node is prescribed, so nothing says where the mesh "
                                       "goes. Prescribe the boundary's nodes.");
  }
  Points places(n, 3);
  for (Index i = 0; i < n; ++i)
  {
    places.row(i) = points.row(ids[i]).array() + 0.; // -0.0 becomes 0.0
  }
  const double extent = diagonal(places);
  this->tolerance_ = RelativeTolerance * extent;

  // From here on, numbers are positions in canonical order.
  std::vector<Index> order = consecutive(n);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      const double *p = places.data() + 3 * a, *q = places.data() + 3 * b;
      for (int j = 0; j < 3; ++j)
      {
        if (p[j] != q[j])
        {
          return p[j] < q[j];
        }
      }
      return ids[a] < ids[b];
    });

  // Cells far wider than the tolerance, so that a search visits one cell, and far smaller than mesh
  // edges.
  const double cell = extent > 0 ? 1024 * this->tolerance_ : 1;
  HashedGrid grid(places.colwise().minCoeff(), cell, n);
  UnionFind<Index> groups(n); // of nodes that are one site
  for (Index i = 0; i < n; ++i)
  {
    const Eigen::RowVector3d x = places.row(order[i]);
    const auto joinIfNear = [&](Index j)
    {
      if ((places.row(order[j]) - x).norm() <= this->tolerance_)
      {
        groups.join(i, j);
      }
    };
    grid.near(x, this->tolerance_, joinIfNear);
    // Of several nodes at one position, only one enters the grid: otherwise the cost would be
    // quadratic.
    if (i == 0 || (places.row(order[i - 1]).array() != x.array()).any())
    {
      grid.insert(x, i);
    }
  }

  std::vector<Index> siteOfRoot(n, -1);
  this->siteOf_.assign(n, -1);
  Index sites = 0;
  for (Index i = 0; i < n; ++i)
  {
    Index& site = siteOfRoot[groups.root(i)];
    site = site < 0 ? sites++ : site;
    this->siteOf_[order[i]] = site;
  }

  this->prescribed_.offsets.assign(sites + 1, 0);
  for (Index site : this->siteOf_)
  {
    ++this->prescribed_.offsets[site + 1];
  }
  std::partial_sum(this->prescribed_.offsets.begin(), this->prescribed_.offsets.end(),
    this->prescribed_.offsets.begin());
  this->prescribed_.values.resize(n);
  std::vector<Index> next(this->prescribed_.offsets.begin(), this->prescribed_.offsets.end() - 1);
  for (Index i : order)
  {
    this->prescribed_.values[next[this->siteOf_[i]]++] = i;
  }
  this->coordinates_.resize(sites, 3);
  for (Index s = 0; s < sites; ++s)
  {
    this->coordinates_.row(s) = places.row(*this->prescribed_.begin(s));
  }
}

Points InterpolationSites::average(const Points& prescribed, Monitor& monitor) const
{
  Points result(this->size(), 3);
  const auto averageOf = [&](Index s)
  {
    const Index *i = this->prescribed_.begin(s), *end = this->prescribed_.end(s);
    Eigen::RowVector3d sum = prescribed.row(*i);
    if (end - i > 1)
    {
      const double count = static_cast<double>(end - i);
      for (++i; i != end; ++i)
      {
        sum += prescribed.row(*i);
      }
      sum /= count;
    }
    return sum;
  };
  parallel(this->size(), monitor, [&](Index s) { result.row(s) = averageOf(s); });
  return result;
}

void InterpolationSites::scatterTranspose(const Points& sites, Points& prescribed) const
{
  for (Index i = 0; i < static_cast<Index>(this->siteOf_.size()); ++i)
  {
    const Index s = this->siteOf_[i];
    const Index count = this->prescribed_.end(s) - this->prescribed_.begin(s);
    prescribed.row(i) += sites.row(s) / static_cast<double>(count);
  }
}
}
