// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMorph.h"

#include "Boundary/SurfaceLoops.h"
#include "BoundaryMorphing/KnownMotion.h"
#include "BoundaryMorphing/SurfaceHarmonicExtension.h"

#include <algorithm>
#include <optional>

namespace morph
{
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
