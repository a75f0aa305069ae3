// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"

#include "Boundary/FaceQuality.h"
#include "Boundary/FoldedFaces.h"
#include "BoundaryMorphing/MotionFit.h"
#include "BoundaryMorphing/PhongSurface.h"
#include "Energies/FaceEnergy.h"
#include "Optimization/Minimizers.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

namespace morph
{
namespace
{
constexpr double StopMove = 1e-3;      // of the mean edge
constexpr double LeastDecrease = 1e-6; // of the energy in a round, relative
constexpr int Rounds = 20;
constexpr int StepsInRound = 3;
constexpr int MostHalvings = 6;
constexpr int UntangleStages = 40;
constexpr int StagesWithoutGain = 6;

double knob(const char* name, double value)
{
  const char* text = std::getenv(name);
  return text ? std::atof(text) : value;
}

using Row = Eigen::RowVector3d;

class Smoother
{
public:
  Smoother(const BoundaryFaces& faces, const Classification& geometry, Index surface,
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

  bool hasFree() const { return !this->free_.empty(); }
  const std::vector<Index>& nodes() const { return this->nodes_; }
  const Points& points() const { return this->points_; }
  const MinimizerEffort& effort() const { return this->effort_; }

  void run()
  {
    FaceEnergy energy(this->corners_, this->free_, this->points_.rows());
    this->setPlanes(energy, this->points_);
    energy.setDensity({});
    const FaceEnergy::State s0 = energy.evaluate(this->points_, this->monitor_);
    if (s0.inverted > 0)
    {
      this->untangle(energy);
    }
    energy.setDensity({});
    FaceEnergy::State s1 = energy.evaluate(this->points_, this->monitor_);
    if (s1.inverted == 0)
    {
      FaceDensity density;
      this->improve(energy, density);
      density.power = static_cast<int>(knob("P", 1));
      if (density.power > 1)
      {
        this->improve(energy, density);
      }
    }
    if (std::getenv("TRACE"))
    {
      energy.setDensity({});
      const FaceEnergy::State s2 = energy.evaluate(this->points_, this->monitor_);
      std::fprintf(stderr, "surface %d: free %d corners %d plane %d; E %g inv %d | untangled %g inv %d | %g inv %d; steps %d cg %d ev %d\n",
        int(surface_), int(free_.size()), int(corners_.size()), shape_ && shape_->isPlane(), s0.energy, int(s0.inverted), s1.energy, int(s1.inverted), s2.energy, int(s2.inverted),
        int(effort_.steps), int(effort_.linearIterations), int(effort_.evaluations));
    }
  }

private:
  Index local(Index node) const
  {
    return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node) - this->nodes_.begin();
  }

  void makeCorners()
  {
    const GeometrySurface& surface = this->geometry_.surfaces[this->surface_];
    std::vector<Index> fixed;
    for (const Index node : this->nodes_)
    {
      if (this->motion_.state[node] != BoundaryMotion::OnSurface)
      {
        fixed.push_back(node);
      }
    }
    Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
    if (knob("AFFINE", 1) > 0)
    {
      map += affineFit(this->motion_, fixed).gradient();
    }
    std::vector<std::uint8_t> isCorner(this->nodes_.size(), 0);
    double all = 0;
    for (const Index f : surface.faces)
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
        isCorner[this->local(own)] = 1;
        if (!(a.cross(b).dot(area) > 0))
        {
          continue;
        }
        const Row p = a * map, q = b * map;
        const double length = p.norm(), height = length > 0 ? p.cross(q).norm() / length : 0;
        if (!(height > 1e-6 * q.norm() && length > 1e-6 * q.norm()))
        {
          continue; // TODO fall back
        }
        Eigen::Matrix2d edges;
        edges << length, p.dot(q) / length, 0, height;
        // All corners together count a face once: on quadrilaterals of both diagonals.
        const double weight = edges.determinant() / (size == 3 ? 3. : 2.);
        this->corners_.push_back({ { this->local(own), this->local(next), this->local(last) },
          edges.inverse(), weight });
        this->faceOf_.push_back(f);
        all += weight;
      }
    }
    std::vector<std::uint8_t> isFree(this->nodes_.size(), 0);
    for (std::size_t i = 0; i < this->nodes_.size(); ++i)
    {
      if (isCorner[i] && this->motion_.state[this->nodes_[i]] == BoundaryMotion::OnSurface)
      {
        isFree[i] = 1;
        this->free_.push_back(static_cast<Index>(i));
      }
    }
    std::size_t kept = 0;
    for (std::size_t c = 0; c < this->corners_.size(); ++c)
    {
      const Index* node = this->corners_[c].node;
      this->corners_[c].weight /= all;
      if (isFree[node[0]] || isFree[node[1]] || isFree[node[2]])
      {
        this->corners_[kept] = this->corners_[c];
        this->faceOf_[kept++] = this->faceOf_[c];
      }
    }
    this->corners_.resize(kept);
    this->faceOf_.resize(kept);
    if (this->shape_)
    {
      for (const Index i : this->free_)
      {
        this->triangle_.push_back(this->shape_->triangleAt(this->nodes_[i]));
      }
    }
  }

