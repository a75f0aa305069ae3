// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMorph.h"

#include "BoundaryMorphing/BoundaryProjection.h"
#include "BoundaryMorphing/KnownMotion.h"
#include "Geometry/AffineFit.h"
#include "Solvers/MultigridSolver.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace morph
{
namespace
{
using Pair = std::pair<Index, Index>;

/// Returns the edges of the faces, lower node first, each once.
std::vector<Pair> edgesOf(const BoundaryFaces& faces, const std::vector<Index>& faceIds)
{
  std::vector<Pair> edges;
  for (Index f : faceIds)
  {
    const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
    for (Index k = 0; k < size; ++k)
    {
      const Index a = faces.connectivity[first + k];
      const Index b = faces.connectivity[first + (k + 1) % size];
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  sortUnique(edges);
  return edges;
}

/// The number of a node in faces.nodes.
Index placeOf(const BoundaryFaces& faces, Index node)
{
  return std::lower_bound(faces.nodes.begin(), faces.nodes.end(), node) - faces.nodes.begin();
}

class Smoother
{
public:
  Smoother(const BoundaryFaces& faces, const std::vector<Index>& free, const AffineFit& fit,
    BoundaryMotion& motion)
    : faces_(faces)
    , fit_(fit)
    , motion_(motion)
  {
    for (Index node : free)
    {
      const Index k = placeOf(faces, node);
      const bool isCorner = faces.between.begin(k) == faces.between.end(k);
      (isCorner ? this->corners_ : this->middles_).push_back(node);
    }
  }

  void run(const std::vector<Index>& faceIds, Monitor& monitor)
  {
    if (!this->corners_.empty())
    {
      this->solve(edgesOf(this->faces_, faceIds), monitor);
    }
    for (Index node : this->middles_)
    {
      this->set(node, meanBetween(this->faces_, placeOf(this->faces_, node), this->motion_.rest,
                        [this](Index corner) { return this->residual(corner); }));
    }
  }

private:
  Eigen::RowVector3d field(Index node) const
  {
    return this->fit_.displacement(Eigen::RowVector3d(this->motion_.rest.row(node)));
  }
  Eigen::RowVector3d residual(Index node) const
  {
    return this->motion_.displacement.row(node) - this->field(node);
  }
  void set(Index node, const Eigen::RowVector3d& residual)
  {
    this->motion_.displacement.row(node) = this->field(node) + residual;
  }
  /// Returns the row of a free corner, or -1.
  int row(Index node) const
  {
    const auto place = std::lower_bound(this->corners_.begin(), this->corners_.end(), node);
    return place != this->corners_.end() && *place == node
             ? static_cast<int>(place - this->corners_.begin())
             : -1;
  }

  void solve(const std::vector<Pair>& edges, Monitor& monitor)
  {
    const auto length = [&](const Pair& e)
    { return (this->motion_.rest.row(e.first) - this->motion_.rest.row(e.second)).norm(); };
    double longest = 0;
    for (const Pair& e : edges)
    {
      longest = std::max(longest, length(e));
    }
    const Index n = static_cast<Index>(this->corners_.size());
    Points b = Points::Zero(n, 3), x = Points::Zero(n, 3);
    std::vector<Eigen::Triplet<double, int>> entries;
    double largestResidual = 0, largestMotion = 0;
    for (const Pair& e : edges)
    {
      // The weight of coincident nodes is large but bounded.
      const double weight = longest > 0 ? longest / std::max(length(e), 1e-6 * longest) : 1;
      const int i = this->row(e.first), j = this->row(e.second);
      for (const auto& [own, other, node] :
        { std::make_tuple(i, j, e.second), std::make_tuple(j, i, e.first) })
      {
        if (own < 0)
        {
          continue;
        }
        entries.emplace_back(own, own, weight);
        if (other >= 0)
        {
          entries.emplace_back(own, other, -weight);
        }
        else
        {
          const Eigen::RowVector3d r = this->residual(node);
          b.row(own) += weight * r;
          largestResidual = std::max(largestResidual, r.norm());
          largestMotion = std::max(largestMotion, this->motion_.displacement.row(node).norm());
        }
      }
    }
    if (largestResidual > 1e-13 * largestMotion) // otherwise it is rounding
    {
      LinearEquations equations = { CsrMatrix(n, n),
        this->motion_.rest(this->corners_, allColumns) };
      equations.matrix.setFromTriplets(entries.begin(), entries.end());
      SpdSolver solver;
      ProgressRange first(monitor, 0, 0.5), second(monitor, 0.5, 1);
      solver.prepare(std::move(equations), first);
      solver.solve(b, x, 1e-12, 2000, second);
    }
    for (Index i = 0; i < n; ++i)
    {
      this->set(this->corners_[i], x.row(i));
    }
  }

  const BoundaryFaces& faces_;
  const AffineFit& fit_;
  BoundaryMotion& motion_;
  std::vector<Index> corners_, middles_; ///< free, ascending
};
}

void extendHarmonically(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, BoundaryMotion& motion,
  Monitor& monitor)
{
  const AffineFit fit =
    AffineLeastSquares(motion.rest(fixed, allColumns), motion.rest(free, allColumns))
      .fit(motion.displacement(fixed, allColumns));
  Smoother(faces, free, fit, motion).run(faceIds, monitor);
}

namespace
{
/// A known node on the curve, or one of its two ends.
struct Anchor
{
  double parameter;
  Index place; ///< index in curve.nodes
};

/// Returns displacements in the order of curve.nodes, zero for the known nodes.
Points blend(const GeometryCurve& curve, const std::vector<Anchor>& anchors,
  const MotionAround::Mixture& fit, const BoundaryMotion& motion)
{
  const auto field = [&](Index node) -> Eigen::RowVector3d
  { return fit.displacement(Eigen::RowVector3d(motion.rest.row(node))); };
  const auto residual = [&](const Anchor& a) -> Eigen::RowVector3d
  {
    const Index node = curve.nodes[a.place];
    return motion.displacement.row(node) - field(node);
  };
  Points result = Points::Zero(static_cast<Index>(curve.nodes.size()), 3);
  for (std::size_t i = 0; i < curve.nodes.size(); ++i)
  {
    if (motion.state[curve.nodes[i]] != BoundaryMotion::Unknown)
    {
      continue;
    }
    const double t = curve.parameter[i];
    const auto after = std::upper_bound(anchors.begin(), anchors.end(), t,
      [](double value, const Anchor& a) { return value < a.parameter; });
    // Ends are anchors where they are vertices, and loops repeat theirs beyond [0, 1]: both sides
    // have one.
    const Anchor& b = after == anchors.end() ? anchors.back() : *after;
    const Anchor& a = after == anchors.begin() ? b : *(after - 1);
    const double length = b.parameter - a.parameter;
    const double s = length > 0 ? (t - a.parameter) / length : 0;
    result.row(static_cast<Index>(i)) =
      field(curve.nodes[i]) + (1 - s) * residual(a) + s * residual(b);
  }
  return result;
}

std::vector<Anchor> findAnchors(const GeometryCurve& curve, const BoundaryMotion& motion)
{
  std::vector<Anchor> anchors;
  for (std::size_t i = 0; i < curve.nodes.size(); ++i)
  {
    if (motion.state[curve.nodes[i]] != BoundaryMotion::Unknown)
    {
      anchors.push_back({ curve.parameter[i], static_cast<Index>(i) });
    }
  }
  if (curve.loop && !anchors.empty())
  {
    Anchor before = anchors.back(), after = anchors.front();
    before.parameter -= 1;
    after.parameter += 1;
    anchors.insert(anchors.begin(), before);
    anchors.push_back(after);
  }
  return anchors;
}
}

Index morphCurves(const Classification& geometry, UnattachedMotion unattached,
  BoundaryMotion& motion, Monitor& monitor)
{
  const BoundaryMotion before = motion;
  KnownMotion known(geometry, before);
  for (std::size_t c = 0; c < geometry.curves.size(); ++c)
  {
    const GeometryCurve& curve = geometry.curves[c];
    std::vector<Index> unknown;
    for (Index node : curve.nodes)
    {
      if (before.state[node] == BoundaryMotion::Unknown)
      {
        unknown.push_back(node);
      }
    }
    if (unknown.empty())
    {
      continue;
    }
    const MotionAround around = known.around(curve);
    const std::vector<Anchor> anchors = findAnchors(curve, before);
    if (anchors.empty())
    {
      extrapolate(around, unknown, unattached, motion);
    }
    else
    {
      const Points moved = blend(curve, anchors, around.affineFit(), before);
      for (std::size_t i = 0; i < curve.nodes.size(); ++i)
      {
        if (before.state[curve.nodes[i]] == BoundaryMotion::Unknown)
        {
          motion.displacement.row(curve.nodes[i]) = moved.row(static_cast<Index>(i));
        }
      }
    }
    for (Index node : unknown)
    {
      motion.state[node] = BoundaryMotion::OnCurve;
    }
    monitor.check();
    monitor.progress(static_cast<double>(c + 1) / static_cast<double>(geometry.curves.size()));
  }
  return known.summed();
}

std::vector<std::vector<Index>> boundaryLoops(
  const BoundaryFaces& faces, const std::vector<Index>& some)
{
  std::map<std::pair<Index, Index>, int> uses; // directed edges
  for (Index f : some)
  {
    const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
    for (Index k = 0; k < size; ++k)
    {
      ++uses[{ faces.connectivity[first + k], faces.connectivity[first + (k + 1) % size] }];
    }
  }
  std::map<Index, Index> next;
  for (const auto& [edge, count] : uses)
  {
    if (uses.count({ edge.second, edge.first }))
    {
      continue;
    }
    if (count > 1 || !next.emplace(edge).second)
    {
      return {};
    }
  }
  std::vector<std::vector<Index>> loops;
  while (!next.empty())
  {
    loops.emplace_back();
    for (auto step = next.begin(); step != next.end();)
    {
      const Index to = step->second;
      loops.back().push_back(step->first);
      next.erase(step);
      step = next.find(to);
      if (step == next.end() && to != loops.back().front())
      {
        return {};
      }
    }
    if (loops.back().size() < 3)
    {
      return {};
    }
  }
  return loops;
}

namespace
{
bool isUnknown(const GeometrySurface& surface, const BoundaryMotion& motion)
{
  return std::all_of(surface.nodes.begin(), surface.nodes.end(),
    [&](Index node) { return motion.state[node] == BoundaryMotion::Unknown; });
}

/// Returns the loops around a surface as rows in `fixed`; none if a loop's node is not fixed.
SurfaceResidual::Loops loopRows(
  const BoundaryFaces& faces, const std::vector<Index>& faceIds, const std::vector<Index>& fixed)
{
  SurfaceResidual::Loops loops = boundaryLoops(faces, faceIds);
  for (std::vector<Index>& loop : loops)
  {
    for (Index& node : loop)
    {
      const auto place = std::lower_bound(fixed.begin(), fixed.end(), node);
      if (place == fixed.end() || *place != node)
      {
        return {};
      }
      node = place - fixed.begin();
    }
  }
  return loops;
}

void prepareResidual(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, Index neighbors,
  const Points& rest, SurfaceWeights& weights, SurfaceWeights::Surface& surface, Monitor& monitor)
{
  if (surface.fixed == fixed)
  {
    return;
  }
  surface.fixed.clear(); // if prepare() throws, none are kept
  surface.residual.setNumberOfNeighbors(neighbors);
  surface.residual.prepare(
    rest(fixed, allColumns), rest(free, allColumns), loopRows(faces, faceIds, fixed), monitor);
  surface.fixed = fixed;
  ++weights.prepared;
}

void moveLinearly(const SurfaceResidual& residual, const std::vector<Index>& fixed,
  const std::vector<Index>& free, BoundaryMotion& motion, Monitor& monitor)
{
  Points moved;
  residual.evaluateLinear(motion.displacement(fixed, allColumns), moved, monitor);
  motion.displacement(free, allColumns) = moved;
}

/// Returns whether the affine map had to be replaced.
bool moveByResidual(const SurfaceResidual& residual, const std::vector<Index>& fixed,
  const std::vector<Index>& free, BoundaryMotion& motion, Monitor& monitor)
{
  const Points target = motion.rest(fixed, allColumns) + motion.displacement(fixed, allColumns);
  Points moved;
  const bool replaced = residual.evaluate(target, moved, monitor);
  for (std::size_t i = 0; i < free.size(); ++i)
  {
    motion.displacement.row(free[i]) = moved.row(static_cast<Index>(i)) - motion.rest.row(free[i]);
  }
  return replaced;
}
}

SurfaceMorphReport morphSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const SurfaceMorphOptions& options, BoundaryMotion& motion, Monitor& monitor,
  SurfaceWeights* kept)
{
  SurfaceMorphReport report;
  SurfaceWeights own;
  SurfaceWeights& weights = kept ? *kept : own;
  weights.surfaces.resize(geometry.surfaces.size());
  BoundaryMotion before;
  std::optional<KnownMotion> known; // for surfaces that follow other nodes
  if (std::any_of(geometry.surfaces.begin(), geometry.surfaces.end(),
        [&](const GeometrySurface& surface) { return isUnknown(surface, motion); }))
  {
    before = motion;
    known.emplace(geometry, before);
  }
  const double count = static_cast<double>(geometry.surfaces.size());
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    const GeometrySurface& surface = geometry.surfaces[s];
    std::vector<Index> fixed, free;
    for (Index node : surface.nodes)
    {
      (motion.state[node] != BoundaryMotion::Unknown ? fixed : free).push_back(node);
    }
    const bool moves = std::any_of(fixed.begin(), fixed.end(),
      [&](Index node) { return !motion.displacement.row(node).isZero(0); });
    if (fixed.empty())
    {
      const Index body = motion.bodyOfNode[faces.connectivity[faces.offsets[surface.faces[0]]]];
      extrapolate(known->around(body, free), free, options.unattached, motion);
      report.unattached.push_back(static_cast<Index>(s));
    }
    else if (moves && !free.empty())
    {
      if (options.method != SurfaceMorphOptions::Method::WeightedResidual && !options.linear)
      {
        extendHarmonically(faces, surface.faces, fixed, free, motion, monitor);
      }
      else
      {
        SurfaceWeights::Surface& one = weights.surfaces[s];
        prepareResidual(
          faces, surface.faces, fixed, free, options.neighbors, motion.rest, weights, one, monitor);
        if (options.linear)
        {
          moveLinearly(one.residual, fixed, free, motion, monitor);
        }
        else if (moveByResidual(one.residual, fixed, free, motion, monitor))
        {
          report.reflected.push_back(static_cast<Index>(s));
        }
        if (!kept)
        {
          one = {}; // keeps the weights of one surface at a time in memory
        }
      }
    }
    for (Index node : free)
    {
      motion.state[node] = BoundaryMotion::OnSurface;
    }
    monitor.check();
    monitor.progress(static_cast<double>(s + 1) / count);
  }
  return report;
}
}
