// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/Target.h"

#include "Boundary/SurfaceEdges.h"
#include "Geometry/NearestNodes.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
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

namespace
{
using Row = ProjectionTarget::Row;

/// The rounding of single precision, in which STL files are written.
double roundingOf(const Points& x)
{
  return x.rows() == 0 ? 0 : 1e-7 * (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
}

/// Gives for each point the one that replaces all points within the rounding.
std::vector<Index> mergedPoints(const Points& x)
{
  std::vector<Index> merged(x.rows(), -1);
  if (x.rows() == 0)
  {
    return merged;
  }
  const NearestNodes all(x);
  const double rounding = roundingOf(x);
  std::vector<std::int32_t> near;
  for (Index i = 0; i < x.rows(); ++i)
  {
    if (merged[i] >= 0)
    {
      continue;
    }
    merged[i] = i;
    all.within(x.row(i), rounding, near);
    for (const Index j : near)
    {
      merged[j] = merged[j] < 0 ? i : merged[j];
    }
  }
  return merged;
}

std::vector<TargetTriangle> mergedTriangles(
  const Points& x, const std::vector<TargetTriangle>& triangles, const std::vector<Index>& merged)
{
  std::vector<TargetTriangle> result;
  for (const auto& [a, b, c] : triangles)
  {
    const TargetTriangle t = { merged[a], merged[b], merged[c] };
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
    {
      result.push_back(t);
    }
  }
  return cleanTriangles(x, result, roundingOf(x));
}

BoundaryFaces facesOf(const std::vector<TargetTriangle>& triangles)
{
  BoundaryFaces faces;
  for (const TargetTriangle& triangle : triangles)
  {
    faces.add(triangle.begin(), triangle.end());
  }
  faces.takeNodes();
  return faces;
}

/// Throws for places where digits are lost: none of a mesh's motion would be left.
void requireUsable(const Points& x, const Points& mesh)
{
  constexpr double Farthest = 1e5; // sizes of the mesh
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < mesh.rows(); ++i)
  {
    box.extend(mesh.row(i).transpose());
  }
  std::vector<Index> notFinite, far;
  for (Index i = 0; i < x.rows(); ++i)
  {
    if (!x.row(i).allFinite())
    {
      notFinite.push_back(i);
    }
    else if (box.exteriorDistance(x.row(i).transpose()) > Farthest * box.diagonal().norm())
    {
      far.push_back(i);
    }
  }
  if (!notFinite.empty())
  {
    throw Error("The target surface has coordinates that are not finite (NaN or infinite), "
                "at its points " +
                listIds(notFinite) + ".");
  }
  if (!far.empty())
  {
    throw Error("The target surface is farther from the mesh than 100,000 times its size, "
                "at its points " +
                listIds(far) + ". Give it the unit and the origin of the mesh.");
  }
}

}

struct Target::Implementation
{
  Points points;
  std::vector<TargetTriangle> triangles;
  Options options;
  double cosine = 0; ///< of the largest angle between normals
  Classification geometry;
  std::unique_ptr<TriangleTree> all;
  /// by the target's surfaces, where one was asked for
  std::vector<std::unique_ptr<TriangleTree>> parts;
  std::vector<const TriangleTree*> ofSurface; ///< by the mesh's surfaces
  std::unique_ptr<TriangleTree> features;     ///< edges, as flat triangles; null where none is
  double sign = 1;

  std::unique_ptr<TriangleTree> treeOf(const std::vector<Index>& some) const
  {
    std::vector<TriangleTree::Triangle> corners;
    for (const Index t : some)
    {
      const auto& [a, b, c] = this->triangles[t];
      corners.push_back({ this->points.row(a), this->points.row(b), this->points.row(c) });
    }
    return std::make_unique<TriangleTree>(std::move(corners));
  }
  /// Whether there is one. A place `y` that was found as near to `x` as rounding is `x` itself.
  bool take(const TriangleTree::Found& found, const Row& x, Row& y) const
  {
    y = found.triangle >= 0 && (found.place - x).norm() > this->options.rounding ? found.place : x;
    return found.triangle >= 0;
  }
  auto fits(const TriangleTree& place, const Row& normal) const
  {
    return [this, &place, normal](Index triangle)
    { return normal.isZero(0) || this->sign * place.normal(triangle).dot(normal) >= this->cosine; };
  }

  /// Adds one to the count of each of the target's surfaces within `distance` of `x`.
  void vote(const Row& x, double distance, std::vector<Index>& count) const
  {
    std::vector<Index> candidates; // of the triangles whose boxes are near
    const auto collect = [&](Index triangle)
    {
      candidates.push_back(this->geometry.surfaceOfFace[triangle]);
      return false;
    };
    this->all->nearest(x, distance, collect);
    sortUnique(candidates);
    for (const Index s : candidates)
    {
      const auto belongs = [&](Index triangle)
      { return this->geometry.surfaceOfFace[triangle] == s; };
      count[s] += this->all->nearest(x, distance, belongs).triangle >= 0;
    }
  }

  const TriangleTree* part(Index surface)
  {
    std::unique_ptr<TriangleTree>& part = this->parts[surface];
    if (!part)
    {
      part = this->treeOf(this->geometry.surfaces[surface].faces);
    }
    return part.get();
  }
};

