// SPDX-License-Identifier: BSD-3-Clause
#include "CornerAngles.h"

#include "BlockSum.h"
#include "CellPatch.h"
#include "Minimizers.h"
#include "NodeUses.h"
#include "ScaledJacobian.h"
#include "SimplicialDecomposition.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr int Power = 8;
constexpr int Rounds = 6;
constexpr int Steps = 40;
constexpr int Rings = 2;
constexpr double LeastGain = 1e-3;
// Worst are the cells that are less than this above the least: of it, and of the way to 1.
constexpr double OfTheLeast = 0.5, OfTheWay = 0.1;

/// A tetrahedron's corners in positive order; the decomposition has one of them.
constexpr int TetCorners[4][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 3, 0, 2, 1 } };

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

double power(double x)
{
  static_assert(Power == 8, "three squarings");
  x *= x;
  x *= x;
  return x * x;
}
}

CornerAngles::CornerAngles(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& cells, const std::vector<Index>& free, double least)
  : free_(free)
{
  const std::vector<std::int32_t> row = placesIn(free, mesh.numberOfNodes());
  for (Index c : cells)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const bool isTet = shape.shape == Shape::Tet;
    const int count = isTet ? 4 : cornerTetrahedra(shape.shape);
    for (int k = 0; k < count; ++k)
    {
      const int* local =
        isTet ? TetCorners[k] : simplicialDecomposition(shape.shape).tets[k].corner;
      Corner corner;
      corner.scale = orientation[c] * scaleOf(shape.shape) / least;
      bool moves = false;
      for (int a = 0; a < 4; ++a)
      {
        corner.node[a] = mesh.cell(c)[shape.cornerNode[local[a]]];
        moves = moves || row[corner.node[a]] >= 0;
      }
      if (moves)
      {
        this->corners_.push_back(corner);
      }
    }
  }
  this->uses_ =
    placesOfRows(static_cast<Index>(4 * this->corners_.size()), static_cast<Index>(free.size()),
      [&](Index place) { return row[this->corners_[place / 4].node[place % 4]]; });
}

double CornerAngles::measure(
  const Corner& corner, const Points& points, Eigen::Matrix3d& edges) const
{
  for (int k = 0; k < 3; ++k)
  {
    edges.col(k) = (points.row(corner.node[k + 1]) - points.row(corner.node[0])).transpose();
  }
  const double lengths = edges.col(0).norm() * edges.col(1).norm() * edges.col(2).norm();
  return lengths > 0 ? corner.scale * edges.determinant() / lengths : 0;
}

Objective::Value CornerAngles::value(const Points& points, Monitor& monitor) const
{
  const auto count = static_cast<Index>(this->corners_.size());
  const double sum = blockSum(count, monitor, 0.,
    [&](Index c)
    {
      Eigen::Matrix3d edges;
      const double s = this->measure(this->corners_[c], points, edges);
      return s > 0 ? power(1 / s) : std::numeric_limits<double>::infinity();
    });
  return { sum / static_cast<double>(std::max<Index>(1, count)), std::isfinite(sum) };
}

void CornerAngles::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  // Each corner writes what it gives to its nodes; then each node sums up in a fixed order.
  const auto count = static_cast<Index>(this->corners_.size());
  Points parts(4 * count, 3);
  monitor.parallelFor(count, Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        Eigen::Matrix3d D;
        const double s = this->measure(this->corners_[c], points, D);
        const double factor = s > 0 ? Power * power(1 / s) / static_cast<double>(count) : 0;
        const double determinant = D.determinant();
        for (int k = 0; k < 3 && factor > 0; ++k)
        {
          const Eigen::Vector3d normal = D.col((k + 1) % 3).cross(D.col((k + 2) % 3));
          parts.row(4 * c + k + 1) =
            factor * (D.col(k) / D.col(k).squaredNorm() - normal / determinant).transpose();
        }
        if (!(factor > 0))
        {
          parts.middleRows(4 * c + 1, 3).setZero();
        }
        parts.row(4 * c) = -parts.middleRows(4 * c + 1, 3).colwise().sum();
      }
    });
  sumOverPlaces(this->uses_, parts, result, monitor);
}

namespace
{
std::vector<Index> worstCells(const Mesh& mesh, const Quality& quality)
{
  const double least = quality.minimum;
  const double limit = least + std::min(OfTheLeast * least, OfTheWay * (1 - least));
  std::vector<Index> worst;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (quality.scaledJacobian[c] <= limit && numberOfCorners(cellShape(mesh.types[c])->shape) > 0)
    {
      worst.push_back(c);
    }
  }
  return worst;
}
}

int raiseWorstCells(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor)
{
  Quality quality = measureQuality(mesh, points, orientation, {}, monitor);
  if (!(quality.minimum > 0))
  {
    return 0;
  }
  const Adjacency around = nodeToCells(mesh);
  for (int round = 0; round < Rounds; ++round)
  {
    const CellPatch patch = cellPatch(mesh, around, free, worstCells(mesh, quality), Rings);
    if (patch.nodes.empty())
    {
      return round;
    }
    const CornerAngles angles(mesh, orientation, patch.cells, patch.nodes, quality.minimum);
    MinimizerLimits limits;
    limits.steps = Steps;
    MinimizerEffort effort;
    Points trial = points;
    limitedMemoryBfgs(angles, trial, limits, effort, monitor);
    Quality next = measureQuality(mesh, trial, orientation, {}, monitor);
    if (!(next.minimum > (1 + LeastGain) * quality.minimum))
    {
      return round;
    }
    points.swap(trial);
    quality = std::move(next);
  }
  return Rounds;
}
}
