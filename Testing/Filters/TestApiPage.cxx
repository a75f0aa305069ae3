// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <sstream>

// The program of the page.
#define main apiPageProgram
#include "ApiPageExample.inc" // made from Documentation/API.md
#undef main

TEST(ApiPage, CxxExamplePrintsWhatThePageSays)
{
  std::filesystem::copy_file(MESHMORPHING_MODELS "/bore_hex_small.vtu", "part.vtu",
    std::filesystem::copy_options::overwrite_existing);
  std::ostringstream printed;
  std::streambuf* screen = std::cout.rdbuf(printed.rdbuf());
  EXPECT_EQ(apiPageProgram(), 0);
  std::cout.rdbuf(screen);
  std::filesystem::remove("part.vtu");
  EXPECT_EQ(printed.str(), API_PAGE_PRINTS "\n");
}
