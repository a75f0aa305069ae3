// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Optimization/Objective.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// How near the corners of cells are to being flat: the mean over the corners of (least / s)^8,
/// where s is the determinant of the corner's three edges over the product of their lengths, scaled
/// as in the cell's scaled Jacobian. So the worst corners outweigh all others, and lengths do not
/// count. Infinite, and no step may end, where an s is not positive. Of a pyramid the corners of
/// its base. Corners without a free node are left out. Not for two threads at once.
class WorstCornerNorm : public Objective
{
public:
  /// `cells`: ids of volume cells; `orientation`: #cells of the mesh; `free`: ids of the nodes that
  /// move, ascending; `least`: what s is held against, above 0. Cost: 50 bytes a corner.
  WorstCornerNorm(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& cells, const std::vector<Index>& free, double least);

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;

  /// Of one corner in each cell of a batch: what takes s to 1 in the cell of scaled Jacobian 1,
  /// with the cell's sign, over `least`; 0 where the corner does not count.
  struct Scales
  {
    double factor[SimdWidth];
  };
  struct Corners
  {
    std::vector<Scales> scales; ///< as the batches' places, of which a corner has SimdWidth
    Index count = 0;            ///< that count
  };

private:
  std::vector<Index> free_;
  CellBatches batches_;
  Corners corners_;
  mutable Points parts_; ///< of the gradient, kept from call to call
};
}
