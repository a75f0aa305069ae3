// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/BlockCsr3f.h"
#include "Optimization/Objective.h"
#include "Support/Monitor.h"

#include <gtest/gtest.h>

/// Derivatives of objectives against differences.
namespace differences
{
using morph::Index;
using morph::Points;

/// Calls compare(row, coordinate, plus, minus) with `points` off by 1e-6 either way, for the first
/// `dimension` coordinates of each free node.
template <typename Compare>
void forEach(
  const morph::Objective& objective, const Points& points, int dimension, const Compare& compare)
{
  const std::vector<Index>& free = objective.free();
  for (Index row = 0; row < static_cast<Index>(free.size()); ++row)
  {
    for (int j = 0; j < dimension; ++j)
    {
      Points plus = points, minus = points;
      plus(free[row], j) += 1e-6;
      minus(free[row], j) -= 1e-6;
      compare(row, j, plus, minus);
    }
  }
}

/// The gradient is the slope of the energy, to `tolerance` of `size` plus its norm. Returns it.
inline Points expectGradient(const morph::Objective& objective, const Points& points,
  double tolerance, double size = 1, int dimension = 3)
{
  morph::Monitor monitor;
  Points gradient;
  objective.gradient(points, gradient, monitor);
  EXPECT_EQ(gradient.rows(), static_cast<Index>(objective.free().size()));
  forEach(objective, points, dimension,
    [&](Index row, int j, const Points& plus, const Points& minus)
    {
      const double slope =
        (objective.value(plus, monitor).energy - objective.value(minus, monitor).energy) / 2e-6;
      EXPECT_NEAR(gradient(row, j), slope, tolerance * (size + gradient.norm()));
    });
  return gradient;
}

/// The matrix has at least the curvature of the energy: a projection only adds some.
inline void expectCurvature(
  const morph::SecondOrderObjective& objective, const Points& points, int dimension = 3)
{
  morph::Monitor monitor;
  morph::BlockCsr3f matrix;
  objective.hessian(points, matrix, monitor);
  forEach(objective, points, dimension,
    [&](Index row, int j, const Points& plus, const Points& minus)
    {
      Points up, down, product, unit = Points::Zero(matrix.rows(), 3);
      objective.gradient(plus, up, monitor);
      objective.gradient(minus, down, monitor);
      unit(row, j) = 1;
      matrix.multiply(unit, product, monitor);
      EXPECT_GE(product(row, j), (up(row, j) - down(row, j)) / 2e-6 - 1e-4 * product.norm());
    });
}
}
