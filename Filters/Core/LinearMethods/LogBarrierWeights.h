// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// Log-barrier weights of one node i: the convex weights that keep it in place and maximize sum log
/// w_j. The constraints are sum w_j = 1 and sum w_j d_j = 0, with d_j = x_j - x_i. Sources: Staten
/// et al., IMR 2011, equation (13); Shontz and Vavasis, IMR 2003.
///
/// The dual problem has three unknowns. The stationary point has 1 / w_j = k (1 + mu . d_j) with k
/// neighbors, where mu minimizes the self-concordant function g(mu) = -sum log(1 + mu . d_j).
/// Damped Newton steps from mu = 0 converge without a line search (Nesterov and Nemirovskii, 1994)
/// if the node lies strictly inside its neighbors' hull. The d_j are whitened first, so stretched
/// and flat neighborhoods are as easy as round ones.
///
/// Use one object a thread: it keeps its buffers between nodes.
class LogBarrierWeights
{
public:
  enum class Place
  {
    Inside, ///< strictly inside the hull, all weights positive
    /// on a face or edge of the hull: the limit of the weights, zero off this face
    OnHull,
    Outside ///< no convex weights exist
  };
  struct Result
  {
    Place place;
    int iterations; ///< Newton steps
  };

  /// Computes the weights. `offsets`: k x 3, the d_j, in any unit; neighbors may coincide.
  /// `weights`: k numbers, filled unless Outside, with sum 1 to rounding and |sum w_j d_j| <= 1e-10
  /// max |d_j|. OnHull means within 1e-11 of the local size, if the limit has this residual. An
  /// inner node nearer to the hull than about 1e-9 may count as either. Cost: 0.5 to 1 microsecond
  /// for the 26 neighbors in a hexahedral mesh.
  Result compute(const double (*offsets)[3], int k, double* weights);

private:
  using Pair = Eigen::Array2d; ///< two neighbors at a time: one SSE register
  struct Dual;

  void resize(int k);
  bool whiten(const double (*offsets)[3], int k, double scale);
  int whitenCarefully(const double (*offsets)[3], int k, double scale);
  void minimize(Dual& dual, int k, int dimension, double limit, int mostIterations);
  void turn(Dual& dual, int k, int dimension);
  void fillWeights(int k, double* weights) const;
  Result computeCarefully(const double (*offsets)[3], int k, double scale, double* weights);

  // Whitened d_j by coordinate, padded with zeros, which do not change any sum.
  std::vector<Pair> x_, y_, z_;
  std::vector<Pair> inverse_;                      ///< 1 / (1 + mu . d_j) at the minimum
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero(); ///< of the whitened d_j
};
}
