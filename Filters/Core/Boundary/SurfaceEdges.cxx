// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/SurfaceEdges.h"

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
struct Side
{
  Index low, high, face, place;
  bool forward; ///< the face runs from `low` to `high`

  bool operator<(const Side& other) const
  {
    return std::tie(this->low, this->high, this->face, this->place) <
           std::tie(other.low, other.high, other.face, other.place);
  }
};

std::vector<Side> sides(const BoundaryFaces& faces)
{
  std::vector<Side> result;
  result.reserve(faces.connectivity.size());
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
    for (Index k = 0; k < size; ++k)
    {
      const Index a = faces.connectivity[first + k];
      const Index b = faces.connectivity[first + (k + 1) % size];
      result.push_back({ std::min(a, b), std::max(a, b), static_cast<Index>(f), k, a < b });
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Returns unit normals; zero for faces without area.
Points normals(const ConstPoints& points, const BoundaryFaces& faces)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  Points result = Points::Zero(count, 3);
  for (Index f = 0; f < count; ++f)
  {
    const Index* nodes = faces.connectivity.data() + faces.offsets[f];
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    double longest = 0;
    for (Index k = 0; k < size; ++k)
    {
      longest =
        std::max(longest, (points.row(nodes[(k + 1) % size]) - points.row(nodes[k])).squaredNorm());
    }
    const Eigen::RowVector3d area = vectorArea(points, nodes, size);
    // Below this thickness, rounding determines the normal.
    if (area.norm() > 1e-10 * longest)
    {
      result.row(f) = area.normalized();
    }
  }
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
    std::sort(flat.begin(), flat.end());
    flat.erase(std::unique(flat.begin(), flat.end()), flat.end());
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

SurfaceEdges surfaceEdges(const ConstPoints& points, const BoundaryFaces& faces)
{
  SurfaceEdges result;
  const std::vector<Side> all = sides(faces);
  result.ofFace.offsets = faces.offsets;
  result.ofFace.values.resize(all.size());
  result.faces.offsets.push_back(0);
  std::vector<Meeting> meeting;
  for (std::size_t i = 0; i < all.size();)
  {
    std::size_t end = i;
    for (; end < all.size() && all[end].low == all[i].low && all[end].high == all[i].high; ++end)
    {
      result.ofFace.values[faces.offsets[all[end].face] + all[end].place] = result.count();
      result.faces.values.push_back(all[end].face);
    }
    const bool manifold = end == i + 2;
    meeting.push_back({ { manifold ? all[i].face : -1, manifold ? all[i + 1].face : -1 },
      manifold && all[i].forward == all[i + 1].forward });
    result.nodes.push_back({ all[i].low, all[i].high });
    result.faces.offsets.push_back(static_cast<Index>(result.faces.values.size()));
    i = end;
  }

  Points normal = normals(points, faces);
  result.visits = fillNormals(points, result, meeting, normal);
  for (const Meeting& at : meeting)
  {
    result.angle.push_back(at.face[0] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                          : degreesBetween(normal.row(at.face[0]),
                                              normal.row(at.face[1]), at.sameDirection));
  }
  return result;
}
}
