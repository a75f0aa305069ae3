// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

namespace morph
{
/// The affine displacement field u(x) = u_c + G (x - c) nearest to given displacements in the sense of least squares,
/// of minimum norm where the points lie in a plane, on a line or in one point. Zero for zero displacements, and
/// linear in them. Cost: one pass.
class AffineFit
{
public:
  /// `rest`: all nodes; `ids`: those with a displacement; `displacement`: #ids x 3.
  AffineFit(const Points& rest, const std::vector<Index>& ids, const Points& displacement);

  template <typename Row>
  Eigen::RowVector3d displacement(const Row& x) const
  {
    return this->mean_ + (x - this->centre_) * this->gradient_;
  }

private:
  Eigen::RowVector3d centre_, mean_;
  Eigen::Matrix3d gradient_;
};
}
