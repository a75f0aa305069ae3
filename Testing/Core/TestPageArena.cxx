// SPDX-License-Identifier: BSD-3-Clause
#include "Support/HugePages.h"
#include "Support/PageArena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace morph;

TEST(PageArena, KeepsCopiesOfAnySize)
{
  PageArena arena;
  std::vector<std::vector<int>> given;
  std::vector<const int*> kept;
  for (const std::size_t size : { 0, 1, 3, 1000, 20000, 3, 3000000, 5, 100000 })
  {
    given.emplace_back(size);
    std::iota(given.back().begin(), given.back().end(), static_cast<int>(kept.size()));
    kept.push_back(arena.copy(given.back()));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(kept.back()) % 16, 0);
  }
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    EXPECT_TRUE(std::equal(given[i].begin(), given[i].end(), kept[i])) << "copy " << i;
  }
}

TEST(HugePages, AdviceKeepsContentAndTakesAnyRange)
{
  std::vector<int> values(5000000);
  std::iota(values.begin(), values.end(), 0);
  for (const std::size_t size : { std::size_t(0), std::size_t(100), values.size() - 1 })
  {
    adviseHugePages(values.data() + 1, size * sizeof(int));
  }
  adviseHugePages(nullptr, 0);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    ASSERT_EQ(values[i], static_cast<int>(i));
  }
}

TEST(HugePages, LargeVectorsHaveTheirSizeAndValue)
{
  EXPECT_EQ(largeVector<int>(1000000, 7), std::vector<int>(1000000, 7));
  EXPECT_EQ(largeVector<int>(1000000), std::vector<int>(1000000, 0));
  EXPECT_TRUE(largeVector<int>(0).empty());
  std::vector<int> grows(10, 3);
  resizeLarge(grows, 2000000);
  EXPECT_EQ(grows.size(), 2000000);
  const int* before = grows.data();
  resizeLarge(grows, 1000);
  EXPECT_EQ(grows.size(), 1000);
  EXPECT_EQ(grows.data(), before);
}
