// SPDX-License-Identifier: BSD-3-Clause
#include "FoldoverDensity.h"

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
Eigen::Matrix3d cofactor(const Eigen::Matrix3d& J)
{
  Eigen::Matrix3d result;
  result.col(0) = J.col(1).cross(J.col(2));
  result.col(1) = J.col(2).cross(J.col(0));
  result.col(2) = J.col(0).cross(J.col(1));
  return result;
}

/// Sets negative eigenvalues to 0.
void makeSemiDefinite(Eigen::Matrix3d& A)
{
  // Most matrices are definite, which a Cholesky factorisation tells sooner.
  const double pivot = A(1, 1) - A(1, 0) * A(1, 0) / A(0, 0);
  if (A(0, 0) > 0 && pivot > 0 && A.determinant() > 0)
  {
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  A = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).asDiagonal() *
      eigen.eigenvectors().transpose();
}

/// chi and its derivatives by the determinant D.
struct Regularised
{
  Regularised(double D, double epsilon)
  {
    const double root = std::sqrt(epsilon * epsilon + D * D);
    // The second form is the first without its cancellation.
    this->chi = D > 0 ? (D + root) / 2 : epsilon * epsilon / (2 * (root - D));
    this->first = this->chi / root;
    this->second = epsilon * epsilon / (2 * root * root * root);
  }
  double chi, first, second;
};
}

FoldoverDensity::Derivatives FoldoverDensity::derivatives(double I, double D) const
{
  const double a = (1 - this->theta) / 3, b = this->theta / 2;
  const Regularised r(D, this->epsilon);
  const double p = 1 / std::cbrt(r.chi * r.chi);
  const double u = r.first / r.chi, v = r.second / r.chi;
  const double square = (1 + D * D) / r.chi;

  Derivatives d;
  d.value = a * I * p + b * square;
  d.I = a * p;
  d.D = -2. / 3 * a * I * p * u + b * (2 * D / r.chi - square * u);
  d.II = 0;
  d.ID = -2. / 3 * a * p * u;
  d.DD = a * I * p * (10. / 9 * u * u - 2. / 3 * v) +
         b * (2 / r.chi - 4 * D / r.chi * u - square * v + 2 * square * u * u);
  if (this->stiffness > 0)
  {
    const double gap = 1 - this->stiffness * d.value;
    if (!(gap > 0))
    {
      d.value = std::numeric_limits<double>::infinity();
      return d;
    }
    const double once = 1 / (gap * gap), twice = 2 * this->stiffness / (gap * gap * gap);
    d.II = once * d.II + twice * d.I * d.I;
    d.ID = once * d.ID + twice * d.I * d.D;
    d.DD = once * d.DD + twice * d.D * d.D;
    d.I *= once;
    d.D *= once;
    d.value /= gap;
  }
  return d;
}

double FoldoverDensity::distortion(const Eigen::Matrix3d& J) const
{
  const double D = J.determinant();
  const Regularised r(D, this->epsilon);
  return (1 - this->theta) / 3 * J.squaredNorm() / std::cbrt(r.chi * r.chi) +
         this->theta / 2 * (1 + D * D) / r.chi;
}

double FoldoverDensity::value(const Eigen::Matrix3d& J) const
{
  const double phi = this->distortion(J);
  const double gap = 1 - this->stiffness * phi;
  return gap > 0 ? phi / gap : std::numeric_limits<double>::infinity();
}

double FoldoverDensity::gradient(const Eigen::Matrix3d& J, Eigen::Matrix3d& derivative) const
{
  const Eigen::Matrix3d cof = cofactor(J);
  const Derivatives d = this->derivatives(J.squaredNorm(), J.col(0).dot(cof.col(0)));
  derivative = 2 * d.I * J + d.D * cof;
  return d.value;
}

SignedSingularValues::SignedSingularValues(const Eigen::Matrix3d& J)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(J.transpose() * J);
  this->V = eigen.eigenvectors().rowwise().reverse();
  if (this->V.determinant() < 0)
  {
    this->V.col(2) *= -1;
  }
  // The left vectors by orthogonalisation in descending order: a vanishing singular value leaves its vector to the others.
  const Eigen::Vector3d first = J * this->V.col(0);
  Eigen::Vector3d second = J * this->V.col(1);
  const double length = first.norm();
  this->U.col(0) = length > 0 ? Eigen::Vector3d(first / length) : this->V.col(0);
  second -= second.dot(this->U.col(0)) * this->U.col(0);
  const double across = second.norm();
  this->U.col(1) =
    across > 1e-14 * length ? Eigen::Vector3d(second / across) : this->U.col(0).unitOrthogonal();
  this->U.col(2) = this->U.col(0).cross(this->U.col(1));
  this->S << this->U.col(0).dot(first), this->U.col(1).dot(J * this->V.col(1)),
    this->U.col(2).dot(J * this->V.col(2));
}

void FoldoverDensity::hessian(
  const Eigen::Matrix3d& J, const Eigen::Matrix3d& g, Eigen::Matrix3d (&block)[3][3]) const
{
  const SignedSingularValues svd(J);
  const Eigen::Vector3d& s = svd.S;
  const Eigen::Vector3d c(s[1] * s[2], s[0] * s[2], s[0] * s[1]); // d(det)/ds
  const Derivatives d = this->derivatives(s.squaredNorm(), s[0] * s[1] * s[2]);

  // Stretches along the axes, coupled with each other.
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      A(i, j) = 4 * d.II * s[i] * s[j] + 2 * d.ID * (s[i] * c[j] + s[j] * c[i]) +
                d.DD * c[i] * c[j] + (i == j ? 2 * d.I : d.D * s[3 - i - j]);
    }
  }
  makeSemiDefinite(A);
  // Rotations and shears between two axes: half the sum and half the difference of their eigenvalues.
  Eigen::Vector3d sum, difference;
  for (int k = 0; k < 3; ++k)
  {
    const double twist = std::max(0., 2 * d.I + d.D * s[k]);
    const double shear = std::max(0., 2 * d.I - d.D * s[k]);
    sum[k] = (shear + twist) / 2;
    difference[k] = (shear - twist) / 2;
  }

  const Eigen::Matrix3d h = svd.V.transpose() * g;
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      Eigen::Matrix3d K;
      for (int i = 0; i < 3; ++i)
      {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        K(i, i) =
          A(i, i) * h(i, a) * h(i, b) + sum[k] * h(j, a) * h(j, b) + sum[j] * h(k, a) * h(k, b);
        K(i, j) = A(i, j) * h(i, a) * h(j, b) + difference[k] * h(j, a) * h(i, b);
        K(j, i) = A(j, i) * h(j, a) * h(i, b) + difference[k] * h(i, a) * h(j, b);
      }
      block[a][b].noalias() = svd.U * K * svd.U.transpose();
    }
  }
}
}
