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
using Corners = CornerAngles::Corners;
constexpr int Power = 8;

/// A tetrahedron's corners in positive order; the decomposition has one of them.
constexpr WeightedTet TetCorners[4] = { { { 0, 1, 2, 3 }, 1 }, { { 1, 2, 0, 3 }, 1 },
  { { 2, 0, 1, 3 }, 1 }, { { 3, 0, 2, 1 }, 1 } };

SimplicialDecomposition cornerTets(Shape shape)
{
  return shape == Shape::Tet ? SimplicialDecomposition{ 4, TetCorners }
                             : SimplicialDecomposition{ cornerTetrahedra(shape),
                                 simplicialDecomposition(shape).tets };
}

/// What takes s to 1 in the cell of scaled Jacobian 1.
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

/// One corner of each cell of a group.
struct Corner
{
  LaneMatrix edges, normals; ///< the normals: of each two edges, by which the determinant grows
  Lanes determinant, squares[3];
  Lanes s; ///< over `least`, 1 where the corner does not count

  MORPH_LANES_INLINE Corner(const LaneVector (&x)[8], const int* corner, const Lanes& scale)
  {
    edgesOf(x, corner, this->edges);
    cofactor(this->edges, this->normals);
    dot(this->edges[0], this->normals[0], this->determinant);
    for (int k = 0; k < 3; ++k)
    {
      dot(this->edges[k], this->edges[k], this->squares[k]);
    }
    const Lanes zero = {}, one = zero + 1.;
    const Lanes square = this->squares[0] * this->squares[1] * this->squares[2];
    const auto some = square > 0.;
    const Lanes quotient = scale * this->determinant / squareRoot(some ? square : one);
    this->s = scale == 0. ? one : some ? quotient : zero;
  }

  /// s^-8, infinite where s is not positive.
  MORPH_LANES_INLINE void power(Lanes& result) const
  {
    static_assert(Power == 8, "three squarings");
    const Lanes infinity = Lanes{} + std::numeric_limits<double>::infinity();
    result = this->s > 0. ? 1. / this->s : infinity;
    result *= result;
    result *= result;
    result *= result;
  }
};

struct GroupValue
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups, const Corners& corners,
    const Points& points, double& sum)
  {
    LaneVector x[8];
    cornersOf(groups, group, points, x);
    const SimplicialDecomposition parts = cornerTets(groups.shape(group));
    const CornerAngles::Scales* scales =
      corners.scales.data() + groups.firstPlace(group) / LaneCount;
    const Lanes zero = {};
    Lanes all = {};
    for (int t = 0; t < parts.count; ++t)
    {
      const Lanes scale = load(scales[t].factor);
      Lanes power;
      Corner(x, parts.tets[t].corner, scale).power(power);
      all += scale == 0. ? zero : power;
    }
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      sum += all[lane];
    }
  }
};

struct GroupGradient
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups, const Corners& corners,
    const Points& points, Points& forces)
  {
    LaneVector x[8], sum[8] = {};
    cornersOf(groups, group, points, x);
    const SimplicialDecomposition parts = cornerTets(groups.shape(group));
    const CornerAngles::Scales* scales =
      corners.scales.data() + groups.firstPlace(group) / LaneCount;
    const double mean = Power / static_cast<double>(corners.count);
    const Lanes zero = {}, one = zero + 1.;
    for (int t = 0; t < parts.count; ++t)
    {
      const Lanes scale = load(scales[t].factor);
      const int* corner = parts.tets[t].corner;
      const Corner own(x, corner, scale);
      Lanes power;
      own.power(power);
      const auto counts = (scale != 0.) & (own.s > 0.);
      const Lanes factor = counts ? mean * power : zero;
      const Lanes byDeterminant = factor / (counts ? own.determinant : one);
      LaneVector all = {};
      for (int k = 0; k < 3; ++k)
      {
        const Lanes byLength = factor / (counts ? own.squares[k] : one);
        for (int i = 0; i < 3; ++i)
        {
          const Lanes force = byLength * own.edges[k][i] - byDeterminant * own.normals[k][i];
          sum[corner[k + 1]][i] += force;
          all[i] += force;
        }
      }
      for (int i = 0; i < 3; ++i)
      {
        sum[corner[0]][i] -= all[i];
      }
    }
    storeAtPlaces(groups, group, sum, forces);
  }
};

Corners scaledCorners(
  const CellGroups& groups, const std::vector<std::int8_t>& orientation, double least)
{
  Corners result;
  result.scales.resize(groups.places() / LaneCount);
  for (Index group = 0; group < groups.size(); ++group)
  {
    const SimplicialDecomposition parts = cornerTets(groups.shape(group));
    CornerAngles::Scales* scales = result.scales.data() + groups.firstPlace(group) / LaneCount;
    for (int lane = 0; lane < groups.cells(group); ++lane)
    {
      for (int t = 0; t < parts.count; ++t)
      {
        if (groups.moves(group, lane, parts.tets[t].corner))
        {
          scales[t].factor[lane] =
            orientation[groups.cell(group, lane)] * scaleOf(groups.shape(group)) / least;
          ++result.count;
        }
      }
    }
  }
  result.count = std::max<Index>(1, result.count);
  return result;
}
}

CornerAngles::CornerAngles(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& cells, const std::vector<Index>& free, double least)
  : free_(rowOrder(mesh, free))
  , groups_(mesh, this->free_, cells)
  , corners_(scaledCorners(this->groups_, orientation, least))
{
}

Objective::Value CornerAngles::value(const Points& points, Monitor& monitor) const
{
  const auto sum =
    sumOverGroups<GroupValue, double>(this->groups_, monitor, this->corners_, points);
  return { sum / static_cast<double>(this->corners_.count), std::isfinite(sum) };
}

void CornerAngles::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromGroups<GroupGradient>(
    this->groups_, this->parts_, result, monitor, this->corners_, points);
}
}
