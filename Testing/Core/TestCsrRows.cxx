// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/CsrRows.h"

#include <gtest/gtest.h>

#include <random>

using namespace morph;

namespace
{
/// A third of the entries are numbers in [-1, 1]; the others are none.
template <typename Scalar>
CsrRows<Scalar> randomRows(int rows, int columns, std::mt19937& random)
{
  std::uniform_real_distribution<Scalar> number(-1, 1);
  CsrRows<Scalar> result;
  result.rows = rows;
  result.ownStart.push_back(0);
  result.ownColumn.resize(rows * columns);
  result.ownValue.resize(rows * columns);
  int at = 0;
  for (int i = 0; i < rows; ++i)
  {
    for (int j = 0; j < columns; ++j)
    {
      if (random() % 3 == 0)
      {
        result.ownColumn[at] = j;
        result.ownValue[at++] = number(random);
      }
    }
    result.ownStart.push_back(at);
  }
  result.adopt();
  return result;
}

template <typename Scalar>
Eigen::MatrixXd dense(const CsrRows<Scalar>& A, int columns)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(A.rows, columns);
  for (int i = 0; i < A.rows; ++i)
  {
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      result(i, A.column[k]) += A.value[k];
    }
  }
  return result;
}
}

// Many columns are numbered by a hash map, few by a table.
TEST(CsrRows, ProductsDoNotDependOnHowColumnsAreNumbered)
{
  constexpr int Rows = 9000, Inner = 40, Columns = 30, Many = 1 << 20;
  std::mt19937 random(meshes::seed());
  const CsrRows<double> A = randomRows<double>(Rows, Inner, random);
  const CsrRows<float> B = randomRows<float>(Inner, Columns, random);
  meshes::ThreadedMonitor monitor(2);
  const CsrRows<float> C = randomRows<float>(Rows, Inner, random);
  const CsrRows<double> D = randomRows<double>(Inner, Columns, random);
  const auto expectProduct =
    [](const CsrRows<double>& few, const CsrRows<double>& many, const Eigen::MatrixXd& expected)
  {
    ASSERT_EQ(few.ownStart, many.ownStart);
    EXPECT_TRUE((few.ownColumn == many.ownColumn).all());
    EXPECT_TRUE((few.ownValue == many.ownValue).all());
    EXPECT_LT((dense(few, Columns) - expected).cwiseAbs().maxCoeff(), 1e-13);
  };
  expectProduct(product(A, B, Columns, monitor), product(A, B, Many, monitor),
    dense(A, Inner) * dense(B, Columns));
  expectProduct(product(C, D, Columns, monitor), product(C, D, Many, monitor),
    dense(C, Inner) * dense(D, Columns));
}
