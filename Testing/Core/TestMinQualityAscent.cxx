// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"
#include "Untangling/MinQualityAscent.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using morph::Index;
using morph::Mesh;
using morph::MovableQuality;
using morph::Points;

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
}

TEST(MinQualityAscent, OnePlaceAtItsBoundDoesNotStopTheOthers)
{
  const Mesh mesh = spoiltMesh();
  const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const MovableQuality quality(mesh, orientation, partition.free);
  meshes::ThreadedMonitor one(1), three(3);
  Points points = mesh.points;
  const double bound = quality.bounds(points).movable;
  const morph::AscentEffort first = morph::raiseMinimumQuality(quality, bound, points, one);
  const MovableQuality::Result floor = quality.measure(points, one);
  ASSERT_TRUE(morph::hasReached(floor.minimum, bound)) << floor.minimum << " of " << bound;
  const double before = minimumElsewhere(mesh, floor);
  ASSERT_GT(before, 3 * floor.minimum);

  Points again = points;
  const morph::AscentEffort effort = morph::raiseNextWorst(quality, first, points, one);
  EXPECT_GT(effort.rounds, 0);
  EXPECT_LE(effort.cellEvaluations,
    std::max(0.3 * first.cellEvaluations, 20. * static_cast<double>(mesh.numberOfCells())) * 1.1);
  const MovableQuality::Result raised = quality.measure(points, one);
  EXPECT_GE(raised.minimum, floor.minimum);
  EXPECT_GT(minimumElsewhere(mesh, raised), 1.2 * before);
  EXPECT_EQ(
    meshes::rows(points, partition.prescribed), meshes::rows(mesh.points, partition.prescribed));
  morph::raiseNextWorst(quality, first, again, three);
  EXPECT_TRUE(motions::identical(points, again));
}

TEST(MinQualityAscent, AMeshWithManyCellsAtItsMinimumStays)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const std::vector<std::int8_t> orientation(mesh.numberOfCells(), 1);
  const morph::NodePartition partition = motions::outerPartition(mesh);
  Mesh sheared = mesh;
  meshes::transform(
    sheared, [](const motions::Row& x) { return motions::Row(x[0] + 0.5 * x[1], x[1], x[2]); });
  const MovableQuality quality(sheared, orientation, partition.free);
  meshes::ThreadedMonitor monitor;
  Points points = sheared.points;
  EXPECT_EQ(morph::raiseNextWorst(quality, {}, points, monitor).rounds, 0);
  EXPECT_EQ(points, sheared.points);
}
