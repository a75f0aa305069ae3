// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/GivenSurfaces.h"

#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <tuple>

namespace morph
{
namespace
{
/// Whether an edge between these nodes may lie on a curve.
bool mayShareCurve(const GivenGeometry& given, const std::array<Index, 2>& nodes)
{
  const std::int8_t a = given.dimension[nodes[0]], b = given.dimension[nodes[1]];
  return a < 2 && b < 2 && (a == 0 || b == 0 || given.id[nodes[0]] == given.id[nodes[1]]);
}

/// Returns the id of each face from its surface nodes.
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
    sortUnique(torn);
    throw Error(
      "Nodes are given to a surface, but share a boundary face with a node given to "
      "another surface: node ids " +
      listIds(torn) +
      ". Give the nodes where surfaces meet to a curve (dimension 1) or vertex (dimension 0).");
  }
  return result;
}

/// The ids of the two faces at an edge; `found` is false if there are not two.
struct Beside
{
  bool found;
  Index face[2];
};

Beside beside(const SurfaceEdges& edges, Index e)
{
  const Index* at = edges.faces.begin(e);
  return edges.faces.end(e) - at == 2 ? Beside{ true, { at[0], at[1] } }
                                      : Beside{ false, { -1, -1 } };
}

/// Gives faces without an id a neighbor's over edges that `mayCross` allows, the flattest first, in
/// rounds. After the first round only neighbors of faces that the last round changed can change, so
/// each face is examined a few times. Returns the number of examinations.
template <typename MayCross>
Index spread(const SurfaceEdges& edges, const MayCross& mayCross, std::vector<Index>& id)
{
  Index visits = 0;
  std::vector<std::pair<Index, Index>> found; // face, id
  std::vector<Index> waiting = consecutive(id.size());
  do
  {
    found.clear();
    visits += static_cast<Index>(waiting.size());
    for (Index f : waiting)
    {
      std::tuple<double, Index> best(181, NoGeometry);
      for (const Index* e = edges.ofFace.begin(f); id[f] == NoGeometry && e != edges.ofFace.end(f);
           ++e)
      {
        const Beside at = beside(edges, *e);
        if (!at.found || !mayCross(*e))
        {
          continue;
        }
        const Index other = id[at.face[0] == f ? at.face[1] : at.face[0]];
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
    waiting.clear();
    for (const auto& [face, surface] : found)
    {
      for (const Index* e = edges.ofFace.begin(face); e != edges.ofFace.end(face); ++e)
      {
        const Beside at = beside(edges, *e);
        const Index other = at.face[0] == face ? at.face[1] : at.face[0];
        if (at.found && id[other] == NoGeometry)
        {
          waiting.push_back(other);
        }
      }
    }
    sortUnique(waiting);
  } while (!waiting.empty());
  return visits;
}

/// Step 3 of givenSurfaces().
class CurveFinder
{
public:
  CurveFinder(
    const ConstPoints& points, const SurfaceEdges& edges, const ClassificationOptions& options)
    : points_(points)
    , edges_(edges)
    , given_(options.given)
    , featureAngle_(options.featureAngle)
    , isCurve_(edges.count(), 0)
    , at_(points.rows())
  {
  }

  std::vector<std::uint8_t> find(const std::vector<Index>& id)
  {
    for (Index e = 0; e < this->edges_.count(); ++e)
    {
      const Beside at = beside(this->edges_, e);
      if (at.found && id[at.face[0]] != NoGeometry && id[at.face[1]] != NoGeometry &&
          id[at.face[0]] != id[at.face[1]])
      {
        this->mark(e);
      }
    }
    this->joinCurveNodes();
    this->endCurves();
    return std::move(this->isCurve_);
  }

private:
  void mark(Index e)
  {
    this->isCurve_[e] = 1;
    for (Index node : this->edges_.nodes[e])
    {
      this->at_[node].push_back(e);
    }
  }

  /// Returns unmarked edges that may lie on a curve and have `onCurve` ends that are given to one.
  std::vector<Index> candidates(int onCurve) const
  {
    std::vector<Index> result;
    for (Index e = 0; e < this->edges_.count(); ++e)
    {
      const auto& ends = this->edges_.nodes[e];
      const int count =
        (this->given_.dimension[ends[0]] == 1) + (this->given_.dimension[ends[1]] == 1);
      if (!this->isCurve_[e] && count == onCurve && mayShareCurve(this->given_, ends))
      {
        result.push_back(e);
      }
    }
    return result;
  }

  void joinCurveNodes()
  {
    std::vector<std::pair<double, Index>> byLength;
    for (Index e : this->candidates(2))
    {
      const auto& ends = this->edges_.nodes[e];
      byLength.emplace_back((this->points_.row(ends[0]) - this->points_.row(ends[1])).norm(), e);
    }
    std::sort(byLength.begin(), byLength.end());
    for (const auto& [length, e] : byLength)
    {
      const auto& ends = this->edges_.nodes[e];
      if (this->at_[ends[0]].size() < 2 && this->at_[ends[1]].size() < 2)
      {
        this->mark(e);
      }
    }
    for (Index e : this->candidates(0))
    {
      if (this->edges_.angle[e] > this->featureAngle_)
      {
        this->mark(e);
      }
    }
  }

  void endCurves()
  {
    std::vector<std::vector<Index>> toVertex(this->at_.size());
    for (Index e : this->candidates(1))
    {
      const auto& ends = this->edges_.nodes[e];
      toVertex[this->given_.dimension[ends[0]] == 1 ? ends[0] : ends[1]].push_back(e);
    }
    for (std::size_t i = 0; i < toVertex.size(); ++i)
    {
      std::vector<Index>& open = toVertex[i];
      while (!open.empty() && this->at_[i].size() < 2)
      {
        const Index chosen = this->straightest(static_cast<Index>(i), open);
        open.erase(std::remove(open.begin(), open.end(), chosen), open.end());
        this->mark(chosen);
      }
    }
  }

  /// Returns the candidate at a node that continues its curve edge, or another candidate, most
  /// nearly straight.
  Index straightest(Index node, const std::vector<Index>& open) const
  {
    const auto away = [&](Index e) -> Eigen::RowVector3d
    {
      const auto& ends = this->edges_.nodes[e];
      return (this->points_.row(ends[0] == node ? ends[1] : ends[0]) - this->points_.row(node))
        .normalized();
    };
    std::tuple<double, Index> best(2, -1);
    for (Index e : open)
    {
      for (Index other : this->at_[node].empty() ? open : this->at_[node])
      {
        best = std::min(best, std::make_tuple(e == other ? 1.5 : away(e).dot(away(other)), e));
      }
    }
    return std::get<1>(best);
  }

  const ConstPoints& points_;
  const SurfaceEdges& edges_;
  const GivenGeometry& given_;
  double featureAngle_;
  std::vector<std::uint8_t> isCurve_;
  std::vector<std::vector<Index>> at_; ///< #nodes, curve edges
};
}

GivenSurfaces givenSurfaces(const ConstPoints& points, const BoundaryFaces& faces,
  const SurfaceEdges& edges, const ClassificationOptions& options)
{
  GivenSurfaces result;
  const GivenGeometry& given = options.given;
  if (given.dimension.empty() || !given.surface.empty())
  {
    result.id = given.surface;
    return result;
  }
  result.id = fromNodes(faces, given);
  result.visits = spread(
    edges, [&](Index e) { return !mayShareCurve(given, edges.nodes[e]); }, result.id);
  result.isCurve = CurveFinder(points, edges, options).find(result.id);
  result.visits += spread(
    edges, [&](Index e) { return !result.isCurve[e] && edges.angle[e] <= options.featureAngle; },
    result.id);
  return result;
}
}
