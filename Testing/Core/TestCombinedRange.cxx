// SPDX-License-Identifier: BSD-3-Clause
// The valid range of straight motions and turns together, against a search with the measure of
// quality on random motions.
#include "Mesh/Topology.h"
#include "Meshes.h"
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
  Points straight, others[2]; ///< of the second turn

  double searched(double far) const
  {
    return bisectedEnd([this](double f) { return this->isValid(f); }, 1, far / 2000, far);
  }
};

void makeCase(Case& result, const std::string& kind, int number)
{
  std::mt19937 random(meshes::seed() + 1000 * number);
  std::uniform_real_distribution<double> one(-1, 1);
  Mesh& mesh = result.mesh;
  mesh = meshes::randomMesh(kind, number, random);
  result.orientation = cellSigns(mesh, connectedComponents(mesh));
  for (Points* part :
    { &result.straight, &result.first, &result.second, &result.others[0], &result.others[1] })
  {
    *part = meshes::noise(mesh.points.rows(), .3, random);
  }
  const auto angle = [&] { return std::copysign(1 + one(random) / 2, one(random)); };
  result.motion = { &mesh.points, &result.straight,
    { { &result.first, &result.second, angle() } } };
  if (number % 2 == 1)
  {
    result.motion.turns.push_back({ &result.others[0], &result.others[1], angle() });
  }
}

/// About the z axis, and by (1, 1, 1).
void turnAndShift(Case& problem)
{
  const Points& x = problem.mesh.points;
  problem.straight = Points::Ones(x.rows(), 3);
  problem.first = problem.second = Points::Zero(x.rows(), 3);
  problem.first.col(0) = -x.col(1);
  problem.first.col(1) = x.col(0);
  problem.second.leftCols(2) = -x.leftCols(2);
  problem.motion = { &x, &problem.straight, { { &problem.first, &problem.second, .5 } } };
}

class CombinedRanges : public testing::TestWithParam<std::string>
{
};
}

TEST_P(CombinedRanges, AreThoseOfASearch)
{
  const bool isQuadratic = GetParam().find("quadratic") == 0;
  int finite = 0, tight = 0, made = 0;
  for (int number = 0; made < Cases && number < 4 * Cases; ++number)
  {
    SCOPED_TRACE("case " + std::to_string(number) + ", seed " + std::to_string(meshes::seed()));
    Case problem;
    makeCase(problem, GetParam(), number);
    if (!problem.isValid(0))
    {
      continue;
    }
    ++made;
    const ValidRange found = problem.range();
    EXPECT_EQ(found.highestCell >= 0, std::isfinite(found.highest));
    if (isQuadratic)
    {
      // A bound on the safe side; a search by proofs would be slow.
      for (int part = 1; part <= 10; ++part)
      {
        EXPECT_TRUE(problem.isValid(std::min(found.highest * (1 - 1e-9), 4.) * part / 10));
      }
      finite += std::isfinite(found.highest);
      tight += found.highest > 0 && !problem.isValid(2 * found.highest);
    }
    else
    {
      const double expected = problem.searched(4);
      EXPECT_LE(found.highest, expected + 1e-9);
      if (found.highest < expected - 1e-6)
      {
        // A step of the search may pass over a short interval of inversion.
        EXPECT_FALSE(problem.isValid(found.highest + 1e-6)) << found.highest << " " << expected;
      }
      finite += std::isfinite(expected);
      tight += std::isfinite(expected) && found.highest > .5 * expected;
    }
    for (int threads : isQuadratic ? std::vector<int>{ 3 } : std::vector<int>{ 2, 3 })
    {
      problem.expectRangeInThreads(found, threads);
    }
  }
  EXPECT_EQ(made, Cases);
  EXPECT_GE(finite, Cases / 2);
  EXPECT_GE(tight, finite / 2) << "of " << finite << " within a factor of 2";
}

INSTANTIATE_TEST_SUITE_P(Kinds, CombinedRanges,
  testing::Values("hexes", "tets", "wedges", "pyramids", "quadratic hexes", "quadratic tets"),
  [](const auto& info)
  {
    std::string name = info.param;
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    return name;
  });

TEST(CombinedRange, OfARigidTurnWithAShiftHasNoEnd)
{
  Case problem;
  problem.mesh = meshes::hexes(3, 2, 2);
  turnAndShift(problem);
  ValidRange found = problem.range();
  EXPECT_EQ(found.highest, HUGE_VAL);
  EXPECT_EQ(found.highestCell, -1);

  problem.mesh.points.row(0) << 5, 5, 5; // inverted at 0
  found = problem.range();
  EXPECT_TRUE(std::isnan(found.highest));
  EXPECT_EQ(found.highestCell, 0);
}

TEST(CombinedRange, OfFlatCellsIsFoundInFewSteps)
{
  Case problem;
  problem.mesh = meshes::tets(2, 2, 2);
  problem.mesh.points.col(0) *= 1e-9; // as flat as that
  turnAndShift(problem);
  EXPECT_EQ(problem.range().highest, HUGE_VAL);

  problem.straight.col(1) = problem.mesh.points.col(2); // they shear too, and stay valid
  const double factor = problem.range().highest;
  EXPECT_GE(factor, 0); // on the safe side
  EXPECT_LT(factor, 1);
}

TEST(CombinedRange, AsksWhetherToStop)
{
  Case problem;
  problem.mesh = meshes::hexes(20, 10, 10);
  turnAndShift(problem);
  meshes::WatchingMonitor monitor;
  validRange(problem.mesh, problem.motion, {}, {}, monitor);
  EXPECT_GE(monitor.questions, 3);
  monitor.cancelAfter = monitor.questions + 2;
  EXPECT_THROW(validRange(problem.mesh, problem.motion, {}, {}, monitor), Error);
}
