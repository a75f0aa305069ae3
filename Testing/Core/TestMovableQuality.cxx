// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
using namespace morph;

std::vector<std::int8_t> orientationOf(const morph::Mesh& mesh)
{
  return morph::cellSigns(mesh, morph::connectedComponents(mesh));
}

/// Calls test(mesh, free, quality, monitor) with meshes whose free nodes the test may move.
template <typename Test>
void forEachJittered(const Test& test)
{
  for (const auto& [name, original] : motions::jittered())
  {
    SCOPED_TRACE(name);
    morph::Mesh mesh = original;
    meshes::ThreadedMonitor monitor;
    const auto orientation = orientationOf(mesh);
    const morph::NodePartition partition = motions::outerPartition(mesh);
    const MovableQuality quality(mesh, orientation, partition.free);
    test(mesh, partition.free, quality, monitor);
  }
}
}

TEST(MovableQuality, MovableAndFixedSamplesMakeTheScaledJacobian)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    meshes::ThreadedMonitor monitor;
    const auto orientation = orientationOf(mesh);
    const morph::NodePartition partition = motions::outerPartition(mesh);
    const MovableQuality quality(mesh, orientation, partition.free);
    const MovableQuality::Result movable = quality.measure(mesh.points, monitor);
    const morph::Quality whole = morph::measureCorners(mesh, mesh.points, orientation, {}, monitor);
    EXPECT_EQ(std::min(movable.minimum, quality.bounds(mesh.points).fixed), whole.minimum);
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      EXPECT_FALSE(movable.scaledJacobian[c] < whole.scaledJacobian[c]) << c;
    }
  }
}

TEST(MovableQuality, FreeNodesChangeNothingThatIsFixedAndNoMovableSampleExceedsItsBound)
{
  forEachJittered(
    [](morph::Mesh& mesh, const std::vector<Index>& free, const MovableQuality& quality,
      morph::Monitor& monitor)
    {
      const Points original = mesh.points;
      const MovableQuality::Bounds bounds = quality.bounds(mesh.points);
      EXPECT_GT(bounds.movable, 0);
      for (int round = 0; round < 20; ++round)
      {
        for (Index node : free)
        {
          mesh.points.row(node) = original.row(node) + 0.3 * Eigen::RowVector3d::Random();
        }
        EXPECT_EQ(quality.bounds(mesh.points).fixed, bounds.fixed);
        EXPECT_EQ(quality.bounds(mesh.points).movable, bounds.movable);
        EXPECT_LE(quality.measure(mesh.points, monitor).minimum, bounds.movable);
      }
    });
}

TEST(MovableQuality, MeasuringTheCellsOfAMovedNodeAgainIsMeasuringAll)
{
  forEachJittered(
    [](morph::Mesh& mesh, const std::vector<Index>& free, const MovableQuality& quality,
      morph::Monitor& monitor)
    {
      const morph::Adjacency around = morph::nodeToCells(mesh);
      MovableQuality::Result kept = quality.measure(mesh.points, monitor);
      for (const Index node : free)
      {
        // Far enough to invert cells.
        mesh.points.row(node) += 0.6 * Eigen::RowVector3d::Random();
        const std::vector<Index> cells(around.begin(node), around.end(node));
        quality.measureAgain(cells, mesh.points, kept, monitor);
      }
      const MovableQuality::Result all = quality.measure(mesh.points, monitor);
      EXPECT_EQ(kept.minimum, all.minimum);
      EXPECT_EQ(kept.inverted, all.inverted);
      EXPECT_GT(all.inverted, 0);
      for (Index c = 0; c < mesh.numberOfCells(); ++c)
      {
        const double value = all.scaledJacobian[c];
        EXPECT_TRUE(
          std::isnan(value) ? std::isnan(kept.scaledJacobian[c]) : kept.scaledJacobian[c] == value)
          << c;
      }
    });
}

TEST(MovableQuality, ASkewFaceIsTheBoundOfAHexahedron)
{
  morph::Mesh mesh = meshes::hexes(2, 2, 2);
  const auto orientation = orientationOf(mesh);
  const double angle = 0.4;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    mesh.points(n, 0) += mesh.points(n, 1) / std::tan(angle);
  }
  // The node in the middle is free, and no cell has a sample without a free node but at the brick's
  // corners and edges.
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const MovableQuality quality(mesh, orientation, partition.free);
  meshes::ThreadedMonitor monitor;
  EXPECT_NEAR(quality.bounds(mesh.points).movable, std::sin(angle), 1e-14);
  EXPECT_NEAR(quality.bounds(mesh.points).fixed, std::sin(angle), 1e-14);
  EXPECT_NEAR(quality.measure(mesh.points, monitor).minimum, std::sin(angle), 1e-14);
}

TEST(MovableQuality, MoreInvertedCellsAreWorseThanALowerMinimum)
{
  MovableQuality::Result valid, lower, tangled;
  valid.minimum = 0.2;
  lower.minimum = 0.1;
  tangled.minimum = 0.3;
  tangled.inverted = 1;
  EXPECT_TRUE(lower < valid);
  EXPECT_FALSE(valid < lower);
  EXPECT_FALSE(valid < valid);
  EXPECT_TRUE(tangled < lower);
}

TEST(MovableQuality, WithoutAFreeNodeNothingIsMovable)
{
  const morph::Mesh mesh = meshes::hexes(1, 1, 1);
  const auto orientation = orientationOf(mesh);
  const std::vector<Index> none;
  const MovableQuality quality(mesh, orientation, none);
  meshes::ThreadedMonitor monitor;
  EXPECT_EQ(quality.bounds(mesh.points).fixed, 1);
  EXPECT_EQ(quality.bounds(mesh.points).movable, std::numeric_limits<double>::infinity());
  EXPECT_EQ(quality.measure(mesh.points, monitor).inverted, 0);
  EXPECT_TRUE(std::isnan(quality.measure(mesh.points, monitor).scaledJacobian[0]));
}

TEST(WorstMean, IsTheMeanOfTheWorstShareOfTheMeasuredCells)
{
  morph::Quality quality;
  for (int i = 0; i < 1000; ++i)
  {
    quality.scaledJacobian.push_back((i * 7 % 1000) * 1e-3 - 0.1);
  }
  quality.scaledJacobian.insert(
    quality.scaledJacobian.begin() + 5, std::numeric_limits<double>::quiet_NaN());
  quality.measured = 1000;
  // Of 0, 1, ... 999 thousandths, less a tenth.
  EXPECT_NEAR(morph::worstMean(quality), -0.1 + 4.5e-3, 1e-15);
  EXPECT_NEAR(morph::worstMean(quality, 0.0105), -0.1 + 5e-3, 1e-15);
  EXPECT_NEAR(morph::worstMean(quality, 1), -0.1 + 0.4995, 1e-13);
  const double expected = morph::worstMean(quality, 0.3);
  std::reverse(quality.scaledJacobian.begin(), quality.scaledJacobian.end());
  EXPECT_EQ(morph::worstMean(quality, 0.3), expected);
}

TEST(WorstMean, FewCellsGiveTheMinimumAndNoneNaN)
{
  morph::Quality quality;
  EXPECT_TRUE(std::isnan(morph::worstMean(quality)));
  quality.scaledJacobian = { 0.5, std::numeric_limits<double>::quiet_NaN(), -0.25 };
  quality.measured = 2;
  EXPECT_EQ(morph::worstMean(quality), -0.25);
}
