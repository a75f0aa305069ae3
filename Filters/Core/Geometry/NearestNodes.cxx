// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/NearestNodes.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Place = std::array<double, 3>;

// Number of places per block at each level: a factor of eight, as the curve fills cubes.
constexpr std::array<Index, 3> BlockLength = { 512, 64, 8 };
constexpr Index LeafSize = 16;

constexpr double Tie = 1e-9; // of the distance

/// Enlarges a squared distance to cover the rounding of the differences that led to it.
double widened(double squaredDistance)
{
  return squaredDistance * (1 + 1e-12) + std::numeric_limits<double>::min();
}

double squaredDistance(const double* a, const double* b)
{
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/// The point-set interface that nanoflann requires.
struct Cloud
{
  Points points;

  std::size_t kdtree_get_point_count() const
  {
    return static_cast<std::size_t>(this->points.rows());
  }
  double kdtree_get_pt(std::size_t i, std::size_t j) const
  {
    return this->points(static_cast<Index>(i), static_cast<Index>(j));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud,
  3, std::uint32_t>;

/// What nanoflann 1.5 and later ask of a result set besides; the order is not used.
struct ResultSet
{
  using DistanceType = double;
  using IndexType = std::uint32_t;
  void sort() {}
};

/// A nanoflann result set that keeps the k smallest squared distances, unsorted. Its cost is linear
/// in the points received; nanoflann's own sorted list is quadratic in k.
class SmallestDistances : public ResultSet
{
public:
  explicit SmallestDistances(Index k)
    : k_(static_cast<std::size_t>(k))
  {
    this->distances_.reserve(2 * this->k_);
  }

  std::size_t size() const { return this->distances_.size(); }
  bool full() const { return this->distances_.size() >= this->k_; }
  double worstDist() const { return this->worst_; }
  bool addPoint(double distance, std::uint32_t)
  {
    this->distances_.push_back(distance);
    if (this->distances_.size() == 2 * this->k_)
    {
      this->shorten();
    }
    return true;
  }

  /// The k-th smallest distance; at least k must have been added.
  double largest()
  {
    this->shorten();
    return this->worst_;
  }

private:
  void shorten()
  {
    const auto last = this->distances_.begin() + static_cast<std::ptrdiff_t>(this->k_ - 1);
    std::nth_element(this->distances_.begin(), last, this->distances_.end());
    this->worst_ = *last;
    this->distances_.resize(this->k_);
  }

  std::size_t k_;
  double worst_ = std::numeric_limits<double>::max();
  std::vector<double> distances_;
};

/// A nanoflann result set that receives every point within a radius.
class WithinRadius : public ResultSet
{
public:
  WithinRadius(double squaredRadius, std::vector<std::int32_t>& found)
    : squaredRadius_(squaredRadius)
    , found_(found)
  {
  }

  std::size_t size() const { return this->found_.size(); }
  bool full() const { return true; }
  double worstDist() const { return this->squaredRadius_; }
  bool addPoint(double, std::uint32_t node)
  {
    this->found_.push_back(static_cast<std::int32_t>(node));
    return true;
  }

private:
  double squaredRadius_;
  std::vector<std::int32_t>& found_;
};

template <typename Value>
void makeRoom(std::vector<Value>& values, Index n)
{
  if (static_cast<Index>(values.size()) < n) // never shrunk: growing again would clear it each time
  {
    values.resize(n);
  }
}

/// Nodes that may be neighbors of some place of a block, ascending. They are the first `count`
/// entries of vectors that never shrink.
struct Candidates
{
  Index count = 0;
  std::vector<std::int32_t> nodes;
  std::array<std::vector<double>, 3> coordinates;

  void reserve(Index n)
  {
    makeRoom(this->nodes, n);
    for (std::vector<double>& values : this->coordinates)
    {
      makeRoom(values, n);
    }
  }
};

/// Sets the first `count` entries of `distances`.
void squaredDistances(const Candidates& candidates, const double* x, std::vector<double>& distances)
{
  const Index n = candidates.count;
  makeRoom(distances, n);
  const double *a = candidates.coordinates[0].data(), *b = candidates.coordinates[1].data(),
               *c = candidates.coordinates[2].data();
  double* d = distances.data();
  for (Index i = 0; i < n; ++i)
  {
    const double u = a[i] - x[0], v = b[i] - x[1], w = c[i] - x[2];
    d[i] = u * u + v * v + w * w;
  }
}

/// Returns the k-th smallest of n values and reorders them. Counting by size first leaves few
/// comparisons, of which half would be mispredicted.
double kthSmallest(double* values, Index n, Index k)
{
  constexpr int Bins = 64;
  const auto range = std::minmax_element(values, values + n);
  const double low = *range.first, scale = (Bins - .5) / (*range.second - low);
  if (n >= Bins && scale > 0 && scale <= std::numeric_limits<double>::max())
  {
    const auto bin = [=](double value) { return static_cast<int>((value - low) * scale); };
    std::array<Index, Bins> sizes{};
    for (Index i = 0; i < n; ++i)
    {
      ++sizes[bin(values[i])];
    }
    int wanted = 0;
    for (; k > sizes[wanted]; ++wanted)
    {
      k -= sizes[wanted];
    }
    Index m = 0;
    for (Index i = 0; i < n; ++i)
    {
      const double value = values[i];
      values[m] = value; // m <= i
      m += bin(value) == wanted ? 1 : 0;
    }
    n = m;
  }
  std::nth_element(values, values + k - 1, values + n);
  return values[k - 1];
}

/// A ball around the bounding box of consecutive places. The k-th neighbor of its centre is at most
/// `reach` away. It contains the box because it must also contain the centres of inner blocks.
struct Block
{
  Place middle;
  double radius = 0;
  double reach = 0;
};

Block blockAround(const Points& x, const Index* rows, Index n)
{
  Place low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (Index i = 0; i < n; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      low[j] = std::min(low[j], x(rows[i], j));
      high[j] = std::max(high[j], x(rows[i], j));
    }
  }
  Block block;
  for (int j = 0; j < 3; ++j)
  {
    block.middle[j] = low[j] + (high[j] - low[j]) / 2;
  }
  block.radius = std::sqrt(std::max(squaredDistance(low.data(), block.middle.data()),
    squaredDistance(high.data(), block.middle.data())));
  return block;
}
}

struct NearestNodes::Implementation
{
  explicit Implementation(const Points& nodes)
    : cloud{ nodes }
    , rounding(4 * std::numeric_limits<double>::epsilon() * nodes.cwiseAbs().maxCoeff())
    , tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(LeafSize))
  {
  }

  /// The squared distance up to which nodes are as far as one at a squared distance.
  double withTies(double squaredDistance) const
  {
    const double most = std::sqrt(squaredDistance) * (1 + Tie) + this->rounding;
    return widened(most * most);
  }

  double squaredDistanceOfKth(const Place& x, Index k) const
  {
    SmallestDistances smallest(k);
    this->tree.findNeighbors(smallest, x.data(), {});
    return smallest.largest();
  }

  void within(const Place& x, double squaredRadius, Candidates& found) const
  {
    found.nodes.clear();
    WithinRadius all(squaredRadius, found.nodes);
    this->tree.findNeighbors(all, x.data(), {});
    std::sort(found.nodes.begin(), found.nodes.end());
    found.count = static_cast<Index>(found.nodes.size());
    found.reserve(found.count);
    for (int j = 0; j < 3; ++j)
    {
      for (Index i = 0; i < found.count; ++i)
      {
        found.coordinates[j][i] = this->cloud.points(found.nodes[i], j);
      }
    }
  }

  Cloud cloud;
  double rounding; ///< of the distance of nodes
  Tree tree;
};

