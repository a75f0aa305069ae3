// SPDX-License-Identifier: BSD-3-Clause
#include "Baselines.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace benchmark
{
Eigen::VectorXd weightsByEigen(const morph::Points& offsets)
{
  const auto k = static_cast<double>(offsets.rows());
  const Eigen::Matrix3d S = offsets.transpose() * offsets / k;
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  const Eigen::Matrix3Xd d = llt.matrixL().solve(Eigen::Matrix3Xd(offsets.transpose()));
  Eigen::Vector3d mu = Eigen::Vector3d::Zero();
  Eigen::VectorXd r;
  constexpr int MostIterations = 30;
  constexpr double Damped = 0.25;
  constexpr double End = 1e-13;
  for (int i = 0; i < MostIterations; ++i)
  {
    r = (1 + (d.transpose() * mu).array()).inverse();
    const Eigen::Matrix3Xd scaled = d * r.asDiagonal();
    const Eigen::Vector3d gradient = -scaled.rowwise().sum();
    const Eigen::Matrix3d hessian = scaled * scaled.transpose();
    const Eigen::Vector3d step = -hessian.llt().solve(gradient);
    const double decrement = std::sqrt(-gradient.dot(step));
    if (decrement < End)
    {
      break;
    }
    mu += decrement > Damped ? Eigen::Vector3d(step / (1 + decrement)) : step;
  }
  return r / r.sum();
}
}
