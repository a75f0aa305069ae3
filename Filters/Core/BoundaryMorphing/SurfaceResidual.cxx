// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/SurfaceResidual.h"

#include "Boundary/SurfaceEdges.h"
#include "Interpolation/InverseDistanceWeights.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Dense>

#include <cmath>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double Flat = 1e-12; // determinants and areas below this, relative, count as zero

void requireFinite(const char* what, const Points& points)
{
  std::vector<Index> wrong;
  for (Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      wrong.push_back(i);
    }
  }
  if (!wrong.empty())
  {
    throw Error(
      std::string(what) + " that are not finite (NaN or infinite) in rows " + listIds(wrong) + ".");
  }
}

void requireLoops(const SurfaceResidual::Loops& loops, Index points)
{
  for (std::size_t l = 0; l < loops.size(); ++l)
  {
    if (loops[l].size() < 3)
    {
      throw Error("Loop " + std::to_string(l) + " of a surface has " +
                  std::to_string(loops[l].size()) + " points; a loop has at least three.");
    }
    std::vector<Index> wrong;
    for (Index row : loops[l])
    {
      if (row < 0 || row >= points)
      {
        wrong.push_back(row);
      }
    }
    if (!wrong.empty())
    {
      throw Error("Loop " + std::to_string(l) + " of a surface names rows " + listIds(wrong) +
                  " where there are " + std::to_string(points) + " prescribed points.");
    }
  }
}

Points centered(const Points& points)
{
  return points.rowwise() - points.colwise().mean();
}

/// Returns the unit normal of the plane that fits the points, and two unit vectors in it. Their
/// rotation is that of the eigenvectors.
Eigen::Matrix3d planeAxes(const Points& points)
{
  const Points arms = centered(points);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(arms.transpose() * arms);
  Eigen::Matrix3d columns;
  columns.col(0) = axes.eigenvectors().col(0);
  columns.col(1) = axes.eigenvectors().col(1);
  columns.col(2) = columns.col(0).cross(columns.col(1));
  return columns;
}

Eigen::Vector3d areaOf(const SurfaceResidual::Loops& loops, const Points& points)
{
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const std::vector<Index>& loop : loops)
  {
    sum += vectorArea(points, loop.data(), static_cast<Index>(loop.size()));
  }
  return sum.transpose();
}

/// Returns the rotation times scale that fits the map from `rest` to `moved` (both centered), for
/// row vectors. Source: Kabsch, Acta Cryst. A 34 (1978) 827-828; the scale is the ratio of the
/// extents.
Eigen::Matrix3d similarity(const Points& rest, const Points& moved)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
    rest.transpose() * moved, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, 1);
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const double scale = std::sqrt(moved.squaredNorm() / rest.squaredNorm());
  return scale * svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}
}

/// u(x) = mean + (x - center) gradient.
struct SurfaceResidual::Map
{
  Eigen::RowVector3d center, mean;
  Eigen::Matrix3d gradient;
  bool isReplaced = false; ///< by the best rotation and scale

  Eigen::RowVector3d displacement(const Eigen::RowVector3d& x) const
  {
    return this->mean + (x - this->center) * this->gradient;
  }
};

void SurfaceResidual::setNumberOfNeighbors(Index count)
{
  if (count < 1)
  {
    throw Error("The number of neighbors must be at least 1; it is " + std::to_string(count) + ".");
  }
  this->numberOfNeighbors_ = count;
}

void SurfaceResidual::prepare(
  const Points& prescribed, const Points& points, const Loops& loops, Monitor& monitor)
{
  this->prepared_ = false;
  requireFinite("Prescribed points", prescribed);
  requireFinite("Points of a surface", points);
  requireLoops(loops, prescribed.rows());
  this->prescribed_ = prescribed;
  this->points_ = points;
  this->loops_ = loops;
  this->sites_ = InterpolationSites(prescribed, consecutive(prescribed.rows()));
  this->fit_ = AffineLeastSquares(this->sites_.coordinates(), points);
  this->weights_ = inverseDistanceWeights(this->sites_, points, this->numberOfNeighbors_, monitor);
  this->prepared_ = true;
}

