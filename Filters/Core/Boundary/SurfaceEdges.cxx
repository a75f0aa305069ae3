// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/SurfaceEdges.h"

#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
/// A face's edge.
struct Side
{
  Index low, high, face;
  bool forward; ///< the face runs from `low` to `high`
};

/// The sides of all faces. Numbers of sides are those of the corners at which they start.
class Sides
{
public:
  Sides(const BoundaryFaces& faces, Monitor& monitor)
    : faces_(faces)
    , face_(faces.connectivity.size())
  {
    parallel(static_cast<Index>(faces.offsets.size()) - 1, monitor,
      [&](Index f)
      {
        std::fill(
          this->face_.begin() + faces.offsets[f], this->face_.begin() + faces.offsets[f + 1], f);
      });
  }

  Index size() const { return static_cast<Index>(this->face_.size()); }

  Side operator[](Index side) const
  {
    const Index face = this->face_[side], end = this->faces_.offsets[face + 1];
    const Index next = side + 1 < end ? side + 1 : this->faces_.offsets[face];
    const Index a = this->faces_.connectivity[side], b = this->faces_.connectivity[next];
    return { std::min(a, b), std::max(a, b), face, a < b };
  }

  /// Returns the numbers of all sides by lower node, higher node and number.
  std::vector<Index> sorted(Index nodes, Monitor& monitor) const
  {
    Adjacency byLow = sortIntoBuckets(this->size(), nodes, monitor,
      [this](Index first, Index last, const auto& add)
      {
        for (Index side = first; side < last; ++side)
        {
          add((*this)[side].low, side);
        }
      });
    parallel(nodes, monitor,
      [&](Index node)
      {
        std::stable_sort(byLow.values.begin() + byLow.offsets[node],
          byLow.values.begin() + byLow.offsets[node + 1],
          [this](Index a, Index b) { return (*this)[a].high < (*this)[b].high; });
      });
    return std::move(byLow.values);
  }

private:
  const BoundaryFaces& faces_;
  std::vector<Index> face_; ///< of each side
};

/// Returns a face's unit normal; zero for a face without area.
Eigen::RowVector3d normalOf(const ConstPoints& points, const BoundaryFaces& faces, Index face)
{
  const Index* nodes = faces.connectivity.data() + faces.offsets[face];
  const Index size = faces.offsets[face + 1] - faces.offsets[face];
  double longest = 0;
  for (Index k = 0; k < size; ++k)
  {
    longest =
      std::max(longest, (points.row(nodes[(k + 1) % size]) - points.row(nodes[k])).squaredNorm());
  }
  const Eigen::RowVector3d area = vectorArea(points, nodes, size);
  // Below this thickness, rounding determines the normal.
  return area.norm() > 1e-10 * longest ? area.normalized() : Eigen::RowVector3d::Zero();
}

Points normals(const ConstPoints& points, const BoundaryFaces& faces, Monitor& monitor)
{
  Points result(static_cast<Index>(faces.offsets.size()) - 1, 3);
  parallel(result.rows(), monitor, [&](Index f) { result.row(f) = normalOf(points, faces, f); });
  return result;
}

/// Two faces at an edge.
struct Meeting
{
  Index face[2];
  bool sameDirection; ///< both run through the edge in one direction: their windings are opposite
};

