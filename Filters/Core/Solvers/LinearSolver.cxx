// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/LinearSolver.h"

#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cmath>

namespace morph
{
std::vector<Index> LinearEquations::singularRows() const
{
  const Eigen::VectorXd diagonal = this->matrix.diagonal();
  std::vector<Index> rows;
  for (Index i = 0; i < diagonal.size(); ++i)
  {
    if (!(diagonal[i] > 0 && std::isfinite(diagonal[i])))
    {
      rows.push_back(i);
    }
  }
  return rows;
}

SolveReport LinearSolver::solve(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  MultiVector rows = toRows(x, monitor);
  const SolveReport report =
    this->solve(toRows(b, monitor), rows, tolerance, maxIterations, monitor);
  fromRows(rows, x, monitor);
  return report;
}

SolveReport solveConstrained(const LinearSolver& solver, const Points& b,
  const RowConstraints& constraints, Points& x, double tolerance, int maxIterations,
  PointsVectors& work, Monitor& monitor, const Communicator& communicator)
{
  const auto product = [&](const Points& from, Points& to) { solver.product(from, to, monitor); };
  const auto precondition = [&](const Points& from, Points& to)
  {
    communicator.sum(0.); // ends all processes where one was cancelled
    solver.precondition(from, to, monitor);
  };
  PointsSystem system = { product, precondition,
    [&](const Points& v, const Points& w) { return communicator.sum(dot(v, w, monitor)); }, b, x,
    monitor, work,
    [&](Points& v)
    {
      parallel(static_cast<Index>(constraints.rows.size()), monitor,
        [&](Index k) { v.row(constraints.rows[k]) *= constraints.directions[k]; });
    } };
  communicator.sum(0.);
  solver.product(x, work.Ap, monitor);
  const double given2 = std::max(system.dot(b, b), system.dot(work.Ap, work.Ap));
  Sums norm2 = system.residual();
  const SolverGoal goal = solverGoal(system.one(given2), norm2, tolerance, maxIterations);
  SolveReport report;
  report.iterations = conjugateGradients(system, norm2, goal, monitor);
  goal.report(norm2, report);
  return report;
}
}
