// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Optimization/Objective.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// Quasi-isometric stiffening of the samples of the scaled Jacobian: corners, and centers of
/// hexahedra. A sample s has the distortion f = 1 / s^2. With the cosines c of its three edges
///
///   f = u^2 / D(c),  D = 1 + 2 c1 c2 c3 - c1^2 - c2^2 - c3^2,  u^2 = 1, 3/4 (wedge), 1/2 (tet)
///   energy = sum h(f),  h = ((1 - t f)^-2 - 1) / (2 t)
///
/// A pyramid has the corners of the tetrahedra at its base corners, and u^2 = 1/4. h is a barrier:
/// f stays below 1 / t, and raising t raises the minimum of s. D is the Gram determinant of unit
/// edges, so log D is concave and h is convex in the cosines. Thus the Gauss-Newton matrix sum
/// (dc/dx)^T (d2h/dc2) (dc/dx) is positive semi-definite. Source of the stiffening: Garanzha et
/// al., ACM Trans. Graph. 43(1) (2024), arXiv 2201.12112, with the exponent 1 and another
/// distortion.
///
/// Lengths have no part in f. Edges of cells that are not tetrahedra have limits: each corner edge
/// of length l adds 2 ((c / l)^8 + (l / C)^8), where c is 1/5 and C five times the undeformed
/// length in the scale of the cell's start. Where the start is beyond a limit, the limit gives way
/// to 0.8 of that length, or l / 0.8. Samples without a free node are left out. Not thread-safe.
class StiffenedDistortion : public SecondOrderObjective
{
public:
  /// `mesh`: the undeformed shapes; `orientation`: #cells; `cells`: ids of volume cells; `free`:
  /// ids of the nodes that move, ascending; `start`: #nodes x 3, a mesh that the lengths' limits
  /// refer to. Cost: a pass over the cells; 0.4 kB a hexahedron, 16 bytes a tetrahedron.
  StiffenedDistortion(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& cells, const std::vector<Index>& free, const Points& start,
    const Communicator& communicator = Communicator::alone());

  struct State
  {
    double energy;  ///< infinite where a sample is inverted or beyond the barrier
    double largest; ///< f; infinite where a sample is inverted
  };
  State evaluate(const Points& points, Monitor& monitor) const;

  /// Sets t, 0 or more.
  void setLevel(double t) { this->level_ = t; }
  double level() const { return this->level_; }
  /// A corner with one free neighbor is at most the sine between its two other edges. Counts each
  /// sample whose bound b is below `floor` as s floor / b, so that the others rise beyond it. 0:
  /// counts all as they are, the default.
  void setFloor(double floor) { this->floor_ = floor; }
  /// Limits that have given way follow edges that `points` has brought nearer to them.
  void restoreLimits(const Points& points);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;
  void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const override;

  /// The squares of the lengths' limits of one corner's edges in each cell of a batch.
  struct Limits
  {
    float least[3][SimdWidth], near[3][SimdWidth]; ///< c, as it is and as it would be
    float byMost[3][SimdWidth];                    ///< 1 / C
  };
  /// One sample in each cell of a batch: its bound with the cell's sign, which is infinite without
  /// one; 0 where it is left out.
  struct Bounds
  {
    float bound[SimdWidth];
  };

private:
  struct Sum;
  struct Samples;
  struct BatchValue;
  struct BatchGradient;
  struct BatchHessian;
  void findBounds(
    Index batch, int lane, const std::vector<std::int8_t>& orientation, const Points& start);
  void findLimits(Index batch, int lane, const Points& shapes, const Points& start);

  PatternId pattern_; ///< of the second derivatives
  std::vector<Index> free_;
  CellBatches batches_;
  std::vector<Index> firstBound_, firstLimits_; ///< of each batch
  std::vector<Bounds> bounds_;
  std::vector<Limits> limits_;
  double level_ = 0, floor_ = 0;
  mutable Points parts_; ///< of the gradient, kept between calls
};
}
