// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/NearestNodes.h"

#include "Meshes.h"

#include "Mesh/Topology.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace morph;

namespace
{
/// All nodes at most as far as the k-th, to a relative 1e-9 and rounding.
std::vector<std::int32_t> byAllDistances(const Points& nodes, const Eigen::RowVector3d& x, Index k)
{
  const Eigen::VectorXd distances = (nodes.rowwise() - x).rowwise().norm();
  std::vector<double> sorted(distances.data(), distances.data() + distances.size());
  std::sort(sorted.begin(), sorted.end());
  const double most = (1 + 1e-9) * sorted[std::min<Index>(k, nodes.rows()) - 1] +
                      4 * std::numeric_limits<double>::epsilon() * nodes.cwiseAbs().maxCoeff();
  std::vector<std::int32_t> result;
  for (Index i = 0; i < nodes.rows(); ++i)
  {
    if (distances[i] <= most)
    {
      result.push_back(static_cast<std::int32_t>(i));
    }
  }
  return result;
}

void expectNearest(const Points& nodes, const Points& x, Index k, const std::string& what)
{
  const NearestNodes nearest(nodes);
  std::vector<std::int32_t> found;
  for (Index i = 0; i < x.rows(); ++i)
  {
    nearest.nearest(x.row(i), k, found);
    ASSERT_EQ(found, byAllDistances(nodes, x.row(i), k)) << what << ", place " << i << ", k " << k;
    EXPECT_DOUBLE_EQ(
      nearest.distance(x.row(i)), (nodes.rowwise() - x.row(i)).rowwise().norm().minCoeff())
      << what;
  }
}
}

TEST(NearestNodes, AgreeWithAllDistances)
{
  std::mt19937 random(meshes::seed());
  const Points cloud = meshes::randomPoints(400, random),
               inside = meshes::randomPoints(300, random);
  for (Index k : { 1, 2, 20, 80, 399, 400, 1000 })
  {
    expectNearest(cloud, inside, k, "random");
  }
  expectNearest(cloud, 50 * inside, 20, "far away");
  expectNearest(cloud, cloud, 5, "themselves");
  expectNearest(cloud.topRows(1), inside, 3, "a single node");
}

TEST(NearestNodes, AllNodesOfATieCountHoweverTheLatticeIsTurned)
{
  Monitor monitor;
  const Mesh mesh = meshes::hexes(10, 9, 8);
  const Points nodes = meshes::rows(mesh.points, boundaryFaces(mesh, monitor).nodes);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const NearestNodes straight(nodes), turned(nodes * turn);
  std::vector<std::int32_t> one, other;
  Index more = 0;
  for (Index k : { 1, 4, 7, 80 })
  {
    expectNearest(nodes, mesh.points, k, "lattice");
    for (Index i = 0; i < mesh.points.rows(); ++i)
    {
      straight.nearest(mesh.points.row(i), k, one);
      turned.nearest(mesh.points.row(i) * turn, k, other);
      EXPECT_EQ(one, other) << "place " << i << ", k " << k;
      more += static_cast<Index>(one.size()) > k ? 1 : 0;
    }
  }
  EXPECT_GT(more, mesh.points.rows());
}

TEST(NearestNodes, DuplicatesCountOneByOne)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  Points plane = mesh.points;
  plane.col(1).setConstant(3);
  expectNearest(plane, mesh.points, 11, "plane with duplicates");
  expectNearest(plane, plane, 3, "at the duplicates");
  expectNearest(Points::Constant(30, 3, .1), mesh.points, 4, "a pile");
}

TEST(NearestNodes, GradedSetsFarFromTheOriginAreExactToo)
{
  std::mt19937 random(meshes::seed());
  Points nodes = meshes::randomPoints(500, random), x = meshes::randomPoints(500, random);
  const auto grade = [](double v) { return v * v * v * v * v; };
  nodes = nodes.unaryExpr(grade);
  x = x.unaryExpr(grade);
  expectNearest(nodes, x, 25, "graded");
  nodes.array() += 1e7;
  x.array() += 1e7;
  expectNearest(nodes, x, 25, "graded and far off");
}

TEST(NearestNodes, ARadiusHoldsTheNodesOnItsSphere)
{
  const Points nodes = meshes::hexes(6, 6, 6).points;
  const NearestNodes nearest(nodes);
  std::vector<std::int32_t> found;
  nearest.within({ 3, 3, 3 }, 1, found);
  EXPECT_EQ(found.size(), 7u); // the node and the six beside it
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  nearest.within({ 3, 3, 3 }, 0, found);
  EXPECT_EQ(found, std::vector<std::int32_t>{ 3 + 7 * (3 + 7 * 3) });
  nearest.within({ 3.5, 3, 3 }, 0.4, found);
  EXPECT_TRUE(found.empty());
}
