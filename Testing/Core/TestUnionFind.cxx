// SPDX-License-Identifier: BSD-3-Clause
#include "Support/UnionFind.h"

#include "InThreads.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

using namespace morph;

TEST(UnionFind, NumbersAreAloneAtFirst)
{
  UnionFind<int> sets(3);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(sets.root(i), i);
  }
}

TEST(UnionFind, JoinsUnderTheLowestNumber)
{
  UnionFind<Index> sets(6);
  EXPECT_EQ(sets.join(5, 3), 3);
  EXPECT_EQ(sets.join(3, 5), 3); // they are one set
  EXPECT_EQ(sets.join(4, 5), 3);
  EXPECT_EQ(sets.join(1, 4), 1);
  EXPECT_EQ(sets.join(2, 2), 2);
  const Index roots[6] = { 0, 1, 2, 1, 1, 1 };
  for (Index i = 0; i < 6; ++i)
  {
    EXPECT_EQ(sets.root(i), roots[i]);
  }
}

TEST(UnionFind, AgreesWithFloodingInAnyOrder)
{
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 200; ++trial)
  {
    const int n = 1 + static_cast<int>(random() % 60);
    std::vector<std::pair<int, int>> pairs(random() % (n + 1));
    for (auto& [a, b] : pairs)
    {
      a = static_cast<int>(random() % n);
      b = static_cast<int>(random() % n);
    }
    // The lowest number floods its set.
    std::vector<int> lowest(n);
    std::iota(lowest.begin(), lowest.end(), 0);
    for (bool changed = true; changed;)
    {
      changed = false;
      for (const auto& [a, b] : pairs)
      {
        const int low = std::min(lowest[a], lowest[b]);
        changed = changed || lowest[a] != low || lowest[b] != low;
        lowest[a] = lowest[b] = low;
      }
    }
    for (int order = 0; order < 3; ++order)
    {
      std::shuffle(pairs.begin(), pairs.end(), random);
      UnionFind<int> sets(n);
      for (const auto& [a, b] : pairs)
      {
        EXPECT_EQ(sets.join(a, b), std::min(sets.root(a), sets.root(b)));
      }
      for (int i = 0; i < n; ++i)
      {
        ASSERT_EQ(sets.root(i), lowest[i]) << "trial " << trial << ", number " << i;
      }
    }
  }
}

// The lowest numbers come last in some threads and first in others.
TEST(UnionFind, ThreadsMayJoinAtOnce)
{
  constexpr int Numbers = 20000, Sets = 7;
  for (const int threads : { 2, 5 })
  {
    UnionFind<int> sets(Numbers);
    meshes::inThreads(threads,
      [&](int t)
      {
        std::vector<int> mine;
        for (int i = Sets + t; i < Numbers; i += threads)
        {
          mine.push_back(i);
        }
        std::shuffle(mine.begin(), mine.end(), std::mt19937(meshes::seed() + t));
        for (const int i : mine)
        {
          sets.join(i, i - Sets);
        }
      });
    for (int i = 0; i < Numbers; ++i)
    {
      ASSERT_EQ(sets.root(i), i % Sets) << threads << " threads";
    }
  }
}
