// SPDX-License-Identifier: BSD-3-Clause
// Valid ranges against bisection with the measure of quality, on random motions.
#include "Meshes.h"
#include "Motions.h"
#include "Quality/Bernstein.h"
#include "Quality/ValidRange.h"
#include "Support/Error.h"
#include "ValidRangeCases.h"
#include "WatchingMonitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;

namespace
{
constexpr int Cases = 200;

struct Case : RangeCase
{
  double bisected(double sign) const
  {
    return sign * bisectedEnd([this](double s) { return this->isValid(s); }, sign, 0.005, 5);
  }
};

class ValidRanges : public testing::TestWithParam<std::tuple<std::string, bool>>
{
};
}

TEST_P(ValidRanges, AreThoseOfBisection)
{
  const auto& [kind, isRotation] = GetParam();
  const bool isQuadratic = kind.find("quadratic") == 0;
  int bothFinite = 0, tight = 0, made = 0;
  for (int number = 0; made < Cases && number < 4 * Cases; ++number)
  {
    SCOPED_TRACE("case " + std::to_string(number) + ", seed " + std::to_string(meshes::seed()));
    Case problem;
    std::mt19937 random(meshes::seed() + 1000 * number);
    problem.mesh = meshes::randomMesh(kind, number, random); // some are mirrored
    problem.moveAtRandom(isRotation, random);
    if (!problem.isValid(0))
    {
      continue;
    }
    ++made;
    const ValidRange range = problem.range();
    ASSERT_FALSE(range.isEmpty);
    const double low = problem.bisected(-1), high = problem.bisected(1);
    bothFinite += std::isfinite(range.lowest) && std::isfinite(range.highest);
    for (const auto& [found, expected] :
      { std::make_pair(-range.lowest, -low), std::make_pair(range.highest, high) })
    {
      if (std::isinf(expected))
      {
        EXPECT_TRUE(isQuadratic || found > 4.99);
        continue;
      }
      EXPECT_LE(found, expected + 2e-9 * (1 + expected));
      // A step of the search may pass over a short interval of inversion.
      if (!isQuadratic && found < expected - 1e-8)
      {
        EXPECT_FALSE(problem.isValid((expected == high ? 1 : -1) * (found + 1e-7))) << found;
      }
      tight += found > .5 * expected;
    }
    EXPECT_EQ(range.lowestCell >= 0, std::isfinite(range.lowest));
    EXPECT_EQ(range.highestCell >= 0, std::isfinite(range.highest));
    for (int threads : { 2, 3 })
    {
      problem.expectRangeInThreads(range, threads);
    }
  }
  EXPECT_EQ(made, Cases);
  EXPECT_GE(bothFinite, Cases / 2);
  RecordProperty("tight", tight);
  EXPECT_GE(tight, Cases) << "of the ends within a factor of 2, two a case";
}

INSTANTIATE_TEST_SUITE_P(Kinds, ValidRanges,
  testing::Combine(
    testing::Values("hexes", "tets", "wedges", "pyramids", "quadratic hexes", "quadratic tets"),
    testing::Bool()),
  [](const auto& info)
  {
    std::string name = std::get<0>(info.param) + (std::get<1>(info.param) ? "Turned" : "Shifted");
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    return name;
  });

TEST(ValidRange, OfQuadraticCellsIsAsAccurateForASlowMotion)
{
  constexpr double Slow = 1e-5;
  std::mt19937 random(meshes::seed());
  const Mesh mesh = meshes::quadraticTets(1, 1, 1);
  Monitor monitor;
  for (int trial = 0; trial < 20; ++trial)
  {
    const Points fast = meshes::noise(mesh.points.rows(), 1, random), slow = Slow * fast;
    const ValidRange own = validRange(mesh, { &mesh.points, &fast, {} }, {}, {}, monitor);
    const ValidRange range = validRange(mesh, { &mesh.points, &slow, {} }, {}, {}, monitor);
    EXPECT_NEAR(range.highest * Slow, own.highest, 1e-9 * own.highest);
    EXPECT_NEAR(range.lowest * Slow, own.lowest, -1e-9 * own.lowest);
  }
}

TEST(ValidRange, OfACubeThatIsFlattened)
{
  Case problem;
  problem.mesh = meshes::hexes(3, 3, 3);
  problem.first = Points::Zero(problem.mesh.points.rows(), 3);
  problem.first.col(2) = -.25 * problem.mesh.points.col(2);
  problem.motion = { &problem.mesh.points, &problem.first, {} };
  ValidRange range = problem.range();
  EXPECT_NEAR(range.highest, 4, 1e-11);
  EXPECT_LE(range.highest, 4);
  EXPECT_EQ(range.highestCell, 0);
  EXPECT_EQ(range.lowest, -HUGE_VAL);
  EXPECT_EQ(range.lowestCell, -1);

  // Rigid turns are valid at any angle.
  Points second = problem.mesh.points;
  problem.first.col(0) = -problem.mesh.points.col(1);
  problem.first.col(1) = problem.mesh.points.col(0);
  problem.first.col(2).setZero();
  second *= -1;
  second.col(2).setZero();
  problem.motion = { &problem.mesh.points, nullptr, { { &problem.first, &second, 1 } } };
  range = problem.range();
  EXPECT_EQ(range.highest, HUGE_VAL);
  EXPECT_EQ(range.lowest, -HUGE_VAL);

  // Inverted at 0.
  problem.mesh.points.row(0) << 5, 5, 5;
  range = problem.range();
  EXPECT_TRUE(range.isEmpty);
  EXPECT_TRUE(std::isnan(range.lowest) && std::isnan(range.highest));
  EXPECT_EQ(range.lowestCell, 0);
}

