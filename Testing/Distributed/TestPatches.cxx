// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Patches.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Pieces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using morph::Index;
using morph::Monitor;
using morph::Points;
using morph::distributed::DistributedMesh;
using morph::distributed::PatchLimits;
using morph::distributed::PatchReport;
using morph::distributed::Ranks;

/// A block with two nodes far from one another that have gone through their cells.
struct Case
{
  explicit Case(const Ranks& ranks)
    : whole(meshes::hexes(16, 6, 6))
    , mesh(pieces::distribute(ranks, whole, 1, meshes::seed()))
  {
    Monitor monitor;
    const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes;
    this->partition = morph::partitionNodes(mesh.mesh(), pieces::localNodes(mesh, outer));
    this->moved = mesh.mesh().points;
    for (Index n = 0; n < this->moved.rows(); ++n)
    {
      const Eigen::RowVector3d x = this->moved.row(n);
      if (x == Eigen::RowVector3d(3, 3, 3) || x == Eigen::RowVector3d(13, 3, 3))
      {
        this->moved(n, 0) += 1.4;
      }
    }
  }

  morph::Mesh whole;
  DistributedMesh mesh;
  morph::NodePartition partition;
  Points moved;
};
}

TEST(DistributedPatches, RepairInvertedCellsAndMoveNothingElse)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  Monitor monitor;
  const auto report = morph::distributed::repairInverted(
    c.mesh, c.mesh.mesh().points, c.partition, {}, c.moved, monitor);
  EXPECT_EQ(report.bad, 0);
  EXPECT_EQ(report.tooLarge, 0);
  // The patches of six rings end before the middle.
  double middle = 0;
  for (Index n = 0; n < c.moved.rows(); ++n)
  {
    if (c.mesh.mesh().points(n, 0) == 0 || c.mesh.mesh().points(n, 0) == 16)
    {
      middle = std::max(middle, (c.moved.row(n) - c.mesh.mesh().points.row(n)).norm());
    }
  }
  EXPECT_EQ(ranks.maximum(middle), 0);
}

TEST(DistributedPatches, SayWhatTheyGatherAndHaveALimit)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  Monitor monitor;
  const Points before = c.moved;
  std::vector<Index> seeds;
  for (Index cell = 0; cell < c.mesh.pieceCells(); ++cell)
  {
    const Index* nodes = c.mesh.mesh().cell(cell);
    if (std::any_of(nodes, nodes + c.mesh.mesh().cellSize(cell),
          [&](Index node) { return c.moved.row(node) != c.mesh.mesh().points.row(node); }))
    {
      seeds.push_back(cell);
    }
  }
  PatchLimits limits;
  limits.rings = 1;
  const PatchReport report = morph::distributed::repairPatches(
    c.mesh, c.mesh.mesh().points, c.partition, seeds, {}, limits, c.moved, monitor);
  EXPECT_EQ(report.patches, 2);
  EXPECT_EQ(report.failed, 0);
  // The nodes within two cells of each move, and so change the cells within three.
  EXPECT_EQ(report.cells, 2 * 6 * 6 * 6);
  EXPECT_EQ(report.bytes > 0, ranks.count() > 1);

  limits.few = 100;
  c.moved = before;
  EXPECT_TRUE(morph::distributed::repairPatches(
    c.mesh, c.mesh.mesh().points, c.partition, seeds, {}, limits, c.moved, monitor)
                .isTooLarge);
  EXPECT_EQ(c.moved, before);
}
