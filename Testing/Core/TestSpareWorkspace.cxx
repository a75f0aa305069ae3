// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/RightHandSide.h"
#include "Solvers/SpareWorkspace.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

using namespace morph;

TEST(SpareWorkspace, KeepsOneSetOfVectorsUnlessTheyAreLarge)
{
  SpareWorkspace<int> spare;
  int made = 0;
  const auto take = [&] { return spare.take([&] { return std::make_unique<int>(made++); }); };
  std::unique_ptr<int> first = take(), second = take();
  EXPECT_EQ(*first, 0);
  EXPECT_EQ(*second, 1);
  spare.giveBack(std::move(second), SpareWorkspace<int>::MostBytes);
  EXPECT_EQ(*take(), 1); // and it is lost
  spare.giveBack(std::move(first), SpareWorkspace<int>::MostBytes + 1);
  EXPECT_EQ(*take(), 2);
}

TEST(RightHandSide, IsThatOfTheCoupling)
{
  constexpr int Rows = 20, Columns = 7;
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(Rows, Columns), u(Columns, 4);
  for (int i = 0; i < Rows; i += 3) // the others have no entry
  {
    for (int j = 0; j < Columns; j += 2)
    {
      dense(i, j) = number(random);
    }
  }
  const CsrMatrix C = dense.sparseView();
  MultiVector vectors;
  for (int j = 0; j < Columns; ++j)
  {
    vectors.emplace_back(number(random), number(random), number(random), number(random));
    u.row(j) = vectors.back();
  }
  const Eigen::MatrixXd expected = -dense * u;
  const RightHandSide computed(C, vectors);
  ASSERT_EQ(computed.rows(), Rows);
  MultiVector stored;
  for (int i = 0; i < Rows; ++i)
  {
    EXPECT_LE((computed[i].transpose() - expected.row(i)).cwiseAbs().maxCoeff(), 1e-14);
    stored.push_back(computed[i]);
  }
  const RightHandSide given(stored);
  ASSERT_EQ(given.rows(), Rows);
  for (int i = 0; i < Rows; ++i)
  {
    EXPECT_EQ(given[i], computed[i]);
  }
}
