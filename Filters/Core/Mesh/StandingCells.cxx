// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/StandingCells.h"

#include "Support/Lists.h"

#include <Eigen/Geometry>

namespace morph
{
namespace
{
/// Puts a prism's back upright on its front. `corners`: front first. `count`: 6 or 8.
void stand(double (*corners)[3], int count, double thickness)
{
  using Row = Eigen::Map<Eigen::RowVector3d>;
  const int half = count / 2;
  const auto at = [&](int k) { return Row(corners[k]); };
  const Eigen::RowVector3d area =
    half == 3 ? (at(1) - at(0)).cross(at(2) - at(0)) : (at(2) - at(0)).cross(at(3) - at(1));
  Eigen::RowVector3d across = Eigen::RowVector3d::Zero();
  for (int k = 0; k < half; ++k)
  {
    across += at(half + k) - at(k);
  }
  const double side = area.dot(across) < 0 ? -1 : 1;
  const Eigen::RowVector3d upright = side * thickness * area.stableNormalized();
  for (int k = 0; k < half; ++k)
  {
    at(half + k) = at(k) + upright;
  }
}
}

std::vector<Index> frontOf(const Mesh& mesh, Index cell)
{
  const CellShape& shape = *cellShape(mesh.types[cell]);
  const Index* nodes = mesh.cell(cell);
  return shape.dimension == 3 ? std::vector<Index>(nodes, nodes + shape.numberOfCorners / 2)
                              : std::vector<Index>();
}

Mesh standing(const Mesh& mesh, const ConstPoints& points)
{
  Mesh result;
  result.types = mesh.types;
  result.offsets = mesh.offsets;
  result.connectivity = consecutive(mesh.connectivity.size());
  result.points = points(mesh.connectivity, allColumns);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const int half = static_cast<int>(frontOf(mesh, c).size());
    auto* x = reinterpret_cast<double(*)[3]>(result.points.data() + 3 * mesh.offsets[c]);
    if (half == 0)
    {
      continue;
    }
    stand(x, 2 * half, mesh.layer.thickness);
    const Eigen::RowVector3d upright =
      result.points.row(mesh.offsets[c] + half) - result.points.row(mesh.offsets[c]);
    // A quadratic prism: the edges of its front, those of its back, and those between.
    const auto middles = mesh.cellSize(c) > 2 * half ? half : 0;
    for (int k = 0; k < middles; ++k)
    {
      const Index edge = mesh.offsets[c] + 2 * half + k;
      result.points.row(edge + half) = result.points.row(edge) + upright;
      result.points.row(edge + 2 * half) = result.points.row(mesh.offsets[c] + k) + upright / 2;
    }
  }
  return result;
}

void copyStanding(
  const Mesh& mesh, Index cell, const CellShape& shape, const ConstPoints& points, double* corners)
{
  copyCorners(mesh, cell, shape, points, corners);
  if (mesh.layer.isCurved() && shape.dimension == 3)
  {
    stand(reinterpret_cast<double(*)[3]>(corners), shape.numberOfCorners, mesh.layer.thickness);
  }
}
}