/// A search over consecutive places, with its buffers.
class NearestNodes::Run
{
public:
  Run(const Implementation& nodes, const Points& x, const Index* rows, Index k, const Visit& visit)
    : nodes_(nodes)
    , x_(x)
    , rows_(rows)
    , k_(k)
    , visit_(visit)
  {
  }

  void search(Index begin, Index end)
  {
    for (Index first = begin; first < end; first += BlockLength[0])
    {
      const Index last = std::min(end, first + BlockLength[0]);
      Block block = blockAround(this->x_, this->rows_ + first, last - first);
      block.reach = std::sqrt(this->nodes_.squaredDistanceOfKth(block.middle, this->k_));
      this->nodes_.within(block.middle, this->squaredRadius(block), this->candidates_[0]);
      this->divide(first, last, 1, block);
    }
  }

private:
  /// Squared radius of a ball around the centre that holds every neighbor of the block's places.
  double squaredRadius(const Block& block) const
  {
    const double radius = block.reach + 2 * block.radius;
    return this->nodes_.withTies(radius * radius);
  }

  /// Processes places begin to end - 1 of `outer`, whose candidates are candidates_[level - 1].
  void divide(Index begin, Index end, std::size_t level, const Block& outer)
  {
    if (level == BlockLength.size())
    {
      for (Index i = begin; i < end; ++i)
      {
        const double* x = this->x_.data() + 3 * this->rows_[i];
        this->nearest(x, this->reach(x, outer));
        this->visit_(this->rows_[i], { this->neighbors_.nodes.data(),
                                       this->neighborDistances_.data(), this->neighbors_.count });
      }
      return;
    }
    for (Index first = begin; first < end; first += BlockLength[level])
    {
      const Index last = std::min(end, first + BlockLength[level]);
      Block block = blockAround(this->x_, this->rows_ + first, last - first);
      const Candidates& candidates = this->candidates_[level - 1];
      squaredDistances(candidates, block.middle.data(), this->distances_);
      block.reach = this->reach(block.middle.data(), outer);
      block.reach = std::sqrt(this->kthDistance(candidates.count, block.reach));
      this->narrow(block, candidates, this->candidates_[level]);
      this->divide(first, last, level + 1, block);
    }
  }