/// Gives faces without area the normal of their neighbor at the longest edge that has one, in
/// rounds. After the first round only neighbors of faces that the last round changed can change.
/// Returns the number of examinations.
Index fillNormals(const ConstPoints& points, const SurfaceEdges& edges,
  const std::vector<Meeting>& meeting, Points& normal)
{
  const auto across = [&](Index f, Index e)
  { return meeting[e].face[0] == f ? meeting[e].face[1] : meeting[e].face[0]; };
  Index visits = 0;
  std::vector<Index> flat;
  for (Index f = 0; f < normal.rows(); ++f)
  {
    if (normal.row(f).isZero(0))
    {
      flat.push_back(f);
    }
  }
  std::vector<std::pair<Index, Eigen::RowVector3d>> found;
  do
  {
    found.clear();
    visits += static_cast<Index>(flat.size());
    for (Index f : flat)
    {
      double longest = -1;
      for (const Index* e = edges.ofFace.begin(f); e != edges.ofFace.end(f); ++e)
      {
        const Meeting& at = meeting[*e];
        const Index other = across(f, *e);
        const auto& ends = edges.nodes[*e];
        const double length = (points.row(ends[0]) - points.row(ends[1])).squaredNorm();
        if (other >= 0 && !normal.row(other).isZero(0) && length > longest)
        {
          found.resize(found.size() + (longest < 0));
          found.back() = { f, normal.row(other) * (at.sameDirection ? -1 : 1) };
          longest = length;
        }
      }
    }
    for (const auto& [face, direction] : found)
    {
      normal.row(face) = direction;
    }
    flat.clear();
    for (const auto& [face, direction] : found)
    {
      for (const Index* e = edges.ofFace.begin(face); e != edges.ofFace.end(face); ++e)
      {
        const Index other = across(face, *e);
        if (other >= 0 && normal.row(other).isZero(0))
        {
          flat.push_back(other);
        }
      }
    }
    sortUnique(flat);
  } while (!flat.empty());
  return visits;
}

double degreesBetween(Eigen::RowVector3d a, const Eigen::RowVector3d& b, bool sameDirection)
{
  if (sameDirection)
  {
    a = -a; // neighbors of equal winding run through their edge in opposite directions
  }
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::acos(-1.);
}
}

Eigen::RowVector3d vectorArea(const ConstPoints& points, const Index* nodes, Index size)
{
  Eigen::RowVector3d area = Eigen::RowVector3d::Zero();
  const Eigen::RowVector3d origin = points.row(nodes[0]);
  for (Index k = 1; k + 1 < size; ++k)
  {
    const Eigen::RowVector3d a = points.row(nodes[k]) - origin;
    area += a.cross(points.row(nodes[k + 1]) - origin) / 2;
  }
  return area;
}

Index SurfaceEdges::find(Index a, Index b) const
{
  const std::array<Index, 2> key = { std::min(a, b), std::max(a, b) };
  const auto place = std::lower_bound(this->nodes.begin(), this->nodes.end(), key);
  return place != this->nodes.end() && *place == key ? place - this->nodes.begin() : -1;
}

SurfaceEdges surfaceEdges(const ConstPoints& points, const BoundaryFaces& faces, Monitor& monitor)
{
  SurfaceEdges result;
  const Sides sides(faces, monitor);
  const std::vector<Index> order = sides.sorted(points.rows(), monitor);
  result.ofFace.offsets = faces.offsets;
  result.ofFace.values.resize(order.size());
  result.faces.values.reserve(order.size());
  std::vector<Meeting> meeting;
  for (std::size_t i = 0; i < order.size();)
  {
    const Side first = sides[order[i]];
    Side last = first;
    std::size_t end = i;
    for (; end < order.size(); ++end)
    {
      const Side side = sides[order[end]];
      if (side.low != first.low || side.high != first.high)
      {
        break;
      }
      result.ofFace.values[order[end]] = result.count();
      result.faces.values.push_back(side.face);
      last = side;
    }
    const bool manifold = end == i + 2;
    meeting.push_back({ { manifold ? first.face : -1, manifold ? last.face : -1 },
      manifold && first.forward == last.forward });
    result.nodes.push_back({ first.low, first.high });
    result.faces.offsets.push_back(static_cast<Index>(result.faces.values.size()));
    i = end;
  }

  Points normal = normals(points, faces, monitor);
  result.visits = fillNormals(points, result, meeting, normal);
  result.angle.resize(meeting.size());
  parallel(static_cast<Index>(meeting.size()), monitor,
    [&](Index e)
    {
      const Meeting& at = meeting[e];
      result.angle[e] = at.face[0] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                       : degreesBetween(normal.row(at.face[0]),
                                           normal.row(at.face[1]), at.sameDirection);
    });
  return result;
}

