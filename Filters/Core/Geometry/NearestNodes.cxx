// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/NearestNodes.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace morph
{
namespace
{
constexpr Index LeafSize = 16;
constexpr double Tie = 1 + 1e-9; // of distances

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

/// The k nearest nodes with all others as far as the k-th. Of a tie nanoflann's own set keeps what
/// its tree has first, and its cost is quadratic in k.
class NearestSet : public ResultSet
{
public:
  NearestSet(std::size_t k, double rounding, std::vector<std::pair<double, std::uint32_t>>& found)
    : k_(k)
    , rounding_(rounding)
    , room_(2 * k)
    , found_(found)
  {
    this->found_.clear();
  }

  std::size_t size() const { return this->found_.size(); }
  bool full() const { return this->found_.size() >= this->k_; }
  double worstDist() const { return this->limit_; }
  bool addPoint(double squaredDistance, std::uint32_t node)
  {
    this->found_.emplace_back(squaredDistance, node);
    if (this->found_.size() == this->room_)
    {
      this->shorten();
      this->room_ = 2 * this->found_.size();
    }
    return true;
  }

  /// Removes what is farther than the k-th.
  void shorten()
  {
    const auto last = this->found_.begin() + static_cast<std::ptrdiff_t>(this->k_ - 1);
    std::nth_element(this->found_.begin(), last, this->found_.end());
    const double most = Tie * std::sqrt(last->first) + this->rounding_;
    this->limit_ = most * most + std::numeric_limits<double>::min();
    this->found_.erase(std::remove_if(this->found_.begin(), this->found_.end(),
                         [&](const auto& one) { return one.first >= this->limit_; }),
      this->found_.end());
  }

private:
  std::size_t k_;
  double rounding_;
  std::size_t room_;
  double limit_ = std::numeric_limits<double>::infinity(); ///< of squared distances
  std::vector<std::pair<double, std::uint32_t>>& found_;
};

/// All nodes nearer than a limit.
class WithinSet : public ResultSet
{
public:
  WithinSet(double squaredRadius, std::vector<std::int32_t>& found)
    : squaredRadius_(squaredRadius)
    , found_(found)
  {
    this->found_.clear();
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
}

struct NearestNodes::Implementation
{
  explicit Implementation(const Points& nodes)
    : cloud{ nodes }
    , rounding(4 * std::numeric_limits<double>::epsilon() * nodes.cwiseAbs().maxCoeff())
    , tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(LeafSize))
  {
  }

  Cloud cloud;
  double rounding; ///< of the distance of nodes
  Tree tree;
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

double NearestNodes::distance(const Eigen::RowVector3d& x) const
{
  std::uint32_t node = 0;
  double squaredDistance = 0;
  nanoflann::KNNResultSet<double, std::uint32_t> nearest(1);
  nearest.init(&node, &squaredDistance);
  this->implementation_->tree.findNeighbors(nearest, x.data(), {});
  return std::sqrt(squaredDistance);
}

void NearestNodes::nearest(
  const Eigen::RowVector3d& x, Index k, std::vector<std::int32_t>& found) const
{
  std::vector<std::pair<double, std::uint32_t>> near;
  NearestSet set(
    static_cast<std::size_t>(std::min(k, this->size())), this->implementation_->rounding, near);
  this->implementation_->tree.findNeighbors(set, x.data(), {});
  set.shorten();
  found.resize(near.size());
  std::transform(near.begin(), near.end(), found.begin(),
    [](const auto& one) { return static_cast<std::int32_t>(one.second); });
  std::sort(found.begin(), found.end());
}

void NearestNodes::within(
  const Eigen::RowVector3d& x, double radius, std::vector<std::int32_t>& found) const
{
  // nanoflann finds what is nearer than its limit, and distances are rounded.
  WithinSet set(Tie * radius * radius + std::numeric_limits<double>::min(), found);
  this->implementation_->tree.findNeighbors(set, x.data(), {});
  const Points& points = this->implementation_->cloud.points;
  const auto outside = [&](std::int32_t node) { return (points.row(node) - x).norm() > radius; };
  found.erase(std::remove_if(found.begin(), found.end(), outside), found.end());
  std::sort(found.begin(), found.end());
}
}
