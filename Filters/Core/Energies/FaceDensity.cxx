// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/FaceDensity.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace morph
{
namespace
{
/// 1 / (2 chi) and its derivatives by the determinant d.
struct Weight
{
  double value, first, second;

  Weight(double d, double epsilon)
  {
    const double root = std::sqrt(d * d + epsilon * epsilon);
    // Two forms of one number, each without cancellation where it is used.
    this->value = d > 0 ? 1 / (d + root) : (root - d) / (epsilon * epsilon);
    this->first = -this->value / root;
    this->second = 1 / (root * root * root);
  }
};

/// J = U diag(s) V^T with rotations U and V; s[1] has the sign of the determinant.
struct PlaneSingularValues
{
  Eigen::Matrix2d U, V;
  Eigen::Vector2d s;

  explicit PlaneSingularValues(const Eigen::Matrix2d& J)
  {
    const double e = (J(0, 0) + J(1, 1)) / 2, f = (J(0, 0) - J(1, 1)) / 2;
    const double g = (J(1, 0) + J(0, 1)) / 2, h = (J(1, 0) - J(0, 1)) / 2;
    const double sum = std::hypot(e, h), difference = std::hypot(f, g);
    this->s << sum + difference, sum - difference;
    const double a = std::atan2(g, f), b = std::atan2(h, e);
    this->U = rotation((b + a) / 2);
    this->V = rotation((a - b) / 2);
  }

  static Eigen::Matrix2d rotation(double angle)
  {
    Eigen::Matrix2d R;
    R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return R;
  }
};

double infiniteUnlessFinite(double value)
{
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

double toPower(double value, int power)
{
  double result = value;
  for (int i = 1; i < power; ++i)
  {
    result *= value;
  }
  return result;
}
}

Eigen::Matrix2d FaceDensity::cofactor(const Eigen::Matrix2d& J)
{
  Eigen::Matrix2d result;
  result << J(1, 1), -J(1, 0), -J(0, 1), J(0, 0);
  return result;
}

double FaceDensity::value(const Eigen::Matrix2d& J) const
{
  const double d = J.determinant();
  if (!(this->epsilon > 0 || d > 0))
  {
    return std::numeric_limits<double>::infinity();
  }
  const double phi = J.squaredNorm() * Weight(d, this->epsilon).value;
  return infiniteUnlessFinite(toPower(phi, this->power));
}

double FaceDensity::gradient(const Eigen::Matrix2d& J, Eigen::Matrix2d& derivative) const
{
  const Weight weight(J.determinant(), this->epsilon);
  const double square = J.squaredNorm(), phi = square * weight.value;
  derivative = 2 * weight.value * J + square * weight.first * cofactor(J);
  if (this->power > 1)
  {
    derivative *= this->power * toPower(phi, this->power - 1);
  }
  return this->value(J);
}

FaceDensity::Hessian FaceDensity::hessian(const Eigen::Matrix2d& J) const
{
  const PlaneSingularValues svd(J);
  const double s0 = svd.s[0], s1 = svd.s[1], square = s0 * s0 + s1 * s1;
  const Weight weight(s0 * s1, this->epsilon);
  const double byDeterminant = square * weight.first;

  // Along the singular values, and the twist and the shear of the axes.
  Eigen::Matrix2d A;
  A(0, 0) = 2 * weight.value + 4 * s0 * s1 * weight.first + s1 * s1 * square * weight.second;
  A(1, 1) = 2 * weight.value + 4 * s0 * s1 * weight.first + s0 * s0 * square * weight.second;
  A(0, 1) = A(1, 0) = 2 * square * weight.first + byDeterminant + s0 * s1 * square * weight.second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
  const Eigen::Matrix2d& axes = eigen.eigenvectors();

  Hessian result = Hessian::Zero();
  const auto add = [&](double curvature, const Eigen::Matrix2d& mode)
  {
    if (curvature > 0)
    {
      const Eigen::Matrix2d direction = svd.U * mode * svd.V.transpose();
      const Eigen::Map<const Eigen::Vector4d> entries(direction.data());
      result += curvature * entries * entries.transpose();
    }
  };
  for (int k = 0; k < 2; ++k)
  {
    add(eigen.eigenvalues()[k], axes.col(k).asDiagonal().toDenseMatrix());
  }
  Eigen::Matrix2d twist, shear;
  twist << 0, -std::sqrt(0.5), std::sqrt(0.5), 0;
  shear << 0, std::sqrt(0.5), std::sqrt(0.5), 0;
  add(2 * weight.value + byDeterminant, twist);
  add(2 * weight.value - byDeterminant, shear);
  if (this->power > 1)
  {
    const double phi = square * weight.value;
    const double p = this->power, slope = toPower(phi, this->power - 1);
    const Eigen::Matrix2d first = 2 * weight.value * J + byDeterminant * cofactor(J);
    const Eigen::Map<const Eigen::Vector4d> g(first.data());
    result = p * slope * result + p * (p - 1) * (slope / phi) * (g * g.transpose());
  }
  return result;
}
}
