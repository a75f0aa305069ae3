// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/ChunkedMatrix.h"
#include "Solvers/MixedPrecisionMatrix.h"
#include "Solvers/RowProducts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace morph;

namespace
{
/// A matrix of one row for each value, which stands in column 0.
CsrMatrix columnOf(const std::vector<double>& values)
{
  CsrMatrix matrix(static_cast<Index>(values.size()), 2);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    matrix.insert(static_cast<Index>(i), 0) = values[i];
  }
  matrix.makeCompressed();
  return matrix;
}
}

TEST(MixedPrecisionMatrix, KeepsEveryBit)
{
  std::mt19937_64 random(meshes::seed());
  std::uniform_real_distribution<double> mantissa(1, 2);
  for (const double size : { 1e-290, 1e-20, 1., 3e7, 1e300 })
  {
    // The last doubles below a power of two round up to it; halves of a float's digit are ties.
    std::vector<double> values = { 0., 1., std::nextafter(1., 0.), std::nextafter(1., 2.),
      std::nextafter(2., 0.), 1 + std::ldexp(1., -24), 1 + 3 * std::ldexp(1., -24) };
    for (int i = 0; i < 2000; ++i)
    {
      const double sign = i % 2 == 0 ? 1 : -1;
      values.push_back(sign * std::ldexp(mantissa(random), -static_cast<int>(random() % 60)));
    }
    for (double& value : values)
    {
      value *= size;
    }
    Monitor monitor;
    const MixedPrecisionMatrix matrix(columnOf(values), monitor);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const int k = static_cast<int>(i);
      EXPECT_EQ(matrix.value(k), values[i]) << size;
      EXPECT_EQ(matrix.rounded().value[k], static_cast<float>(values[i] / matrix.unit())) << size;
    }
  }
}

TEST(MixedPrecisionMatrix, TinyEntriesStayTinyAndOthersExact)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> values = { 1., 1e-50, -1e-70, std::ldexp(1., -400), -0., Infinity,
    std::nan("") };
  Monitor monitor;
  const MixedPrecisionMatrix matrix(columnOf(values), monitor);
  EXPECT_EQ(matrix.value(0), 1);
  EXPECT_EQ(matrix.value(1), 1e-50);
  const double least = std::ldexp(1., -126 - MixedPrecisionMatrix::LargestExponent);
  EXPECT_EQ(matrix.value(2), -least);
  EXPECT_EQ(matrix.value(3), least);
  EXPECT_EQ(matrix.value(4), 0);
  EXPECT_EQ(matrix.value(5), Infinity); // it does not count as the largest
  EXPECT_TRUE(std::isnan(matrix.value(6)));
}

TEST(MixedPrecisionMatrix, TakesAMatrixThatIsNotCompressed)
{
  CsrMatrix loose(3, 3);
  loose.reserve(Eigen::VectorXi::Constant(3, 2));
  loose.insert(0, 0) = 2;
  loose.insert(2, 1) = -3;
  ASSERT_FALSE(loose.isCompressed());
  Monitor monitor;
  const MixedPrecisionMatrix matrix(loose, monitor);
  EXPECT_EQ(matrix.entries(), 2u);
  EXPECT_EQ((matrix.toCsr() - loose).norm(), 0);
}

