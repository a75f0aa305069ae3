// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/WorstCornerNorm.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/MinQualityAscent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
using morph::Index;
using morph::Mesh;
using morph::Points;
using morph::WorstCornerNorm;

std::vector<Index> volumeCells(const Mesh& mesh)
{
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (morph::cellShape(mesh.types[c])->dimension == 3)
    {
      cells.push_back(c);
    }
  }
  return cells;
}

std::vector<std::int8_t> orientationOf(const Mesh& mesh)
{
  return morph::cellSigns(mesh, morph::connectedComponents(mesh));
}

int raise(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, morph::Monitor& monitor, double goal = 1)
{
  const morph::MovableQuality quality(mesh, orientation, free);
  return morph::raiseMinimumQuality(quality, goal, points, monitor).rounds;
}

void expectGradientOfDifferences(
  const WorstCornerNorm& norm, const Points& points, const std::vector<Index>& free)
{
  meshes::ThreadedMonitor monitor;
  Points gradient;
  norm.gradient(points, gradient, monitor);
  const double h = 1e-6;
  for (Index i = 0; i < gradient.rows(); ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      Points plus = points, minus = plus;
      plus(free[i], j) += h;
      minus(free[i], j) -= h;
      const double difference =
        (norm.value(plus, monitor).energy - norm.value(minus, monitor).energy) / (2 * h);
      EXPECT_NEAR(gradient(i, j), difference, 1e-5 * (1 + gradient.norm()));
    }
  }
}
}

TEST(WorstCornerNorm, GradientIsThatOfFiniteDifferences)
{
  meshes::ThreadedMonitor monitor;
  for (auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    const WorstCornerNorm angles(mesh, orientationOf(mesh), volumeCells(mesh), free, 0.7, 3);
    ASSERT_TRUE(angles.value(mesh.points, monitor).allowed);
    expectGradientOfDifferences(angles, mesh.points, free);
  }
}

TEST(WorstCornerNorm, OneWhereAllCornersAreTheLeastAndInfiniteWhereOneIsInverted)
{
  meshes::ThreadedMonitor monitor;
  Mesh mesh = meshes::hexes(3, 3, 3);
  const std::vector<Index> free = motions::outerPartition(mesh).free;
  const WorstCornerNorm angles(mesh, orientationOf(mesh), volumeCells(mesh), free, 1, 3);
  EXPECT_NEAR(angles.value(mesh.points, monitor).energy, 1, 1e-14);
  mesh.points.row(free[0]) += Eigen::RowVector3d(1.5, 0, 0);
  const morph::Objective::Value value = angles.value(mesh.points, monitor);
  EXPECT_TRUE(std::isinf(value.energy));
  EXPECT_FALSE(value.allowed);
}

TEST(WorstCornerNorm, ValueAndGradientAtOnceAreThoseOfEach)
{
  meshes::ThreadedMonitor one(1), three(3);
  for (auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    const WorstCornerNorm angles(mesh, orientationOf(mesh), volumeCells(mesh), free, 0.7, 5);
    Points gradient, both;
    angles.gradient(mesh.points, gradient, one);
    const double energy = angles.valueAndGradient(mesh.points, both, three).energy;
    EXPECT_NEAR(energy, angles.value(mesh.points, one).energy, 1e-13 * energy);
    EXPECT_EQ(energy, angles.valueAndGradient(mesh.points, both, one).energy);
    EXPECT_EQ(gradient, both);
  }
}

TEST(WorstCornerNorm, GradientAtShortEdgesIsThatOfFiniteDifferences)
{
  meshes::ThreadedMonitor monitor;
  for (auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    WorstCornerNorm norm(mesh, orientationOf(mesh), volumeCells(mesh), free, 0.7, 3);
    const double before = norm.value(mesh.points, monitor).energy;
    norm.keepEdges(mesh, 8 * mesh.points); // edges are short beside these
    const bool isOfTetrahedra = name.find("tet") == 0;
    EXPECT_EQ(norm.value(mesh.points, monitor).energy > before, !isOfTetrahedra);
    expectGradientOfDifferences(norm, mesh.points, free);
  }
}

TEST(WorstCornerNorm, EdgesOfHexahedraDoNotCollapse)
{
  meshes::ThreadedMonitor monitor;
  Mesh mesh = meshes::hexes(3, 3, 3);
  const std::vector<Index> free = motions::outerPartition(mesh).free;
  // Layers of hexahedra have right angles whatever their thickness.
  const auto value = [&](const WorstCornerNorm& norm, double height)
  {
    Points points = mesh.points;
    for (Index node = 0; node < mesh.numberOfNodes(); ++node)
    {
      points(node, 2) = points(node, 2) == 1 ? height : points(node, 2);
    }
    return norm.value(points, monitor).energy;
  };
  WorstCornerNorm norm(mesh, orientationOf(mesh), volumeCells(mesh), free, 1, 3);
  EXPECT_NEAR(value(norm, 0.01), 1, 1e-12);
  norm.keepEdges(mesh, mesh.points);
  EXPECT_NEAR(value(norm, 1), 1, 1e-7);
  EXPECT_LT(value(norm, 0.3), 1.001);
  EXPECT_GT(value(norm, 0.05), 10);
}

