// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ThinSvd3.h"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>

namespace morph
{
ThinSvd3::ThinSvd3(const ConstPoints& vectors)
  : dimension(0)
{
  constexpr double RankTolerance = 1e-11;
  Eigen::MatrixXd tall = Eigen::MatrixXd::Zero(std::max<Index>(vectors.rows(), 3), 3);
  tall.topRows(vectors.rows()) = vectors;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::MatrixXd R = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(R, Eigen::ComputeFullV);
  this->extent = svd.singularValues();
  this->axes = qr.colsPermutation() * svd.matrixV();
  for (int c = 0; c < 3; ++c)
  {
    this->dimension += this->extent[c] > RankTolerance * this->extent[0];
  }
}
}
