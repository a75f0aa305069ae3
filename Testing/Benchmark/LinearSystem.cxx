// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSystem.h"

namespace benchmark
{
morph::Points prescribedDisplacement(const Problem& problem)
{
  const std::vector<morph::Index>& ids = problem.partition.prescribed;
  morph::Points displacement(problem.target.rows(), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto row = static_cast<morph::Index>(i);
    displacement.row(row) = problem.target.row(row) - problem.mesh.points.row(ids[i]);
  }
  return displacement;
}

morph::Points displacement(
  const Problem& problem, const std::vector<morph::Index>& ids, const morph::Points& moved)
{
  morph::Points result(static_cast<morph::Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    result.row(static_cast<morph::Index>(i)) = moved.row(ids[i]) - problem.mesh.points.row(ids[i]);
  }
  return result;
}

double relativeResidual(const LinearSystem& system, const morph::Points& x)
{
  // A column that is rounding beside the others ends at 1e-14 of them, as in the solvers.
  constexpr double Rounding = 1e-4;
  const morph::Points residual = system.rightHandSide - system.matrix * x;
  const double whole = Rounding * system.rightHandSide.norm();
  return (
    residual.colwise().norm().array() / system.rightHandSide.colwise().norm().array().max(whole))
    .maxCoeff();
}
}
