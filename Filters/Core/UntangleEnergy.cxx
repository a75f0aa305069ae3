// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleEnergy.h"

#include "BlockSum.h"
#include "NodeUses.h"
#include "SimplicialDecomposition.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
}

UntangleEnergy::UntangleEnergy(
  const Mesh& mesh, const std::vector<Index>& free, const TargetShapes& targets, double margin)
  : free_(free)
  , margin_(margin)
{
  const std::vector<std::int32_t> row = placesIn(free, mesh.numberOfNodes());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const SimplicialDecomposition parts = simplicialDecomposition(shape.shape);
    for (Index t = targets.start[c]; t < targets.start[c + 1]; ++t)
    {
      const TargetShapes::Tetrahedron& target = targets.tetrahedra[t];
      Tetrahedron own;
      bool isMovable = false;
      for (int k = 0; k < 4; ++k)
      {
        own.node[k] = mesh.cell(c)[shape.cornerNode[parts.tets[t - targets.start[c]].corner[k]]];
        isMovable = isMovable || row[own.node[k]] >= 0;
      }
      if (!isMovable || !(target.weight > 0))
      {
        continue;
      }
      own.volume = Eigen::Map<const Eigen::Matrix3d>(target.inverse).determinant();
      this->tetrahedra_.push_back(own);
    }
  }
  this->uses_ =
    placesOfRows(static_cast<Index>(4 * this->tetrahedra_.size()), static_cast<Index>(free.size()),
      [&](Index place) { return row[this->tetrahedra_[place / 4].node[place % 4]]; });
}

Eigen::Matrix3d UntangleEnergy::edges(const Tetrahedron& tetrahedron, const Points& points) const
{
  Eigen::Matrix3d result;
  for (int k = 0; k < 3; ++k)
  {
    result.col(k) =
      (points.row(tetrahedron.node[k + 1]) - points.row(tetrahedron.node[0])).transpose();
  }
  return result;
}

Objective::Value UntangleEnergy::value(const Points& points, Monitor& monitor) const
{
  const auto count = static_cast<Index>(this->tetrahedra_.size());
  const double sum = blockSum(count, monitor, 0.,
    [&](Index t)
    {
      const Tetrahedron& own = this->tetrahedra_[t];
      const double missing =
        std::max(0., this->margin_ - own.volume * this->edges(own, points).determinant());
      return 4 * missing * missing;
    });
  return { sum / static_cast<double>(std::max<Index>(1, count)), true };
}

void UntangleEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  // Each tetrahedron writes what it gives to its corners; then each node sums up in a fixed order.
  const auto count = static_cast<Index>(this->tetrahedra_.size());
  Points parts(4 * count, 3);
  monitor.parallelFor(count, Grain,
    [&](Index first, Index last)
    {
      for (Index t = first; t < last; ++t)
      {
        const Tetrahedron& own = this->tetrahedra_[t];
        const Eigen::Matrix3d D = this->edges(own, points);
        const double missing = std::max(0., this->margin_ - own.volume * D.determinant());
        const double slope = -8 * missing * own.volume / static_cast<double>(count);
        for (int k = 0; k < 3; ++k)
        {
          parts.row(4 * t + k + 1) =
            slope * D.col((k + 1) % 3).cross(D.col((k + 2) % 3)).transpose();
        }
        parts.row(4 * t) = -parts.middleRows(4 * t + 1, 3).colwise().sum();
      }
    });
  sumOverPlaces(this->uses_, parts, result, monitor);
}
}
