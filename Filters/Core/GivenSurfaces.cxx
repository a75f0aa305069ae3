// SPDX-License-Identifier: BSD-3-Clause
#include "GivenSurfaces.h"

#include "Error.h"

#include <algorithm>
#include <tuple>

namespace morph
{
namespace
{
/// Whether an edge between these nodes may lie on a curve.
bool mayShareCurve(const GivenGeometry& given, const std::array<Index, 2>& nodes)
{
  const int a = given.dimension[nodes[0]], b = given.dimension[nodes[1]];
  return a < 2 && b < 2 && (a == 0 || b == 0 || given.id[nodes[0]] == given.id[nodes[1]]);
}

/// From the surface nodes of each face.
std::vector<Index> fromNodes(const BoundaryFaces& faces, const GivenGeometry& given)
{
  const Index count = static_cast<Index>(faces.offsets.size()) - 1;
  std::vector<Index> result(count, NoGeometry), torn;
  for (Index f = 0; f < count; ++f)
  {
    for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
    {
      const Index node = faces.connectivity[k];
      if (given.dimension[node] != 2)
      {
        continue;
      }
      if (result[f] != NoGeometry && result[f] != given.id[node])
      {
        torn.push_back(node);
      }
      result[f] = given.id[node];
    }
  }
  if (!torn.empty())
  {
    std::sort(torn.begin(), torn.end());
    torn.erase(std::unique(torn.begin(), torn.end()), torn.end());
    throw Error(
      "Nodes are given to a surface, but share a boundary face with a node given to "
      "another surface: node ids " +
      listIds(torn) +
      ". Give the nodes where surfaces meet to a curve (dimension 1) or vertex (dimension 0).");
  }
  return result;
}

/// One round: faces without an id take a neighbor's. `overCurves`: over edges that may lie on a curve but are no feature,
/// else over those that cannot. Returns whether any did.
bool spread(const SurfaceEdges& edges, const ClassificationOptions& options, bool overCurves,
  std::vector<Index>& id)
{
  std::vector<std::pair<Index, Index>> found; // face, id
  for (Index f = 0; f < static_cast<Index>(id.size()); ++f)
  {
    std::tuple<double, Index> best(181, NoGeometry);
    for (const Index* e = edges.ofFace.begin(f); id[f] == NoGeometry && e != edges.ofFace.end(f);
         ++e)
    {
      const Index* at = edges.faces.begin(*e);
      if (edges.faces.end(*e) - at != 2 ||
          mayShareCurve(options.given, edges.nodes[*e]) != overCurves ||
          (overCurves && !(edges.angle[*e] <= options.featureAngle)))
      {
        continue;
      }
      const Index other = id[at[0] == f ? at[1] : at[0]];
      if (other != NoGeometry)
      {
        best = std::min(best, std::make_tuple(edges.angle[*e], other));
      }
    }
    if (std::get<1>(best) != NoGeometry)
    {
      found.emplace_back(f, std::get<1>(best));
    }
  }
  for (const auto& [face, surface] : found)
  {
    id[face] = surface;
  }
  return !found.empty();
}
}

std::vector<Index> givenSurfaces(
  const BoundaryFaces& faces, const SurfaceEdges& edges, const ClassificationOptions& options)
{
  if (options.given.dimension.empty() || !options.given.surface.empty())
  {
    return options.given.surface;
  }
  std::vector<Index> id = fromNodes(faces, options.given);
  while (spread(edges, options, false, id) || spread(edges, options, true, id))
  {
  }
  return id;
}

void markGivenSeams(const ConstPoints& points, const SurfaceEdges& edges,
  const ClassificationOptions& options, SurfacePatches& patches)
{
  const GivenGeometry& given = options.given;
  if (given.dimension.empty())
  {
    return;
  }
  const std::vector<std::uint8_t> before = patches.isCurve;
  std::vector<std::vector<Index>> curvesAt(given.dimension.size()); // curve edges
  const auto mark = [&](Index e)
  {
    patches.isCurve[e] = 1;
    for (Index node : edges.nodes[e])
    {
      curvesAt[node].push_back(e);
    }
  };
  for (Index e = 0; e < edges.count(); ++e)
  {
    if (before[e])
    {
      mark(e);
    }
  }
  const std::vector<std::vector<Index>> atFirst = curvesAt;
  std::vector<std::vector<Index>> toVertex(given.dimension.size()); // edges that may end a curve
  for (Index e = 0; e < edges.count(); ++e)
  {
    const Index a = edges.nodes[e][0], b = edges.nodes[e][1];
    if (before[e] || !mayShareCurve(given, edges.nodes[e]))
    {
      continue;
    }
    const int onCurve = (given.dimension[a] == 1) + (given.dimension[b] == 1);
    if (onCurve == 1)
    {
      toVertex[given.dimension[a] == 1 ? a : b].push_back(e);
    }
    else if (onCurve == 2 ? atFirst[a].size() < 2 && atFirst[b].size() < 2
                          : edges.angle[e] > options.featureAngle)
    {
      mark(e);
    }
  }
  const auto away = [&](Index e, Index node) -> Eigen::RowVector3d
  {
    const auto& ends = edges.nodes[e];
    return (points.row(ends[0] == node ? ends[1] : ends[0]) - points.row(node)).normalized();
  };
  for (std::size_t i = 0; i < toVertex.size(); ++i)
  {
    const Index node = static_cast<Index>(i);
    while (!toVertex[i].empty() && curvesAt[i].size() < 2)
    {
      // The straightest pair of edges: with the curve's own, or of two candidates.
      std::tuple<double, Index> best(2, -1);
      for (Index e : toVertex[i])
      {
        for (Index other : curvesAt[i].empty() ? toVertex[i] : curvesAt[i])
        {
          const double cosine = e == other ? 1.5 : away(e, node).dot(away(other, node));
          best = std::min(best, std::make_tuple(cosine, e));
        }
      }
      const Index chosen = std::get<1>(best);
      toVertex[i].erase(
        std::remove(toVertex[i].begin(), toVertex[i].end(), chosen), toVertex[i].end());
      mark(chosen);
    }
  }
}
}
