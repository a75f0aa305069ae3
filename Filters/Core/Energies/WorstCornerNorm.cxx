// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/WorstCornerNorm.h"

#include "Energies/BatchReductions.h"
#include "Energies/CellBatchKernel.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/UnknownOrdering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using namespace foldover;
using Corners = WorstCornerNorm::Corners;

/// A tetrahedron's corners in positive order; the decomposition has only one of them.
constexpr WeightedTet TetCorners[4] = { { { 0, 1, 2, 3 }, 1 }, { { 1, 2, 0, 3 }, 1 },
  { { 2, 0, 1, 3 }, 1 }, { { 3, 0, 2, 1 }, 1 } };

SimplicialDecomposition cornerTets(Shape shape)
{
  return shape == Shape::Tet ? SimplicialDecomposition{ 4, TetCorners }
                             : SimplicialDecomposition{ cornerTetrahedra(shape),
                                 simplicialDecomposition(shape).tets };
}

/// Returns the factor that makes s 1 in the cell of scaled Jacobian 1.
double scaleOf(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
    case Shape::Pyramid:
      return std::sqrt(2.);
    case Shape::Wedge:
      return 2 / std::sqrt(3.);
    default:
      return 1;
  }
}

struct Corner
{
  SimdMatrix edges, normals; ///< the normals of pairs of edges are the determinant's gradient
  SimdDouble4 determinant, squares[3];
  SimdDouble4 s; ///< over `least`, 1 where the corner is left out

  MORPH_SIMD_INLINE Corner(const SimdVector (&x)[8], const int* corner, const SimdDouble4& scale)
  {
    edgesOf(x, corner, this->edges);
    cofactor(this->edges, this->normals);
    dot(this->edges[0], this->normals[0], this->determinant);
    for (int k = 0; k < 3; ++k)
    {
      dot(this->edges[k], this->edges[k], this->squares[k]);
    }
    const SimdDouble4 zero = {}, one = zero + 1.;
    const SimdDouble4 square = this->squares[0] * this->squares[1] * this->squares[2];
    const auto some = square > 0.;
    const SimdDouble4 quotient = scale * this->determinant / squareRoot(some ? square : one);
    this->s = scale == 0. ? one : some ? quotient : zero;
  }

  /// Computes 1 / s, squared this often; infinite where s is not positive.
  MORPH_SIMD_INLINE void power(int squarings, SimdDouble4& result) const
  {
    const SimdDouble4 infinity = SimdDouble4{} + std::numeric_limits<double>::infinity();
    result = this->s > 0. ? 1. / this->s : infinity;
    for (int k = 0; k < squarings; ++k)
    {
      result *= result;
    }
  }
};

struct BatchValue
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Corners& corners,
    const Points& points, double& sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    const WorstCornerNorm::Scales* scales =
      corners.scales.data() + batches.firstPlace(batch) / SimdWidth;
    const SimdDouble4 zero = {};
    SimdDouble4 all = {};
    for (int t = 0; t < parts.count; ++t)
    {
      const SimdDouble4 scale = load(scales[t].factor);
      SimdDouble4 power;
      Corner(x, parts.tets[t].corner, scale).power(corners.squarings, power);
      all += scale == 0. ? zero : power;
    }
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      sum += all[lane];
    }
  }
};

struct BatchGradient
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Corners& corners,
    const Points& points, Points& forces)
  {
    SimdVector x[8], sum[8] = {};
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    const WorstCornerNorm::Scales* scales =
      corners.scales.data() + batches.firstPlace(batch) / SimdWidth;
    const double mean = (1 << corners.squarings) / static_cast<double>(corners.count);
    const SimdDouble4 zero = {}, one = zero + 1.;
    for (int t = 0; t < parts.count; ++t)
    {
      const SimdDouble4 scale = load(scales[t].factor);
      const int* corner = parts.tets[t].corner;
      const Corner own(x, corner, scale);
      SimdDouble4 power;
      own.power(corners.squarings, power);
      const auto counts = (scale != 0.) & (own.s > 0.);
      const SimdDouble4 factor = counts ? mean * power : zero;
      const SimdDouble4 byDeterminant = factor / (counts ? own.determinant : one);
      SimdVector all = {};
      for (int k = 0; k < 3; ++k)
      {
        const SimdDouble4 byLength = factor / (counts ? own.squares[k] : one);
        for (int i = 0; i < 3; ++i)
        {
          const SimdDouble4 force = byLength * own.edges[k][i] - byDeterminant * own.normals[k][i];
          sum[corner[k + 1]][i] += force;
          all[i] += force;
        }
      }
      for (int i = 0; i < 3; ++i)
      {
        sum[corner[0]][i] -= all[i];
      }
    }
    storeAtPlaces(batches, batch, sum, forces);
  }
};

Corners scaledCorners(const CellBatches& batches, const std::vector<std::int8_t>& orientation,
  double least, int squarings)
{
  Corners result;
  result.squarings = squarings;
  result.scales.resize(batches.places() / SimdWidth);
  for (Index batch = 0; batch < batches.size(); ++batch)
  {
    const SimplicialDecomposition parts = cornerTets(batches.shape(batch));
    WorstCornerNorm::Scales* scales = result.scales.data() + batches.firstPlace(batch) / SimdWidth;
    for (int lane = 0; lane < batches.cells(batch); ++lane)
    {
      for (int t = 0; t < parts.count; ++t)
      {
        if (batches.moves(batch, lane, parts.tets[t].corner))
        {
          scales[t].factor[lane] =
            orientation[batches.cell(batch, lane)] * scaleOf(batches.shape(batch)) / least;
          ++result.count;
        }
      }
    }
  }
  return result;
}
}

WorstCornerNorm::WorstCornerNorm(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& cells, const std::vector<Index>& free, double least, int squarings,
  const Communicator& communicator)
  : free_(unknownOrdering(mesh, free))
  , batches_(mesh, this->free_, cells)
  , corners_(scaledCorners(this->batches_, orientation, least, squarings))
{
  this->share(communicator, this->free_);
  this->corners_.count = std::max<Index>(1, communicator.sum(this->corners_.count));
}

Objective::Value WorstCornerNorm::value(const Points& points, Monitor& monitor) const
{
  const double sum = this->communicator().sum(
    sumOverBatches<BatchValue, double>(this->batches_, monitor, this->corners_, points));
  return { sum / static_cast<double>(this->corners_.count), std::isfinite(sum) };
}

void WorstCornerNorm::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromBatches<BatchGradient>(
    this->batches_, this->parts_, result, monitor, this->corners_, points);
  this->rows().add(result);
}
}