TEST(ValidRange, EndsBeforeAllEdgesVanishTogether)
{
  std::mt19937 random(meshes::seed());
  for (int trial = 0; trial < 50; ++trial)
  {
    Case problem;
    problem.mesh = meshes::hexes(1, 1, 1);
    problem.mesh.points += .2 * meshes::noise(8, 1, random);
    problem.first = (-problem.mesh.points).rowwise() + problem.mesh.points.row(0);
    problem.motion = { &problem.mesh.points, &problem.first, {} };
    const ValidRange range = problem.range();
    EXPECT_LE(range.highest, 1) << "seed " << meshes::seed() << ", trial " << trial;
    EXPECT_GT(range.highest, 1 - 1e-9); // a triple root
    EXPECT_TRUE(problem.isValid((1 - 1e-9) * range.highest));
  }
}

TEST(ValidRange, OfAMotionByATinyFactorIsThatOfTheMotion)
{
  std::mt19937 random(meshes::seed());
  const Mesh mesh = meshes::tets(2, 2, 2);
  const Points fast = meshes::noise(mesh.points.rows(), 1, random), slow = 1e-300 * fast;
  Monitor monitor;
  const ValidRange own = validRange(mesh, { &mesh.points, &fast, {} }, {}, {}, monitor);
  const ValidRange range = validRange(mesh, { &mesh.points, &slow, {} }, {}, {}, monitor);
  ASSERT_LT(own.highest, HUGE_VAL);
  EXPECT_NEAR(range.highest / 1e300, own.highest, 1e-9 * own.highest);

  const NodeMotion turn = { &mesh.points, nullptr, { { &fast, &fast, 1 } } };
  const NodeMotion slowTurn = { &mesh.points, nullptr, { { &fast, &fast, 1e-300 } } };
  EXPECT_NEAR(validRange(mesh, slowTurn, {}, {}, monitor).highest / 1e300,
    validRange(mesh, turn, {}, {}, monitor).highest, 1e-9);
}

TEST(PolynomialRoot, FindsTheFirst)
{
  const double cubic[] = { 6, -11, 6, -1 }; // (1 - t)(2 - t)(3 - t)
  EXPECT_NEAR(firstPositiveRoot(cubic, 3), 1, 1e-11);
  EXPECT_LE(firstPositiveRoot(cubic, 3), 1);
  const double touching[] = { 4, -4, 1 }; // (2 - t)^2
  EXPECT_NEAR(firstPositiveRoot(touching, 2), 2, 1e-5);
  const double none[] = { 1, -1, 1 };
  EXPECT_EQ(firstPositiveRoot(none, 2), HUGE_VAL);
  const double small[] = { 1e-9, -1, 0, 0 };
  EXPECT_NEAR(firstPositiveRoot(small, 3), 1e-9, 1e-20);
  for (double unit : { 1e-100, 1e-12, 1e3, 1e12, 1e100 })
  {
    const double scaled[] = { 6, -11 / unit, 6 / unit / unit, -1 / unit / unit / unit };
    EXPECT_NEAR(firstPositiveRoot(scaled, 3) / unit, 1, 1e-11);
    const double rising[] = { 1, 1 / unit, 0, -2 / unit / unit / unit }; // up, then down
    EXPECT_NEAR(firstPositiveRoot(rising, 3) / unit, 1, 1e-11);
  }
  const double negative[] = { -1, 5 };
  EXPECT_EQ(firstPositiveRoot(negative, 1), 0);
  EXPECT_TRUE(isPositiveUntil(cubic, 3, .5));
  EXPECT_FALSE(isPositiveUntil(cubic, 3, 1));
  EXPECT_FALSE(isPositiveUntil(cubic, 3, HUGE_VAL));
  EXPECT_TRUE(isPositiveUntil(small, 3, 1e-10));
}

TEST(PolynomialRoot, OfNumbersBeyondAllBoundsIsNone)
{
  const double first[] = { HUGE_VAL, -5, 3, 1 }, last[] = { 1, 2, 3, HUGE_VAL };
  const double not1[] = { 1, NAN, 3, 1 }, large[] = { 1e308, -1e308, 1e308, -1e-308 };
  EXPECT_EQ(firstPositiveRoot(first, 3), 0);
  EXPECT_EQ(firstPositiveRoot(last, 3), 0);
  EXPECT_EQ(firstPositiveRoot(not1, 3), 0);
  EXPECT_GE(firstPositiveRoot(large, 3), 0); // it ends
}

TEST(ValidRange, AsksWhetherToStop)
{
  Case problem;
  problem.mesh = meshes::hexes(30, 30, 10);
  problem.first = Points::Random(problem.mesh.points.rows(), 3);
  problem.motion = { &problem.mesh.points, &problem.first, {} };
  meshes::WatchingMonitor monitor;
  validRange(problem.mesh, problem.motion, {}, {}, monitor);
  EXPECT_GE(monitor.questions, 2);
  monitor.cancelAfter = monitor.questions + 1;
  EXPECT_THROW(validRange(problem.mesh, problem.motion, {}, {}, monitor), Error);
}
