// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Support/Lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace
{
using morph::Index;

/// Random rows of some numbers, also with repetitions.
std::vector<std::pair<Index, Index>> randomPairs(Index rows, Index count, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::pair<Index, Index>> pairs(count);
  for (auto& [row, number] : pairs)
  {
    row = static_cast<Index>(random() % rows);
    number = static_cast<Index>(random() % 1000);
  }
  return pairs;
}

morph::Adjacency sorted(
  const std::vector<std::pair<Index, Index>>& pairs, Index rows, morph::Monitor& monitor)
{
  return morph::sortIntoBuckets(static_cast<Index>(pairs.size()), rows, monitor,
    [&](Index first, Index last, const auto& add)
    {
      for (Index i = first; i < last; ++i)
      {
        add(pairs[i].first, pairs[i].second);
      }
    });
}
}

TEST(Buckets, HaveEachRowsNumbersInOrderForAnyNumberOfThreads)
{
  constexpr Index Rows = 700; // the last 100 have no number
  auto pairs = randomPairs(Rows - 100, 50000, 7);
  morph::Monitor serial;
  const morph::Adjacency none = sorted({}, Rows, serial);
  EXPECT_EQ(none.offsets, std::vector<Index>(Rows + 1, 0));
  EXPECT_TRUE(none.values.empty());

  const morph::Adjacency one = sorted(pairs, Rows, serial);
  meshes::ThreadedMonitor three(3);
  const morph::Adjacency many = sorted(pairs, Rows, three);
  EXPECT_EQ(one.offsets, many.offsets);
  EXPECT_EQ(one.values, many.values);

  std::sort(pairs.begin(), pairs.end());
  std::vector<Index> expected;
  for (const auto& [row, number] : pairs)
  {
    expected.push_back(number);
  }
  EXPECT_EQ(one.values, expected);
  for (Index row = 0; row < Rows; ++row)
  {
    const auto count = std::count_if(
      pairs.begin(), pairs.end(), [row](const auto& pair) { return pair.first == row; });
    EXPECT_EQ(one.offsets[row + 1] - one.offsets[row], count) << row;
  }
}

TEST(RemoveRepeated, KeepsOneOfEachInARow)
{
  morph::Adjacency lists;
  lists.offsets = { 0, 3, 3, 6, 7, 8 };
  lists.values = { 1, 1, 2, 2, 2, 2, 2, 5 };
  morph::removeRepeated(lists);
  EXPECT_EQ(lists.offsets, (std::vector<morph::Index>{ 0, 2, 2, 3, 4, 5 }));
  EXPECT_EQ(lists.values, (std::vector<morph::Index>{ 1, 2, 2, 2, 5 }));
  morph::Adjacency none;
  morph::removeRepeated(none);
  EXPECT_TRUE(none.values.empty());
}
