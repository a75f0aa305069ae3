// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Optimization/Objective.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// A norm of the worst corners: the p-th root of the mean over the corners of (least / s)^p. s is
/// the determinant of the corner's edges over the product of their lengths, scaled as in the cell's
/// scaled Jacobian. So the worst corners dominate, and lengths have no effect, but for keepEdges().
/// If any s is not positive it is infinite, and no step may end there. Pyramids count their base
/// corners. Corners without a free node are left out. Not thread-safe.
class WorstCornerNorm : public Objective
{
public:
  /// `cells`: ids of volume cells; `orientation`: #cells of the mesh; `free`: ids of the nodes that
  /// move, ascending; `least`: reference value for s, above 0; `squarings`: the power p is 2 to
  /// this, in [0, 9]; `goal`: a minimum of s that is enough, where no edge is short. Cost: 75 bytes
  /// a corner.
  WorstCornerNorm(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& cells, const std::vector<Index>& free, double least, int squarings,
    double goal = std::numeric_limits<double>::infinity(),
    const Communicator& communicator = Communicator::alone());

  /// Keeps edges from collapsing. Angles do not prevent that in hexahedra, wedges and pyramids, and
  /// the gradient grows with 1 / length, so that no step gets far. (least / s)^2 becomes that plus
  /// a sum of (c / l)^8 over the corner's edges, where l is the length. c is a tenth of the
  /// undeformed length, scaled as the cell's mean edge from `shapes` to `start`, but at most 0.8 of
  /// that in `start`. `shapes`: the undeformed mesh; `start`: #nodes x 3. Cost: a pass over the
  /// cells.
  void keepEdges(const Mesh& shapes, const Points& start);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  /// Collective, as the root's gradient depends on the sum over all processes.
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;
  Value valueAndGradient(const Points& points, Points& result, Monitor& monitor) const override;

  /// One corner in each cell of a batch: `least` over the factor that makes s 1 in the ideal cell,
  /// with the cell's sign; 0 if left out. A tetrahedron's corners have the same.
  struct Scales
  {
    double unit[SimdWidth];
    double shortest[3][SimdWidth]; ///< squares of the lengths c in keepEdges()
  };
  struct Corners
  {
    std::vector<Scales> scales; ///< in the order of the batches' places, SimdWidth a corner
    int squarings = 0;
    double enough = 0; ///< of the largest power
    Index count = 0;   ///< number of corners that are not left out, of all processes
  };

private:
  /// The powers of 1 / s over `least`, by lane.
  struct Sum;
  struct BatchValue;
  struct BatchGradient;
  Value valueOf(const Sum& sum) const;

  std::vector<Index> free_;
  CellBatches batches_;
  Corners corners_;
  mutable Points parts_; ///< of the gradient, kept between calls
};
}
