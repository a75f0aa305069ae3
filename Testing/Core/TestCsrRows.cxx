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
TEST(CsrRows, TripleProductsDoNotDependOnHowColumnsAreNumbered)
{
  constexpr int Rows = 9000, Inner = 40, Columns = 30, Many = 1 << 20;
  std::mt19937 random(meshes::seed());
  const CsrRows<float> R = randomRows<float>(Rows, Inner, random);
  const CsrRows<double> A = randomRows<double>(Inner, Inner, random);
  const CsrRows<float> P = randomRows<float>(Inner, Columns, random);
  meshes::ThreadedMonitor monitor(2);
  const CsrRows<double> few = tripleProduct(R, A, P, Columns, monitor);
  const CsrRows<double> many = tripleProduct(R, A, P, Many, monitor);
  ASSERT_EQ(few.ownStart, many.ownStart);
  EXPECT_TRUE((few.ownColumn == many.ownColumn).all());
  EXPECT_TRUE((few.ownValue == many.ownValue).all());
  const Eigen::MatrixXd expected = dense(R, Inner) * dense(A, Inner) * dense(P, Columns);
  EXPECT_LT((dense(few, Columns) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CsrRows, TripleProductsDoNotDependOnThreads)
{
  constexpr int Rows = 9000, Inner = 40, Columns = 30;
  std::mt19937 random(meshes::seed());
  const CsrRows<float> R = randomRows<float>(Rows, Inner, random);
  const CsrRows<double> A = randomRows<double>(Inner, Inner, random);
  const CsrRows<float> P = randomRows<float>(Inner, Columns, random);
  Monitor serial;
  meshes::ThreadedMonitor threads(3);
  const CsrRows<double> one = tripleProduct(R, A, P, Columns, serial);
  const CsrRows<double> three = tripleProduct(R, A, P, Columns, threads);
  ASSERT_EQ(one.ownStart, three.ownStart);
  EXPECT_TRUE((one.ownColumn == three.ownColumn).all());
  EXPECT_TRUE((one.ownValue == three.ownValue).all());
}
