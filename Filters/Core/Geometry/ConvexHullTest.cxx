// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ConvexHullTest.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr double Tolerance = 1e-7; // its square is well above the rounding of dot products
constexpr int MostPasses = 1000;

/// A corral: up to four vectors whose hull has its point nearest to the origin in its interior.
class Corral
{
public:
  explicit Corral(const Eigen::Vector3d& d)
    : size_(1)
  {
    this->vectors_.col(0) = d;
    this->weights_[0] = 1;
  }

  bool full() const { return this->size_ == 4; }

  Eigen::Vector3d nearest() const
  {
    return this->vectors_.leftCols(this->size_) * this->weights_.head(this->size_);
  }

  /// Adds a vector on the origin's side of the nearest point, then drops vectors that are not
  /// needed.
  void add(const Eigen::Vector3d& d)
  {
    this->vectors_.col(this->size_) = d;
    this->weights_[this->size_++] = 0;
    for (;;)
    {
      const Eigen::Vector4d target = this->affineWeights();
      // The largest step from the present weights to the target that keeps all weights positive.
      double step = 1;
      int leaving = -1;
      for (int i = 0; i < this->size_; ++i)
      {
        if (target[i] < 0)
        {
          const double limit = this->weights_[i] / (this->weights_[i] - target[i]);
          if (limit < step || leaving < 0)
          {
            step = std::min(step, limit);
            leaving = i;
          }
        }
      }
      this->weights_.head(this->size_) += step * (target - this->weights_).head(this->size_);
      if (leaving < 0)
      {
        return;
      }
      --this->size_;
      this->vectors_.col(leaving) = this->vectors_.col(this->size_).eval();
      this->weights_[leaving] = this->weights_[this->size_];
    }
  }

private:
  /// Weights, of sum one, of the point nearest to the origin in the affine hull of the vectors.
  Eigen::Vector4d affineWeights() const
  {
    Eigen::Matrix4d A = Eigen::Matrix4d::Identity();
    const auto vectors = this->vectors_.leftCols(this->size_);
    A.topLeftCorner(this->size_, this->size_) =
      (vectors.transpose() * vectors).array() + 1.; // positive definite: affinely independent
    Eigen::Vector4d ones = Eigen::Vector4d::Zero();
    ones.head(this->size_).setOnes();
    const Eigen::Vector4d u = A.ldlt().solve(ones);
    return u / u.sum();
  }

  int size_;
  Eigen::Matrix<double, 3, 4> vectors_;
  Eigen::Vector4d weights_ = Eigen::Vector4d::Zero();
};
}

bool insideConvexHull(const Eigen::RowVector3d& x, const ConstPoints& points)
{
  const Index n = points.rows();
  Points directions(n, 3);
  for (Index i = 0; i < n; ++i)
  {
    const Eigen::RowVector3d d = points.row(i) - x;
    const double length = d.norm();
    if (length == 0)
    {
      return true;
    }
    directions.row(i) = d / length;
  }
  if (n == 0)
  {
    return false;
  }
  Corral corral(directions.row(0));
  for (int pass = 0; pass < MostPasses; ++pass)
  {
    const Eigen::Vector3d v = corral.nearest();
    const double length = v.norm();
    if (length <= Tolerance || corral.full())
    {
      // The nearest point is inside the hull of four vectors, so it is the origin.
      return true;
    }
    Index lowest = 0;
    double least = std::numeric_limits<double>::max();
    for (Index i = 0; i < n; ++i)
    {
      const double dot =
        directions(i, 0) * v[0] + directions(i, 1) * v[1] + directions(i, 2) * v[2];
      if (dot < least)
      {
        least = dot;
        lowest = i;
      }
    }
    if (least > Tolerance * length)
    {
      return false; // all points are on one side of the plane through x normal to v
    }
    corral.add(directions.row(lowest));
  }
  return false;
}
}
