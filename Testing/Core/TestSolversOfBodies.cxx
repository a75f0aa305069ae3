// SPDX-License-Identifier: BSD-3-Clause
// Bodies that do not touch are systems of their own.
#include "Meshes.h"
#include "Solvers/MultigridSolver.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace morph;

namespace
{
/// Two lines whose rows take turns, so that every range of rows has both.
struct TwoLines
{
  static constexpr int Size = 6000; // more than one block of sums
  CsrMatrix A{ 2 * Size, 2 * Size };
  Points places = Points::Zero(2 * Size, 3), expected{ 2 * Size, 3 };

  explicit TwoLines(double second)
  {
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < 2 * Size; ++i)
    {
      this->places(i, 0) = i / 2;
      this->places(i, 1) = i % 2 * 10;
      for (int c = 0; c < 3; ++c)
      {
        this->expected(i, c) = number(random) * (i % 2 == 0 ? 1 : second);
      }
      entries.emplace_back(i, i, 2.1);
      if (i >= 2)
      {
        entries.emplace_back(i, i - 2, -1);
        entries.emplace_back(i - 2, i, -1);
      }
    }
    this->A.setFromTriplets(entries.begin(), entries.end());
  }
  /// The largest error of a line, in parts of its own size.
  double error(const Points& x, int line) const
  {
    double most = 0, size = 0;
    for (Index i = line; i < x.rows(); i += 2)
    {
      most = std::max(most, (x.row(i) - this->expected.row(i)).norm());
      size = std::max(size, this->expected.row(i).norm());
    }
    return most / size;
  }
};
}

template <typename Solver>
class SolversOfBodies : public testing::Test
{
};
using Solvers = testing::Types<SpdSolver, GeneralSolver>;
TYPED_TEST_SUITE(SolversOfBodies, Solvers);

TYPED_TEST(SolversOfBodies, SolveEachBodyToItsOwnSize)
{
  for (const double second : { 1., 1e-8, 1e-30 })
  {
    const TwoLines problem(second);
    Points reference;
    for (const int threads : { 1, 3 })
    {
      meshes::ThreadedMonitor monitor(threads);
      TypeParam solver;
      solver.prepare({ problem.A, problem.places }, monitor);
      EXPECT_EQ(solver.components().count, 2);
      Points x = Points::Zero(2 * TwoLines::Size, 3);
      solver.solve(Points(problem.A * problem.expected), x, 1e-10, 100, monitor);
      EXPECT_LT(problem.error(x, 0), 1e-8);
      EXPECT_LT(problem.error(x, 1), 1e-8) << second;
      reference = threads == 1 ? x : reference;
      EXPECT_TRUE((x.array() == reference.array()).all());
    }
  }
}