namespace
{
class Tracer
{
public:
  Tracer(const SurfaceEdges& all, const std::vector<Index>& edges,
    const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles)
    : isVertex_(isVertex)
    , middles_(middles)
    , used_(all.count(), 0)
  {
    for (Index e : edges)
    {
      this->at_.push_back({ all.nodes[e][0], all.nodes[e][1], e });
      this->at_.push_back({ all.nodes[e][1], all.nodes[e][0], e });
    }
    std::sort(this->at_.begin(), this->at_.end());
  }

  std::vector<CurveChain> trace()
  {
    std::vector<CurveChain> chains;
    // Sorted by node: the lower of two vertices starts first, towards its lower neighbor.
    for (const Step& step : this->at_)
    {
      if (this->isVertex_[step.from] && !this->used_[step.edge])
      {
        chains.push_back(this->follow(step));
      }
    }
    for (const Step& step : this->at_)
    {
      if (!this->used_[step.edge])
      {
        chains.push_back(this->follow(step));
        chains.back().loop = true;
        // Mid-side nodes of the closing edge remain after the last corner; the first corner is not
        // repeated.
        chains.back().nodes.pop_back();
      }
    }
    std::sort(chains.begin(), chains.end(),
      [](const CurveChain& a, const CurveChain& b)
      {
        const auto key = [](const CurveChain& c)
        {
          return std::make_tuple(*std::min_element(c.nodes.begin(), c.nodes.end()),
            *std::min_element(c.edges.begin(), c.edges.end()));
        };
        return key(a) < key(b);
      });
    return chains;
  }

private:
  struct Step
  {
    Index from, to, edge;
    bool operator<(const Step& other) const
    {
      return std::tie(this->from, this->to) < std::tie(other.from, other.to);
    }
  };

  CurveChain follow(Step step)
  {
    const Index start = step.from;
    CurveChain chain;
    chain.nodes.push_back(start);
    while (true)
    {
      this->used_[step.edge] = 1;
      chain.edges.push_back(step.edge);
      this->appendMiddles(step.edge, chain);
      chain.nodes.push_back(step.to);
      if (this->isVertex_[step.to] || step.to == start)
      {
        return chain;
      }
      auto next = std::lower_bound(this->at_.begin(), this->at_.end(), Step{ step.to, -1, -1 });
      next += next->edge == step.edge; // two edges meet here: take the other one
      step = *next;
    }
  }

  void appendMiddles(Index edge, CurveChain& chain) const
  {
    for (auto m = std::lower_bound(
           this->middles_.begin(), this->middles_.end(), std::pair<Index, Index>(edge, -1));
         m != this->middles_.end() && m->first == edge; ++m)
    {
      chain.nodes.push_back(m->second);
    }
  }

  const std::vector<std::uint8_t>& isVertex_;
  const std::vector<std::pair<Index, Index>>& middles_;
  std::vector<std::uint8_t> used_;
  std::vector<Step> at_; ///< each curve edge from both of its ends
};
}

std::vector<CurveChain> curveChains(const SurfaceEdges& all, const std::vector<Index>& edges,
  const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles)
{
  return Tracer(all, edges, isVertex, middles).trace();
}

std::vector<double> arcLengthParameters(const ConstPoints& points, const CurveChain& chain)
{
  const std::size_t n = chain.nodes.size();
  std::vector<double> t(n, 0);
  const auto step = [&](std::size_t i, std::size_t j)
  { return (points.row(chain.nodes[j]) - points.row(chain.nodes[i])).norm(); };
  for (std::size_t i = 1; i < n; ++i)
  {
    t[i] = t[i - 1] + step(i - 1, i);
  }
  const double length = t.back() + (chain.loop ? step(n - 1, 0) : 0);
  const double pieces = static_cast<double>(chain.loop ? n : n - 1);
  for (std::size_t i = 0; i < n; ++i)
  {
    t[i] = length > 0 ? t[i] / length : static_cast<double>(i) / pieces;
  }
  return t;
}
}
