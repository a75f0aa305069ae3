// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/DampedJacobi.h"
#include "Solvers/MultiVector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace morph;

namespace
{
constexpr int Rows = 40;
constexpr float Diagonal = 2;

/// The Laplacian of a line. D^-1 A has the eigenvalues 1 - cos(k pi / (Rows + 1)) and sines.
CsrRows<float> line()
{
  CsrRows<float> A;
  A.rows = Rows;
  A.ownStart.push_back(0);
  A.ownColumn.resize(3 * Rows);
  A.ownValue.resize(3 * Rows);
  int at = 0;
  for (int i = 0; i < Rows; ++i)
  {
    for (int j = std::max(i - 1, 0); j <= std::min(i + 1, Rows - 1); ++j)
    {
      A.ownColumn[at] = j;
      A.ownValue[at++] = i == j ? Diagonal : -1;
    }
    A.ownStart.push_back(at);
  }
  A.adopt();
  return A;
}

DampedJacobi smoother()
{
  return { std::vector<float>(Rows, 1 / Diagonal), 2 };
}
}

TEST(DampedJacobi, StartsAsAStepFromZero)
{
  Monitor monitor;
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<float> number(-1, 1);
  const FloatMultiVector zero(Rows, Eigen::Vector4f::Zero());
  FloatMultiVector rhs, started(Rows), stepped(Rows);
  for (int i = 0; i < Rows; ++i)
  {
    rhs.emplace_back(number(random), number(random), number(random), number(random));
  }
  smoother().start(rhs.data(), started.data(), monitor);
  const Eigen::Vector4d products =
    smoother().step(line(), rhs.data(), zero.data(), stepped.data(), monitor);
  EXPECT_EQ(started, stepped);
  Eigen::Vector4d expected = Eigen::Vector4d::Zero();
  for (int i = 0; i < Rows; ++i)
  {
    expected += rhs[i].cast<double>().cwiseProduct(stepped[i].cast<double>());
  }
  EXPECT_LE((products - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.maxCoeff());
}

// The range in which it is a smoother: from a quarter of the largest eigenvalue.
TEST(DampedJacobi, DampsTheUpperEigenvalues)
{
  Monitor monitor;
  const FloatMultiVector rhs(Rows, Eigen::Vector4f::Zero());
  for (int k = 1; k <= Rows; ++k)
  {
    const double eigenvalue = 1 - std::cos(k * M_PI / (Rows + 1));
    FloatMultiVector error(Rows), next(Rows);
    for (int i = 0; i < Rows; ++i)
    {
      error[i].setConstant(static_cast<float>(std::sin((i + 1) * k * M_PI / (Rows + 1))));
    }
    const float before = error[0][0];
    smoother().step(line(), rhs.data(), error.data(), next.data(), monitor);
    const double factor = next[0][0] / before;
    EXPECT_NEAR(factor, 1 - eigenvalue / 1.25, 1e-5);
    EXPECT_LE(std::abs(factor), eigenvalue >= 0.5 ? 0.60001 : 1) << "eigenvalue " << eigenvalue;
  }
}
