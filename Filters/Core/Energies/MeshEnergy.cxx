// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/MeshEnergy.h"

#include "Energies/BatchHessian.h"
#include "Energies/CellBatchKernel.h"
#include "Energies/CellBatches.h"
#include "Mesh/NodePartition.h"
#include "Mesh/ShellLayer.h"

#include <algorithm>
#include <limits>

namespace morph
{
namespace
{
using namespace foldover;

// with less regularization, every inverted tetrahedron has infinite energy
constexpr double LeastEpsilon = 1e-9;

struct BatchEnergy
{
  template <typename Density>
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Density& density,
    const Points& points, EnergyState& sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition parts = simplicialDecomposition(batches.shape(batch));
    const SimdTargets targets(batches, batch);
    const SimdDouble4 zero = {};
    const SimdDouble4 one = zero + 1.;
    SimdDouble4 energy = {}, inverted = {}, least = zero + std::numeric_limits<double>::infinity();
    for (int t = 0; t < parts.count; ++t)
    {
      const SimdTarget target(targets, parts.tets[t], t);
      SimdMatrix J;
      jacobian(x, parts.tets[t].corner, target, J);
      SimdDouble4 determinant, value;
      valueAt(density, J, determinant, value);
      const SimdDouble4& weight = target.weight;
      energy += weight * value;
      least = select((weight > 0.) & (determinant < least), determinant, least);
      inverted += select((weight > 0.) & (determinant <= 0.), one, zero);
    }
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      sum += { energy[lane], least[lane], static_cast<Index>(inverted[lane]) };
    }
  }
};

/// Computes each batch's gradient at its corners, at their places in `parts`.
struct BatchGradient
{
  template <typename Density>
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Density& density,
    const Points& points, Points& parts)
  {
    SimdVector x[8], sum[8] = {};
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition decomposition = simplicialDecomposition(batches.shape(batch));
    const SimdTargets targets(batches, batch);
    for (int t = 0; t < decomposition.count; ++t)
    {
      const int* corner = decomposition.tets[t].corner;
      const SimdTarget target(targets, decomposition.tets[t], t);
      const SimdMatrix& inverse = target.inverse;
      SimdMatrix J, slope;
      jacobian(x, corner, target, J);
      slopeAt(density, target.weight, J, slope);
      for (int i = 0; i < 3; ++i)
      {
        SimdDouble4 all = {};
        for (int k = 0; k < 3; ++k)
        {
          const SimdDouble4 force =
            slope[0][i] * inverse[0][k] + slope[1][i] * inverse[1][k] + slope[2][i] * inverse[2][k];
          sum[corner[k + 1]][i] += force;
          all += force;
        }
        sum[corner[0]][i] -= all;
      }
    }
    storeAtPlaces(batches, batch, sum, parts);
  }
};
}

MeshEnergy::MeshEnergy(
  const Mesh& mesh, const std::vector<Index>& free, const Communicator& communicator)
  : free_(unknownOrdering(mesh, free))
  , batches_(mesh, this->free_)
{
  this->share(communicator, this->free_, mesh.layer.normal, curvedImages(mesh.layer, this->free_));
}

EnergyState MeshEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  const EnergyState sum =
    this->isCondition_
      ? sumOverBatches<BatchEnergy, EnergyState>(
          this->batches_, monitor, ConditionDensity(), points)
      : sumOverBatches<BatchEnergy, EnergyState>(this->batches_, monitor, this->density_, points);
  const Communicator& all = this->communicator();
  return { all.sum(sum.energy), all.minimum(sum.minimumDeterminant), all.sum(sum.inverted) };
}

Objective::Value MeshEnergy::value(const Points& points, Monitor& monitor) const
{
  const EnergyState state = this->evaluate(points, monitor);
  const bool isFinite = !this->isCondition_ && this->density_.epsilon > LeastEpsilon;
  const bool isValid = state.minimumDeterminant > 0;
  return { state.energy, isFinite || isValid, isFinite && isValid };
}

void MeshEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  if (this->isCondition_)
  {
    gatherFromBatches<BatchGradient>(
      this->batches_, this->parts_, result, monitor, ConditionDensity(), points);
  }
  else
  {
    gatherFromBatches<BatchGradient>(
      this->batches_, this->parts_, result, monitor, this->density_, points);
  }
  this->rows().add(result);
}

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
