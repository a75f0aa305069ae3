// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/UntangleEnergy.h"

#include "Energies/BatchReductions.h"
#include "Energies/CellBatchKernel.h"
#include "Mesh/UnknownOrdering.h"

#include <Eigen/LU>

#include <algorithm>

namespace morph
{
namespace
{
using namespace foldover;
using Tetrahedra = UntangleEnergy::Tetrahedra;

/// What a tetrahedron lacks of the margin, 0 if nothing; and the normals of its edges, by which its determinant grows.
MORPH_LANES_INLINE void missing(const LaneVector (&x)[8], const int* corner, const Lanes& inverse,
  double margin, LaneMatrix& normal, Lanes& result)
{
  LaneMatrix D;
  edgesOf(x, corner, D);
  cofactor(D, normal);
  Lanes determinant;
  dot(D[0], normal[0], determinant);
  const Lanes zero = {}, gap = margin - inverse * determinant;
  result = ((inverse != 0.) & (gap > 0.)) ? gap : zero;
}

struct GroupValue
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups,
    const Tetrahedra& tetrahedra, const Points& points, double& sum)
  {
    LaneVector x[8];
    cornersOf(groups, group, points, x);
    const WeightedTet* part = simplicialDecomposition(groups.shape(group)).tets;
    Lanes square = {};
    for (Index t = tetrahedra.first[group]; t < tetrahedra.first[group + 1]; ++t, ++part)
    {
      LaneMatrix normal;
      Lanes gap;
      missing(x, part->corner, load(tetrahedra.volumes[t].inverse), tetrahedra.margin, normal, gap);
      square += gap * gap;
    }
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      sum += square[lane];
    }
  }
};

struct GroupGradient
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups,
    const Tetrahedra& tetrahedra, const Points& points, Points& parts)
  {
    LaneVector x[8], sum[8] = {};
    cornersOf(groups, group, points, x);
    const WeightedTet* part = simplicialDecomposition(groups.shape(group)).tets;
    const double factor = -8 / static_cast<double>(tetrahedra.count);
    for (Index t = tetrahedra.first[group]; t < tetrahedra.first[group + 1]; ++t, ++part)
    {
      LaneMatrix normal;
      Lanes gap;
      const Lanes inverse = load(tetrahedra.volumes[t].inverse);
      missing(x, part->corner, inverse, tetrahedra.margin, normal, gap);
      if (!any(gap > 0.))
      {
        continue;
      }
      const Lanes slope = factor * gap * inverse;
      for (int i = 0; i < 3; ++i)
      {
        Lanes all = {};
        for (int k = 0; k < 3; ++k)
        {
          const Lanes force = slope * normal[k][i];
          sum[part->corner[k + 1]][i] += force;
          all += force;
        }
        sum[part->corner[0]][i] -= all;
      }
    }
    storeAtPlaces(groups, group, sum, parts);
  }
};

Tetrahedra tetrahedraOf(const CellGroups& groups, const TargetShapes& targets, double margin)
{
  Tetrahedra result;
  result.margin = margin;
  for (Index group = 0; group < groups.size(); ++group)
  {
    const Index first = result.first.back();
    const WeightedTet* part = simplicialDecomposition(groups.shape(group)).tets;
    for (int lane = 0; lane < groups.cells(group); ++lane)
    {
      const Index start = targets.start[groups.cell(group, lane)];
      const Index count = targets.start[groups.cell(group, lane) + 1] - start;
      result.volumes.resize(
        std::max(result.volumes.size(), static_cast<std::size_t>(first + count)));
      for (Index t = 0; t < count; ++t)
      {
        const TargetShapes::Tetrahedron& target = targets.tetrahedra[start + t];
        if (target.weight > 0 && groups.moves(group, lane, part[t].corner))
        {
          result.volumes[first + t].inverse[lane] =
            Eigen::Map<const Eigen::Matrix3d>(target.inverse).determinant();
          ++result.count;
        }
      }
    }
    result.first.push_back(static_cast<Index>(result.volumes.size()));
  }
  result.count = std::max<Index>(1, result.count);
  return result;
}
}

UntangleEnergy::UntangleEnergy(
  const Mesh& mesh, const std::vector<Index>& free, const TargetShapes& targets, double margin)
  : free_(rowOrder(mesh, free))
  , groups_(mesh, this->free_)
  , tetrahedra_(tetrahedraOf(this->groups_, targets, margin))
{
}

Objective::Value UntangleEnergy::value(const Points& points, Monitor& monitor) const
{
  const auto sum =
    sumOverGroups<GroupValue, double>(this->groups_, monitor, this->tetrahedra_, points);
  return { 4 * sum / static_cast<double>(this->tetrahedra_.count), true };
}

void UntangleEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  gatherFromGroups<GroupGradient>(
    this->groups_, this->parts_, result, monitor, this->tetrahedra_, points);
}
}
