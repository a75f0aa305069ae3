// SPDX-License-Identifier: BSD-3-Clause
#include "Support/PageBlock.h"

#include <gtest/gtest.h>

#include <cstring>
#include <utility>

using namespace morph;

TEST(PageBlock, KeepsWhatIsNotGivenBack)
{
  constexpr std::size_t Bytes = 10 << 20, Kept = (3 << 20) + 5;
  PageBlock block(Bytes);
  EXPECT_EQ(block.bytes(), Bytes);
  std::memset(block.data(), 7, Bytes);
  block.shrink(Kept);
  EXPECT_GE(block.bytes(), Kept);
#ifdef __linux__
  EXPECT_LT(block.bytes(), Kept + (1 << 20)); // up to a page is left
#endif
  for (std::size_t i = 0; i < Kept; ++i)
  {
    ASSERT_EQ(block.data()[i], 7);
  }
  const std::size_t left = block.bytes();
  block.shrink(2 * Bytes); // it does not grow
  EXPECT_EQ(block.bytes(), left);

  const char* place = block.data();
  PageBlock other = std::move(block);
  EXPECT_EQ(block.data(), nullptr);
  EXPECT_EQ(other.data(), place);
  block = std::move(other);
  EXPECT_EQ(block.data(), place);
  block.shrink(0);
  EXPECT_EQ(block.data(), nullptr);
  EXPECT_EQ(block.bytes(), 0u);
}

TEST(PageBlock, MayBeEmpty)
{
  PageBlock none, nothing(0);
  none.shrink(0);
  EXPECT_EQ(none.data(), nullptr);
  EXPECT_EQ(nothing.data(), nullptr);
  none = PageBlock(100);
  EXPECT_NE(none.data(), nullptr);
}
