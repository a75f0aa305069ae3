// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/ConditionDensity.h"

#include "Energies/ConditionKernel.h"
#include "Energies/EigenMatrix3.h"

namespace morph
{
using foldover::fromEigen;
using foldover::toEigen;

double ConditionDensity::value(const Eigen::Matrix3d& J) const
{
  foldover::Matrix3<double> cofactor;
  foldover::cofactor(fromEigen(J), cofactor);
  double result;
  condition::density(J.squaredNorm(), toEigen(cofactor).squaredNorm(),
    J.col(0).dot(toEigen(cofactor).col(0)), result);
  return result;
}

double ConditionDensity::gradient(const Eigen::Matrix3d& J, Eigen::Matrix3d& derivative) const
{
  double value;
  foldover::Matrix3<double> result;
  condition::gradient(fromEigen(J), value, result);
  derivative = toEigen(result);
  return value;
}

void ConditionDensity::hessian(
  const Eigen::Matrix3d& J, const Eigen::Matrix3d& g, Eigen::Matrix3d (&block)[3][3]) const
{
  foldover::Matrix3<double> result[3][3];
  condition::hessian(fromEigen(J), fromEigen(g), result);
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      block[a][b] = toEigen(result[a][b]);
    }
  }
}
}
