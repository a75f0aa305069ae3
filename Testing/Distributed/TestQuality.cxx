// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/RankCommunicator.h"
#include "Meshes.h"
#include "Pieces.h"
#include "Quality/ScaledJacobian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace
{
using morph::distributed::Ranks;

/// The worst mean of values that are at random on the ranks, and of the whole.
void compare(const std::vector<double>& values, double share)
{
  const Ranks ranks = pieces::world();
  std::mt19937 random(meshes::seed());
  morph::Quality whole, mine;
  for (const double value : values)
  {
    whole.scaledJacobian.push_back(value);
    if (static_cast<int>(random() % ranks.count()) == ranks.rank())
    {
      mine.scaledJacobian.push_back(value);
    }
  }
  const auto mesh = pieces::distribute(ranks, meshes::hexes(1, 1, 1), 1, meshes::seed());
  const morph::distributed::RankCommunicator processes(mesh);
  const double expected = morph::worstMean(whole, share);
  EXPECT_NEAR(morph::worstMean(mine, share, processes), expected, 1e-14);
}
}

TEST(DistributedQuality, WorstMeanIsThatOfAllCells)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int count : { 1, 2, 3, 99, 100, 101, 5000 })
  {
    std::vector<double> values, ties;
    for (int i = 0; i < count; ++i)
    {
      const double value = uniform(random);
      values.push_back(value);
      ties.push_back(std::round(2 * value) / 2);                  // -1, -0.5, 0, 0.5, 1, and -0
      values.push_back(std::numeric_limits<double>::quiet_NaN()); // not measured
    }
    for (const double share : { 1e-6, 0.01, 0.5, 1. })
    {
      compare(values, share);
      compare(ties, share);
    }
  }
}
