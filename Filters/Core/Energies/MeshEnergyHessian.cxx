// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/BatchHessian.h"
#include "Energies/MeshEnergy.h"

namespace morph
{
namespace
{
using namespace foldover;

/// Computes the second derivatives of a batch's tetrahedra.
struct BatchHessian
{
  template <typename Density>
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Density& density,
    const Points& points, SimdMatrix* sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition parts = simplicialDecomposition(batches.shape(batch));
    const SimdTargets targets(batches, batch);
    for (int t = 0; t < parts.count; ++t)
    {
      const SimdTarget target(targets, parts.tets[t], t);
      SimdMatrix J, g, block[3][3];
      jacobian(x, parts.tets[t].corner, target, J);
      for (int j = 0; j < 3; ++j)
      {
        for (int i = 0; i < 3; ++i)
        {
          g[j][i] = target.inverse[i][j];
        }
      }
      curvatureAt(density, J, g, block);
      addByCorners(block, parts.tets[t].corner, target.weight, batches.corners(batch), sum);
    }
  }
};
}

void MeshEnergy::hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    openBlocks(this->batches_, this->free_, this->pattern_, result, monitor);
  }
  this->parts_.resize(0, 3); // the solution of a system needs its memory more
  if (this->isCondition_)
  {
    sumBlocks<BatchHessian>(this->batches_, result, monitor, ConditionDensity(), points);
    return;
  }
  sumBlocks<BatchHessian>(this->batches_, result, monitor, this->density_, points);
}
}
