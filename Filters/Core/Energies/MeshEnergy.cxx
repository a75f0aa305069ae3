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

constexpr double Barrier = 1e-9; // regularisation that keeps nothing inverted finite

struct Sum
{
  double energy = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = 0, inverted = 0;
  Sum& operator+=(const Sum& other)
  {
    this->energy += other.energy;
    this->least = std::min(this->least, other.least);
    this->most = std::max(this->most, other.most);
    this->inverted += other.inverted;
    return *this;
  }
};

struct GroupEnergy
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups,
    const FoldoverDensity& density, const Points& points, Sum& sum)
  {
    LaneVector x[8];
    cornersOf(groups, group, points, x);
    const SimplicialDecomposition parts = simplicialDecomposition(groups.shape(group));
    const CellGroups::Tetrahedra* tetrahedra = groups.targets(group);
    const Lanes zero = {};
    const Lanes one = zero + 1.;
    Lanes energy = {}, most = {}, inverted = {},
          least = zero + std::numeric_limits<double>::infinity();
    for (int t = 0; t < parts.count; ++t, ++tetrahedra)
    {
      LaneMatrix inverse, J;
      inverseOf(*tetrahedra, inverse);
      jacobian(x, parts.tets[t].corner, *tetrahedra, inverse, J);
      LaneVector normal;
      cross(J[1], J[2], normal);
      Lanes determinant, square, phi, value;
      dot(J[0], normal, determinant);
      squaredNorm(J, square);
      Parameters<Lanes> parameters;
      parametersOf(density, *tetrahedra, parameters);
      distortion(parameters, square, determinant, phi);
      stiffen(parameters.stiffness, phi, value);
      const Lanes weight = load(tetrahedra->weight), stiffened = load(tetrahedra->stiffened);
      energy += weight * value;
      least = ((weight > 0.) & (determinant < least)) ? determinant : least;
      inverted += ((weight > 0.) & (determinant <= 0.)) ? one : zero;
      most = ((stiffened > 0.) & (phi > most)) ? phi : most;
    }
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      sum += { energy[lane], least[lane], most[lane], inverted[lane] };
    }
  }
};

/// What each group gives to its corners, at their places in `parts`.
struct GroupGradient
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups,
    const FoldoverDensity& density, const Points& points, Points& parts)
  {
    LaneVector x[8], sum[8] = {};
    cornersOf(groups, group, points, x);
    const SimplicialDecomposition decomposition = simplicialDecomposition(groups.shape(group));
    const CellGroups::Tetrahedra* tetrahedra = groups.targets(group);
    for (int t = 0; t < decomposition.count; ++t, ++tetrahedra)
    {
      const int* corner = decomposition.tets[t].corner;
      LaneMatrix inverse, J, normal;
      inverseOf(*tetrahedra, inverse);
      jacobian(x, corner, *tetrahedra, inverse, J);
      cofactor(J, normal);
      Lanes determinant, square;
      dot(J[0], normal[0], determinant);
      squaredNorm(J, square);
      Parameters<Lanes> parameters;
      parametersOf(density, *tetrahedra, parameters);
      Derivatives<Lanes> d;
      derivatives(parameters, square, determinant, d);
      const Lanes weight = load(tetrahedra->weight);
      const Lanes byNorm = 2. * weight * d.I, byVolume = weight * d.D;
      for (int i = 0; i < 3; ++i)
      {
        Lanes row[3], all = {};
        for (int j = 0; j < 3; ++j)
        {
          row[j] = byNorm * J[j][i] + byVolume * normal[j][i];
        }
        for (int k = 0; k < 3; ++k)
        {
          const Lanes force =
            row[0] * inverse[0][k] + row[1] * inverse[1][k] + row[2] * inverse[2][k];
          sum[corner[k + 1]][i] += force;
          all += force;
        }
        sum[corner[0]][i] -= all;
      }
    }
    storeAtPlaces(groups, group, sum, parts);
  }
};
}

MeshEnergy::MeshEnergy(const Mesh& mesh, const std::vector<Index>& free)
  : free_(rowOrder(mesh, free))
  , groups_(mesh, this->free_)
{
}

MeshEnergy::State MeshEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  const auto sum = sumOverGroups<GroupEnergy, Sum>(this->groups_, monitor, this->density_, points);
  return { sum.energy, sum.least, static_cast<Index>(sum.inverted), sum.most };
}

Objective::Value MeshEnergy::value(const Points& points, Monitor& monitor) const
{
  const State state = this->evaluate(points, monitor);
  return { state.energy, this->density_.epsilon > Barrier || state.leastDeterminant > 0 };
}

void MeshEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromGroups<GroupGradient>(
    this->groups_, this->parts_, result, monitor, this->density_, points);
}
}
