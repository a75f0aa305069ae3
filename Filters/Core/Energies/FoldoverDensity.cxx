// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/FoldoverDensity.h"

#include "Energies/EigenMatrix3.h"

#include <Eigen/LU>

namespace morph
{
namespace
{
using Matrix = foldover::Matrix3<double>;
using foldover::fromEigen;
using foldover::toEigen;

foldover::Parameters<double> parametersOf(const FoldoverDensity& density)
{
  return { density.theta, density.epsilon };
}
}

double FoldoverDensity::value(const Eigen::Matrix3d& J) const
{
  double result;
  foldover::density(parametersOf(*this), J.squaredNorm(), J.determinant(), result);
  return result;
}

double FoldoverDensity::gradient(const Eigen::Matrix3d& J, Eigen::Matrix3d& derivative) const
{
  Matrix cofactor;
  foldover::cofactor(fromEigen(J), cofactor);
  foldover::Derivatives<double> d;
  foldover::derivatives(
    parametersOf(*this), J.squaredNorm(), J.col(0).dot(toEigen(cofactor).col(0)), d);
  derivative = 2 * d.I * J + d.D * toEigen(cofactor);
  return d.value;
}

SignedSingularValues::SignedSingularValues(const Eigen::Matrix3d& J)
{
  Matrix left, right;
  foldover::Vector3<double> values;
  foldover::signedSingularValues(fromEigen(J), left, values, right);
  this->U = toEigen(left);
  this->V = toEigen(right);
  this->S = Eigen::Map<const Eigen::Vector3d>(values.x);
}

void FoldoverDensity::hessian(
  const Eigen::Matrix3d& J, const Eigen::Matrix3d& g, Eigen::Matrix3d (&block)[3][3]) const
{
  Matrix result[3][3];
  foldover::hessian(parametersOf(*this), fromEigen(J), fromEigen(g), result);
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      block[a][b] = toEigen(result[a][b]);
    }
  }
}
}
