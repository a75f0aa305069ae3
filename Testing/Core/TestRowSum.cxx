// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/MultiVector.h"

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
  MultiVectorRow expected(Index i) const
  {
    MultiVectorRow sum = MultiVectorRow::Zero();
    for (CsrMatrix::InnerIterator entry(this->A, i); entry; ++entry)
    {
      sum += entry.value() * this->wide[entry.col()];
    }
    return sum;
  }
};
}

TEST(RowSum, IsThatOfEachPrecision)
{
  const RandomRows rows;
  const CsrRows<double> A = rows.A;
  for (Index i = 0; i < RandomRows::Rows; ++i)
  {
    const Index first = A.start[i], last = A.start[i + 1];
    const MultiVectorRow expected = rows.expected(i);
    const auto errorOf = [&](const MultiVectorRow& sum)
    { return (sum - expected).cwiseAbs().maxCoeff(); };
    EXPECT_LE(errorOf(rowSum(rows.single(), first, last, rows.x.data()).cast<double>()), 1e-5) << i;
    EXPECT_LE(errorOf(rowSum(A, first, last, rows.wide.data())), 1e-14) << i;
    EXPECT_LE(errorOf(rowSum(A, first, last, rows.x.data())), 1e-14) << i;
  }
}

TEST(RowSum, MayBeOfAPartOfARow)
{
  const RandomRows rows;
  const CsrRows<double> A = rows.A;
  for (Index i = 0; i < RandomRows::Rows; ++i)
  {
    const Index first = A.start[i], last = A.start[i + 1], middle = (first + last) / 2;
    const MultiVectorRow parts =
      rowSum(A, first, middle, rows.wide.data()) + rowSum(A, middle, last, rows.wide.data());
    EXPECT_LE((parts - rows.expected(i)).cwiseAbs().maxCoeff(), 1e-14) << i;
    EXPECT_EQ(rowSum(A, last, last, rows.wide.data()), MultiVectorRow(MultiVectorRow::Zero()));
  }
}
