// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/TargetTriangles.h"

#include "Boundary/SurfaceEdges.h"
#include "Support/Lists.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
/// See cleanTriangles().
class TriangleList
{
public:
  TriangleList(const Points& points, double rounding)
    : points_(points)
    , rounding_(rounding)
  {
  }

  void add(TargetTriangle triangle)
  {
    std::rotate(
      triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    this->triangles_.push_back(triangle);
  }

  /// In the order in which they were added, the parts of divided ones last.
  std::vector<TargetTriangle> clean()
  {
    this->removeRepeated();
    std::vector<TargetTriangle> all;
    all.swap(this->triangles_);
    for (TargetTriangle& triangle : all)
    {
      (this->turnFlat(triangle) ? this->flat_ : this->triangles_).push_back(triangle);
    }
    if (!this->flat_.empty())
    {
      this->findEdges();
    }
    // Thin triangles may become flat ones in turn.
    for (std::size_t left = 10 * this->flat_.size(); left > 0 && !this->flat_.empty(); --left)
    {
      this->removeFlat();
    }
    std::vector<TargetTriangle> result;
    std::copy_if(this->triangles_.begin(), this->triangles_.end(), std::back_inserter(result),
      [](const TargetTriangle& triangle) { return triangle != Divided; });
    return result;
  }

private:
  using Edge = std::pair<Index, Index>;
  static constexpr TargetTriangle Divided = { -1, -1, -1 };

  void removeRepeated()
  {
    std::vector<std::size_t> order = consecutive<std::size_t>(this->triangles_.size());
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b)
      { return std::tie(this->triangles_[a], a) < std::tie(this->triangles_[b], b); });
    std::vector<std::uint8_t> isFirst(order.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i)
    {
      isFirst[order[i]] = this->triangles_[order[i]] != this->triangles_[order[i - 1]];
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      if (isFirst[i])
      {
        this->triangles_[kept++] = this->triangles_[i];
      }
    }
    this->triangles_.resize(kept);
  }

  /// Whether it is flat; its longest edge then becomes that of its first two points.
  bool turnFlat(TargetTriangle& triangle) const
  {
    const auto length = [&](int k)
    { return (this->points_.row(triangle[(k + 1) % 3]) - this->points_.row(triangle[k])).norm(); };
    int longest = 0;
    for (int k = 1; k < 3; ++k)
    {
      longest = length(k) > length(longest) ? k : longest;
    }
    const double area = 2 * vectorArea(this->points_, triangle.data(), 3).norm();
    if (area > this->rounding_ * length(longest))
    {
      return false;
    }
    std::rotate(triangle.begin(), triangle.begin() + longest, triangle.end());
    return true;
  }

  template <typename Act>
  void forEdges(std::size_t number, const Act& act) const
  {
    const TargetTriangle& t = this->triangles_[number];
    for (int k = 0; k < 3; ++k)
    {
      act(Edge(std::minmax(t[k], t[(k + 1) % 3])));
    }
  }

  void findEdges()
  {
    for (std::size_t i = 0; i < this->triangles_.size(); ++i)
    {
      this->forEdges(i, [&](const Edge& edge) { this->atEdge_.emplace_back(edge, i); });
    }
    std::sort(this->atEdge_.begin(), this->atEdge_.end());
  }

  /// The triangles at an edge.
  std::vector<std::size_t> beside(const Edge& edge) const
  {
    std::vector<std::size_t> result;
    for (auto at = std::lower_bound(
           this->atEdge_.begin(), this->atEdge_.end(), std::pair(edge, std::size_t(0)));
         at != this->atEdge_.end() && at->first == edge; ++at)
    {
      if (this->triangles_[at->second] != Divided)
      {
        result.push_back(at->second);
      }
    }
    const auto [first, last] = this->atNewEdge_.equal_range(edge);
    for (auto at = first; at != last; ++at)
    {
      if (this->triangles_[at->second] != Divided)
      {
        result.push_back(at->second);
      }
    }
    return result;
  }

  void removeFlat()
  {
    const TargetTriangle flat = this->flat_.back();
    this->flat_.pop_back();
    const std::vector<std::size_t> neighbors = this->beside(Edge(std::minmax(flat[0], flat[1])));
    if (neighbors.size() != 1)
    {
      return;
    }
    TargetTriangle divided = std::exchange(this->triangles_[neighbors.front()], Divided);
    while (Edge(std::minmax(divided[0], divided[1])) != Edge(std::minmax(flat[0], flat[1])))
    {
      std::rotate(divided.begin(), divided.begin() + 1, divided.end());
    }
    for (TargetTriangle part : { TargetTriangle{ divided[0], flat[2], divided[2] },
           TargetTriangle{ flat[2], divided[1], divided[2] } })
    {
      if (part[0] == part[1] || part[1] == part[2] || part[2] == part[0])
      {
        continue;
      }
      if (this->turnFlat(part))
      {
        this->flat_.push_back(part);
        continue;
      }
      this->triangles_.push_back(part);
      this->forEdges(this->triangles_.size() - 1,
        [&](const Edge& edge) { this->atNewEdge_.emplace(edge, this->triangles_.size() - 1); });
    }
  }

  const Points& points_;
  double rounding_;
  std::vector<TargetTriangle> triangles_, flat_;
  std::vector<std::pair<Edge, std::size_t>> atEdge_; ///< sorted, the numbers in triangles_
  std::multimap<Edge, std::size_t> atNewEdge_;       ///< of those behind them
};

}

std::vector<TargetTriangle> cleanTriangles(
  const Points& points, const std::vector<TargetTriangle>& triangles, double rounding)
{
  TriangleList list(points, rounding);
  for (const TargetTriangle& triangle : triangles)
  {
    list.add(triangle);
  }
  return list.clean();
}
}
