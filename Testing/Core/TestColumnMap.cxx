// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Solvers/ColumnMap.h"
#include "Solvers/LocalColumnMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

using namespace morph;

TEST(LocalColumnMap, NumbersColumnsInTheOrderOfInsertion)
{
  std::mt19937 random(meshes::seed());
  LocalColumnMap local;
  for (int length : { 0, 1, 40, 5000, 3, 63, 64, 65, 700 })
  {
    std::uniform_int_distribution<int> column(0, 2 * length);
    std::map<int, int> expected;
    local.clear();
    for (int k = 0; k < length; ++k)
    {
      const int one = column(random) * 4096; // far apart, as in a large matrix
      const int index = expected.emplace(one, static_cast<int>(expected.size())).first->second;
      ASSERT_EQ(local.localIndex(one), index) << length;
      ASSERT_EQ(local.size(), static_cast<int>(expected.size()));
      ASSERT_EQ(local.column(index), one);
    }
  }
}

// Rows near each other, rows that jump, and rows with columns all over the matrix.
TEST(ColumnMap, NumbersColumnsInTheOrderOfInsertion)
{
  std::mt19937 random(meshes::seed());
  for (const int columns : { 1, 1000, 3000000 })
  {
    ColumnMap map(columns);
    int centre = 0;
    for (int row = 0; row < 3000; ++row)
    {
      const int reach = row % 5 == 0 ? columns : std::min(columns, 2000);
      centre = row % 7 == 0 ? static_cast<int>(random() % columns) : centre;
      const int first = std::clamp(centre - reach / 2, 0, columns - reach);
      std::map<int, int> expected;
      map.clear();
      EXPECT_EQ(map.size(), 0);
      for (int k = 0; k < row % 100; ++k)
      {
        const int one = first + static_cast<int>(random() % reach);
        const int index = expected.emplace(one, static_cast<int>(expected.size())).first->second;
        ASSERT_EQ(map.localIndex(one), index) << "row " << row << " of " << columns;
        ASSERT_EQ(map.size(), static_cast<int>(expected.size()));
        ASSERT_EQ(map.column(index), one);
      }
    }
  }
}
