// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"

#include "Geometry/ConvexHullTest.h"
#include "Geometry/NearestNodes.h"
#include "Geometry/SpatialOrder.h"
#include "Mesh/Topology.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

using namespace morph;

namespace
{
Points randomPoints(Index n, std::mt19937& random)
{
  std::uniform_real_distribution<double> value(-1, 1);
  Points points(n, 3);
  return points.unaryExpr([&](double) { return value(random); });
}

std::vector<Index> allIds(Index n)
{
  std::vector<Index> ids(n);
  std::iota(ids.begin(), ids.end(), Index(0));
  return ids;
}

/// The nodes up to the distance of the k-th nearest, and its ties, numbers ascending.
std::vector<std::int32_t> sortedNearest(const Points& nodes, const Eigen::RowVector3d& x, Index k)
{
  std::vector<std::pair<double, std::int32_t>> all;
  for (Index i = 0; i < nodes.rows(); ++i)
  {
    const double u = nodes(i, 0) - x[0], v = nodes(i, 1) - x[1], w = nodes(i, 2) - x[2];
    all.emplace_back(u * u + v * v + w * w, static_cast<std::int32_t>(i));
  }
  std::sort(all.begin(), all.end());
  const double most = std::sqrt(all[std::min(k, nodes.rows()) - 1].first) * (1 + 1e-9) +
                      4 * std::numeric_limits<double>::epsilon() * nodes.cwiseAbs().maxCoeff();
  std::vector<std::int32_t> result;
  for (const auto& [squared, node] : all)
  {
    if (std::sqrt(squared) <= most * (1 + 1e-13))
    {
      result.push_back(node);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

void expectNearest(const Points& nodes, const Points& x, const std::vector<Index>& order, Index k,
  const std::string& what)
{
  const NearestNodes nearest(nodes);
  std::vector<int> visits(x.rows(), 0);
  // In uneven pieces: they must not show.
  const Index n = static_cast<Index>(order.size());
  for (Index first = 0, last = 0; first < n; first = last)
  {
    last = std::min(n, first + 7 + first % 131 * 11);
    nearest.search(x, order, first, last, k,
      [&](Index row, const NearestNodes::Neighbors& found)
      {
        ++visits[row];
        const std::vector<std::int32_t> expected = sortedNearest(nodes, x.row(row), k);
        ASSERT_EQ(std::vector<std::int32_t>(found.nodes, found.nodes + found.count), expected)
          << what << ", place " << row << ", k " << k;
        for (Index i = 0; i < found.count; ++i)
        {
          EXPECT_NEAR(found.squaredDistances[i],
            (nodes.row(found.nodes[i]) - x.row(row)).squaredNorm(),
            1e-14 * found.squaredDistances[i])
            << what;
        }
      });
  }
  for (Index row : order)
  {
    EXPECT_EQ(visits[row], 1) << what;
  }
  EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), Index(0)), n) << what;
}

/// Whether x is in the hull of points in general position: no plane through x and two points has
/// all others on one side.
bool insideByAllPlanes(const Eigen::RowVector3d& x, const Points& points)
{
  const Points d = points.rowwise() - x;
  for (Index i = 0; i < d.rows(); ++i)
  {
    for (Index j = 0; j < i; ++j)
    {
      const Eigen::Vector3d normal =
        Eigen::Vector3d(d.row(i).transpose()).cross(Eigen::Vector3d(d.row(j).transpose()));
      int above = 0, below = 0;
      for (Index k = 0; k < d.rows(); ++k)
      {
        if (k != i && k != j)
        {
          ++(d.row(k).dot(normal) > 0 ? above : below);
        }
      }
      if (above == 0 || below == 0)
      {
        return false;
      }
    }
  }
  return true;
}
}

TEST(NearestNodes, AgreesWithSortingAllDistances)
{
  std::mt19937 random(meshes::seed());
  const Points cloud = randomPoints(400, random);
  const Points inside = randomPoints(900, random);
  for (Index k : { 1, 2, 20, 80, 399, 400, 1000 })
  {
    expectNearest(cloud, inside, spatialOrder(inside, allIds(inside.rows())), k, "random");
  }
  std::vector<Index> shuffled = allIds(inside.rows());
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  expectNearest(cloud, inside, shuffled, 20, "in no order");
  expectNearest(
    cloud, 50 * inside, spatialOrder(50 * inside, allIds(inside.rows())), 20, "far away");
  expectNearest(cloud, cloud, spatialOrder(cloud, allIds(cloud.rows())), 5, "themselves");
  expectNearest(cloud.topRows(1), inside, allIds(inside.rows()), 3, "a single node");
  expectNearest(cloud, inside, { 8, 3 }, 3, "two of them");
  expectNearest(cloud, inside, {}, 3, "none of them");
}

