// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/UntangleEnergy.h"

#include "Energies/CellBatchKernel.h"
#include "Energies/CellBatches.h"
#include "Mesh/NodePartition.h"
#include "Mesh/ShellLayer.h"

#include <Eigen/LU>

#include <algorithm>

namespace morph
{
namespace
{
using namespace foldover;
using Tetrahedra = UntangleEnergy::Tetrahedra;

/// Computes how far a tetrahedron is below the margin, or 0. Also computes its edges' normals, the
/// gradient of its determinant.
MORPH_SIMD_INLINE void missing(const SimdVector (&x)[8], const int* corner,
  const SimdDouble4& inverse, double margin, SimdMatrix& normal, SimdDouble4& result)
{
  SimdMatrix D;
  edgesOf(x, corner, D);
  cofactor(D, normal);
  SimdDouble4 determinant;
  dot(D[0], normal[0], determinant);
  const SimdDouble4 zero = {}, gap = margin - inverse * determinant;
  result = select((inverse != 0.) & (gap > 0.), gap, zero);
}

struct BatchValue
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const Tetrahedra& tetrahedra, const Points& points, double& sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const WeightedTet* part = simplicialDecomposition(batches.shape(batch)).tets;
    SimdDouble4 square = {};
    for (Index t = tetrahedra.first[batch]; t < tetrahedra.first[batch + 1]; ++t, ++part)
    {
      SimdMatrix normal;
      SimdDouble4 gap;
      missing(x, part->corner, load(tetrahedra.inverse[t].data()), tetrahedra.margin, normal, gap);
      square += gap * gap;
    }
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      sum += square[lane];
    }
  }
};

struct BatchGradient
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const Tetrahedra& tetrahedra, const Points& points, Points& parts)
  {
    SimdVector x[8], sum[8] = {};
    cornersOf(batches, batch, points, x);
    const WeightedTet* part = simplicialDecomposition(batches.shape(batch)).tets;
    const double factor = -8 / static_cast<double>(tetrahedra.count);
    for (Index t = tetrahedra.first[batch]; t < tetrahedra.first[batch + 1]; ++t, ++part)
    {
      SimdMatrix normal;
      SimdDouble4 gap;
      const SimdDouble4 inverse = load(tetrahedra.inverse[t].data());
      missing(x, part->corner, inverse, tetrahedra.margin, normal, gap);
      if (!any(gap > 0.))
      {
        continue;
      }
      const SimdDouble4 slope = factor * gap * inverse;
      for (int i = 0; i < 3; ++i)
      {
        SimdDouble4 all = {};
        for (int k = 0; k < 3; ++k)
        {
          const SimdDouble4 force = slope * normal[k][i];
          sum[part->corner[k + 1]][i] += force;
          all += force;
        }
        sum[part->corner[0]][i] -= all;
      }
    }
    storeAtPlaces(batches, batch, sum, parts);
  }
};

Tetrahedra tetrahedraOf(const CellBatches& batches, const TargetMatrices& targets, double margin)
{
  Tetrahedra result;
  result.margin = margin;
  for (Index batch = 0; batch < batches.size(); ++batch)
  {
    const Index first = result.first.back();
    const SimplicialDecomposition parts = simplicialDecomposition(batches.shape(batch));
    for (int lane = 0; lane < batches.cells(batch); ++lane)
    {
      const Index cell = batches.cell(batch, lane);
      for (int t = 0; t < parts.count; ++t)
      {
        if (targets.includes(cell, t) && batches.moves(batch, lane, parts.tets[t].corner))
        {
          result.inverse.resize(
            std::max(result.inverse.size(), static_cast<std::size_t>(first + t + 1)));
          result.inverse[first + t][lane] = 1 / targets.edges(cell, parts.tets[t]).determinant();
          ++result.count;
        }
      }
    }
    result.first.push_back(static_cast<Index>(result.inverse.size()));
  }
  return result;
}
}

UntangleEnergy::UntangleEnergy(const Mesh& mesh, const std::vector<Index>& free,
  const TargetMatrices& targets, double margin, const Communicator& communicator)
  : free_(unknownOrdering(mesh, free))
  , batches_(mesh, this->free_)
  , tetrahedra_(tetrahedraOf(this->batches_, targets, margin))
{
  this->share(communicator, this->free_, mesh.layer.normal, curvedImages(mesh.layer, this->free_));
  this->tetrahedra_.count = std::max<Index>(1, communicator.sum(this->tetrahedra_.count));
}

Objective::Value UntangleEnergy::value(const Points& points, Monitor& monitor) const
{
  const double sum = this->communicator().sum(
    sumOverBatches<BatchValue, double>(this->batches_, monitor, this->tetrahedra_, points));
  return { 4 * sum / static_cast<double>(this->tetrahedra_.count), true };
}

void UntangleEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromBatches<BatchGradient>(
    this->batches_, this->parts_, result, monitor, this->tetrahedra_, points);
  this->rows().add(result);
}
}