TEST(WorstCornerNorm, IsEnoughWhereTheMinimumIsAtTheGoal)
{
  meshes::ThreadedMonitor monitor;
  for (auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    const std::vector<std::int8_t> orientation = orientationOf(mesh);
    const double minimum =
      morph::MovableQuality(mesh, orientation, free).measure(mesh.points, monitor).minimum;
    for (const double goal : { 0.99 * minimum, 1.01 * minimum })
    {
      const WorstCornerNorm angles(
        mesh, orientation, volumeCells(mesh), free, 0.5 * minimum, 4, goal);
      EXPECT_EQ(angles.value(mesh.points, monitor).enough, goal < minimum);
    }
    const WorstCornerNorm never(mesh, orientation, volumeCells(mesh), free, minimum, 4);
    EXPECT_FALSE(never.value(mesh.points, monitor).enough);
  }
}

TEST(RaiseWorstCells, RaisesTheLeastAndKeepsTheRest)
{
  for (const Mesh& rest :
    { meshes::hexes(4, 4, 4), meshes::tets(4, 4, 4), meshes::hexesAndPyramids(4, 4, 4) })
  {
    Mesh mesh = rest;
    const morph::NodePartition partition = motions::outerPartition(mesh);
    const Index moved = partition.free[partition.free.size() / 2];
    mesh.points.row(moved) += Eigen::RowVector3d(0.3, 0.2, 0.25);
    meshes::ThreadedMonitor one(1), three(3);
    const std::vector<std::int8_t> orientation = orientationOf(rest);
    const auto least = [&](const Points& points)
    { return morph::measureQuality(mesh, points, orientation, {}, one).minimum; };
    const double before = least(mesh.points);
    ASSERT_GT(before, 0);
    Points points = mesh.points, again = points;
    EXPECT_GT(raise(mesh, orientation, partition.free, points, one), 0);
    EXPECT_GT(least(points), 1.2 * before);
    EXPECT_GT(least(points), 0.8 * least(rest.points));
    for (Index node : partition.prescribed)
    {
      EXPECT_EQ(points.row(node), mesh.points.row(node));
    }
    raise(mesh, orientation, partition.free, again, three);
    EXPECT_EQ(points, again);
  }
}

TEST(RaiseWorstCells, OneCellThatTheBoundaryDeterminesDoesNotStopTheRest)
{
  const Mesh rest = meshes::tets(4, 4, 4);
  const std::vector<std::int8_t> orientation = orientationOf(rest);
  const morph::NodePartition partition = motions::outerPartition(rest);
  Mesh mesh = rest;
  // The corner of the brick, near the face opposite of its only cell: all four nodes are
  // prescribed.
  mesh.points.row(0) += 0.3 * Eigen::RowVector3d(1, 1, 1);
  meshes::ThreadedMonitor monitor;
  const morph::Quality flat = morph::measureQuality(mesh, mesh.points, orientation, {}, monitor);
  for (Index node : partition.free)
  {
    mesh.points.row(node) += 0.3 * Eigen::RowVector3d(0.9, 0.7, -0.8) * (node % 3 - 1);
  }
  const morph::Quality before = morph::measureQuality(mesh, mesh.points, orientation, {}, monitor);
  ASSERT_GT(before.minimum, 0);
  ASSERT_LT(before.minimum, 0.9 * flat.minimum);
  Points points = mesh.points;
  EXPECT_GT(raise(mesh, orientation, partition.free, points, monitor), 0);
  const morph::Quality after = morph::measureQuality(mesh, points, orientation, {}, monitor);
  EXPECT_EQ(after.minimum, flat.minimum);
  EXPECT_EQ(after.worstCell, flat.worstCell);
  const morph::MovableQuality quality(mesh, orientation, partition.free);
  EXPECT_EQ(quality.bounds(points).fixed, flat.minimum);
  EXPECT_GT(quality.measure(points, monitor).minimum, 1.03 * flat.minimum);
  EXPECT_LE(quality.measure(points, monitor).minimum, quality.bounds(points).movable);
  // Unless that is the goal.
  points = mesh.points;
  EXPECT_GT(raise(mesh, orientation, partition.free, points, monitor, flat.minimum), 0);
  EXPECT_GE(quality.measure(points, monitor).minimum, flat.minimum * (1 - 5e-3));
  const Points done = points;
  EXPECT_EQ(raise(mesh, orientation, partition.free, points, monitor, flat.minimum), 0);
  EXPECT_EQ(points, done);
}

TEST(RaiseWorstCells, LeavesTangledAndPerfectMeshesBitForBit)
{
  Mesh mesh = meshes::hexes(4, 4, 4);
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const std::vector<std::int8_t> orientation = orientationOf(mesh);
  meshes::ThreadedMonitor monitor;
  Points points = mesh.points;
  EXPECT_EQ(raise(mesh, orientation, partition.free, points, monitor), 0);
  EXPECT_EQ(points, mesh.points);
  points.row(partition.free[0]) += Eigen::RowVector3d(1.5, 0, 0);
  const Points tangled = points;
  EXPECT_EQ(raise(mesh, orientation, partition.free, points, monitor), 0);
  EXPECT_EQ(points, tangled);
}
