// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierWeights.h"

#include "Geometry/RotationFit.h"
#include "Support/Lists.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace morph
{
namespace
{
constexpr int UsualIterations = 30;
constexpr int MostIterations = 500;   // towards a face of the hull a step increases mu by a sixth
constexpr double DampedAbove = 0.25;  // of the Newton decrement
constexpr double EndDecrement = 1e-6; // the next step squares it
constexpr double UsualMu = 1e3;
constexpr double LargestMu = 1e10;
constexpr double TurnEvery = 1e2; // growth of mu
constexpr double HullTolerance =
  1e-11; // of the local size, for neighbors beyond the plane through the node
constexpr double FaceTolerance =
  1e-8; // for neighbors in it; their own part of mu tilts the plane a little less
constexpr double LargestResidual = 1e-10;

/// Solves H x = -g, where H is symmetric positive definite with entries xx, xy, xz, yy, yz, zz.
/// Returns x and the Newton decrement.
double newtonStep(const double H[6], const Eigen::Vector3d& g, Eigen::Vector3d& x)
{
  const double i0 = 1 / H[0];
  const double l1 = H[1] * i0, l2 = H[2] * i0;
  const double d1 = H[3] - l1 * H[1];
  const double i1 = 1 / d1;
  const double e = H[4] - l1 * H[2];
  const double l3 = e * i1;
  const double i2 = 1 / (H[5] - l2 * H[2] - l3 * e);
  const double y0 = -g[0];
  const double y1 = -g[1] - l1 * y0;
  const double y2 = -g[2] - l2 * y0 - l3 * y1;
  x[2] = y2 * i2;
  x[1] = y1 * i1 - l3 * x[2];
  x[0] = y0 * i0 - l1 * x[1] - l2 * x[2];
  return std::sqrt(std::max(0., y0 * y0 * i0 + y1 * y1 * i1 + y2 * y2 * i2));
}

enum class Status
{
  Converged,
  OnBoundary, ///< mu . d_j >= 0 for all j: g has no minimum
  BeyondLimit,
  Stalled
};
}

struct LogBarrierWeights::Dual
{
  Eigen::Vector3d mu = Eigen::Vector3d::Zero(); ///< in whitened coordinates
  int iterations = 0;
  Status status = Status::Stalled;
};

void LogBarrierWeights::resize(int k)
{
  const std::size_t pairs = static_cast<std::size_t>(k + 1) / 2;
  for (std::vector<Pair>* v : { &this->x_, &this->y_, &this->z_, &this->inverse_ })
  {
    v->resize(pairs);
  }
  // Pads an odd number of neighbors.
  this->x_.back()[1] = this->y_.back()[1] = this->z_.back()[1] = 0;
}

/// Whitens by the Cholesky factor of sum d d^T / k. Returns false if it is too near singular for
/// its digits.
bool LogBarrierWeights::whiten(const double (*offsets)[3], int k, double scale)
{
  constexpr double SmallestPivot = 1e-12; // of the entry it came from
  double S[6] = {}, sum[3] = {};
  for (int j = 0; j < k; ++j)
  {
    const double x = scale * offsets[j][0], y = scale * offsets[j][1], z = scale * offsets[j][2];
    S[0] += x * x;
    S[1] += x * y;
    S[2] += x * z;
    S[3] += y * y;
    S[4] += y * z;
    S[5] += z * z;
    sum[0] += x;
    sum[1] += y;
    sum[2] += z;
  }
  const double perNeighbor = 1. / k;
  for (double& s : S)
  {
    s *= perNeighbor;
  }
  const double p0 = S[0];
  const double i0 = 1 / std::sqrt(p0);
  const double l1 = S[1] * i0, l2 = S[2] * i0;
  const double p1 = S[3] - l1 * l1;
  const double i1 = 1 / std::sqrt(p1);
  const double l3 = (S[4] - l1 * l2) * i1;
  const double p2 = S[5] - l2 * l2 - l3 * l3;
  const double i2 = 1 / std::sqrt(p2);
  if (!(p0 > 0 && p1 > SmallestPivot * S[3] && p2 > SmallestPivot * S[5]))
  {
    return false;
  }
  const auto solve = [&](const double* d, double by, double& x, double& y, double& z)
  {
    x = by * d[0] * i0;
    y = (by * d[1] - l1 * x) * i1;
    z = (by * d[2] - l2 * x - l3 * y) * i2;
  };
  double* x = this->x_[0].data();
  double* y = this->y_[0].data();
  double* z = this->z_[0].data();
  for (int j = 0; j < k; ++j)
  {
    solve(offsets[j], scale, x[j], y[j], z[j]);
  }
  solve(sum, perNeighbor, this->mean_[0], this->mean_[1], this->mean_[2]);
  return true;
}

/// Whitens by the singular values of all d_j, which keep the digits that their squares lose.
/// Returns the dimension of the span of the d_j; whitened coordinates beyond it are zero.
int LogBarrierWeights::whitenCarefully(const double (*offsets)[3], int k, double scale)
{
  const Points d = scale * Eigen::Map<const Points>(offsets[0], k, 3);
  const ThinSvd3 principal(d);
  Eigen::Matrix3d toWhite = Eigen::Matrix3d::Zero();
  for (int c = 0; c < principal.dimension; ++c)
  {
    toWhite.col(c) =
      principal.axes.col(c) * (std::sqrt(static_cast<double>(k)) / principal.extent[c]);
  }
  const Points white = d * toWhite;
  for (int j = 0; j < k; ++j)
  {
    this->x_[0].data()[j] = white(j, 0);
    this->y_[0].data()[j] = white(j, 1);
    this->z_[0].data()[j] = white(j, 2);
  }
  this->mean_ = white.colwise().mean();
  return principal.dimension;
}

/// Applies Newton's method from dual.mu, up to a total of `mostIterations`, while mu stays below
/// `limit`.
void LogBarrierWeights::minimize(Dual& dual, int k, int dimension, double limit, int mostIterations)
{
  const std::size_t pairs = static_cast<std::size_t>(k + 1) / 2;
  dual.status = Status::Stalled;
  while (dual.iterations < mostIterations)
  {
    Eigen::Vector3d step;
    double decrement = 0;
    if (dual.iterations == 0)
    {
      // Whitening makes the Hessian at mu = 0 k times the identity, so the first step needs no
      // sums.
      step = this->mean_;
      decrement = std::sqrt(static_cast<double>(k)) * step.norm();
    }
    else
    {
      const Pair mx = Pair::Constant(dual.mu[0]), my = Pair::Constant(dual.mu[1]),
                 mz = Pair::Constant(dual.mu[2]);
      Pair gx = Pair::Zero(), gy = gx, gz = gx, xx = gx, xy = gx, xz = gx, yy = gx, yz = gx,
           zz = gx;
      Pair least = gx, most = gx;
      for (std::size_t p = 0; p < pairs; ++p)
      {
        const Pair x = this->x_[p], y = this->y_[p], z = this->z_[p];
        const Pair along = mx * x + my * y + mz * z;
        least = least.min(along);
        most = most.max(along);
        const Pair r = 1 / (1 + along);
        const Pair a = r * x, b = r * y, c = r * z;
        gx -= a;
        gy -= b;
        gz -= c;
        xx += a * a;
        xy += a * b;
        xz += a * c;
        yy += b * b;
        yz += b * c;
        zz += c * c;
      }
      // mu . d_j >= 0 for all j: all neighbors are on one side of a plane through the node.
      if (least.minCoeff() >= -HullTolerance * most.maxCoeff() && most.maxCoeff() > 0)
      {
        dual.status = Status::OnBoundary;
        return;
      }
      const Eigen::Vector3d g(gx.sum(), gy.sum(), gz.sum());
      const double H[6] = { xx.sum(), xy.sum(), xz.sum(), dimension < 2 ? 1 : yy.sum(), yz.sum(),
        dimension < 3 ? 1 : zz.sum() };
      decrement = newtonStep(H, g, step);
      if (!step.allFinite())
      {
        dual.status = Status::OnBoundary; // mu is normal to a face of the hull, to rounding
        return;
      }
    }
    dual.mu += decrement > DampedAbove ? Eigen::Vector3d(step / (1 + decrement)) : step;
    ++dual.iterations;
    if (decrement <= EndDecrement)
    {
      const Pair mx = Pair::Constant(dual.mu[0]), my = Pair::Constant(dual.mu[1]),
                 mz = Pair::Constant(dual.mu[2]);
      for (std::size_t p = 0; p < pairs; ++p)
      {
        this->inverse_[p] = 1 / (1 + (mx * this->x_[p] + my * this->y_[p] + mz * this->z_[p]));
      }
      dual.status = Status::Converged;
      return;
    }
    if (!(dual.mu.norm() <= limit))
    {
      dual.status = std::isfinite(dual.mu.norm()) ? Status::BeyondLimit : Status::Stalled;
      return;
    }
  }
}

/// Reflects the whitened coordinates so that mu lies along the last axis. Near the hull mu is huge
/// and nearly orthogonal to the neighbors with large weights. Along an axis its products with them,
/// and the Hessian's smallest pivot, keep their digits.
void LogBarrierWeights::turn(Dual& dual, int k, int dimension)
{
  Eigen::Vector3d axis = dual.mu.normalized();
  axis[dimension - 1] += axis[dimension - 1] < 0 ? -1 : 1;
  const double scale = 2 / axis.squaredNorm();
  double* x = this->x_[0].data();
  double* y = this->y_[0].data();
  double* z = this->z_[0].data();
  for (int j = 0; j < k; ++j)
  {
    const double along = scale * (axis[0] * x[j] + axis[1] * y[j] + axis[2] * z[j]);
    x[j] -= along * axis[0];
    y[j] -= along * axis[1];
    z[j] -= along * axis[2];
  }
  dual.mu -= scale * axis.dot(dual.mu) * axis;
}

void LogBarrierWeights::fillWeights(int k, double* weights) const
{
  const double* inverse = this->inverse_[0].data();
  double sum = 0;
  for (int j = 0; j < k; ++j)
  {
    sum += inverse[j];
  }
  const double scale = 1 / sum;
  for (int j = 0; j < k; ++j)
  {
    weights[j] = scale * inverse[j];
  }
}

LogBarrierWeights::Result LogBarrierWeights::compute(
  const double (*offsets)[3], int k, double* weights)
{
  double largest = 0;
  for (int j = 0; j < k; ++j)
  {
    for (int c = 0; c < 3; ++c)
    {
      largest = std::max(largest, std::abs(offsets[j][c]));
    }
  }
  if (k == 0)
  {
    return { Place::Outside, 0 };
  }
  if (!(largest > 0)) // all neighbors coincide: any convex weights are exact
  {
    std::fill(weights, weights + k, 1. / k);
    return { Place::Inside, 0 };
  }
  const double scale = 1 / largest;
  this->resize(k);
  int iterations = 0;
  if (this->whiten(offsets, k, scale))
  {
    Dual dual;
    this->minimize(dual, k, 3, UsualMu, UsualIterations);
    iterations = dual.iterations;
    if (dual.status == Status::Converged)
    {
      this->fillWeights(k, weights);
      return { Place::Inside, iterations };
    }
  }
  Result careful = this->computeCarefully(offsets, k, scale, weights);
  careful.iterations += iterations;
  return careful;
}

/// Treats the remaining cases: flat neighborhoods, and nodes near the hull, on it or outside. Where
/// g has no minimum, mu defines a plane through the node with every neighbor on one side. Neighbors
/// off this plane get weight zero, and the others form the same problem with one dimension less.
LogBarrierWeights::Result LogBarrierWeights::computeCarefully(
  const double (*offsets)[3], int k, double scale, double* weights)
{
  std::vector<int> kept = consecutive<int>(k);
  Result result = { Place::Inside, 0 };
  using Offset = std::array<double, 3>;
  std::vector<Offset> some;
  std::vector<double> found;
  for (int faces = 0; faces < 3 && !kept.empty(); ++faces)
  {
    some.clear();
    for (int j : kept)
    {
      some.push_back({ offsets[j][0], offsets[j][1], offsets[j][2] });
    }
    const int count = static_cast<int>(kept.size());
    const auto* d = reinterpret_cast<const double(*)[3]>(some.data());
    this->resize(count);
    const int dimension = std::max(this->whitenCarefully(d, count, scale), 1);
    Dual dual;
    for (double limit = TurnEvery; limit <= LargestMu; limit *= TurnEvery)
    {
      this->minimize(dual, count, dimension, limit, MostIterations);
      if (dual.status != Status::BeyondLimit)
      {
        break;
      }
      this->turn(dual, count, dimension);
    }
    result.iterations += dual.iterations;
    if (dual.status == Status::Converged)
    {
      found.resize(count);
      this->fillWeights(count, found.data());
      Eigen::RowVector3d residual = Eigen::RowVector3d::Zero();
      std::fill(weights, weights + k, 0.);
      for (int i = 0; i < count; ++i)
      {
        residual += found[i] * scale * Eigen::Map<const Eigen::RowVector3d>(d[i]);
        weights[kept[i]] = found[i];
      }
      if (residual.norm() <= LargestResidual)
      {
        return result;
      }
      break;
    }
    if (dual.status == Status::Stalled)
    {
      break;
    }
    const Eigen::Vector3d normal = dual.mu.normalized();
    std::vector<int> face;
    for (int i = 0; i < count; ++i)
    {
      const std::size_t p = static_cast<std::size_t>(i) / 2;
      const Eigen::Vector3d white(this->x_[p][i % 2], this->y_[p][i % 2], this->z_[p][i % 2]);
      if (normal.dot(white) <= FaceTolerance)
      {
        face.push_back(kept[i]);
      }
    }
    if (face.size() == kept.size())
    {
      break;
    }
    kept.swap(face);
    result.place = Place::OnHull;
  }
  result.place = Place::Outside;
  return result;
}
}
