// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/Falloff.h"
#include "Meshes.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace morph;

namespace
{
Points randomPoints(Index count, unsigned seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> value(0, 1);
  Points points(count, 3);
  for (Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = value(generator);
  }
  return points;
}

Points faded(const Points& moving, const Points& displacement, const Points& places, double radius,
  int threads = 1)
{
  meshes::ThreadedMonitor monitor(threads);
  Falloff falloff;
  falloff.prepare(moving, places, radius, monitor);
  return falloff.evaluate(displacement, monitor);
}

/// The formula, neighbor by neighbor.
Points byHand(const Points& moving, const Points& displacement, const Points& places, double radius)
{
  Points result = Points::Zero(places.rows(), 3);
  for (Index i = 0; i < places.rows(); ++i)
  {
    std::vector<std::pair<double, Index>> near;
    for (Index k = 0; k < moving.rows(); ++k)
    {
      near.emplace_back((moving.row(k) - places.row(i)).squaredNorm(), k);
    }
    std::sort(near.begin(), near.end());
    near.resize(std::min<std::size_t>(near.size(), 20));
    const double t = std::sqrt(near[0].first) / radius;
    double sum = 0;
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (const auto& [distance2, k] : near)
    {
      sum += 1 / distance2;
      mean += displacement.row(k) / distance2;
    }
    if (t < 1)
    {
      result.row(i) = std::pow(1 - t, 4) * (4 * t + 1) / sum * mean;
    }
  }
  return result;
}
}

TEST(Falloff, IsTheFormula)
{
  const Points moving = randomPoints(150, meshes::seed());
  const Points displacement = randomPoints(150, meshes::seed() + 1);
  const Points places = randomPoints(400, meshes::seed() + 2);
  for (const double radius : { 0.02, 0.1, 5. })
  {
    const Points result = faded(moving, displacement, places, radius);
    EXPECT_LE((result - byHand(moving, displacement, places, radius)).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(Falloff, IsOneAtWhatMovesAndZeroFromTheRadiusOn)
{
  Points moving(2, 3), displacement(2, 3), places(4, 3);
  moving << 0, 0, 0, 10, 0, 0;
  displacement << 1, 2, 3, -4, 5, 6;
  places << 0, 0, 0, 1e-9, 0, 0, 3, 4, 0, 0, 2.5, 0;
  const Points result = faded(moving, displacement, places, 5);
  EXPECT_EQ(result.row(0), displacement.row(0));
  EXPECT_LE((result.row(1) - displacement.row(0)).norm(), 1e-12);
  EXPECT_TRUE(result.row(2).isZero(0)); // at the radius itself
  // Half way, (1 - 1/2)^4 (4/2 + 1) = 3/16, and the other node is at a squared distance of 106.25.
  const Eigen::RowVector3d mean =
    (displacement.row(0) / 6.25 + displacement.row(1) / 106.25) / (1 / 6.25 + 1 / 106.25);
  EXPECT_LE((result.row(3) - 3. / 16 * mean).norm(), 1e-14);
}

TEST(Falloff, DoesNotDependOnTheOrderOrTheThreads)
{
  const Points moving = randomPoints(300, meshes::seed());
  const Points displacement = randomPoints(300, meshes::seed() + 1);
  const Points places = randomPoints(5000, meshes::seed() + 2);
  const Points result = faded(moving, displacement, places, 0.2);
  EXPECT_EQ(faded(moving, displacement, places, 0.2, 3), result);
  EXPECT_EQ(
    faded(moving.colwise().reverse(), displacement.colwise().reverse(), places, 0.2), result);
  EXPECT_EQ(faded(moving, displacement, places.colwise().reverse(), 0.2),
    Points(result.colwise().reverse()));
}

TEST(Falloff, NothingInReachAndNothingThatMoves)
{
  const Points moving = randomPoints(5, meshes::seed());
  Points far = moving;
  far.array() += 100;
  EXPECT_TRUE(faded(moving, moving, far, 1).isZero(0));
  EXPECT_TRUE(faded(moving, Points::Zero(5, 3), moving, 1).isZero(0));
  EXPECT_EQ(faded(moving, moving, Points(0, 3), 1).rows(), 0);
  Monitor monitor;
  Falloff falloff;
  EXPECT_THROW(falloff.prepare(Points(0, 3), far, 1, monitor), Error);
  for (const double radius : { 0., -1., std::nan(""), HUGE_VAL })
  {
    EXPECT_THROW(falloff.prepare(moving, far, radius, monitor), Error);
  }
}