/// `displacement`: of the sites.
SurfaceResidual::Map SurfaceResidual::linearMap(const Points& displacement) const
{
  const AffineFit fit = this->fit_.fit(displacement);
  Map map;
  map.center = this->sites_.coordinates().colwise().mean();
  map.mean = fit.displacement(map.center);
  // Points on a line tell no map of a surface. Those nearly on one tell it as far as their second
  // direction counts.
  map.gradient = this->fit_.directions().shares()[1] * fit.gradient();
  return map;
}

/// `displacement`: of the sites; `prescribed`: new positions of the prescribed points.
SurfaceResidual::Map SurfaceResidual::map(
  const Points& displacement, const Points& prescribed) const
{
  const Points& sites = this->sites_.coordinates();
  Map map = this->linearMap(displacement);
  const Eigen::RowVector3d& shares = this->fit_.directions().shares();
  if (shares[1] == 0)
  {
    return map;
  }
  const Points moved = sites + displacement;
  if (shares[0] < 1)
  {
    // Both planes' axes, areas and normals result from the same steps, so they agree bit for bit
    // without motion.
    const Eigen::Matrix3d axes = planeAxes(sites);
    const Eigen::Vector3d u = axes.col(1), v = axes.col(2);
    Eigen::Vector3d area = u.cross(v);
    Eigen::Vector3d movedArea = Eigen::Vector3d(u + map.gradient.transpose() * u)
                                  .cross(Eigen::Vector3d(v + map.gradient.transpose() * v));
    const Eigen::Vector3d loopArea = areaOf(this->loops_, this->prescribed_);
    const Eigen::Vector3d movedLoopArea = areaOf(this->loops_, prescribed);
    // The loops of a closed strip cancel and determine nothing.
    if (loopArea.norm() > Flat * (sites.rowwise() - map.center).squaredNorm())
    {
      area = loopArea;
      movedArea = movedLoopArea;
    }
    Eigen::Vector3d normal = axes.col(0), movedNormal = planeAxes(moved).col(0);
    normal *= normal.dot(area) < 0 ? -1 : 1;
    movedNormal *= movedNormal.dot(movedArea) < 0 ? -1 : 1;
    const double scale = std::sqrt(movedArea.norm() / area.norm());
    map.gradient +=
      shares[1] * (1 - shares[0]) * normal * (scale * movedNormal - normal).transpose();
  }
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() + map.gradient;
  map.isReplaced = A.determinant() <= Flat * std::pow(A.norm(), 3);
  if (map.isReplaced)
  {
    map.gradient = similarity(centered(sites), centered(moved)) - Eigen::Matrix3d::Identity();
  }
  return map;
}

void SurfaceResidual::require(const Points& prescribed) const
{
  if (!this->prepared_)
  {
    throw Error(
      "The method is not prepared: call prepare() first, and again after one that failed.");
  }
  requireRows("The array of prescribed positions", prescribed.rows(), this->prescribed_.rows());
  requireFinite("Prescribed positions", prescribed);
}

Points SurfaceResidual::spread(const Map& map, Points residual, Monitor& monitor) const
{
  for (Index s = 0; s < residual.rows(); ++s)
  {
    residual.row(s) -= map.displacement(this->sites_.coordinates().row(s));
  }
  Points displacement;
  this->weights_.multiply(residual, displacement, monitor);
  parallel(displacement.rows(), Grain, monitor,
    [&](Index i) { displacement.row(i) += map.displacement(this->points_.row(i)); });
  return displacement;
}

bool SurfaceResidual::evaluate(const Points& prescribed, Points& moved, Monitor& monitor) const
{
  this->require(prescribed);
  monitor.check();
  const Points ofSites = this->sites_.average(prescribed - this->prescribed_, monitor);
  const Map map = this->map(ofSites, prescribed);
  const Points displacement = this->spread(map, ofSites, monitor);
  Points result = this->points_;
  for (Index i = 0; i < result.rows(); ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (displacement(i, j) != 0) // -0.0 + 0.0 would be 0.0
      {
        result(i, j) += displacement(i, j);
      }
    }
  }
  moved.swap(result);
  return map.isReplaced;
}

void SurfaceResidual::evaluateLinear(
  const Points& displacement, Points& moved, Monitor& monitor) const
{
  this->require(displacement);
  monitor.check();
  const Points ofSites = this->sites_.average(displacement, monitor);
  moved = this->spread(this->linearMap(ofSites), ofSites, monitor);
}
}