  /// The side of a face's area that is up.
  Row upOf(Index f, const Points& points) const
  {
    if (this->isFolded_[f])
    {
      return this->quality_.normal.row(f);
    }
    const Index first = this->faces_.offsets[f], size = this->faces_.offsets[f + 1] - first;
    Row sum = Row::Zero();
    const auto at = [&](Index k)
    { return Row(points.row(this->local(this->faces_.connectivity[first + k]))); };
    for (Index k = 2; k < size; ++k)
    {
      sum += (at(k - 1) - at(0)).cross(at(k) - at(0));
    }
    return sum;
  }

  void setPlanes(FaceEnergy& energy, const Points& points)
  {
    const Index n = static_cast<Index>(this->corners_.size());
    Points normals(n, 3), ofNode = Points::Zero(static_cast<Index>(this->nodes_.size()), 3);
    const bool isPlane = this->shape_ && this->shape_->isPlane();
    Row plane = Row::Zero();
    if (isPlane)
    {
      plane = this->shape_->planeNormal();
      double side = 0;
      for (const Index f : this->geometry_.surfaces[this->surface_].faces)
      {
        side += plane.dot(this->quality_.normal.row(f));
      }
      plane = side < 0 ? Row(-plane) : plane;
    }
    for (Index c = 0; c < n; ++c)
    {
      if (isPlane)
      {
        normals.row(c) = plane;
        continue;
      }
      const Index* node = this->corners_[c].node;
      const Row up = this->upOf(this->faceOf_[c], points);
      const Row area = Row(points.row(node[1]) - points.row(node[0]))
                         .cross(Row(points.row(node[2]) - points.row(node[0])));
      const bool isUp = area.dot(up) > 0;
      normals.row(c) = isUp ? area.normalized() : up.normalized();
      for (int k = 0; k < 3; ++k)
      {
        ofNode.row(node[k]) += isUp ? area : Row(-area);
      }
    }
    Points ofFree(static_cast<Index>(this->free_.size()), 3);
    for (std::size_t i = 0; i < this->free_.size(); ++i)
    {
      ofFree.row(static_cast<Index>(i)) =
        isPlane ? plane : Row(ofNode.row(this->free_[i]).normalized());
    }
    this->normals_ = ofFree;
    energy.setPlanes(normals, ofFree);
  }