Target::Target(const Points& points, const std::vector<TargetTriangle>& triangles,
  const Points& mesh, const Options& options, Monitor& monitor)
  : implementation_(new Implementation)
{
  Implementation& own = *this->implementation_;
  own.options = options;
  own.cosine = std::cos(options.normalAngle * std::acos(-1.) / 180);
  own.points = points;
  requireUsable(points, mesh);
  own.triangles = mergedTriangles(points, triangles, mergedPoints(points));
  if (own.triangles.empty())
  {
    throw Error("The target surface has no polygons to project onto (it has " +
                std::to_string(points.rows()) + " points).");
  }
  std::vector<Index> all = consecutive(own.triangles.size());
  own.all = own.treeOf(all);

  ClassificationOptions classification;
  classification.featureAngle = options.featureAngle;
  own.geometry = classify(points, facesOf(own.triangles), classification, monitor);
  own.parts.resize(own.geometry.surfaces.size());
  std::vector<TriangleTree::Triangle> edges;
  for (const GeometryCurve& curve : own.geometry.curves)
  {
    const std::size_t n = curve.nodes.size();
    for (std::size_t i = 0; i + 1 < n + curve.loop; ++i)
    {
      const Row end = points.row(curve.nodes[(i + 1) % n]);
      edges.push_back({ points.row(curve.nodes[i]), end, end });
    }
  }
  if (!edges.empty())
  {
    own.features = std::make_unique<TriangleTree>(std::move(edges));
  }
}

Target::~Target() = default;

void Target::orient(const Points& points, const Points& normals)
{
  Implementation& own = *this->implementation_;
  std::vector<Index> voters;
  for (Index i = 0; i < points.rows(); ++i)
  {
    if (!normals.row(i).isZero(0))
    {
      voters.push_back(i);
    }
  }
  Index agree = 0, disagree = 0;
  const std::size_t stride = 1 + voters.size() / 2000; // a sample is enough
  for (std::size_t k = 0; k < voters.size(); k += stride)
  {
    const Index i = voters[k];
    const Index triangle = own.all->nearest(points.row(i), own.options.reach).triangle;
    const double cosine = own.all->normal(triangle).dot(normals.row(i));
    agree += cosine > 0.5;
    disagree += cosine < -0.5;
  }
  own.sign = disagree > agree ? -1 : 1;
}

void Target::assign(const Classification& geometry, const Points& moved)
{
  Implementation& own = *this->implementation_;
  const double size = (own.points.colwise().maxCoeff() - own.points.colwise().minCoeff()).norm();
  own.ofSurface.assign(geometry.surfaces.size(), nullptr);
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    std::vector<Index> votes(own.geometry.surfaces.size(), 0);
    Index voters = 0;
    for (const Index node : geometry.surfaces[s].nodes)
    {
      if (geometry.dimension[node] < 2)
      {
        ++voters;
        own.vote(moved.row(node), 1e-3 * size, votes);
      }
    }
    const auto best = std::max_element(votes.begin(), votes.end());
    if (best != votes.end() && 2 * *best > voters &&
        std::count(votes.begin(), votes.end(), *best) == 1)
    {
      own.ofSurface[s] = own.part(best - votes.begin());
    }
  }
}

bool Target::hasFeatures() const
{
  return this->implementation_->features != nullptr;
}

const Target::Options& Target::options() const
{
  return this->implementation_->options;
}

const Points& Target::points() const
{
  return this->implementation_->points;
}

const std::vector<TargetTriangle>& Target::triangles() const
{
  return this->implementation_->triangles;
}

const TriangleTree& Target::tree() const
{
  return *this->implementation_->all;
}

bool Target::closestOnVertices(const Row& x, Row& y) const
{
  const Implementation& own = *this->implementation_;
  double least = own.options.reach;
  TriangleTree::Found best{ -1, x };
  for (const GeometryVertex& vertex : own.geometry.vertices)
  {
    const Row place = own.points.row(vertex.node);
    const double distance = (place - x).norm();
    if (distance < least || (best.triangle < 0 && distance <= least))
    {
      least = distance;
      best = { vertex.node, place };
    }
  }
  return own.take(best, x, y);
}

bool Target::closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const
{
  const Implementation& own = *this->implementation_;
  const bool isAssigned = surface >= 0 && !own.ofSurface.empty();
  const TriangleTree* assigned = isAssigned ? own.ofSurface[surface] : nullptr;
  const TriangleTree& place = assigned ? *assigned : *own.all;
  return own.take(place.nearest(x, own.options.reach, own.fits(place, normal)), x, y);
}

bool Target::closestAlong(const Row& x, const Row& direction, const Row& normal, Row& y) const
{
  const Implementation& own = *this->implementation_;
  // Of the rounding of the points.
  constexpr double Wider = 4;
  return own.take(own.all->nearestAlong(x, direction, own.options.reach,
                    Wider * roundingOf(own.points), own.fits(*own.all, normal)),
    x, y);
}

bool Target::closestOnFeatures(Index, const Row& x, Row& y) const
{
  const Implementation& own = *this->implementation_;
  return own.features && own.take(own.features->nearest(x, own.options.reach), x, y);
}
}
