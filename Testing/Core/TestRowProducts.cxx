// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/RowProducts.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace morph;

namespace
{
/// Rows of 0 to 40 entries.
struct RandomRows
{
  static constexpr int Rows = 200, Columns = 50;
  std::mt19937 random{ meshes::seed() };
  CsrMatrix A{ Rows, Columns };
  std::vector<float> rounded;
  FloatMultiVector x;
  MultiVector wide; ///< of the same numbers

  RandomRows()
  {
    std::uniform_real_distribution<float> number(-1, 1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < Rows; ++i)
    {
      for (int k = i % 41; k > 0; --k)
      {
        entries.emplace_back(i, static_cast<int>(this->random() % Columns), number(this->random));
      }
    }
    this->A.setFromTriplets(entries.begin(), entries.end());
    this->rounded.assign(this->A.valuePtr(), this->A.valuePtr() + this->A.nonZeros());
    for (int j = 0; j < Columns; ++j)
    {
      this->x.emplace_back(
        number(this->random), number(this->random), number(this->random), number(this->random));
      this->wide.push_back(this->x.back().cast<double>());
    }
  }
  CsrRows<float> single() const { return { this->A, this->rounded.data() }; }
  MultiVectorRow expected(Index i) const { return rowProduct(this->A, i, this->wide); }
};
}

TEST(RowProducts, AreThoseOfEachPrecision)
{
  const RandomRows rows;
  int visited = 7;
  forRowProducts(rows.single(), rows.x.data(), 7, RandomRows::Rows,
    [&](Index i, const Eigen::Vector4f& product)
    {
      EXPECT_EQ(i, visited++);
      EXPECT_LE((product.cast<double>() - rows.expected(i)).cwiseAbs().maxCoeff(), 1e-5) << i;
    });
  EXPECT_EQ(visited, RandomRows::Rows);
  const auto expectExact = [&](Index i, const MultiVectorRow& product)
  { EXPECT_LE((product - rows.expected(i)).cwiseAbs().maxCoeff(), 1e-14) << i; };
  const CsrRows<double> A = rows.A;
  forRowProducts(A, rows.wide.data(), 0, RandomRows::Rows, expectExact);
  forRowProducts(A, rows.x.data(), 0, RandomRows::Rows, expectExact);
}

TEST(RowProducts, MayBeOfNothing)
{
  const CsrMatrix none(3, 0), empty(0, 0);
  MultiVectorRow products[3] = { MultiVectorRow::Ones(), MultiVectorRow::Ones(),
    MultiVectorRow::Ones() };
  const MultiVector x;
  rowProducts(CsrRows<double>(empty), x.data(), 0, 0, products);
  EXPECT_EQ(products[0], MultiVectorRow(MultiVectorRow::Ones()));
  rowProducts(CsrRows<double>(none), x.data(), 0, 3, products);
  for (const MultiVectorRow& product : products)
  {
    EXPECT_EQ(product, MultiVectorRow(MultiVectorRow::Zero()));
  }
}