  /// Puts free nodes back on the surface. Returns false if one has no place there.
  bool project(Points& points)
  {
    for (std::size_t i = 0; i < this->free_.size(); ++i)
    {
      const Index node = this->free_[i];
      const Row x = points.row(node);
      Row y;
      if (this->target_)
      {
        if (!this->target_->closestOnSurface(this->surface_, x,
              Row(this->normals_.row(static_cast<Index>(i))), y))
        {
          return false;
        }
      }
      else
      {
        y = this->shape_->closest(x, this->triangle_[i]);
      }
      points.row(node) = y;
    }
    return true;
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

  void untangle(FaceEnergy& energy)
  {
    FaceDensity density;
    FaceEnergy::State state = energy.evaluate(this->points_, this->monitor_);
    double best = state.minimumDeterminant;
    Index fewest = state.inverted;
    int idle = 0;
    for (int stage = 0; stage < UntangleStages && idle < StagesWithoutGain; ++stage)
    {
      const double d = std::min(0., state.minimumDeterminant);
      density.epsilon = std::sqrt(1e-12 + 0.04 * d * d);
      energy.setDensity(density);
      MinimizerLimits limits;
      limits.steps = static_cast<int>(knob("USTEPS", 10));
      Points trial = this->points_;
      newton(energy, trial, limits, this->matrix_, this->effort_, this->monitor_);
      if (!this->project(trial))
      {
        return;
      }
      this->points_ = trial;
      this->setPlanes(energy, this->points_);
      state = energy.evaluate(this->points_, this->monitor_);
      if (std::getenv("TRACE"))
      {
        std::fprintf(stderr, "  stage %d eps %g min %g inv %d E %g\n", stage, density.epsilon, state.minimumDeterminant, int(state.inverted), state.energy);
      }
      if (state.inverted == 0)
      {
        return;
      }
      const bool gains = state.inverted < fewest || state.minimumDeterminant > 0.9 * best;
      idle = gains ? 0 : idle + 1;
      best = std::max(best, state.minimumDeterminant);
      fewest = std::min(fewest, state.inverted);
    }
  }

  void improve(FaceEnergy& energy, const FaceDensity& density)
  {
    energy.setDensity(density);
    this->setPlanes(energy, this->points_);
    double now = energy.evaluate(this->points_, this->monitor_).energy;
    const bool isPlane = this->shape_ && this->shape_->isPlane();
    for (int round = 0; round < Rounds; ++round)
    {
      this->monitor_.check();
      const Points before = this->points_;
      Points trial = before;
      MinimizerLimits limits;
      limits.steps = isPlane ? 10 : StepsInRound;
      newton(energy, trial, limits, this->matrix_, this->effort_, this->monitor_);
      const Points way = trial - before;
      double next = now;
      bool found = false;
      for (int halving = 0; halving <= MostHalvings && !found; ++halving)
      {
        trial = before + std::ldexp(1., -halving) * way;
        if (!this->project(trial) ||
            energy.evaluate(trial, this->monitor_).inverted > 0)
        {
          continue;
        }
        this->setPlanes(energy, trial);
        next = energy.evaluate(trial, this->monitor_).energy;
        found = next < now;
        if (!found)
        {
          this->setPlanes(energy, before);
        }
      }
      if (!found)
      {
        break;
      }
      this->points_ = trial;
      const bool settled = now - next < LeastDecrease * next ||
                           (trial - before).rowwise().norm().maxCoeff() <
                             StopMove * this->meanEdge(trial);
      now = next;
      if (settled)
      {
        break;
      }
    }
  }

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const Index surface_;
  const std::vector<Index>& nodes_;
  const ProjectionTarget* target_;
  const BoundaryMotion& motion_;
  const FaceQuality& quality_;
  const std::vector<std::uint8_t>& isFolded_;
  Monitor& monitor_;
  Points points_;                  ///< of nodes_
  std::optional<PhongSurface> shape_; ///< without a target
  std::vector<FaceCorner> corners_; ///< with numbers in nodes_
  std::vector<Index> faceOf_;       ///< of each corner
  std::vector<Index> free_;         ///< numbers in nodes_
  std::vector<Index> triangle_;     ///< of the shape, of each free node
  Points normals_;                  ///< of free nodes
  BlockCsr3f matrix_;
  MinimizerEffort effort_;
};
}

SurfaceMeshSmoothing smoothSurfaceMeshes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor)
{
  SurfaceMeshSmoothing report;
  const Points start = motion.moved();
  const FaceQuality quality = faceQuality(motion.rest, start, faces, geometry);
  std::vector<std::uint8_t> isFolded(faces.cells.size(), 0);
  for (const Index f : foldedFaces(motion.rest, start, faces, geometry))
  {
    isFolded[f] = 1;
  }
  Points result = start;
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s)
  {
    const std::vector<Index>& nodes = geometry.surfaces[s].nodes;
    if (std::none_of(nodes.begin(), nodes.end(),
          [&](Index node) { return !motion.displacement.row(node).isZero(0); }))
    {
      continue;
    }
    Smoother smoother(faces, geometry, static_cast<Index>(s), target, motion, start, quality,
      isFolded, monitor);
    if (!smoother.hasFree())
    {
      continue;
    }
    smoother.run();
    report.steps += smoother.effort().steps;
    report.evaluations += smoother.effort().evaluations;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      if (motion.state[nodes[i]] == BoundaryMotion::OnSurface)
      {
        result.row(nodes[i]) = smoother.points().row(static_cast<Index>(i));
      }
    }
    report.smoothed.push_back(static_cast<Index>(s));
  }
  if (std::getenv("TRACE"))
  {
    const FaceQuality after = faceQuality(motion.rest, result, faces, geometry);
    std::fprintf(stderr, "start: min %g mean %g folded %d; result: min %g mean %g folded %d\n",
      quality.minimum, quality.mean, int(quality.folded.size()), after.minimum, after.mean, int(after.folded.size()));
  }
  for (const Index node : faces.nodes)
  {
    if (motion.state[node] == BoundaryMotion::OnSurface && result.row(node) != start.row(node))
    {
      motion.displacement.row(node) = result.row(node) - motion.rest.row(node);
    }
  }
  return report;
}
}
