// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph
{
/// The regularised foldover-free density of a map's Jacobian J, from 1 for a rotation upwards
/// (Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069):
///
///   phi(J) = (1 - theta) / 3 |J|^2 / chi^(2/3) + theta / 2 (1 + det^2) / chi,
///   chi = (det + sqrt(epsilon^2 + det^2)) / 2.
///
/// It is finite for inverted maps while epsilon > 0, and steep enough there to remove inversions.
/// For epsilon towards 0 it becomes a barrier at det = 0.
struct FoldoverDensity
{
  double theta = 0.1;     ///< weight of the change of volume against that of shape, in [0, 1]
  double epsilon = 1e-10; ///< regularisation, above 0
};
}
