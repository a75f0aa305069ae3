// SPDX-License-Identifier: BSD-3-Clause
// Valid ranges of polyhedra against bisection by the measure, on random motions.
#include "Mesh/Topology.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/ScaledJacobian.h"
#include "Quality/ValidRange.h"
#include "RandomMeshes.h"
#include "ValidRangeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

using namespace morph;

namespace
{
constexpr int Cases = 200;

Mesh polyhedra(const std::string& kind)
{
  return kind == "hexes"      ? meshes::asPolyhedra(meshes::hexes(2, 1, 1))
         : kind == "tets"     ? meshes::asPolyhedra(meshes::tets(1, 1, 1))
         : kind == "pyramids" ? meshes::asPolyhedra(meshes::hexesAndPyramids(2, 1, 1))
                              : meshes::honeycomb(1);
}

void makeCase(RangeCase& result, const std::string& kind, bool isRotation, int number)
{
  std::mt19937 random(meshes::seed() + 1000 * number);
  Mesh& mesh = result.mesh;
  mesh = polyhedra(kind);
  mesh.points += meshes::noise(mesh.points.rows(), .05, random);
  if (number % 3 == 0)
  {
    mesh.points.col(1) *= -1;
  }
  result.moveAtRandom(isRotation, random);
}

class PolyhedronRanges : public testing::TestWithParam<std::tuple<std::string, bool>>
{
};
}

TEST_P(PolyhedronRanges, AreThoseOfBisectionByTheMeasure)
{
  const auto& [kind, isRotation] = GetParam();
  int bothFinite = 0, made = 0;
  for (int number = 0; made < Cases && number < 4 * Cases; ++number)
  {
    SCOPED_TRACE("case " + std::to_string(number) + ", seed " + std::to_string(meshes::seed()));
    RangeCase problem;
    makeCase(problem, kind, isRotation, number);
    const ValidRange range = problem.range();
    ASSERT_EQ(range.isEmpty, !problem.isValid(0));
    if (range.isEmpty)
    {
      continue;
    }
    ++made;
    bothFinite += std::isfinite(range.lowest) && std::isfinite(range.highest);
    for (const auto& [found, sign] :
      { std::make_tuple(-range.lowest, -1.), std::make_tuple(range.highest, 1.) })
    {
      const auto isValid = [&](double s) { return problem.isValid(s); };
      const double expected = bisectedEnd(isValid, sign, .01, 4);
      EXPECT_LE(found, expected + 2e-9 * (1 + expected));
      // Bisection may pass over a short interval of inversion.
      if (found < std::min(expected, 3.98) - 1e-8)
      {
        EXPECT_FALSE(problem.isValid(sign * (found + 1e-7))) << found;
      }
    }
    EXPECT_EQ(range.lowestCell >= 0, std::isfinite(range.lowest));
    EXPECT_EQ(range.highestCell >= 0, std::isfinite(range.highest));
    problem.expectRangeInThreads(range, 3);
  }
  EXPECT_EQ(made, Cases);
  EXPECT_GE(bothFinite, Cases / 2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PolyhedronRanges,
  testing::Combine(testing::Values("hexes", "tets", "pyramids", "honeycomb"), testing::Bool()),
  [](const auto& info)
  { return std::get<0>(info.param) + (std::get<1>(info.param) ? "Turned" : "Shifted"); });

TEST(PolyhedronRange, OfAnAffineMotionIsThatOfTheMeasure)
{
  for (auto& [name, mesh] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    const auto orientation = cellSigns(mesh, connectedComponents(mesh));
    Points first = Points::Zero(mesh.points.rows(), 3);
    first.col(2) = -.25 * mesh.points.col(2);
    Monitor monitor;
    const NodeMotion motion = { &mesh.points, &first, {} };
    const ValidRange range = validRange(mesh, motion, orientation, {}, monitor);
    EXPECT_NEAR(range.highest, 4, 1e-9);
    EXPECT_EQ(range.lowest, -HUGE_VAL);
    for (const double s : { -10., 1., 3.99 })
    {
      EXPECT_TRUE(invertedCells(mesh, mesh.points + s * first, orientation, monitor).empty());
    }
  }
}
