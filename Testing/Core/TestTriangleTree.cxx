// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/TriangleTree.h"
#include "Meshes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace
{
using morph::Index;
using morph::TriangleTree;
using Row = Eigen::RowVector3d;

constexpr double Anywhere = std::numeric_limits<double>::infinity();

Row randomRow(std::mt19937& random, double size)
{
  std::uniform_real_distribution<double> range(-size, size);
  const double x = range(random), y = range(random), z = range(random);
  return { x, y, z };
}

/// Some are segments and points.
std::vector<TriangleTree::Triangle> randomTriangles(std::size_t count, std::mt19937& random)
{
  std::vector<TriangleTree::Triangle> triangles;
  while (triangles.size() < count)
  {
    const Row a = randomRow(random, 1), b = a + randomRow(random, 0.2),
              c = a + randomRow(random, 0.2);
    const std::size_t kind = triangles.size() % 8;
    triangles.push_back({ a, kind == 0 ? a : b, kind <= 1 ? a : c });
  }
  return triangles;
}

/// The least distance of x from some thousand places of the triangle, which lie 1/50 of its edges
/// apart.
double distanceBySampling(const TriangleTree::Triangle& t, const Row& x)
{
  constexpr int N = 50;
  double least = Anywhere;
  for (int i = 0; i <= N; ++i)
  {
    for (int j = 0; i + j <= N; ++j)
    {
      const Row place = (i * t[0] + j * t[1] + (N - i - j) * t[2]) / N;
      least = std::min(least, (place - x).norm());
    }
  }
  return least;
}
}

TEST(TriangleTree, TheNearestPlaceIsAsNearAsAnySample)
{
  std::mt19937 random(meshes::seed());
  const std::vector<TriangleTree::Triangle> triangles = randomTriangles(40, random);
  const TriangleTree tree(triangles);
  for (int i = 0; i < 30; ++i)
  {
    const Row x = randomRow(random, 2);
    const TriangleTree::Found found = tree.nearest(x, Anywhere);
    double least = Anywhere;
    for (const TriangleTree::Triangle& triangle : triangles)
    {
      least = std::min(least, distanceBySampling(triangle, x));
    }
    EXPECT_NEAR((found.place - x).norm(), least, 0.4 / 50); // edges are 0.35 long at most
    EXPECT_LE((found.place - x).norm(), least + 1e-15);
  }
}

TEST(TriangleTree, FindsWhatFitsWithinTheRadius)
{
  std::mt19937 random(meshes::seed());
  const std::vector<TriangleTree::Triangle> triangles = randomTriangles(200, random);
  const TriangleTree tree(triangles);
  const auto isThird = [](Index triangle) { return triangle % 3 == 0; };
  for (int i = 0; i < 100; ++i)
  {
    const Row x = randomRow(random, 1.5);
    TriangleTree::Found best{ -1, x };
    for (Index t = 0; t < 200; t += 3)
    {
      const TriangleTree alone({ triangles[static_cast<std::size_t>(t)] });
      const Row place = alone.nearest(x, Anywhere).place;
      if (best.triangle < 0 || (place - x).norm() < (best.place - x).norm())
      {
        best = { t, place };
      }
    }
    const double distance = (best.place - x).norm();
    EXPECT_EQ(tree.nearest(x, Anywhere, isThird).triangle, best.triangle);
    EXPECT_EQ(tree.nearest(x, 0.99 * distance, isThird).triangle, -1);
    EXPECT_EQ(tree.nearest(x, 1.01 * distance, isThird).place, best.place);
  }
}

TEST(TriangleTree, OfEquallyNearTrianglesTheLowestIsFound)
{
  // Four about the origin, each there twice.
  const Row ends[] = { { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 } };
  std::vector<TriangleTree::Triangle> triangles;
  for (int k = 0; k < 8; ++k)
  {
    triangles.push_back({ Row(0, 0, 0), ends[k % 4], ends[(k + 1) % 4] });
  }
  const TriangleTree tree(triangles);
  EXPECT_EQ(tree.nearest(Row(0, 0, 3), Anywhere).triangle, 0);
  EXPECT_EQ(tree.nearest(Row(-0.25, -0.25, 1), Anywhere).triangle, 2);
}

TEST(TriangleTree, ALineMeetsTheNearestOfTwoWalls)
{
  const auto wall = [](double z) {
    return TriangleTree::Triangle{ Row(-1, -1, z), Row(3, -1, z), Row(-1, 3, z) };
  };
  const TriangleTree tree({ wall(2), wall(-1), wall(-5) });
  const auto all = [](Index) { return true; };
  const Row up = Row(1, 0, 3).normalized();
  const TriangleTree::Found found = tree.nearestAlong(Row(0.5, 0.2, 0), up, 10, 0, all);
  EXPECT_EQ(found.triangle, 1);
  EXPECT_NEAR((found.place - Row(0.5 - 1. / 3, 0.2, -1)).norm(), 0, 1e-15);
  EXPECT_EQ(tree.nearestAlong(Row(0.5, 0.2, 0), up, 1, 0, all).triangle, -1);
  EXPECT_EQ(tree.nearestAlong(Row(-1.001, 0, 1.5), Row(0, 0, 1), 10, 1e-4, all).triangle, -1);
  EXPECT_EQ(tree.nearestAlong(Row(-1.001, 0, 1.5), Row(0, 0, 1), 10, 1e-2, all).triangle, 0);
}
