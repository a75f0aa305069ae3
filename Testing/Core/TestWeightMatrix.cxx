// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"

#include "Interpolation/WeightMatrix.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace morph;

namespace
{
/// Rows of 0 to 9 entries in random columns.
WeightMatrix randomMatrix(Index rows, Index columns, std::mt19937& random)
{
  std::uniform_int_distribution<Index> count(0, 9), column(0, columns - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Index> offsets(rows + 1, 0);
  for (Index i = 0; i < rows; ++i)
  {
    offsets[i + 1] = offsets[i] + count(random);
  }
  WeightMatrix matrix;
  matrix.open(columns, offsets);
  for (Index i = 0; i < rows; ++i)
  {
    for (Index e = 0; e < matrix.entries(i); ++e)
    {
      matrix.column(i)[e] = static_cast<std::int32_t>(column(random));
      matrix.weight(i)[e] = value(random);
    }
  }
  return matrix;
}

Eigen::MatrixXd dense(const WeightMatrix& matrix)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(matrix.rows(), matrix.columns());
  for (Index i = 0; i < matrix.rows(); ++i)
  {
    for (Index e = 0; e < matrix.entries(i); ++e)
    {
      result(i, matrix.column(i)[e]) += matrix.weight(i)[e];
    }
  }
  return result;
}
}

TEST(WeightMatrix, ProductsAreThoseOfTheDenseMatrix)
{
  std::mt19937 random(meshes::seed());
  Monitor monitor;
  for (const auto& [rows, columns] :
    { std::pair<Index, Index>{ 40, 70 }, { 700, 3 }, { 1, 1 }, { 0, 4 } })
  {
    const WeightMatrix matrix = randomMatrix(rows, columns, random);
    ASSERT_EQ(matrix.rows(), rows);
    const Eigen::MatrixXd reference = dense(matrix);
    const Points x = meshes::randomPoints(columns, random), y = meshes::randomPoints(rows, random);
    Points product = Points::Constant(2, 3, 7), transposed = product; // overwritten
    matrix.multiply(x, product, monitor);
    matrix.multiplyTranspose(y, transposed, monitor);
    ASSERT_EQ(product.rows(), rows);
    ASSERT_EQ(transposed.rows(), columns);
    EXPECT_LT((product - reference * x).norm(), 1e-12);
    EXPECT_LT((transposed - reference.transpose() * y).norm(), 1e-11);
  }
}

TEST(WeightMatrix, ThreadsDoNotShow)
{
  std::mt19937 random(meshes::seed());
  const WeightMatrix matrix = randomMatrix(20000, 300, random);
  const Points x = meshes::randomPoints(300, random), y = meshes::randomPoints(20000, random);
  Monitor one;
  Points product, transposed;
  matrix.multiply(x, product, one);
  matrix.multiplyTranspose(y, transposed, one);
  for (int threads : { 2, 3, 5 })
  {
    meshes::ThreadedMonitor many(threads);
    Points again;
    matrix.multiply(x, again, many);
    EXPECT_EQ(std::memcmp(again.data(), product.data(), sizeof(double) * again.size()), 0)
      << threads;
    matrix.multiplyTranspose(y, again, many);
    EXPECT_EQ(std::memcmp(again.data(), transposed.data(), sizeof(double) * again.size()), 0)
      << threads;
  }
}

TEST(WeightMatrix, RefusesWhatDoesNotFit)
{
  WeightMatrix matrix;
  EXPECT_THROW(matrix.open(Index(1) << 31, { 0, 0 }), Error);
  EXPECT_THROW(matrix.open(3, { 0, Index(1) << 58 }), Error);
  EXPECT_EQ(matrix.rows(), 0);
}
