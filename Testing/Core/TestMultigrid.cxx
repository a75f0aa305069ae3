// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/Multigrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace morph;

namespace
{
/// The Laplacian of a line, whose eigenvectors are sines.
CsrMatrix line(int rows, double size)
{
  CsrMatrix A(rows, rows);
  for (int i = 0; i < rows; ++i)
  {
    for (int j = std::max(i - 1, 0); j <= std::min(i + 1, rows - 1); ++j)
    {
      A.insert(i, j) = size * (i == j ? 2 : -1);
    }
  }
  A.makeCompressed();
  return A;
}

Points placesOnLine(int rows)
{
  Points places = Points::Zero(rows, 3);
  places.col(0) = Eigen::VectorXd::LinSpaced(rows, 0, rows - 1);
  return places;
}

template <typename Number>
CsrMatrixOf<Number> randomMatrix(int rows, int columns, std::mt19937& random)
{
  std::uniform_real_distribution<Number> number(-1, 1);
  std::vector<Eigen::Triplet<Number>> entries;
  for (int i = 0; i < rows; ++i)
  {
    for (int j = 0; j < columns; ++j)
    {
      if (random() % 3 == 0)
      {
        entries.emplace_back(i, j, number(random));
      }
    }
  }
  CsrMatrixOf<Number> result(rows, columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}
}

// A sweep and a sweep back, whose blocks are the same for any number of threads.
TEST(GaussSeidel, ASweepForthAndBackDampsEveryErrorForAnyNumberOfThreads)
{
  constexpr int Rows = 5000; // several blocks
  const CsrMatrixOf<float> A = rounded(line(Rows, 1));
  const auto energy = [&](const FloatMultiVector& x)
  {
    double sum = 0;
    for (int i = 0; i < Rows; ++i)
    {
      sum +=
        x[i][0] * (2. * x[i][0] - (i > 0 ? x[i - 1][0] : 0) - (i + 1 < Rows ? x[i + 1][0] : 0));
    }
    return sum;
  };
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<float> number(-1, 1);
  FloatMultiVector error(Rows), zero(Rows, Eigen::Vector4f::Zero()), after[2];
  std::generate(
    error.begin(), error.end(), [&] { return Eigen::Vector4f::Constant(number(random)); });
  for (const int threads : { 1, 3 })
  {
    meshes::ThreadedMonitor monitor(threads);
    GaussSeidel smoother;
    ASSERT_TRUE(smoother.prepare(A, 0, monitor));
    // The error of an iterate e is e - B A e; the sweep back from e does the same for A x = 0.
    FloatMultiVector rhs(Rows), x(Rows), residual(Rows), back(Rows);
    smoother.sweepBack(A, zero.data(), error.data(), back.data(), monitor);
    EXPECT_LT(energy(back), 0.7 * energy(error));
    for (int i = 0; i < Rows; ++i)
    {
      rhs[i] =
        2 * back[i] - (i > 0 ? back[i - 1] : zero[0]) - (i + 1 < Rows ? back[i + 1] : zero[0]);
    }
    smoother.sweep(A, rhs.data(), x.data(), monitor);
    smoother.residual(A, x.data(), residual.data(), monitor);
    for (int i = 0; i < Rows; ++i)
    {
      back[i] -= x[i];
    }
    EXPECT_LT(energy(back), 0.3 * energy(error));
    for (int i = 1; i + 1 < Rows; ++i)
    {
      EXPECT_NEAR(residual[i][3], 2 * back[i][3] - back[i - 1][3] - back[i + 1][3], 1e-5);
    }
    after[threads == 3] = residual;
  }
  EXPECT_EQ(after[0], after[1]);
}

TEST(GaussSeidel, RefusesADiagonalThatHasNoInverse)
{
  Monitor monitor;
  CsrMatrixOf<float> A = rounded(line(3, 1));
  A.coeffRef(1, 1) = 1e-30f;
  EXPECT_FALSE(GaussSeidel().prepare(A, 1e-20f, monitor));
  EXPECT_TRUE(GaussSeidel().prepare(A, 1e-31f, monitor));
}

// The apex of a flat pyramid is near its corners, which have nearer neighbors above and below.
TEST(Multigrid, AnApexFollowsTheColumnsAroundItWithoutJoiningThem)
{
  Points places(5, 3);
  places << 0, 0, 0, 0, 0, .1, 1, 0, 0, 1, 0, .1, .5, 0, .05;
  CsrMatrixOf<float> A(5, 5);
  const std::vector<std::vector<float>> rows = { { 5, -4, 0, 0, -1 }, { -4, 5, 0, 0, -1 },
    { 0, 0, 5, -4, -1 }, { 0, 0, -4, 5, -1 }, { -1, -1, -1, -1, 4 } };
  for (int i = 0; i < 5; ++i)
  {
    for (int j = 0; j < 5; ++j)
    {
      A.insert(i, j) = rows[i][j];
    }
  }
  A.makeCompressed();
  Monitor monitor;
  std::vector<int> aggregateOf;
  const CsrMatrixOf<float> P = prolongation(A, places, aggregateOf, monitor);
  ASSERT_EQ(P.cols(), 2);
  EXPECT_EQ(aggregateOf[0], aggregateOf[1]);
  EXPECT_EQ(aggregateOf[2], aggregateOf[3]);
  EXPECT_FLOAT_EQ(P.coeff(4, 0), 0.5f);
  EXPECT_FLOAT_EQ(P.coeff(4, 1), 0.5f);
}

// The error is damped much more by a cycle than by its smoother, whatever the matrix's size.
TEST(Multigrid, ACycleIsNearTheInverse)
{
  constexpr int Rows = 3000;
  meshes::ThreadedMonitor monitor(2);
  for (const double size : { 1e-200, 1., 1e200 })
  {
    const CsrMatrix A = line(Rows, size);
    Multigrid multigrid;
    multigrid.prepare(A, Multigrid::Symmetry::Symmetric, placesOnLine(Rows), monitor);
    EXPECT_GE(multigrid.numberOfLevels(), 3);
    Multigrid::Workspace workspace = multigrid.workspace();
    FloatMultiVector rhs(Rows), x(Rows);
    const auto exact = [&](int i) { return std::sin(3 * M_PI * (i + 1) / (Rows + 1)); };
    for (int i = 0; i < Rows; ++i)
    {
      double product = 2 * exact(i);
      product -= (i > 0 ? exact(i - 1) : 0) + (i + 1 < Rows ? exact(i + 1) : 0);
      rhs[i].setConstant(static_cast<float>(size / multigrid.unit() * product));
    }
    multigrid.apply(rhs.data(), x.data(), workspace, monitor);
    for (int i = 0; i < Rows; i += 100)
    {
      EXPECT_NEAR(x[i][2], exact(i), 0.3) << size;
    }
  }
}

TEST(Multigrid, TripleProductsAreThoseOfDenseMatricesForAnyNumberOfThreads)
{
  std::mt19937 random(meshes::seed());
  const auto R = randomMatrix<float>(9000, 40, random); // three blocks of rows
  const auto A = randomMatrix<double>(40, 40, random);
  const auto P = randomMatrix<float>(40, 30, random);
  Monitor serial;
  meshes::ThreadedMonitor three(3);
  const CsrMatrix found = tripleProduct(R, A, P, 2, serial);
  EXPECT_EQ((found - tripleProduct(R, A, P, 2, three)).norm(), 0);
  const Eigen::MatrixXd expected =
    2 * Eigen::MatrixXd(R.cast<double>()) * Eigen::MatrixXd(A) * Eigen::MatrixXd(P.cast<double>());
  EXPECT_LT((Eigen::MatrixXd(found) - expected).cwiseAbs().maxCoeff(), 1e-11);
}
