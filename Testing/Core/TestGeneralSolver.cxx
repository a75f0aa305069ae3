// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Solvers/MultigridSolver.h"

#include "Meshes.h"
#include "Motions.h"
#include "Support/Error.h"
#include "WatchingMonitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

using namespace morph;

namespace
{
struct Problem
{
  CsrMatrix A;
  Points places, b;
};

/// I - W with random W >= 0 on the 6 lattice neighbors of an n^3 grid, some of it to the outside:
/// an M-matrix. `wind` in [0, 1): how much more the neighbor upstream along z weighs.
Problem lattice(int n, double wind)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(.5, 1.5);
  const int rows = n * n * n;
  std::vector<Eigen::Triplet<double>> entries;
  Problem problem;
  problem.places.resize(rows, 3);
  problem.b.resize(rows, 3);
  problem.b = problem.b.unaryExpr([&](double) { return value(random) - 1; });
  for (int i = 0; i < rows; ++i)
  {
    const int at[3] = { i % n, i / n % n, i / n / n };
    problem.places.row(i) = Eigen::RowVector3d(at[0], at[1], at[2]);
    double w[6], sum = 0;
    for (int f = 0; f < 6; ++f)
    {
      w[f] = value(random) * (f == 4 ? 1 + wind : f == 5 ? 1 - wind : 1);
      sum += w[f];
    }
    entries.emplace_back(i, i, 1);
    const int stride[3] = { 1, n, n * n };
    for (int f = 0; f < 6; ++f)
    {
      const int axis = f / 2, side = f % 2 ? 1 : -1;
      if (at[axis] + side >= 0 && at[axis] + side < n)
      {
        entries.emplace_back(i, i + side * stride[axis], -w[f] / sum);
      }
    }
  }
  problem.A.resize(rows, rows);
  problem.A.setFromTriplets(entries.begin(), entries.end());
  return problem;
}

Points byLU(const CsrMatrix& A, const Points& b)
{
  return direct::solve(Eigen::SparseMatrix<double>(A), b);
}
}

TEST(GeneralSolver, AgreesWithADirectSolve)
{
  for (double wind : { 0., .3, .9 })
  {
    Problem problem = lattice(11, wind);
    const CsrMatrix A = problem.A, T = CsrMatrix(A.transpose());
    meshes::ThreadedMonitor monitor;
    GeneralSolver solver;
    solver.prepare({ problem.A, problem.places }, monitor);
    Points x = Points::Zero(A.rows(), 3), y = x;
    const SolveReport report = solver.solve(problem.b, x, 1e-12, 500, monitor);
    const SolveReport back = solver.solveTransposed(problem.b, y, 1e-12, 500, monitor);
    EXPECT_LE(report.relativeResidual, 1e-12) << wind;
    EXPECT_LE(back.relativeResidual, 1e-12) << wind;
    EXPECT_LT(report.iterations, 60) << wind;
    const Points expected = byLU(A, problem.b), expectedBack = byLU(T, problem.b);
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff()) << wind;
    EXPECT_LT((y - expectedBack).cwiseAbs().maxCoeff(), 1e-9 * expectedBack.cwiseAbs().maxCoeff())
      << wind;
    EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings[0];
  }
}

TEST(GeneralSolver, ColumnsStopByThemselves)
{
  // A zero column, one of pure roundoff beside the others, and one that is solved at the start.
  Problem problem = lattice(9, .3);
  const CsrMatrix A = problem.A;
  problem.b.col(1) *= 1e-17;
  Points x = Points::Zero(A.rows(), 3);
  x.col(2) = byLU(A, problem.b).col(2);
  const Eigen::VectorXd before = x.col(2);
  meshes::ThreadedMonitor monitor;
  GeneralSolver solver;
  solver.prepare({ problem.A, problem.places }, monitor);
  SolveReport report = solver.solve(problem.b, x, 1e-10, 500, monitor);
  EXPECT_LT(report.iterations, 40);
  EXPECT_LE(report.relativeResidual, 1e-10);
  EXPECT_EQ(x.col(1), Eigen::VectorXd::Zero(A.rows()));
  EXPECT_EQ(x.col(2), before);

  // A column that is hardly above rounding is not reported as one that stagnates.
  problem.b.col(1) *= 3e-14 * 1e17;
  x.setZero();
  report = solver.solve(problem.b, x, 1e-10, 500, monitor);
  EXPECT_LE(report.relativeResidual, 1e-10);

  x.setZero();
  report = solver.solve(Points::Zero(A.rows(), 3), x, 1e-10, 500, monitor);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, Points::Zero(A.rows(), 3));
}