  /// Returns an upper bound of the distance from x to its k-th neighbor. The largest distance to
  /// any k nodes is a bound; the last place's neighbors are likely to be near.
  double reach(const double* x, const Block& outer)
  {
    const double fromOuter = outer.reach + std::sqrt(squaredDistance(x, outer.middle.data()));
    if (this->neighbors_.count == 0)
    {
      return fromOuter;
    }
    double largest = 0;
    for (Index i = 0; i < this->k_; ++i) // any k
    {
      const double u = this->neighbors_.coordinates[0][i] - x[0],
                   v = this->neighbors_.coordinates[1][i] - x[1],
                   w = this->neighbors_.coordinates[2][i] - x[2];
      largest = std::max(largest, u * u + v * v + w * w);
    }
    return std::min(fromOuter, std::sqrt(largest));
  }

  /// Returns the k-th smallest of the first `count` distances_ (squared), which is at most `reach`
  /// squared.
  double kthDistance(Index count, double reach)
  {
    makeRoom(this->nearDistances_, count);
    const double most = widened(reach * reach);
    const double* d = this->distances_.data();
    double* near = this->nearDistances_.data();
    Index m = 0;
    for (Index i = 0; i < count; ++i)
    {
      near[m] = d[i];
      m += d[i] <= most ? 1 : 0;
    }
    return kthSmallest(near, m, this->k_);
  }

  /// Selects the block's candidates; distances_ holds those of `outer` from the block's centre.
  void narrow(const Block& block, const Candidates& outer, Candidates& inner)
  {
    const double most = this->squaredRadius(block);
    inner.reserve(outer.count);
    const double *a = outer.coordinates[0].data(), *b = outer.coordinates[1].data(),
                 *c = outer.coordinates[2].data(), *d = this->distances_.data();
    double *u = inner.coordinates[0].data(), *v = inner.coordinates[1].data(),
           *w = inner.coordinates[2].data();
    std::int32_t* nodes = inner.nodes.data();
    // Every store goes to the next free slot: half the branches would be mispredicted.
    Index m = 0;
    for (Index i = 0; i < outer.count; ++i)
    {
      nodes[m] = outer.nodes[i];
      u[m] = a[i];
      v[m] = b[i];
      w[m] = c[i];
      m += d[i] <= most ? 1 : 0;
    }
    inner.count = m;
  }

  /// Finds neighbors_ of x among the innermost candidates. `reach`: an upper bound of their
  /// distances.
  void nearest(const double* x, double reach)
  {
    const Candidates& from = this->candidates_.back();
    squaredDistances(from, x, this->distances_);
    makeRoom(this->nearPlaces_, from.count);
    makeRoom(this->nearDistances_, from.count);
    const double most = this->nodes_.withTies(reach * reach);
    double *d = this->distances_.data(), *nearDistances = this->nearDistances_.data();
    std::int32_t* nearPlaces = this->nearPlaces_.data();
    Index m = 0;
    for (Index i = 0; i < from.count; ++i)
    {
      nearPlaces[m] = static_cast<std::int32_t>(i);
      nearDistances[m] = d[i];
      m += d[i] <= most ? 1 : 0;
    }

    std::copy(nearDistances, nearDistances + m, d);
    const double largest = this->nodes_.withTies(kthSmallest(d, m, this->k_));
    this->neighbors_.reserve(m + 1);
    makeRoom(this->neighborDistances_, m + 1);
    Index kept = 0;
    for (Index i = 0; i < m; ++i)
    {
      const std::int32_t place = nearPlaces[i];
      const double distance = nearDistances[i];
      this->neighbors_.nodes[kept] = from.nodes[place];
      for (int j = 0; j < 3; ++j)
      {
        this->neighbors_.coordinates[j][kept] = from.coordinates[j][place];
      }
      this->neighborDistances_[kept] = distance;
      kept += distance <= largest ? 1 : 0;
    }
    this->neighbors_.count = kept;
  }

  const Implementation& nodes_;
  const Points& x_;
  const Index* rows_;
  Index k_;
  const Visit& visit_;

  std::array<Candidates, BlockLength.size()> candidates_; ///< of the current block, by level
  Candidates neighbors_;                                  ///< of the last place
  std::vector<double> neighborDistances_;                 ///< squared
  std::vector<double> distances_, nearDistances_;
  std::vector<std::int32_t> nearPlaces_;
};

NearestNodes::NearestNodes(const Points& nodes)
  : implementation_(std::make_unique<Implementation>(nodes))
{
}

NearestNodes::~NearestNodes() = default;

Index NearestNodes::size() const
{
  return this->implementation_->cloud.points.rows();
}

void NearestNodes::within(
  const Eigen::RowVector3d& x, double radius, std::vector<std::int32_t>& found) const
{
  found.clear();
  WithinRadius all(widened(radius * radius), found);
  this->implementation_->tree.findNeighbors(all, x.data(), {});
  const Points& points = this->implementation_->cloud.points;
  const auto outside = [&](std::int32_t node) { return (points.row(node) - x).norm() > radius; };
  found.erase(std::remove_if(found.begin(), found.end(), outside), found.end());
  std::sort(found.begin(), found.end());
}

void NearestNodes::search(const Points& x, const std::vector<Index>& order, Index first, Index last,
  Index k, const Visit& visit) const
{
  Run run(*this->implementation_, x, order.data(), std::min(k, this->size()), visit);
  run.search(first, last);
}
}
