// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/FoldoverKernel.h"

#include <Eigen/Core>

namespace morph
{
/// Between the kernels' matrices and Eigen's.
namespace foldover
{
inline Matrix3<double> fromEigen(const Eigen::Matrix3d& A)
{
  Matrix3<double> result;
  Eigen::Map<Eigen::Matrix3d> view(&result[0][0]);
  view = A;
  return result;
}

inline Eigen::Map<const Eigen::Matrix3d> toEigen(const Matrix3<double>& A)
{
  return Eigen::Map<const Eigen::Matrix3d>(&A[0][0]);
}
}
}
