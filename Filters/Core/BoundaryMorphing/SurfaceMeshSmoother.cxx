// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceMeshSmoother.h"

#include "Support/Parallel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <atomic>
#include <cmath>

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
}

SurfaceMeshSmoother::SurfaceMeshSmoother(const BoundaryFaces& faces, const Classification& geometry,
  Index surface, const ProjectionTarget* target, const BoundaryMotion& motion, const Points& start,
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

void SurfaceMeshSmoother::run()
{
  FaceEnergy energy(this->corners_, this->free_, this->points_.rows());
  this->setPlanes(energy, this->points_);
  energy.setDensity({});
  if (energy.evaluate(this->points_, this->monitor_).inverted == 0 || this->untangle(energy))
  {
    this->improve(energy);
  }
}

Index SurfaceMeshSmoother::local(Index node) const
{
  return std::lower_bound(this->nodes_.begin(), this->nodes_.end(), node) - this->nodes_.begin();
}

void SurfaceMeshSmoother::makeCorners()
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
      // Corners overlap: those of a triangle cover it three times, those of a quadrilateral twice.
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

std::vector<std::uint8_t> SurfaceMeshSmoother::findFree()
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

bool SurfaceMeshSmoother::isOnTarget(Index number, double tolerance) const
{
  const Row x = this->points_.row(number);
  Row y;
  return this->target_->closestOnSurface(this->surface_, x, Row::Zero(), y) &&
         (x - y).norm() <= tolerance;
}

Row SurfaceMeshSmoother::upOf(Index f, const Points& points) const
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

Row SurfaceMeshSmoother::planeNormal() const
{
  const Row normal = this->shape_->planeNormal();
  double side = 0;
  for (const Index f : this->geometry_.surfaces[this->surface_].faces)
  {
    side += normal.dot(this->quality_.normal.row(f));
  }
  return side < 0 ? Row(-normal) : normal;
}

void SurfaceMeshSmoother::setPlanes(FaceEnergy& energy, const Points& points)
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

bool SurfaceMeshSmoother::project(Points& points)
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

double SurfaceMeshSmoother::meanEdge(const Points& points) const
{
  double sum = 0;
  for (const FaceCorner& corner : this->corners_)
  {
    sum += (points.row(corner.node[1]) - points.row(corner.node[0])).norm();
  }
  return sum / static_cast<double>(this->corners_.size());
}

bool SurfaceMeshSmoother::untangle(FaceEnergy& energy)
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

void SurfaceMeshSmoother::improve(FaceEnergy& energy)
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
}