TEST(NearestNodes, PlacesAndNodesOnSpheresAreExact)
{
  // The middle of a box round places on a sphere may lie outside the sphere, and nodes wait just
  // beyond it.
  std::mt19937 random(meshes::seed());
  for (int round = 0; round < 15; ++round)
  {
    Points x = randomPoints(64, random);
    x = x.rowwise().normalized();
    x.topRows(56) *= .9;
    x.bottomRows(8) = x.bottomRows(8).cwiseAbs().array() * .3 + .7;
    x.bottomRows(8) = x.bottomRows(8).rowwise().normalized();
    const Points nodes = 1.02 * randomPoints(600, random).rowwise().normalized();
    for (Index k : { 1, 2, 6 })
    {
      expectNearest(nodes, x, allIds(64), k, "on a sphere");
    }
  }
}

TEST(NearestNodes, AllNodesAsFarAsTheLastCount)
{
  Monitor monitor;
  const Mesh mesh = meshes::hexes(10, 9, 8);
  const Points nodes = meshes::rows(mesh.points, boundaryFaces(mesh, monitor).nodes);
  for (Index k : { 1, 4, 7, 80 })
  {
    expectNearest(
      nodes, mesh.points, spatialOrder(mesh.points, allIds(mesh.points.rows())), k, "lattice");
  }
  Points plane = nodes;
  plane.col(1).setConstant(3);
  expectNearest(plane, mesh.points, allIds(mesh.points.rows()), 11, "plane with duplicates");
  expectNearest(Points::Constant(30, 3, .1), mesh.points, allIds(mesh.points.rows()), 4, "a pile");
}

TEST(NearestNodes, GradedSetsFarFromTheOriginAreExactToo)
{
  std::mt19937 random(meshes::seed());
  Points nodes = randomPoints(500, random), x = randomPoints(500, random);
  const auto grade = [](double v) { return v * v * v * v * v; };
  nodes = nodes.unaryExpr(grade);
  x = x.unaryExpr(grade);
  expectNearest(nodes, x, spatialOrder(x, allIds(500)), 25, "graded");
  nodes.array() += 1e7;
  x.array() += 1e7;
  expectNearest(nodes, x, spatialOrder(x, allIds(500)), 25, "graded and far off");
}

TEST(ConvexHullTest, AgreesWithTryingAllPlanes)
{
  std::mt19937 random(meshes::seed());
  int inside = 0;
  for (int round = 0; round < 300; ++round)
  {
    const Points points = randomPoints(4 + round % 12, random);
    const Eigen::RowVector3d x = .6 * randomPoints(1, random);
    const bool expected = insideByAllPlanes(x, points);
    inside += expected ? 1 : 0;
    EXPECT_EQ(insideConvexHull(x, points), expected) << "round " << round;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 250);
}

TEST(ConvexHullTest, TheHullItselfCountsAsInside)
{
  const Points cube = meshes::hexes(2, 2, 2).points;
  EXPECT_TRUE(insideConvexHull({ 1, 1, 1.5 }, cube));
  EXPECT_TRUE(insideConvexHull({ 1.3, .4, 2 }, cube)); // on a face
  EXPECT_TRUE(insideConvexHull({ 0, .7, 2 }, cube));   // on an edge
  EXPECT_TRUE(insideConvexHull({ 2, 2, 2 }, cube));    // a corner
  EXPECT_FALSE(insideConvexHull({ 1.3, .4, 2 + 1e-5 }, cube));
  EXPECT_FALSE(insideConvexHull({ 0, -1e-5, 2 }, cube));

  Points plane = cube;
  plane.col(2).setConstant(.3);
  EXPECT_TRUE(insideConvexHull({ .9, 1.1, .3 }, plane));
  EXPECT_FALSE(insideConvexHull({ .9, 1.1, .31 }, plane));
  EXPECT_FALSE(insideConvexHull({ 2.1, 1.1, .3 }, plane));
  Points line = plane;
  line.col(0).setConstant(.2);
  EXPECT_TRUE(insideConvexHull({ .2, 1.7, .3 }, line));
  EXPECT_FALSE(insideConvexHull({ .2, 2.7, .3 }, line));
  EXPECT_FALSE(insideConvexHull({ .1, 1.7, .3 }, line));
  EXPECT_FALSE(insideConvexHull({ 0, 0, 0 }, Points(0, 3)));
}

TEST(ConvexHullTest, TurningAndScalingDoNotMatter)
{
  std::mt19937 random(meshes::seed());
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int round = 0; round < 100; ++round)
  {
    const Points points = randomPoints(12, random);
    const Eigen::RowVector3d x = .6 * randomPoints(1, random);
    EXPECT_EQ(insideConvexHull(x, points), insideConvexHull(1e6 * x * turn, 1e6 * points * turn));
  }
}
