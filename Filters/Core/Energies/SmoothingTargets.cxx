// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/SmoothingTargets.h"

#include "Mesh/SimplicialDecomposition.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double LeastVolume = 1e-3; // of the mean cell's

/// Returns the volume of each volume cell, 0 for other cells. Nearly flat cells get the mean.
std::vector<double> volumes(const Mesh& rest, const Communicator& communicator)
{
  std::vector<double> result(rest.numberOfCells(), 0);
  double sum = 0;
  Index count = 0;
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(rest, c);
    double x[8][3];
    copyCorners(rest, c, shape, rest.points, x[0]);
    if (numberOfCorners(shape.shape) > 0)
    {
      result[c] = std::abs(signedVolume(shape.shape, x));
      sum += result[c];
      ++count;
    }
  }
  sum = communicator.sum(sum);
  count = communicator.sum(count);
  const double mean = count > 0 ? sum / static_cast<double>(count) : 0;
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    if (hasCorners(rest, c) && !(result[c] > LeastVolume * mean))
    {
      result[c] = mean > 0 ? mean : 1;
    }
  }
  return result;
}

TargetMatrices idealTargets(
  const Mesh& rest, const std::vector<std::int8_t>& orientation, const Communicator& communicator)
{
  const std::vector<double> volume = volumes(rest, communicator);
  TargetMatrices result;
  result.open(rest);
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const Shape shape = cellShape(rest, c)->shape;
    const int corners = cornerTetrahedra(shape);
    if (corners == 0)
    {
      continue;
    }
    CellCorners ideal = idealShape(shape, Eigen::Vector3d::Ones());
    double x[8][3];
    std::copy(ideal.data(), ideal.data() + ideal.size(), x[0]);
    ideal *= std::cbrt(volume[c] / std::abs(signedVolume(shape, x)));
    ideal.row(0) *= orientation[c];
    std::copy(ideal.data(), ideal.data() + 3 * numberOfCorners(shape),
      result.corners.data() + 3 * result.start[c]);
    // The corners' tetrahedra are alike, and each has the same share of a weight of 1.
    const WeightedTet& first = simplicialDecomposition(shape).tets[0];
    result.factor[c] = 1 / (corners * first.weight * result.edges(c, first).determinant());
    result.included[c] = (1u << corners) - 1;
  }
  return result;
}
}

TargetMatrices smoothingTargets(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  SmoothingTarget target, Monitor& monitor, const Communicator& communicator)
{
  if (target == SmoothingTarget::Ideal)
  {
    return idealTargets(rest, orientation, communicator);
  }
  TargetMatrices result = targetMatrices(rest, orientation, rest.points,
    TargetConstruction::Initial, CellWeights::Volume, monitor, communicator);
  result.theta = 0;
  return result;
}
}
