// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/CurveMorph.h"

#include "BoundaryMorphing/KnownMotion.h"

#include <algorithm>

namespace morph
{
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
}
