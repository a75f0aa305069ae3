// SPDX-License-Identifier: BSD-3-Clause
// Quadratic cells that are inverted between their corners.
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/Certificate.h"
#include "Untangling/HigherOrderUntangling.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

namespace
{
using namespace morph;

std::vector<std::int8_t> signsOf(const Mesh& mesh)
{
  return morph::cellSigns(mesh, morph::connectedComponents(mesh));
}

Index invertedOf(const Mesh& mesh, const Points& points)
{
  meshes::ThreadedMonitor monitor;
  return morph::certify(mesh, points, signsOf(mesh), {}, monitor).inverted;
}

void untangle(const Mesh& mesh, const morph::NodePartition& partition, Points& points)
{
  meshes::ThreadedMonitor monitor;
  morph::untangleHigherOrder(mesh, partition, signsOf(mesh), points, monitor);
}

struct Brick
{
  std::string name;
  Mesh mesh;
};

std::vector<Brick> bricks()
{
  return { { "20 nodes", meshes::quadraticHexes(4, 4, 4, false) },
    { "27 nodes", meshes::quadraticHexes(4, 4, 4, true) },
    { "tetrahedra", meshes::quadraticTets(4, 4, 4) } };
}

/// From the brick [0, 4]^3 to a cylinder about its axis, the lines along it straight.
motions::Row cylinder(const motions::Row& x)
{
  const double a = x[0] - 2, b = x[1] - 2, most = std::max(std::abs(a), std::abs(b));
  const double radius = std::hypot(a, b), factor = radius > 0 ? 0.3 + 0.7 * most / radius : 1;
  return { 2 + factor * a, 2 + factor * b, x[2] };
}
}

TEST(HigherOrderUntangling, MidSideNodesThatInvertCellsComeBack)
{
  for (const Brick& brick : bricks())
  {
    for (const bool mirrored : { false, true })
    {
      SCOPED_TRACE(brick.name);
      Mesh mesh = brick.mesh;
      if (mirrored)
      {
        mesh.points.col(1) *= -1;
      }
      const morph::NodePartition partition = motions::outerPartition(mesh);
      Points points = mesh.points;
      std::srand(meshes::seed());
      for (std::size_t i = 0; i < partition.higherOrderNodes.size(); i += 5)
      {
        points.row(partition.higherOrderNodes[i]) += 0.6 * Eigen::RowVector3d::Random();
      }
      const Points start = points;
      const Index inverted = invertedOf(mesh, points);
      ASSERT_GT(inverted, 5);
      untangle(mesh, partition, points);
      EXPECT_EQ(invertedOf(mesh, points), 0);
      EXPECT_EQ(
        meshes::rows(points, partition.prescribed), meshes::rows(start, partition.prescribed));
      EXPECT_EQ(meshes::rows(points, partition.free), meshes::rows(start, partition.free));
    }
  }
}

TEST(HigherOrderUntangling, TwistedAndBentBricksAndCylindersComeOutValidWhereTheExactMapIs)
{
  int helped = 0;
  for (const Brick& brick : bricks())
  {
    for (const bool isCylinder : { false, true })
    {
      for (const double angle : { 1., 1.6, 2.2 })
      {
        Mesh mesh = brick.mesh;
        if (isCylinder)
        {
          meshes::transform(mesh, cylinder);
        }
        const motions::Map twist = [&](const motions::Row& x)
        { return motions::twist(x, 4, 4, angle); };
        const motions::Map bend = [&](const motions::Row& x) -> motions::Row
        {
          const double radius = 4 / angle + 2 - x[0], turn = angle * x[2] / 4;
          return { 2 + 4 / angle - radius * std::cos(turn), x[1], radius * std::sin(turn) };
        };
        for (const motions::Map& map : { twist, bend })
        {
          SCOPED_TRACE(
            brick.name + (isCylinder ? " cylinder " : " brick ") + std::to_string(angle));
          if (invertedOf(mesh, motions::mapped(mesh.points, map)) > 0)
          {
            continue;
          }
          const morph::NodePartition partition = motions::outerPartition(mesh);
          meshes::ThreadedMonitor monitor(2);
          morph::InversionFree method;
          Points moved;
          method.prepare(mesh, partition, monitor);
          method.evaluate(motions::targets(mesh, partition, map), moved, monitor);
          helped += invertedOf(mesh, moved) > 0 ? 1 : 0;
          untangle(mesh, partition, moved);
          EXPECT_EQ(invertedOf(mesh, moved), 0);
        }
      }
    }
  }
  std::cout << "Helped " << helped << "\n";
}

TEST(HigherOrderUntangling, CellsWithoutMovedPrescribedNodesComeBackBesideThose)
{
  for (const Brick& brick : bricks())
  {
    SCOPED_TRACE(brick.name);
    const Mesh& mesh = brick.mesh;
    const morph::NodePartition partition = motions::outerPartition(mesh);
    Points points = mesh.points;
    std::srand(meshes::seed());
    for (std::size_t i = 0; i < partition.higherOrderNodes.size(); i += 2)
    {
      points.row(partition.higherOrderNodes[i]) += 0.45 * Eigen::RowVector3d::Random();
    }
    for (std::size_t i = 0; i < partition.prescribed.size(); i += 3)
    {
      points.row(partition.prescribed[i]) += 0.35 * Eigen::RowVector3d::Random();
    }
    const Index before = invertedOf(mesh, points);
    untangle(mesh, partition, points);
    EXPECT_LT(3 * invertedOf(mesh, points), 2 * before);
  }
}

TEST(HigherOrderUntangling, CellsThatNoneCanMendAndValidMeshesStay)
{
  Mesh mesh = meshes::quadraticHexes(2, 2, 2, false);
  const morph::NodePartition partition = motions::outerPartition(mesh);
  Points points = mesh.points;
  untangle(mesh, partition, points);
  EXPECT_EQ(points, mesh.points);
  // A prescribed mid-side node of the outer boundary passes the end of its edge.
  for (Index node : partition.prescribed)
  {
    if ((mesh.points.row(node) - motions::Row(0.5, 0, 0)).norm() < 1e-9)
    {
      points(node, 0) = 1.2;
    }
  }
  const Points before = points;
  untangle(mesh, partition, points);
  EXPECT_EQ(points, before);
  EXPECT_EQ(invertedOf(mesh, points), 1);
}
