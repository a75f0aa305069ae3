// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceSmoothing.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/BoundaryProjection.h"
#include "Energies/FaceEnergy.h"
#include "Support/Lists.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr double Poor = 0.2;       // scaled Jacobian
constexpr double PartOfRest = 0.5; // of its undeformed value
constexpr int Rings = 2;
constexpr int Sweeps = 20;
constexpr int MostHalvings = 8;
constexpr double LeastDecrease = 1e-4; // minimum decrease of the sum, relative

using Row = Eigen::RowVector3d;
using Plane = FaceEnergy::Plane;

/// A corner of a face with its two neighbors.
struct Corner
{
  Index node[3];               ///< the corner, the next node, the one before
  Eigen::Matrix2d restInverse; ///< of the two edges in the undeformed face's plane
  double area;                 ///< twice the undeformed triangle's
  double weight;
};

class Improvement
{
public:
  Improvement(const BoundaryFaces& faces, const Classification& geometry,
    const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor)
    : faces_(faces)
    , geometry_(geometry)
    , target_(target)
    , motion_(motion)
    , monitor_(monitor)
    , position_(motion.moved())
  {
  }

  void run()
  {
    const FaceQuality now = this->quality(this->position_);
    const FaceQuality rest = this->quality(this->motion_.rest);
    std::vector<Index> poor;
    for (std::size_t f = 0; f < now.scaledJacobian.size(); ++f)
    {
      const double undeformed = rest.scaledJacobian[f]; // negative where it is folded
      if (now.scaledJacobian[f] < Poor &&
          now.scaledJacobian[f] < undeformed - PartOfRest * std::abs(undeformed))
      {
        poor.push_back(static_cast<Index>(f));
      }
    }
    if (poor.empty())
    {
      return;
    }
    this->makeCorners();
    const std::vector<Index> patch = this->around(poor);
    for (int sweep = 0; sweep < Sweeps; ++sweep)
    {
      this->normal_ =
        surfaceNodeNormals(this->motion_.rest, this->position_, this->faces_, this->geometry_);
      bool any = false;
      for (Index node : patch)
      {
        any = this->improve(node) || any;
      }
      this->monitor_.check();
      if (!any)
      {
        break;
      }
    }
    this->write(patch);
  }

private:
  FaceQuality quality(const Points& points) const
  {
    return faceQuality(this->motion_.rest, points, this->faces_, this->geometry_);
  }

  void makeCorners()
  {
    for (std::size_t f = 0; f + 1 < this->faces_.offsets.size(); ++f)
    {
      const Index first = this->faces_.offsets[f], size = this->faces_.offsets[f + 1] - first;
      const Index* nodes = this->faces_.connectivity.data() + first;
      const Row area = vectorArea(this->motion_.rest, nodes, size);
      if ((size != 3 && size != 4) || !(area.norm() > 0))
      {
        continue;
      }
      const Plane plane = FaceEnergy::tangents(area.normalized());
      for (Index k = 0; k < size; ++k)
      {
        Corner corner{ { nodes[k], nodes[(k + 1) % size], nodes[(k + size - 1) % size] }, {}, 0,
          0 };
        const Eigen::Matrix2d D = edges(corner, this->motion_.rest, plane);
        corner.area = D.determinant();
        // The corners of a triangle cover it three times, those of a quadrilateral twice. With
        // these weights forces of an affine motion cancel between both, too.
        corner.weight = corner.area / (size == 3 ? 3. : 2.);
        if (corner.area > 0)
        {
          corner.restInverse = D.inverse();
          this->corners_.push_back(corner);
        }
      }
    }
    this->cornersAt_ =
      gatherMap(static_cast<Index>(3 * this->corners_.size()), this->motion_.rest.rows(),
        [this](Index place) { return this->corners_[place / 3].node[place % 3]; });
    for (Index& corner : this->cornersAt_.values)
    {
      corner /= 3;
    }
  }

  static Eigen::Matrix2d edges(const Corner& corner, const Points& points, const Plane& plane)
  {
    Eigen::Matrix2d D;
    for (int k = 0; k < 2; ++k)
    {
      D.col(k) =
        ((points.row(corner.node[k + 1]) - points.row(corner.node[0])) * plane).transpose();
    }
    return D;
  }

  /// Returns corners that move, ascending, of faces within some rings of the poor ones.
  std::vector<Index> around(const std::vector<Index>& poor) const
  {
    std::vector<std::uint8_t> near(this->motion_.rest.rows(), 0);
    for (Index f : poor)
    {
      for (Index i = this->faces_.offsets[f]; i < this->faces_.offsets[f + 1]; ++i)
      {
        near[this->faces_.connectivity[i]] = 1;
      }
    }
    for (int ring = 0; ring < Rings; ++ring)
    {
      const std::vector<std::uint8_t> before = near;
      for (const Corner& corner : this->corners_)
      {
        const bool touches =
          before[corner.node[0]] || before[corner.node[1]] || before[corner.node[2]];
        for (Index node : corner.node)
        {
          near[node] = near[node] || touches;
        }
      }
    }
    std::vector<Index> patch;
    for (Index node : this->faces_.nodes)
    {
      if (near[node] && this->motion_.state[node] == BoundaryMotion::OnSurface &&
          this->cornersAt_.begin(node) != this->cornersAt_.end(node))
      {
        patch.push_back(node);
      }
    }
    return patch;
  }

