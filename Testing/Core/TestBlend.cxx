// SPDX-License-Identifier: BSD-3-Clause
// Modes of linear methods and their weighted sums.
#include "LinearMethods.h"
#include "Meshes.h"
#include "Morpher/Blend.h"
#include "Motions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace morph;
using motions::difference;
using motions::identical;
using motions::outerPartition;

namespace
{
class Modes : public testing::TestWithParam<meshes::LinearMethod>
{
};

/// Random displacements of the prescribed nodes.
std::vector<Points> displacements(const NodePartition& partition, int count)
{
  std::mt19937 random(meshes::seed());
  std::vector<Points> result;
  for (int i = 0; i < count; ++i)
  {
    result.push_back(
      .1 * meshes::randomPoints(static_cast<Index>(partition.prescribed.size()), random));
  }
  return result;
}
}

TEST_P(Modes, WeightedSumsAreWhatEvaluateGives)
{
  const std::vector<double> weights = { .5, -1.25, 2 };
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    meshes::ThreadedMonitor monitor(2);
    const auto method = GetParam().make();
    method->prepare(mesh, partition, monitor);
    const std::vector<Points> given = displacements(partition, 3);
    std::vector<EvaluateReport> reports;
    const std::vector<Points> modes = method->basis(given, monitor, &reports);
    ASSERT_EQ(modes.size(), 3u);
    ASSERT_EQ(reports.size(), 3u);

    Points target = meshes::rows(mesh.points, partition.prescribed), moved, blended;
    std::vector<WeightedMode> weighted;
    for (int i = 0; i < 3; ++i)
    {
      target += weights[i] * given[i];
      weighted.push_back({ &modes[i], weights[i] });
      EXPECT_TRUE(identical(meshes::rows(modes[i], partition.prescribed), given[i])) << name;
      EXPECT_TRUE(identical(method->basis({ given[i] }, monitor)[0], modes[i])) << name;
    }
    method->evaluate(target, moved, monitor);
    blend(mesh.points, weighted, blended, monitor);
    EXPECT_LT(difference(moved, blended), 1e-8) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(AllMethods, Modes, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& info) { return info.param.name; });

TEST(Blend, HasTheSameBitsInAnyNumberOfThreads)
{
  std::mt19937 random(meshes::seed());
  const Points rest = meshes::randomPoints(20011, random);
  std::vector<Points> modes;
  std::vector<WeightedMode> weighted;
  for (int i = 0; i < 7; ++i)
  {
    modes.push_back(meshes::randomPoints(rest.rows(), random));
  }
  for (int i = 0; i < 7; ++i)
  {
    weighted.push_back({ &modes[i], std::sin(i + 1.) });
  }
  Points expected(rest.rows(), 3);
  for (Index i = 0; i < rest.size(); ++i)
  {
    volatile double sum = 0; // each operation is rounded once
    for (const WeightedMode& term : weighted)
    {
      volatile const double product = term.weight * term.mode->data()[i];
      sum = sum + product;
    }
    expected.data()[i] = rest.data()[i] + sum;
  }
  for (int threads : { 1, 2, 3, 8 })
  {
    meshes::ThreadedMonitor monitor(threads);
    Points moved;
    blend(rest, weighted, moved, monitor);
    EXPECT_TRUE(identical(moved, expected)) << threads;
    Points inPlace = rest;
    blend(inPlace, weighted, inPlace, monitor);
    EXPECT_TRUE(identical(inPlace, expected)) << threads;
  }
}

TEST(Blend, WithoutMotionKeepsEveryBit)
{
  Points rest(3, 3);
  rest << -0., 0., 1, -1e-310, 5, -0., 1e50, -0., 3;
  const Points still = Points::Zero(3, 3), all = Points::Ones(3, 3);
  Monitor monitor;
  Points moved;
  blend(rest, { { &still, 3 }, { &all, 0 } }, moved, monitor);
  EXPECT_TRUE(identical(moved, rest));
  blend(rest, {}, moved, monitor);
  EXPECT_TRUE(identical(moved, rest));
}

TEST(Blend, RefusesWrongWeightsAndModes)
{
  const Points rest = Points::Zero(3, 3), mode = Points::Ones(3, 3), shorter = Points::Ones(2, 3);
  Monitor monitor;
  Points moved = 7 * Points::Ones(3, 3);
  const double wrong[] = { std::numeric_limits<double>::quiet_NaN(), HUGE_VAL };
  for (double weight : wrong)
  {
    motions::expectError(
      [&] {
        blend(rest, { { &mode, 1 }, { &mode, weight } }, moved, monitor);
      },
      "mode 1 is not finite");
  }
  motions::expectError([&] { blend(rest, { { &shorter, 1 } }, moved, monitor); }, "2 rows");
  EXPECT_EQ(moved(0, 0), 7);
}

TEST_P(Modes, RefuseWrongDisplacements)
{
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  const auto method = GetParam().make();
  motions::expectError([&] { method->basis({}, monitor); }, "not prepared");
  method->prepare(mesh, partition, monitor);
  EXPECT_TRUE(method->basis({}, monitor).empty());
  Points displacement = Points::Zero(static_cast<Index>(partition.prescribed.size()), 3);
  displacement(5, 1) = std::numeric_limits<double>::quiet_NaN();
  motions::expectError([&] { method->basis({ displacement }, monitor); },
    "node ids " + std::to_string(partition.prescribed[5]));
  motions::expectError([&] { method->basis({ Points::Zero(2, 3) }, monitor); }, "2 rows");
}
