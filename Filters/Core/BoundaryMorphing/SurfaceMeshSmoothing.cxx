// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"

#include "Boundary/FaceQuality.h"
#include "Boundary/FoldedFaces.h"
#include "BoundaryMorphing/MidNodes.h"
#include "BoundaryMorphing/SurfaceMeshSmoother.h"
#include "Geometry/AffineFit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace morph
{
namespace
{
constexpr double Rounding = 1e-10;   // of the largest displacement
constexpr double Coordinate = 1e-15; // rounding of a coordinate, relative
constexpr int Layers = 30;

std::vector<std::uint8_t> foldedMask(const Points& rest, const Points& moved,
  const BoundaryFaces& faces, const Classification& geometry)
{
  std::vector<std::uint8_t> isFolded(geometry.surfaceOfFace.size(), 0);
  for (const Index f : foldedFaces(rest, moved, faces, geometry))
  {
    isFolded[f] = 1;
  }
  return isFolded;
}

/// The faces' scaled Jacobians, and which of them are visibly folded, not only bent.
struct Measured
{
  std::vector<double> quality;
  std::vector<std::uint8_t> isFolded;

  Measured(const Points& rest, const Points& moved, const BoundaryFaces& faces,
    const Classification& geometry)
    : quality(faceQuality(rest, moved, faces, geometry).scaledJacobian)
    , isFolded(foldedMask(rest, moved, faces, geometry))
  {
  }
};

/// The quality of one surface's faces.
struct Summary
{
  Index folded = 0; ///< visibly
  Index turned = 0; ///< by the scaled Jacobian
  double minimum = std::numeric_limits<double>::infinity();
  double sum = 0;

  Summary(const GeometrySurface& surface, const Measured& measured)
  {
    for (const Index f : surface.faces)
    {
      const double value = measured.quality[f];
      if (!std::isnan(value))
      {
        this->folded += measured.isFolded[f];
        this->turned += value <= 0;
        this->minimum = std::min(this->minimum, value);
        this->sum += value;
      }
    }
  }

  bool hasMoreFolds(const Summary& other) const
  {
    return this->folded > other.folded || this->turned > other.turned;
  }
  bool hasAsManyFolds(const Summary& other) const
  {
    return this->folded == other.folded && this->turned == other.turned;
  }
  bool hasWorseFaces(const Summary& other) const
  {
    return this->hasMoreFolds(other) ||
           (this->hasAsManyFolds(other) && this->minimum < other.minimum);
  }
  bool isWorse(const Summary& other) const
  {
    return this->hasWorseFaces(other) ||
           (this->hasAsManyFolds(other) && this->minimum == other.minimum && this->sum < other.sum);
  }
};

/// Returns nodes to the start where a surface would be worse than there.
class KeepBetter
{
public:
  KeepBetter(const BoundaryFaces& faces, const Classification& geometry,
    const BoundaryMotion& motion, const Points& start)
    : faces_(faces)
    , geometry_(geometry)
    , motion_(motion)
    , start_(start)
    , isBack_(motion.state.size(), 0)
  {
  }

  /// Moves the surfaces that return wholly from `report.smoothed` to `report.kept`.
  void run(SurfaceMeshSmoothing& report, Points& points)
  {
    const Measured before = this->measured(this->start_);
    std::vector<Index> open = report.smoothed;
    for (int layer = 0; !open.empty(); ++layer)
    {
      const Measured now = this->measured(points);
      std::vector<Index> next;
      for (const Index s : open)
      {
        const GeometrySurface& surface = this->geometry_.surfaces[s];
        const Summary first(surface, before), here(surface, now);
        // Only a start without folds has a minimum to keep.
        const bool mends = here.hasWorseFaces(first) && first.turned == 0 && layer < Layers &&
                           this->takeBackBelow(first.minimum, now.quality, surface, points);
        if (mends)
        {
          next.push_back(s);
        }
        else if (here.isWorse(first))
        {
          this->takeBack(surface.nodes, points);
          report.kept.push_back(s);
        }
      }
      open = next;
    }
    std::sort(report.kept.begin(), report.kept.end());
    const auto isKept = [&](Index s)
    { return std::binary_search(report.kept.begin(), report.kept.end(), s); };
    report.smoothed.erase(std::remove_if(report.smoothed.begin(), report.smoothed.end(), isKept),
      report.smoothed.end());
  }

private:
  Measured measured(const Points& points) const
  {
    return { this->motion_.rest, points, this->faces_, this->geometry_ };
  }

  /// The result tells whether a node returned that had not before.
  template <typename Nodes>
  bool takeBack(const Nodes& nodes, Points& points)
  {
    bool any = false;
    for (const Index node : nodes)
    {
      if (!this->isBack_[node] && this->motion_.state[node] == BoundaryMotion::OnSurface)
      {
        this->isBack_[node] = 1;
        points.row(node) = this->start_.row(node);
        any = true;
      }
    }
    return any;
  }

  bool takeBackBelow(
    double minimum, const std::vector<double>& now, const GeometrySurface& surface, Points& points)
  {
    std::vector<Index> nodes;
    for (const Index f : surface.faces)
    {
      if (now[f] < minimum)
      {
        nodes.insert(nodes.end(), this->faces_.connectivity.begin() + this->faces_.offsets[f],
          this->faces_.connectivity.begin() + this->faces_.offsets[f + 1]);
      }
    }
    return this->takeBack(nodes, points);
  }

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const BoundaryMotion& motion_;
  const Points& start_;
  std::vector<std::uint8_t> isBack_; ///< #nodes
};

/// Whether the surface's nodes move by one affine map, up to rounding.
bool movesAffinely(const std::vector<Index>& nodes, const BoundaryMotion& motion)
{
  const AffineFit fit =
    AffineLeastSquares(motion.rest(nodes, allColumns)).fit(motion.displacement(nodes, allColumns));
  double most = 0, off = 0, size = 0;
  for (const Index node : nodes)
  {
    size = std::max(size, motion.rest.row(node).cwiseAbs().maxCoeff());
    const Eigen::RowVector3d own = motion.displacement.row(node);
    most = std::max(most, own.norm());
    off = std::max(off, (own - fit.displacement(motion.rest.row(node))).norm());
  }
  return off <= Rounding * most + Coordinate * size;
}
}

SurfaceMeshSmoothing smoothSurfaceMeshes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, SmoothedSurfaces which, BoundaryMotion& motion, Monitor& monitor)
{
  SurfaceMeshSmoothing report;
  const Points start = motion.moved();
  const std::vector<std::uint8_t> isFolded = foldedMask(motion.rest, start, faces, geometry);
  const auto isWanted = [&](const GeometrySurface& surface)
  {
    return which == SmoothedSurfaces::All || std::any_of(surface.faces.begin(), surface.faces.end(),
                                               [&](Index f) { return isFolded[f] != 0; });
  };
  if (std::none_of(geometry.surfaces.begin(), geometry.surfaces.end(), isWanted))
  {
    return report;
  }
  const FaceQuality quality = faceQuality(motion.rest, start, faces, geometry);
  Points result = start;
  const double count = static_cast<double>(geometry.surfaces.size());
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    const std::vector<Index>& nodes = geometry.surfaces[s].nodes;
    if (!isWanted(geometry.surfaces[s]) || movesAffinely(nodes, motion))
    {
      continue;
    }
    SurfaceMeshSmoother smoother(
      faces, geometry, static_cast<Index>(s), target, motion, start, quality, isFolded, monitor);
    if (smoother.free().empty())
    {
      continue;
    }
    smoother.run();
    report.steps += smoother.effort().steps;
    for (const Index i : smoother.free())
    {
      result.row(nodes[i]) = smoother.points().row(i);
    }
    report.smoothed.push_back(static_cast<Index>(s));
    monitor.progress(static_cast<double>(s + 1) / count);
  }
  KeepBetter(faces, geometry, motion, start).run(report, result);
  for (const Index node : faces.nodes)
  {
    if (result.row(node) != start.row(node))
    {
      motion.displacement.row(node) = result.row(node) - motion.rest.row(node);
    }
  }
  const bool projects = target && !faces.between.values.empty();
  carryMidNodes(faces, geometry, target,
    projects ? surfaceNodeNormals(motion.rest, start, faces, geometry) : Points(), start, motion);
  return report;
}
}
