// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HangingNodes.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Support/Buckets.h"
#include "Support/Parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>

namespace morph
{
namespace
{
constexpr Index FaceGrain = 256;
/// Of a face's size: how far a node may be off it, and a vector area off that of the small faces.
constexpr double OnFace = 1e-6;

/// The shape functions of a triangle or quadrilateral, in the order of its corners.
using FaceWeights = std::array<double, 4>;

/// Finds the small faces in a large one.
class DividedFaces
{
public:
  DividedFaces(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
    : mesh_(mesh)
    , faces_(faces)
    , area_(static_cast<Index>(faces.cells.size()), 3)
  {
    parallel(this->area_.rows(), monitor,
      [&](Index f)
      {
        const Eigen::RowVector3d origin = this->place(f, 0);
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (Index k = 2; k < this->size(f); ++k)
        {
          sum += (this->place(f, k - 1) - origin).cross(this->place(f, k) - origin) / 2;
        }
        this->area_.row(f) = sum;
      });
    this->ofNode_ = sortIntoBuckets(this->area_.rows(), mesh.numberOfNodes(), monitor,
      [&](Index first, Index last, const auto& add)
      {
        for (Index f = first; f < last; ++f)
        {
          std::for_each(this->begin(f), this->end(f), [&](Index node) { add(node, f); });
        }
      });
  }

  const Index* begin(Index f) const
  {
    return this->faces_.connectivity.data() + this->faces_.offsets[f];
  }
  const Index* end(Index f) const
  {
    return this->faces_.connectivity.data() + this->faces_.offsets[f + 1];
  }
  Index size(Index f) const { return this->faces_.offsets[f + 1] - this->faces_.offsets[f]; }
  bool isCorner(Index f, Index node) const
  {
    return std::find(this->begin(f), this->end(f), node) != this->end(f);
  }

  /// Returns the faces that lie in `f` and fill it, ascending; none if there are no such.
  std::vector<Index> parts(Index f) const
  {
    std::vector<Index> found;
    if (!this->isLinear(f))
    {
      return found;
    }
    const auto addAround = [&](Index node)
    {
      std::for_each(this->ofNode_.begin(node), this->ofNode_.end(node),
        [&](Index g)
        {
          if (this->isPart(g, f) && std::find(found.begin(), found.end(), g) == found.end())
          {
            found.push_back(g);
          }
        });
    };
    std::for_each(this->begin(f), this->end(f), addAround);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      const Index part = found[i];
      std::for_each(this->begin(part), this->end(part), addAround);
    }
    // Surfaces with the same rim have the same vector area.
    Eigen::RowVector3d rest = this->area_.row(f);
    for (const Index part : found)
    {
      rest += this->area_.row(part);
    }
    const bool hasCorners = std::all_of(this->begin(f), this->end(f),
      [&](Index corner)
      {
        return std::any_of(
          found.begin(), found.end(), [&](Index part) { return this->isCorner(part, corner); });
      });
    if (!hasCorners || rest.norm() > OnFace * this->area_.row(f).norm())
    {
      found.clear();
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Returns the weights of the corners of `f` at a place on it, or nothing off it.
  std::optional<FaceWeights> weights(Index f, const Eigen::RowVector3d& x) const
  {
    const Eigen::RowVector3d origin = this->place(f, 0);
    const bool isTriangle = this->size(f) == 3;
    // origin + u a + v b + u v c
    const Eigen::RowVector3d a = this->place(f, 1) - origin,
                             b = this->place(f, isTriangle ? 2 : 3) - origin;
    const Eigen::RowVector3d c = isTriangle
                                   ? Eigen::RowVector3d::Zero()
                                   : Eigen::RowVector3d(this->place(f, 2) - origin - a - b);
    constexpr int Steps = 20; // of Gauss and Newton; one for a parallelogram
    double u = 0.5, v = 0.5;
    Eigen::Vector3d off;
    for (int step = 0; step < Steps; ++step)
    {
      Eigen::Matrix<double, 3, 2> tangents;
      tangents << (a + v * c).transpose(), (b + u * c).transpose();
      off = (x - origin - u * a - v * b - u * v * c).transpose();
      const Eigen::Vector2d change = tangents.colPivHouseholderQr().solve(off);
      u += change[0];
      v += change[1];
      if (!(change.norm() > 1e-15))
      {
        break;
      }
    }
    off = (x - origin - u * a - v * b - u * v * c).transpose();
    for (double* value : { &u, &v })
    {
      *value = std::abs(*value) < OnFace ? 0 : std::abs(*value - 1) < OnFace ? 1 : *value;
    }
    FaceWeights N = isTriangle ? FaceWeights{ 1 - u - v, u, v, 0 }
                               : FaceWeights{ (1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v };
    if (isTriangle && std::abs(N[0]) < OnFace)
    {
      N = { 0, u, 1 - u, 0 };
    }
    const double size = std::sqrt(this->area_.row(f).norm());
    const bool isOn = off.norm() <= OnFace * size &&
                      std::all_of(N.begin(), N.end(), [](double weight) { return weight >= 0; });
    return isOn ? std::make_optional(N) : std::nullopt;
  }

private:
  Eigen::RowVector3d place(Index f, Index corner) const
  {
    return this->mesh_.points.row(this->begin(f)[corner]);
  }
  bool isLinear(Index f) const
  {
    const CellShape& shape = *cellShape(this->mesh_, this->faces_.cells[f]);
    return shape.numberOfNodes == shape.numberOfCorners;
  }
  /// Whether `g` lies in `f`, on its other side.
  bool isPart(Index g, Index f) const
  {
    const auto own = this->area_.row(g), all = this->area_.row(f);
    if (!(own.dot(all) < 0 && own.squaredNorm() < (1 - OnFace) * all.squaredNorm()) ||
        this->faces_.cells[g] == this->faces_.cells[f] || !this->isLinear(g))
    {
      return false;
    }
    return std::all_of(this->begin(g), this->end(g),
      [&](Index node)
      { return this->isCorner(f, node) || this->weights(f, this->mesh_.points.row(node)); });
  }

  const Mesh& mesh_;
  const BoundaryFaces& faces_;
  Points area_; ///< vector areas, outward
  Adjacency ofNode_;
};

/// The nodes on edges, whose ends ascend, and how far they are from the first end, in its lengths.
using NodesOnEdges = std::map<std::pair<Index, Index>, std::map<Index, double>>;

/// Adds nodes on a part of an edge to the edge, and those of an edge to its parts: each may have
/// been found at another face.
void complete(NodesOnEdges& onEdge)
{
  for (bool isChanged = true; isChanged;)
  {
    isChanged = false;
    const NodesOnEdges before = onEdge;
    for (const auto& [edge, nodes] : before)
    {
      std::vector<std::pair<double, Index>> chain = { { 0, edge.first }, { 1, edge.second } };
      for (const auto& [node, at] : nodes)
      {
        chain.emplace_back(at, node);
      }
      std::sort(chain.begin(), chain.end());
      const std::size_t count = chain.size();
      for (std::size_t i = 0; i < count; ++i)
      {
        for (std::size_t j = i + 1; j < count && j - i + 1 < count; ++j)
        {
          const auto [from, first] = chain[i];
          const auto [to, last] = chain[j];
          const bool isReversed = first > last;
          const auto part = std::minmax(first, last);
          for (std::size_t k = i + 1; k < j; ++k)
          {
            const double at = (chain[k].first - from) / (to - from);
            isChanged |= onEdge[part].emplace(chain[k].second, isReversed ? 1 - at : at).second;
          }
          const auto found = before.find(part);
          if (found != before.end())
          {
            for (const auto& [node, at] : found->second)
            {
              const double along = from + (isReversed ? 1 - at : at) * (to - from);
              isChanged |= onEdge[edge].emplace(node, along).second;
            }
          }
        }
      }
    }
  }
}

/// What a node is tied to, and by what weights.
using Tie = std::map<Index, double>;

/// Replaces nodes in ties that are tied themselves.
void resolve(std::map<Index, Tie>& ties)
{
  constexpr int MostLevels = 64; // each at most half as large
  bool isResolved = false;
  for (int level = 0; level < MostLevels && !isResolved; ++level)
  {
    isResolved = true;
    for (auto& [node, tie] : ties)
    {
      Tie flat;
      for (const auto& [master, weight] : tie)
      {
        const auto other = ties.find(master);
        if (other == ties.end())
        {
          flat[master] += weight;
          continue;
        }
        isResolved = false;
        for (const auto& [above, share] : other->second)
        {
          flat[above] += weight * share;
        }
      }
      tie = std::move(flat);
    }
  }
}
}

std::vector<std::uint8_t> HangingNodes::find(
  const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
{
  *this = HangingNodes();
  const Index count = static_cast<Index>(faces.cells.size());
  if (hasPolyhedra(mesh))
  {
    return {};
  }
  const DividedFaces divided(mesh, faces, monitor);
  std::vector<std::vector<Index>> parts(count);
  parallel(count, FaceGrain, monitor, [&](Index f) { parts[f] = divided.parts(f); });
  monitor.check();

  std::vector<std::uint8_t> isInside(count, 0);
  std::map<Index, Tie> ties;
  NodesOnEdges onEdge;
  for (Index f = 0; f < count; ++f)
  {
    if (parts[f].empty())
    {
      continue;
    }
    isInside[f] = 1;
    std::vector<Polygon>& polygons = this->covers_[{ faces.cells[f], faces.sides[f] }];
    for (const Index part : parts[f])
    {
      isInside[part] = 1;
      polygons.emplace_back(std::make_reverse_iterator(divided.end(part)),
        std::make_reverse_iterator(divided.begin(part)));
      for (const Index* node = divided.begin(part); node != divided.end(part); ++node)
      {
        if (divided.isCorner(f, *node))
        {
          continue;
        }
        const FaceWeights N = *divided.weights(f, mesh.points.row(*node));
        Tie tie;
        for (Index k = 0; k < divided.size(f); ++k)
        {
          if (N[k] > 0)
          {
            tie[divided.begin(f)[k]] = N[k];
          }
        }
        if (tie.size() == 2)
        {
          onEdge[{ tie.begin()->first, tie.rbegin()->first }].emplace(*node, tie.rbegin()->second);
        }
        // On an edge of one face and inside another, the edge is what all sides have.
        const auto [known, isNew] = ties.try_emplace(*node, tie);
        if (!isNew && tie.size() < known->second.size())
        {
          known->second = std::move(tie);
        }
      }
    }
  }
  if (this->covers_.empty())
  {
    return {};
  }
  complete(onEdge);
  for (const auto& [edge, nodes] : onEdge)
  {
    std::vector<std::pair<double, Index>> sorted;
    for (const auto& [node, at] : nodes)
    {
      sorted.emplace_back(at, node);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [at, node] : sorted)
    {
      this->onEdge_[edge].push_back(node);
    }
  }
  resolve(ties);
  std::vector<Eigen::Triplet<double, int>> entries;
  for (const auto& [node, tie] : ties)
  {
    for (const auto& [master, weight] : tie)
    {
      entries.emplace_back(static_cast<int>(this->ids_.size()), static_cast<int>(master), weight);
    }
    this->ids_.push_back(node);
  }
  this->weights_.resize(static_cast<Index>(this->ids_.size()), mesh.numberOfNodes());
  this->weights_.setFromTriplets(entries.begin(), entries.end());
  return isInside;
}

bool HangingNodes::hangs(Index node) const
{
  return std::binary_search(this->ids_.begin(), this->ids_.end(), node);
}

NodePartition HangingNodes::extend(NodePartition partition) const
{
  std::vector<Index> more;
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    bool isGiven = true;
    using Masters = Eigen::SparseMatrix<double, Eigen::RowMajor, int>::InnerIterator;
    for (Masters master(this->weights_, static_cast<Index>(i)); master; ++master)
    {
      isGiven = isGiven && std::binary_search(partition.prescribed.begin(),
                             partition.prescribed.end(), static_cast<Index>(master.col()));
    }
    if (isGiven)
    {
      more.push_back(this->ids_[i]);
    }
  }
  std::vector<Index> prescribed, free;
  std::set_union(partition.prescribed.begin(), partition.prescribed.end(), more.begin(), more.end(),
    std::back_inserter(prescribed));
  std::set_difference(partition.free.begin(), partition.free.end(), more.begin(), more.end(),
    std::back_inserter(free));
  partition.prescribed = std::move(prescribed);
  partition.free = std::move(free);
  return partition;
}

std::vector<Index> HangingNodes::without(const std::vector<Index>& ids) const
{
  std::vector<Index> result;
  std::copy_if(
    ids.begin(), ids.end(), std::back_inserter(result), [&](Index id) { return !this->hangs(id); });
  return result;
}

void HangingNodes::apply(Points& displacement) const
{
  if (!this->ids_.empty())
  {
    const Points tied = this->weights_ * displacement;
    displacement(this->ids_, allColumns) = tied;
  }
}

void HangingNodes::applyTranspose(Points& gradient) const
{
  if (!this->ids_.empty())
  {
    const Points own = gradient(this->ids_, allColumns);
    gradient(this->ids_, allColumns).setZero();
    gradient += this->weights_.transpose() * own;
  }
}

void HangingNodes::place(const Points& rest, Points& moved) const
{
  if (this->ids_.empty())
  {
    return;
  }
  Points displacement = moved - rest;
  this->apply(displacement);
  for (const Index node : this->ids_)
  {
    moved.row(node) = rest.row(node) + displacement.row(node);
  }
}

void HangingNodes::divideEdges(Polygon& polygon) const
{
  Polygon all;
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Index from = polygon[k], to = polygon[(k + 1) % polygon.size()];
    all.push_back(from);
    const auto found = this->onEdge_.find({ std::min(from, to), std::max(from, to) });
    if (found != this->onEdge_.end())
    {
      std::vector<Index> nodes = found->second;
      if (from > to)
      {
        std::reverse(nodes.begin(), nodes.end());
      }
      all.insert(all.end(), nodes.begin(), nodes.end());
    }
  }
  polygon = std::move(all);
}

void HangingNodes::divideEdges(BoundaryFaces& faces) const
{
  std::vector<Index> offsets = { 0 }, connectivity;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    Polygon polygon(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
    this->divideEdges(polygon);
    connectivity.insert(connectivity.end(), polygon.begin(), polygon.end());
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  faces.offsets = std::move(offsets);
  faces.connectivity = std::move(connectivity);
}

Mesh HangingNodes::conforming(const Mesh& mesh) const
{
  if (this->empty())
  {
    return mesh;
  }
  std::vector<std::uint8_t> isEnd(mesh.numberOfNodes(), 0);
  for (const auto& [edge, nodes] : this->onEdge_)
  {
    isEnd[edge.first] = isEnd[edge.second] = 1;
  }
  Mesh result;
  result.points = mesh.points;
  result.types = mesh.types;
  result.offsets = { 0 };
  result.faceOffsets = { 0 };
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index *begin = mesh.cell(c), *end = begin + mesh.cellSize(c);
    std::vector<Index> nodes(begin, end);
    const CellShape* shape = cellShape(mesh, c);
    const auto cover = this->covers_.lower_bound({ c, 0 });
    const bool isCovered = cover != this->covers_.end() && cover->first.first == c;
    const bool isVolume =
      shape && shape->dimension == 3 && shape->numberOfNodes == shape->numberOfCorners;
    if (isVolume && (isCovered || std::count_if(begin, end, [&](Index n) { return isEnd[n]; }) > 1))
    {
      std::vector<Polygon> polygons;
      bool isDivided = isCovered;
      for (int side = 0; side < shape->numberOfFaces; ++side)
      {
        const FaceShape& face = shape->faces[side];
        Polygon corners;
        for (int k = 0; k < face.size; ++k)
        {
          const Index node = begin[shape->cornerNode[face.corner[k]]];
          if (std::find(corners.begin(), corners.end(), node) == corners.end())
          {
            corners.push_back(node);
          }
        }
        const auto parts = this->covers_.find({ c, side });
        const std::vector<Polygon> own =
          parts == this->covers_.end() ? std::vector<Polygon>{ corners } : parts->second;
        for (Polygon polygon : own)
        {
          const std::size_t before = polygon.size();
          this->divideEdges(polygon);
          isDivided = isDivided || polygon.size() > before;
          if (polygon.size() > 2) // else it is collapsed
          {
            polygons.push_back(std::move(polygon));
          }
        }
      }
      if (isDivided)
      {
        result.types[c] = Polyhedron;
        for (const Polygon& polygon : polygons)
        {
          result.faces.push_back(static_cast<Index>(polygon.size()));
          result.faces.insert(result.faces.end(), polygon.begin(), polygon.end());
          nodes.insert(nodes.end(), polygon.begin(), polygon.end());
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      }
    }
    result.connectivity.insert(result.connectivity.end(), nodes.begin(), nodes.end());
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
    result.faceOffsets.push_back(static_cast<Index>(result.faces.size()));
  }
  return result;
}
}
