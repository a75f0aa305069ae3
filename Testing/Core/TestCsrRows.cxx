// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/CsrRows.h"
#include "Solvers/MixedPrecisionMatrix.h"

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

/// R A P with two chunks of rows.
struct Factors
{
  static constexpr int Rows = 9000, Inner = 40, Columns = 30;
  std::mt19937 random{ meshes::seed() };
  CsrRows<float> R = randomRows<float>(Rows, Inner, random);
  CsrRows<double> A = randomRows<double>(Inner, Inner, random);
  CsrRows<float> P = randomRows<float>(Inner, Columns, random);

  CsrRows<double> product(int columns, Monitor&& monitor) const
  {
    return tripleProduct(this->R, this->A, this->P, columns, monitor);
  }
};

void expectSame(const CsrRows<double>& a, const CsrRows<double>& b)
{
  ASSERT_EQ(a.ownStart, b.ownStart);
  EXPECT_TRUE((a.ownColumn == b.ownColumn).all());
  EXPECT_TRUE((a.ownValue == b.ownValue).all());
}
}

// Columns near each other are numbered by a table, and far ones by a hash map.
TEST(CsrRows, TripleProductsDoNotDependOnHowColumnsAreNumbered)
{
  constexpr int Spread = 30000;
  const Factors of;
  const CsrRows<double> few = of.product(Factors::Columns, meshes::ThreadedMonitor(2));
  Factors apart;
  apart.P.ownColumn *= Spread;
  CsrRows<double> far = apart.product(Spread * Factors::Columns, meshes::ThreadedMonitor(2));
  far.ownColumn /= Spread;
  expectSame(few, far);
  const Eigen::MatrixXd expected =
    dense(of.R, Factors::Inner) * dense(of.A, Factors::Inner) * dense(of.P, Factors::Columns);
  EXPECT_LT((dense(few, Factors::Columns) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CsrRows, TripleProductsTakeASplitMatrixInItsUnits)
{
  const Factors of;
  CsrMatrix matrix(of.A.rows, Factors::Inner);
  matrix.resizeNonZeros(static_cast<Index>(of.A.entries()));
  std::copy_n(of.A.start, of.A.rows + 1, matrix.outerIndexPtr());
  std::copy_n(of.A.column, of.A.entries(), matrix.innerIndexPtr());
  std::copy_n(of.A.value, of.A.entries(), matrix.valuePtr());
  meshes::ThreadedMonitor monitor(2);
  const MixedPrecisionMatrix split(matrix, monitor);
  CsrRows<double> found = tripleProduct(of.R, split, of.P, Factors::Columns, monitor);
  found.ownValue *= split.unit();
  expectSame(found, of.product(Factors::Columns, meshes::ThreadedMonitor(2)));
}

TEST(CsrRows, TripleProductsDoNotDependOnThreads)
{
  const Factors of;
  expectSame(of.product(Factors::Columns, Monitor()),
    of.product(Factors::Columns, meshes::ThreadedMonitor(3)));
}
