// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/FemWarp.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"
#include "Untangling/QualityRaising.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using namespace morph;

/// A node of the top that comes near the diagonal of a face: a place with a low bound.
const motions::Row Spoilt(2, 4, 6);

Mesh spoiltMesh()
{
  const Mesh lattice = meshes::hexes(20, 8, 6);
  Mesh mesh = lattice;
  meshes::jitterInterior(mesh, 0.2, meshes::seed());
  for (Index node = 0; node < mesh.numberOfNodes(); ++node)
  {
    if ((lattice.points.row(node) - Spoilt).norm() < 2.5)
    {
      mesh.points.row(node) = lattice.points.row(node); // the place itself stays valid
    }
    if ((mesh.points.row(node) - Spoilt).norm() < 1e-9)
    {
      mesh.points.row(node) += motions::Row(0.49, 0.49, 0);
    }
  }
  return mesh;
}

/// The minimum over cells far from that node, which no ring around it reaches.
double minimumElsewhere(const Mesh& mesh, const MovableQuality::Result& quality)
{
  double least = 1;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if ((mesh.points.row(mesh.cell(c)[0]) - Spoilt).norm() > 9)
    {
      least = std::min(least, quality.scaledJacobian[c]);
    }
  }
  return least;
}

std::vector<std::int8_t> orientationOf(const Mesh& mesh)
{
  return morph::cellSigns(mesh, morph::connectedComponents(mesh));
}

/// Returns the number of steps.
Index raise(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, morph::Monitor& monitor, double goal = 1)
{
  const MovableQuality quality(mesh, orientation, free);
  return morph::raiseQuality(quality, goal, morph::InversionFree::DefaultSteps, points, monitor)
    .steps;
}
}

TEST(QualityRaising, OnePlaceAtItsBoundDoesNotStopTheOthers)
{
  const Mesh mesh = spoiltMesh();
  const auto orientation = orientationOf(mesh);
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const MovableQuality quality(mesh, orientation, partition.free);
  meshes::ThreadedMonitor one(1), three(3);
  const double bound = quality.bounds(mesh.points).movable;
  const double before = minimumElsewhere(mesh, quality.measure(mesh.points, one));
  ASSERT_GT(before, 3 * bound);
  Points points = mesh.points, again = points;
  raise(mesh, orientation, partition.free, points, one, bound);
  const MovableQuality::Result raised = quality.measure(points, one);
  EXPECT_GE(raised.minimum, bound * (1 - 5e-3));
  EXPECT_GT(minimumElsewhere(mesh, raised), 1.2 * before);
  EXPECT_EQ(
    meshes::rows(points, partition.prescribed), meshes::rows(mesh.points, partition.prescribed));
  raise(mesh, orientation, partition.free, again, three, bound);
  EXPECT_TRUE(motions::identical(points, again));
}

TEST(QualityRaising, RaisesTheLeastAndKeepsTheRest)
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

TEST(QualityRaising, OneCellThatTheBoundaryDeterminesDoesNotStopTheRest)
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
  EXPECT_EQ(done.rows(), points.rows());
}

TEST(QualityRaising, TheMeanFallsForAMuchHigherMinimumAlone)
{
  const Mesh mesh = meshes::tets(5, 5, 5);
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const std::vector<std::int8_t> orientation = orientationOf(mesh);
  const MovableQuality quality(mesh, orientation, partition.free);
  meshes::ThreadedMonitor monitor;
  morph::FemWarp femWarp;
  femWarp.prepare(mesh, partition, monitor);
  int guarded = 0;
  for (const double angle : { 0.5, 0.8, 1.2, 1.6 })
  {
    const auto twist = [&](const motions::Row& x) { return motions::twist(x, 6, 6, angle); };
    const Points start = motions::moved(femWarp, motions::targets(mesh, partition, twist), monitor);
    Points points = start;
    const MovableQuality::Bounds bounds = quality.bounds(start);
    raise(
      mesh, orientation, partition.free, points, monitor, std::min(bounds.fixed, bounds.movable));
    const auto mean = [&](const Points& of)
    { return morph::measureCorners(mesh, of, orientation, {}, monitor).mean; };
    const double least = quality.measure(start, monitor).minimum;
    const double now = quality.measure(points, monitor).minimum;
    EXPECT_GE(now, least);
    EXPECT_TRUE(now > 1.1 * least || mean(points) >= mean(start)) << angle;
    guarded += now <= 1.1 * least ? 1 : 0;
  }
  EXPECT_GT(guarded, 0);
}

TEST(QualityRaising, LeavesTangledAndPerfectMeshesBitForBit)
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