TEST(GeneralSolver, SaysWhereItDoesNotConverge)
{
  // Large entries of both signs at random places: the multigrid comes nowhere near the inverse.
  constexpr int n = 1000;
  std::mt19937 random(meshes::seed());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i)
  {
    entries.emplace_back(i, i, 1);
    for (int k = 0; k < 30; ++k)
    {
      const int j = static_cast<int>(random() % n);
      if (j != i)
      {
        entries.emplace_back(i, j, random() % 2 ? 1 : -1);
      }
    }
  }
  CsrMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const Points places = lattice(10, 0).places, b = lattice(10, 0).b;
  Points x = Points::Zero(n, 3);
  Monitor monitor;
  GeneralSolver solver;
  solver.prepare({ A, places }, monitor);
  motions::expectError(
    Error::Kind::NoConvergence, [&] { solver.solve(b, x, 1e-12, 60, monitor); },
    "relative residual");
  EXPECT_EQ(x.squaredNorm(), 0); // untouched
}

TEST(GeneralSolver, TakesHugeRightHandSides)
{
  Problem problem = lattice(9, .3);
  meshes::WatchingMonitor monitor;
  GeneralSolver solver;
  solver.prepare({ problem.A, problem.places }, monitor);
  Points x = Points::Zero(problem.b.rows(), 3);
  problem.b *= 1e100;
  const SolveReport report = solver.solve(problem.b, x, 1e-10, 500, monitor);
  EXPECT_LE(report.relativeResidual, 1e-10);
}

TEST(GeneralSolver, EndsWhereItsNumbersOverflow)
{
  // x_0 is about 1e177: its residual is rounding of 1e161, whose square is infinite.
  CsrMatrix A(3, 3);
  for (int i = 0; i < 3; ++i)
  {
    A.insert(i, i) = 1;
  }
  A.insert(0, 1) = -1e30;
  A.insert(1, 2) = -.7;
  A.makeCompressed();
  const Points places = Points::Identity(3, 3), b = Points::Constant(3, 3, 1e147 / 3);
  Points x = Points::Zero(3, 3);
  meshes::WatchingMonitor monitor;
  GeneralSolver solver;
  solver.prepare({ A, places }, monitor);
  motions::expectError(
    Error::Kind::NoConvergence, [&] { solver.solve(b, x, 1e-10, 2000, monitor); }, "overflowed");
  EXPECT_GT(monitor.questions, 0);
  EXPECT_EQ(x.squaredNorm(), 0); // untouched
}

TEST(GeneralSolver, RowsWithoutAPositiveDiagonalAreNamed)
{
  Problem problem = lattice(4, 0);
  problem.A.coeffRef(17, 17) = 0;
  Monitor monitor;
  GeneralSolver solver;
  try
  {
    solver.prepare({ problem.A, problem.places }, monitor);
    ADD_FAILURE() << "no error";
  }
  catch (const SingularRows& error)
  {
    EXPECT_EQ(error.rows(), std::vector<std::int64_t>{ 17 });
  }
}

TEST(GeneralSolver, ThreadsDoNotShow)
{
  Problem problem = lattice(18, .3); // more rows than one block of sums
  const CsrMatrix A = problem.A;
  Points reference, referenceBack;
  for (int threads : { 1, 2, 5 })
  {
    meshes::ThreadedMonitor monitor(threads);
    GeneralSolver solver;
    solver.prepare({ A, problem.places }, monitor);
    Points x = Points::Zero(A.rows(), 3), y = x;
    solver.solve(problem.b, x, 1e-10, 500, monitor);
    solver.solveTransposed(problem.b, y, 1e-10, 500, monitor);
    if (threads == 1)
    {
      reference = x;
      referenceBack = y;
    }
    EXPECT_EQ(std::memcmp(x.data(), reference.data(), sizeof(double) * x.size()), 0) << threads;
    EXPECT_EQ(std::memcmp(y.data(), referenceBack.data(), sizeof(double) * y.size()), 0) << threads;
  }
}

TEST(Solvers, TakeASystemOfNoRows)
{
  Monitor monitor;
  const Points none(0, 3);
  Points x(0, 3);
  SpdSolver symmetric;
  symmetric.prepare({ CsrMatrix(0, 0), none }, monitor);
  EXPECT_EQ(symmetric.solve(none, x, 1e-10, 100, monitor).iterations, 0);
  PointsVectors work;
  EXPECT_EQ(
    solveConstrained(symmetric, none, {}, x, 1e-10, 100, work, monitor).relativeResidual, 0);
  symmetric.precondition(none, x, monitor);
  GeneralSolver general;
  general.prepare({ CsrMatrix(0, 0), none }, monitor);
  EXPECT_EQ(general.solve(none, x, 1e-10, 100, monitor).iterations, 0);
  EXPECT_EQ(general.solveTransposed(none, x, 1e-10, 100, monitor).iterations, 0);
  EXPECT_EQ(x.rows(), 0);
}
