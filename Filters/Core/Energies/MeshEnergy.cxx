// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/MeshEnergy.h"

#include "Energies/BatchReductions.h"
#include "Energies/CellBatchKernel.h"
#include "Mesh/UnknownOrdering.h"

#include <algorithm>
#include <limits>

namespace morph
{
namespace
{
using namespace foldover;

// with less regularisation, every inverted tetrahedron has infinite energy
constexpr double Barrier = 1e-9;

struct Sum
{
  double energy = 0;
  double least = std::numeric_limits<double>::infinity();
  double inverted = 0;
  Sum& operator+=(const Sum& other)
  {
    this->energy += other.energy;
    this->least = std::min(this->least, other.least);
    this->inverted += other.inverted;
    return *this;
  }
};

struct BatchEnergy
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const FoldoverDensity& density, const Points& points, Sum& sum)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition parts = simplicialDecomposition(batches.shape(batch));
    const CellBatches::Tetrahedra* tetrahedra = batches.targets(batch);
    const SimdDouble4 zero = {};
    const SimdDouble4 one = zero + 1.;
    SimdDouble4 energy = {}, inverted = {}, least = zero + std::numeric_limits<double>::infinity();
    for (int t = 0; t < parts.count; ++t, ++tetrahedra)
    {
      SimdMatrix inverse, J;
      inverseOf(*tetrahedra, inverse);
      jacobian(x, parts.tets[t].corner, *tetrahedra, inverse, J);
      SimdVector normal;
      cross(J[1], J[2], normal);
      SimdDouble4 determinant, square, value;
      dot(J[0], normal, determinant);
      squaredNorm(J, square);
      Parameters<SimdDouble4> parameters;
      parametersOf(density, *tetrahedra, parameters);
      foldover::density(parameters, square, determinant, value);
      const SimdDouble4 weight = load(tetrahedra->weight);
      energy += weight * value;
      least = ((weight > 0.) & (determinant < least)) ? determinant : least;
      inverted += ((weight > 0.) & (determinant <= 0.)) ? one : zero;
    }
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      sum += { energy[lane], least[lane], inverted[lane] };
    }
  }
};

/// Computes each batch's gradient at its corners, at their places in `parts`.
struct BatchGradient
{
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches,
    const FoldoverDensity& density, const Points& points, Points& parts)
  {
    SimdVector x[8], sum[8] = {};
    cornersOf(batches, batch, points, x);
    const SimplicialDecomposition decomposition = simplicialDecomposition(batches.shape(batch));
    const CellBatches::Tetrahedra* tetrahedra = batches.targets(batch);
    for (int t = 0; t < decomposition.count; ++t, ++tetrahedra)
    {
      const int* corner = decomposition.tets[t].corner;
      SimdMatrix inverse, J, normal;
      inverseOf(*tetrahedra, inverse);
      jacobian(x, corner, *tetrahedra, inverse, J);
      cofactor(J, normal);
      SimdDouble4 determinant, square;
      dot(J[0], normal[0], determinant);
      squaredNorm(J, square);
      Parameters<SimdDouble4> parameters;
      parametersOf(density, *tetrahedra, parameters);
      Derivatives<SimdDouble4> d;
      derivatives(parameters, square, determinant, d);
      const SimdDouble4 weight = load(tetrahedra->weight);
      const SimdDouble4 byNorm = 2. * weight * d.I, byVolume = weight * d.D;
      for (int i = 0; i < 3; ++i)
      {
        SimdDouble4 row[3], all = {};
        for (int j = 0; j < 3; ++j)
        {
          row[j] = byNorm * J[j][i] + byVolume * normal[j][i];
        }
        for (int k = 0; k < 3; ++k)
        {
          const SimdDouble4 force =
            row[0] * inverse[0][k] + row[1] * inverse[1][k] + row[2] * inverse[2][k];
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
  this->share(communicator, this->free_);
}

MeshEnergy::State MeshEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  const auto sum =
    sumOverBatches<BatchEnergy, Sum>(this->batches_, monitor, this->density_, points);
  const Communicator& all = this->communicator();
  return { all.sum(sum.energy), all.minimum(sum.least), all.sum(static_cast<Index>(sum.inverted)) };
}

Objective::Value MeshEnergy::value(const Points& points, Monitor& monitor) const
{
  const State state = this->evaluate(points, monitor);
  return { state.energy, this->density_.epsilon > Barrier || state.minimumDeterminant > 0 };
}

void MeshEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromBatches<BatchGradient>(
    this->batches_, this->parts_, result, monitor, this->density_, points);
  this->rows().add(result);
}
}