TEST(MixedPrecisionMatrix, FromChunksIsThatOfTheJoinedRows)
{
  // Two chunks and a part of one, with rows of 0 to 6 entries.
  constexpr Index Rows = 2 * ChunkRows + 100;
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  const auto make = [&](std::mt19937 source)
  {
    ChunkedMatrix chunked{ Rows, Rows + 6, {} };
    for (Index first = 0; first < Rows; first += ChunkRows)
    {
      RowsInWork<double> rows;
      for (Index i = first; i < std::min(Rows, first + ChunkRows); ++i)
      {
        rows.size.push_back(static_cast<int>(i % 7));
        for (int k = 0; k < i % 7; ++k)
        {
          rows.column.push_back(static_cast<int>(i + k));
          rows.value.push_back(number(source));
        }
      }
      chunked.chunks.emplace_back(rows, std::make_shared<PageArena>());
    }
    return chunked;
  };
  meshes::ThreadedMonitor monitor(3);
  CsrMatrix joined;
  joinRows(make(random), joined, monitor);
  const MixedPrecisionMatrix matrix(make(random), monitor);
  EXPECT_EQ(joined.rows(), Rows);
  EXPECT_EQ(matrix.rows(), Rows);
  EXPECT_EQ(matrix.columns(), Rows + 6);
  ASSERT_EQ(static_cast<Index>(matrix.entries()), joined.nonZeros());
  EXPECT_GE(matrix.memory(), 12 * matrix.entries());
  const CsrMatrix back = matrix.toCsr();
  EXPECT_EQ((back - joined).norm(), 0);
  const Eigen::VectorXd diagonal = matrix.diagonal(monitor);
  for (Index i = 0; i < Rows; ++i)
  {
    ASSERT_EQ(matrix.rounded().start[i], joined.outerIndexPtr()[i]);
    EXPECT_EQ(diagonal[i], joined.coeff(i, i)) << i;
    EXPECT_EQ(diagonal[i] == 0, i % 7 == 0) << i;
  }
}

TEST(MixedPrecisionMatrix, ColumnsAreNarrowWhereTheyFit)
{
  constexpr int Most = static_cast<int>(NarrowColumns::MostStep), Rows = 3 * Most;
  Monitor monitor;
  const auto narrowed = [&](int row, std::vector<int> columns)
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (const int column : columns)
    {
      entries.emplace_back(row, column, 1 + column);
    }
    CsrMatrix matrix(Rows, Rows);
    matrix.setFromTriplets(entries.begin(), entries.end());
    MixedPrecisionMatrix mixed(matrix, monitor);
    const bool fits = mixed.narrowColumns(monitor);
    EXPECT_EQ(fits, mixed.narrowColumns(monitor));
    EXPECT_EQ((mixed.toCsr() - matrix).norm(), 0);
    EXPECT_EQ(mixed.diagonal(monitor), Eigen::VectorXd(matrix.diagonal()));
    return fits;
  };
  EXPECT_TRUE(narrowed(Most, { 0, Most, 2 * Most }));
  EXPECT_TRUE(narrowed(0, { 0, Most, 2 * Most, 3 * Most - 1 }));
  EXPECT_FALSE(narrowed(Most + 1, { 0, Most + 1 })); // too far below the diagonal
  EXPECT_FALSE(narrowed(Most, { Most + 1 }));        // nothing up to the diagonal
  EXPECT_FALSE(narrowed(0, { 0, Most + 1 }));        // too far from the one before
}

TEST(MixedPrecisionMatrix, MayBeEmpty)
{
  Monitor monitor;
  for (const CsrMatrix& none : { CsrMatrix(0, 0), CsrMatrix(3, 3) })
  {
    const MixedPrecisionMatrix matrix(none, monitor);
    EXPECT_EQ(matrix.rows(), none.rows());
    EXPECT_EQ(matrix.entries(), 0u);
    EXPECT_EQ(matrix.unit(), 1);
    EXPECT_EQ(matrix.toCsr().nonZeros(), 0);
    EXPECT_EQ(matrix.diagonal(monitor).norm(), 0);
    MultiVector x(3, MultiVectorRow::Ones()), products(3, MultiVectorRow::Ones());
    rowProducts(matrix, x.data(), 0, none.rows(), products.data());
    for (Index i = 0; i < none.rows(); ++i)
    {
      EXPECT_EQ(products[i], MultiVectorRow(MultiVectorRow::Zero()));
    }
  }
  EXPECT_EQ(MixedPrecisionMatrix().entries(), 0u);
}