  struct Sum
  {
    double value = 0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    double least = std::numeric_limits<double>::infinity(); ///< determinant
  };

  Sum sumAround(Index node, const Plane& plane, double delta) const
  {
    Sum sum;
    for (const Index* c = this->cornersAt_.begin(node); c != this->cornersAt_.end(node); ++c)
    {
      const Corner& corner = this->corners_[*c];
      const Eigen::Matrix2d J = edges(corner, this->position_, plane) * corner.restInverse;
      const double d = J.determinant(), root = std::sqrt(d * d + delta * delta);
      const double chi = d > 0 || delta == 0 ? (d + root) / 2 : delta * delta / (2 * (root - d));
      sum.least = std::min(sum.least, d);
      if (!(chi > 0))
      {
        sum.value = std::numeric_limits<double>::infinity();
        return sum;
      }
      const double square = J.squaredNorm();
      sum.value += corner.weight * square / (2 * chi);
      const Eigen::Matrix2d force =
        corner.weight * (J / chi - square / (2 * chi * root) * FaceDensity::cofactor(J)) *
        corner.restInverse.transpose();
      sum.gradient += node == corner.node[1]   ? Eigen::Vector2d(force.col(0))
                      : node == corner.node[2] ? Eigen::Vector2d(force.col(1))
                                               : Eigen::Vector2d(-force.rowwise().sum());
    }
    return sum;
  }

  /// Returns the Newton step in the tangent plane, by differences of the gradient. Curvature is
  /// made positive.
  Eigen::Vector2d step(Index node, const Plane& plane, double delta, const Sum& sum)
  {
    const Row place = this->position_.row(node);
    double length = 0;
    for (const Index* c = this->cornersAt_.begin(node); c != this->cornersAt_.end(node); ++c)
    {
      length = std::max(length, std::sqrt(this->corners_[*c].area));
    }
    const double h = 1e-6 * length;
    Eigen::Matrix2d H;
    for (int j = 0; j < 2; ++j)
    {
      this->position_.row(node) = place + h * plane.col(j).transpose();
      H.col(j) = (this->sumAround(node, plane, delta).gradient - sum.gradient) / h;
    }
    this->position_.row(node) = place;
    if (!H.allFinite())
    {
      return Eigen::Vector2d::Zero();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(
      Eigen::Matrix2d(H + H.transpose()) / 2);
    const Eigen::Vector2d curvature =
      eigen.eigenvalues().cwiseAbs().cwiseMax(1e-3 * eigen.eigenvalues().cwiseAbs().maxCoeff());
    if (!(curvature.minCoeff() > 0))
    {
      return Eigen::Vector2d::Zero();
    }
    return -eigen.eigenvectors() *
           (eigen.eigenvectors().transpose() * sum.gradient).cwiseQuotient(curvature);
  }

  bool improve(Index node)
  {
    const Row normal = this->normal_.row(node), place = this->position_.row(node);
    if (!(normal.norm() > 0))
    {
      return false;
    }
    const Plane plane = FaceEnergy::tangents(normal);
    const double least = this->sumAround(node, plane, 1).least;
    const double delta = least > 0 ? 0 : 2 * std::sqrt(1e-6 + 0.04 * least * least);
    const Sum sum = this->sumAround(node, plane, delta);
    Eigen::Vector2d way = this->step(node, plane, delta, sum);
    for (int halving = 0; halving < MostHalvings; ++halving, way /= 2)
    {
      Row to = place + (plane * way).transpose();
      if (this->target_ &&
          !this->target_->closestOnSurface(this->geometry_.entity[node], Row(to), normal, to))
      {
        continue;
      }
      this->position_.row(node) = to;
      if (this->sumAround(node, plane, delta).value < (1 - LeastDecrease) * sum.value)
      {
        return true;
      }
    }
    this->position_.row(node) = place;
    return false;
  }

  /// Writes the corners' new positions to the motion and moves the nodes between them.
  void write(const std::vector<Index>& patch)
  {
    const Points before = this->motion_.moved();
    for (Index node : patch)
    {
      if (this->position_.row(node) != before.row(node))
      {
        this->motion_.displacement.row(node) =
          this->position_.row(node) - this->motion_.rest.row(node);
      }
    }
    carryMidNodes(
      this->faces_, this->geometry_, this->target_, this->normal_, before, this->motion_);
  }

  const BoundaryFaces& faces_;
  const Classification& geometry_;
  const ProjectionTarget* target_;
  BoundaryMotion& motion_;
  Monitor& monitor_;
  Points position_; ///< #nodes x 3
  Points normal_;
  std::vector<Corner> corners_;
  Adjacency cornersAt_; ///< #nodes: corners that use the node
};
}

void smoothSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor)
{
  Improvement(faces, geometry, target, motion, monitor).run();
}
}
