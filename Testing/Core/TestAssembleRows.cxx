// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/CsrMatrix.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

using namespace morph;

TEST(SparseRow, SumsByColumnInTheOrderOfTheCalls)
{
  SparseRow row;
  for (int round = 0; round < 2; ++round)
  {
    row.clear();
    for (int k = 0; k < 3000; ++k) // grows beyond its first table
    {
      row.add(7919 * (k % 1000), k);
    }
    ASSERT_EQ(row.entries().size(), 1000u);
    EXPECT_EQ(row.entries()[5], SparseRow::Entry(7919 * 5, 5 + 1005 + 2005));
    EXPECT_EQ(row.sorted().back().first, 7919 * 999);
  }
}

TEST(AssembleRows, MakesAscendingRowsOfBothPartsForAnyNumberOfThreads)
{
  constexpr Index Rows = 10000, Inside = 10000, Columns = 10500; // three blocks
  const auto makeRow = [](Index i, SparseRow& row)
  {
    std::mt19937 random(static_cast<unsigned>(i));
    for (unsigned k = random() % 30; k > 0; --k)
    {
      row.add(static_cast<int>(random() % Columns), 1e-3 * static_cast<double>(random() % 1000));
    }
  };
  const auto assembled = [&](Monitor&& monitor)
  { return assembleRows(Rows, Inside, Columns, monitor, [&]() -> MakeRow { return makeRow; }); };
  const SplitMatrix one = assembled(Monitor()), three = assembled(meshes::ThreadedMonitor(3));
  EXPECT_EQ((one.inside - three.inside).norm(), 0);
  EXPECT_EQ((one.outside - three.outside).norm(), 0);
  EXPECT_EQ(one.inside.cols(), Inside);
  EXPECT_EQ(one.outside.cols(), Columns - Inside);
  for (Index i = 0; i < Rows; ++i)
  {
    SparseRow row;
    makeRow(i, row);
    Index before = -1, count = 0;
    const auto check = [&](Index column, double value)
    {
      EXPECT_GT(column, before);
      before = column;
      row.add(static_cast<int>(column), -value);
      ++count;
    };
    for (CsrMatrix::InnerIterator entry(one.inside, i); entry; ++entry)
    {
      check(entry.col(), entry.value());
    }
    for (CsrMatrix::InnerIterator entry(one.outside, i); entry; ++entry)
    {
      check(Inside + entry.col(), entry.value());
    }
    ASSERT_EQ(count, static_cast<Index>(row.entries().size()));
    for (const auto& [column, left] : row.entries())
    {
      EXPECT_EQ(left, 0) << "row " << i << ", column " << column;
    }
  }
}
