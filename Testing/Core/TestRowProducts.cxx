// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/RowProducts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

using namespace morph;

namespace
{
/// Rows of 0 to 40 entries in random order.
struct RandomRows
{
  explicit RandomRows(std::mt19937& random)
  {
    std::uniform_real_distribution<float> number(-1, 1);
    this->A.rows = 200;
    this->A.ownStart.push_back(0);
    std::vector<int> columns;
    for (int i = 0; i < this->A.rows; ++i)
    {
      for (int k = i % 41; k > 0; --k)
      {
        columns.push_back(static_cast<int>(random() % Columns));
      }
      this->A.ownStart.push_back(static_cast<int>(columns.size()));
    }
    this->A.ownColumn = Eigen::Map<Eigen::ArrayXi>(columns.data(), columns.size());
    this->A.ownValue =
      CsrRows<float>::Values::NullaryExpr(columns.size(), [&](Index) { return number(random); });
    this->A.adopt();
    this->wide.resize(this->A.rows, Columns);
    this->wide.resizeNonZeros(static_cast<Index>(columns.size()));
    std::copy_n(this->A.start, this->A.rows + 1, this->wide.outerIndexPtr());
    std::copy_n(this->A.column, columns.size(), this->wide.innerIndexPtr());
    std::uniform_real_distribution<double> wideNumber(-1e5, 1e5);
    std::generate_n(this->wide.valuePtr(), columns.size(), [&] { return wideNumber(random); });
    Monitor monitor;
    this->doubles = MixedPrecisionMatrix(this->wide, monitor);
    for (int j = 0; j < Columns; ++j)
    {
      this->x.emplace_back(number(random), number(random), number(random), number(random));
      this->xDouble.push_back(this->x.back().cast<double>());
    }
  }

  /// The product of row i in the order of additions that RowProducts.cxx documents.
  template <typename Row, typename Values>
  Row expected(int i, const Values* value) const
  {
    using Scalar = typename Row::Scalar;
    const auto term = [&](int k)
    { return Row(Scalar(value[k]) * this->x[this->A.column[k]].template cast<Scalar>()); };
    Row sum[4] = { Row::Zero(), Row::Zero(), Row::Zero(), Row::Zero() };
    int k = this->A.start[i];
    for (; k + 4 <= this->A.start[i + 1]; k += 4)
    {
      for (int j = 0; j < 4; ++j)
      {
        sum[j] += term(k + j);
      }
    }
    Row all = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    for (; k < this->A.start[i + 1]; ++k)
    {
      all += term(k);
    }
    return all;
  }

  MultiVectorRow expectedWide(int i) const
  {
    return this->expected<MultiVectorRow>(i, this->wide.valuePtr());
  }

  static constexpr int Columns = 50;
  CsrRows<float> A;
  CsrMatrix wide; ///< the same structure
  MixedPrecisionMatrix doubles;
  FloatMultiVector x;
  MultiVector xDouble;
};
}

// The sums are written out here for any processor: AVX2 must not change a bit.
TEST(RowProducts, HaveTheSameBitsOnEveryProcessor)
{
  std::mt19937 random(meshes::seed());
  const RandomRows rows(random);
  int visited = 7;
  forRowProducts(rows.A, rows.x.data(), 7, rows.A.rows,
    [&](Index i, const Eigen::Vector4f& product)
    {
      EXPECT_EQ(i, visited++);
      EXPECT_EQ(product, rows.expected<Eigen::Vector4f>(static_cast<int>(i), rows.A.value))
        << "row " << i;
    });
  EXPECT_EQ(visited, rows.A.rows);
  forRowProducts(rows.doubles, rows.xDouble.data(), 0, rows.A.rows,
    [&](Index i, const MultiVectorRow& product)
    { EXPECT_EQ(product, rows.expectedWide(static_cast<int>(i))) << "row " << i; });
  forRowProducts(rows.doubles, rows.x.data(), 0, rows.A.rows,
    [&](Index i, const MultiVectorRow& product)
    { EXPECT_EQ(product, rows.expectedWide(static_cast<int>(i))) << "row " << i; });
}

// Narrow columns are read in another way, and must not change a bit either.
TEST(RowProducts, OfNarrowColumnsHaveTheSameBits)
{
  constexpr Index Rows = 70000, Width = 17;
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < Rows; ++i)
  {
    for (Index k = 0; k < i % Width; ++k) // from far below the diagonal to far above it
    {
      const Index column = std::max<Index>(0, i - NarrowColumns::MostStep) + 8000 * k;
      entries.emplace_back(i, std::min(column, Rows - 1), number(random));
    }
  }
  CsrMatrix A(Rows, Rows);
  A.setFromTriplets(entries.begin(), entries.end());
  meshes::ThreadedMonitor monitor(3);
  const MixedPrecisionMatrix wide(A, monitor);
  MixedPrecisionMatrix before(A, monitor);
  ASSERT_TRUE(before.narrowColumns(monitor));
  const MixedPrecisionMatrix narrow = std::move(before);
  EXPECT_LT(narrow.memory(), wide.memory());
  EXPECT_EQ((narrow.toCsr() - A).norm(), 0);
  FloatMultiVector x(Rows), single[2] = { FloatMultiVector(Rows), FloatMultiVector(Rows) };
  MultiVector xDouble(Rows), both[2] = { MultiVector(Rows), MultiVector(Rows) };
  for (Index j = 0; j < Rows; ++j)
  {
    xDouble[j] = MultiVectorRow::NullaryExpr([&](Index) { return number(random); });
    x[j] = xDouble[j].cast<float>();
  }
  const auto expectSame = [&](const auto& a, const auto& b)
  { EXPECT_EQ(std::memcmp(a.data(), b.data(), Rows * sizeof(a[0])), 0); };
  rowProducts(wide.rounded(), x.data(), 0, Rows, single[0].data());
  rowProducts(narrow.rounded(), x.data(), 0, Rows, single[1].data());
  expectSame(single[0], single[1]);
  rowProducts(wide, x.data(), 0, Rows, both[0].data());
  rowProducts(narrow, x.data(), 0, Rows, both[1].data());
  expectSame(both[0], both[1]);
  rowProducts(wide, xDouble.data(), 0, Rows, both[0].data());
  rowProducts(narrow, xDouble.data(), 0, Rows, both[1].data());
  expectSame(both[0], both[1]);
}

TEST(RowProducts, AgreeWithEigen)
{
  std::mt19937 random(meshes::seed());
  const RandomRows rows(random);
  Eigen::MatrixXd x(RandomRows::Columns, 4);
  for (int j = 0; j < RandomRows::Columns; ++j)
  {
    x.row(j) = rows.xDouble[j];
  }
  const Eigen::MatrixXd product = rows.wide * x;
  MultiVector result(rows.A.rows);
  rowProducts(rows.doubles, rows.xDouble.data(), 0, rows.A.rows, result.data());
  FloatMultiVector inFloat(rows.A.rows);
  rowProducts(rows.doubles.rounded(), rows.x.data(), 0, rows.A.rows, inFloat.data());
  const double unit = rows.doubles.unit();
  for (int i = 0; i < rows.A.rows; ++i)
  {
    EXPECT_LE((result[i].transpose() - product.row(i)).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LE(
      (unit * inFloat[i].cast<double>().transpose() - product.row(i)).cwiseAbs().maxCoeff(), 10.);
  }
}
