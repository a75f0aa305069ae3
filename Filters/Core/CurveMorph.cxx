// SPDX-License-Identifier: BSD-3-Clause
#include "CurveMorph.h"

#include "MotionFit.h"

#include <algorithm>

namespace morph
{
namespace
{
/// The known nodes by where they are, all as of before the first curve moved.
class Surroundings
{
public:
  Surroundings(const Classification& geometry, const BoundaryMotion& motion)
    : motion_(motion)
    , all_(motion.known())
    , ofSurface_(geometry.surfaces.size())
  {
    for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
    {
      for (Index node : geometry.surfaces[s].nodes)
      {
        if (motion.state[node] != BoundaryMotion::Unknown)
        {
          this->ofSurface_[s].push_back(node);
        }
      }
    }
  }

  /// Those on the curve, on the surfaces beside it, on its body, and all.
  std::vector<std::vector<Index>> around(const GeometryCurve& curve) const
  {
    std::vector<std::vector<Index>> sets(4);
    for (Index node : curve.nodes)
    {
      if (this->motion_.state[node] != BoundaryMotion::Unknown)
      {
        sets[0].push_back(node);
      }
    }
    for (Index s : curve.surfaces)
    {
      sets[1].insert(sets[1].end(), this->ofSurface_[s].begin(), this->ofSurface_[s].end());
    }
    for (std::vector<Index>* set : { &sets[0], &sets[1] })
    {
      std::sort(set->begin(), set->end());
      set->erase(std::unique(set->begin(), set->end()), set->end());
    }
    const Index body = this->motion_.bodyOfNode[curve.nodes[0]];
    std::copy_if(this->all_.begin(), this->all_.end(), std::back_inserter(sets[2]),
      [&](Index node) { return this->motion_.bodyOfNode[node] == body; });
    sets[3] = this->all_;
    return sets;
  }

private:
  const BoundaryMotion& motion_;
  std::vector<Index> all_;
  std::vector<std::vector<Index>> ofSurface_;
};

/// A known node on the curve, or one of its two ends there.
struct Anchor
{
  double parameter;
  Index place; ///< in curve.nodes
};

/// Displacements of the nodes of one curve that are unknown; in the order of curve.nodes, zero for the known.
Points blend(const GeometryCurve& curve, const std::vector<Anchor>& anchors, const AffineFit& fit,
  const BoundaryMotion& motion)
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
    // Ends are anchors where they are vertices, and loops repeat theirs beyond [0, 1]: both sides have one.
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

void morphCurves(
  const Classification& geometry, Unattached unattached, BoundaryMotion& motion, Monitor& monitor)
{
  const Surroundings surroundings(geometry, motion);
  const BoundaryMotion before = motion;
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
    const std::vector<std::vector<Index>> sets = surroundings.around(curve);
    const std::vector<Index>& set = spanningSet(before.rest, curve.nodes, sets);
    const std::vector<Anchor> anchors = findAnchors(curve, before);
    if (anchors.empty())
    {
      follow(set, unknown, unattached, motion);
    }
    else
    {
      const Points moved = blend(curve, anchors, affineFit(before, set), before);
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
}
}
