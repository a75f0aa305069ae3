// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/BoundaryProjection.h"
#include "BoundaryMorphing/PhongSurface.h"
#include "Energies/FaceEnergy.h"
#include "Geometry/AffineFit.h"
#include "Optimization/Minimizers.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace morph
{
namespace
{
constexpr int Power = 8;               // of the inverse mean ratio: the worst faces count most
constexpr double StopMove = 1e-2;      // of the mean edge
constexpr double LeastDecrease = 1e-4; // of the energy in a round, relative
constexpr int Rounds = 20;
constexpr int StepsInPlane = 10; // Newton steps of a round in a plane
constexpr int StepsOnCurved = 3; // elsewhere: tangent planes stay those of its start
constexpr int MostHalvings = 6;
constexpr int UntangleStages = 40;
constexpr int UntangleSteps = 10; // Newton steps in a stage
constexpr int StagesWithoutGain = 6;
constexpr double OnTarget = 1e-6; // of the mean edge

using Row = Eigen::RowVector3d;

Row areaOf(const FaceCorner& corner, const Points& points)
{
  const Row own = points.row(corner.node[0]);
  return (Row(points.row(corner.node[1])) - own).cross(Row(points.row(corner.node[2])) - own);
}

/// Smooths the mesh of one surface; see smoothSurfaceMeshes(). Holds its arguments by reference.
class SurfaceMeshSmoother
{
public:
  /// `surface`: its number. `start`: #nodes x 3, moved positions. `quality`: of the start.
  /// `isFolded`: #faces, nonzero for foldedFaces() of the start. Without a `target` that holds the
  /// surface, its nodes keep to its shape at the start.
  SurfaceMeshSmoother(const BoundaryFaces& faces, const Classification& geometry, Index surface,
    const ProjectionTarget* target, const BoundaryMotion& motion, const Points& start,
    const FaceQuality& quality, const std::vector<std::uint8_t>& isFolded, Monitor& monitor)
    : faces_(faces)
    , geometry_(geometry)
    , surface_(surface)
    , nodes_(geometry.surfaces[surface].nodes)
    , target_(target && target->holds(surface) ? target : nullptr)
    , motion_(motion)
    , quality_(quality)
    , isFolded_(isFolded)
    , monitor_(monitor)
    , points_(start(nodes_, allColumns))
  {
    if (!this->target_)
    {
      this->shape_.emplace(start, faces, geometry.surfaces[surface].faces);
    }
    this->makeCorners();
  }

  /// Corners that move, as numbers among the surface's nodes; may be empty.
  const std::vector<Index>& free() const { return this->free_; }

  /// Untangles and smooths. Call it once, with a free node.
  void run()
  {
    FaceEnergy energy(this->corners_, this->free_, this->points_.rows());
    this->setPlanes(energy, this->points_);
    energy.setDensity({});
    if (energy.evaluate(this->points_, this->monitor_).inverted == 0 || this->untangle(energy))
    {
      this->improve(energy);
    }
  }

  /// #surface nodes x 3
  const Points& points() const { return this->points_; }
  const MinimizerEffort& effort() const { return this->effort_; }

private:
  Index local(Index node) const
  {
    return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node) - this->nodes_.begin();
  }

  std::vector<std::uint8_t> findFree()
  {
    std::vector<std::uint8_t> isCorner(this->nodes_.size(), 0), isFree = isCorner;
    for (const FaceCorner& corner : this->corners_)
    {
      for (const Index number : corner.node)
      {
        isCorner[number] = 1;
      }
    }
    const double tolerance = OnTarget * this->meanEdge(this->points_);
    for (std::size_t i = 0; i < this->nodes_.size(); ++i)
    {
      const Index number = static_cast<Index>(i);
      if (isCorner[i] && this->motion_.state[this->nodes_[i]] == BoundaryMotion::OnSurface &&
          (!this->target_ || this->isOnTarget(number, tolerance)))
      {
        isFree[i] = 1;
        this->free_.push_back(number);
        if (this->shape_)
        {
          this->triangle_.push_back(this->shape_->triangleAt(this->nodes_[i]));
        }
      }
    }
    return isFree;
  }

  void makeCorners()
  {
    double all = 0;
    for (const Index f : this->geometry_.surfaces[this->surface_].faces)
    {
      const Index first = this->faces_.offsets[f], size = this->faces_.offsets[f + 1] - first;
      const Index* node = this->faces_.connectivity.data() + first;
      if (size != 3 && size != 4)
      {
        continue;
      }
      const Row area = vectorArea(this->motion_.rest, node, size);
      for (Index k = 0; k < size; ++k)
      {
        const Index own = node[k], next = node[(k + 1) % size], last = node[(k + size - 1) % size];
        const Row a = this->motion_.rest.row(next) - this->motion_.rest.row(own);
        const Row b = this->motion_.rest.row(last) - this->motion_.rest.row(own);
        if (!(a.cross(b).dot(area) > 0))
        {
          continue; // no shape to aim for
        }
        Eigen::Matrix2d edges;
        edges << a.norm(), a.dot(b) / a.norm(), 0, a.cross(b).norm() / a.norm();
        // Corners overlap: a triangle is covered three times, a quadrilateral twice.
        const double weight = edges.determinant() / (size == 3 ? 3. : 2.);
        this->corners_.push_back(
          { { this->local(own), this->local(next), this->local(last) }, edges.inverse(), weight });
        this->faceOf_.push_back(f);
        all += weight;
      }
    }
    const std::vector<std::uint8_t> isFree = this->findFree();
    std::size_t kept = 0;
    for (std::size_t c = 0; c < this->corners_.size(); ++c)
    {
      const Index* node = this->corners_[c].node;
      if (isFree[node[0]] || isFree[node[1]] || isFree[node[2]])
      {
        this->corners_[kept] = this->corners_[c];
        this->corners_[kept].weight /= all;
        this->faceOf_[kept++] = this->faceOf_[c];
      }
    }
    this->corners_.resize(kept);
    this->faceOf_.resize(kept);
  }

  /// Returns the side of a face's area that is up.
  Row upOf(Index f, const Points& points) const
  {
    if (this->isFolded_[f])
    {
      return this->quality_.normal.row(f);
    }
    const Index first = this->faces_.offsets[f], size = this->faces_.offsets[f + 1] - first;
    const auto at = [&](Index k)
    { return Row(points.row(this->local(this->faces_.connectivity[first + k]))); };
    Row sum = Row::Zero();
    for (Index k = 2; k < size; ++k)
    {
      sum += (at(k - 1) - at(0)).cross(at(k) - at(0));
    }
    return sum;
  }

  Row planeNormal() const
  {
    const Row normal = this->shape_->planeNormal();
    double side = 0;
    for (const Index f : this->geometry_.surfaces[this->surface_].faces)
    {
      side += normal.dot(this->quality_.normal.row(f));
    }
    return side < 0 ? Row(-normal) : normal;
  }

  bool isPlane() const { return this->shape_ && this->shape_->isPlane(); }

  void setPlanes(FaceEnergy& energy, const Points& points)
  {
    const Index corners = static_cast<Index>(this->corners_.size());
    Points ofCorner(corners, 3);
    this->normals_.resize(static_cast<Index>(this->free_.size()), 3);
    if (this->isPlane())
    {
      const Row normal = this->planeNormal();
      ofCorner.rowwise() = normal;
      this->normals_.rowwise() = normal;
      energy.setPlanes(ofCorner, this->normals_);
      return;
    }
    Points ofNode = Points::Zero(points.rows(), 3);
    for (Index c = 0; c < corners; ++c)
    {
      const FaceCorner& corner = this->corners_[c];
      const Row up = this->upOf(this->faceOf_[c], points), area = areaOf(corner, points);
      const bool isUp = area.dot(up) > 0;
      ofCorner.row(c) = (isUp ? area : up).normalized();
      for (const Index number : corner.node)
      {
        ofNode.row(number) += isUp ? area : Row(-area);
      }
    }
    for (std::size_t i = 0; i < this->free_.size(); ++i)
    {
      this->normals_.row(static_cast<Index>(i)) = ofNode.row(this->free_[i]).normalized();
    }
    energy.setPlanes(ofCorner, this->normals_);
  }

  /// Puts free nodes on the surface. Returns false if one has no place there.
  bool project(Points& points)
  {
    std::atomic<bool> all{ true };
    parallel(static_cast<Index>(this->free_.size()), 64, this->monitor_,
      [&](Index i)
      {
        const Row x = points.row(this->free_[i]);
        Row y = x;
        if (!this->target_)
        {
          y = this->shape_->closest(x, this->triangle_[i]);
        }
        else if (!this->target_->closestOnSurface(this->surface_, x, Row(this->normals_.row(i)), y))
        {
          all = false;
        }
        points.row(this->free_[i]) = y;
      });
    return all && points.allFinite();
  }

  bool isOnTarget(Index number, double tolerance) const
  {
    const Row x = this->points_.row(number);
    Row y;
    return this->target_->closestOnSurface(this->surface_, x, Row::Zero(), y) &&
           (x - y).norm() <= tolerance;
  }

  double meanEdge(const Points& points) const
  {
    double sum = 0;
    for (const FaceCorner& corner : this->corners_)
    {
      sum += (points.row(corner.node[1]) - points.row(corner.node[0])).norm();
    }
    return sum / static_cast<double>(this->corners_.size());
  }

  /// Returns whether no corner is inverted any more.
  bool untangle(FaceEnergy& energy)
  {
    FaceDensity density;
    EnergyState state = energy.evaluate(this->points_, this->monitor_);
    EnergyState best = state;
    MinimizerLimits limits;
    limits.steps = UntangleSteps;
    int idle = 0;
    for (int stage = 0; stage < UntangleStages && idle < StagesWithoutGain; ++stage)
    {
      this->monitor_.check();
      // The rule of Escobar et al. and of gmsh: the less is inverted, the nearer to a barrier.
      const double inverted = std::min(0., state.minimumDeterminant);
      density.epsilon = std::sqrt(1e-12 + 0.04 * inverted * inverted);
      energy.setDensity(density);
      Points trial = this->points_;
      newton(energy, trial, limits, this->matrix_, this->effort_, this->monitor_);
      if (!this->project(trial))
      {
        return false;
      }
      this->points_ = trial;
      this->setPlanes(energy, this->points_);
      state = energy.evaluate(this->points_, this->monitor_);
      if (state.inverted == 0)
      {
        return true;
      }
      const bool gains =
        state.inverted < best.inverted || state.minimumDeterminant > 0.9 * best.minimumDeterminant;
      idle = gains ? 0 : idle + 1;
      best.inverted = std::min(best.inverted, state.inverted);
      best.minimumDeterminant = std::max(best.minimumDeterminant, state.minimumDeterminant);
    }
    return false;
  }

  void improve(FaceEnergy& energy)
  {
    FaceDensity density;
    density.power = Power;
    energy.setDensity(density);
    this->setPlanes(energy, this->points_);
    double now = energy.evaluate(this->points_, this->monitor_).energy;
    MinimizerLimits limits;
    limits.steps = this->isPlane() ? StepsInPlane : StepsOnCurved;
    for (int round = 0; round < Rounds; ++round)
    {
      this->monitor_.check();
      Points trial = this->points_;
      newton(energy, trial, limits, this->matrix_, this->effort_, this->monitor_);
      const Points way = trial - this->points_;
      double next = now;
      bool found = false;
      for (int halving = 0; halving <= MostHalvings && !found; ++halving)
      {
        trial = this->points_ + std::ldexp(1., -halving) * way;
        if (!this->project(trial) || energy.evaluate(trial, this->monitor_).inverted > 0)
        {
          continue;
        }
        this->setPlanes(energy, trial);
        next = energy.evaluate(trial, this->monitor_).energy;
        found = next < now;
        if (!found)
        {
          this->setPlanes(energy, this->points_);
        }
      }
      if (!found)
      {
        return;
      }
      const double most = (trial - this->points_).rowwise().norm().maxCoeff();
      this->points_ = trial;
      if (now - next < LeastDecrease * next || most < StopMove * this->meanEdge(trial))
      {
        return;
      }
      now = next;
    }
  }

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const Index surface_;
  const std::vector<Index>& nodes_; ///< ids, ascending
  const ProjectionTarget* target_;  ///< null without one that holds the surface
  const BoundaryMotion& motion_;
  const FaceQuality& quality_;
  const std::vector<std::uint8_t>& isFolded_;
  Monitor& monitor_;
  Points points_;                     ///< #nodes_ x 3
  std::optional<PhongSurface> shape_; ///< without a target
  std::vector<FaceCorner> corners_;   ///< with numbers in nodes_
  std::vector<Index> faceOf_;         ///< of each corner
  std::vector<Index> free_;           ///< numbers in nodes_
  std::vector<Index> triangle_;       ///< of the shape, of each free node
  Points normals_;                    ///< #free_ x 3
  BlockCsr3f matrix_;
  MinimizerEffort effort_;
};

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
