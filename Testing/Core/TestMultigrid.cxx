// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/Aggregation.h"
#include "Solvers/Multigrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace morph;

namespace
{
/// The Laplacian of a line. D^-1 A has the eigenvalues 1 - cos(k pi / (rows + 1)) and sines.
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

TEST(Multigrid, EstimatesTheLargestEigenvalue)
{
  constexpr int Rows = 300;
  Monitor monitor;
  const CsrMatrixOf<float> A = rounded(line(Rows, 1));
  const float found = largestEigenvalue(A, std::vector<float>(Rows, 0.5f), monitor);
  const double largest = 1 + std::cos(M_PI / (Rows + 1));
  EXPECT_GE(1.25 * found, largest);
  EXPECT_LE(found, 2);
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
    Multigrid::Workspace workspace(multigrid);
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
