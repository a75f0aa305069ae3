// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;
using shapes::Row;
using Map = std::function<Row(const Row&)>;

namespace
{
struct Case : shapes::ClassifiedShape
{
  using ClassifiedShape::ClassifiedShape;

  /// Nodes of vertices and curves moved by `map`, then surfaces by their displacement alone.
  BoundaryMotion follow(const Map& map, Monitor& monitor) const
  {
    BoundaryMotion motion = this->withEdgesMoved(map);
    SurfaceMorphOptions options;
    options.method = SurfaceMorphOptions::Method::MeshSmoothing;
    morphCurves(this->geometry, options.unattached, motion, monitor);
    morphSurfaces(this->faces, this->geometry, options, motion, monitor);
    return motion;
  }

  FaceQuality quality(const Points& moved) const
  {
    return faceQuality(this->mesh.points, moved, this->faces, this->geometry);
  }

  SurfaceMeshSmoothing smooth(
    BoundaryMotion& motion, Monitor& monitor, const ProjectionTarget* target = nullptr) const
  {
    return smoothSurfaceMeshes(
      this->faces, this->geometry, target, SmoothedSurfaces::All, motion, monitor);
  }
};

/// A plate with a round hole. `hexes`: or tetrahedra.
Map holeMoved(double by)
{
  return [by](const Row& x) { return Row(x.head<2>().norm() < 1.01 ? Row(x + Row(by, 0, 0)) : x); };
}
}

TEST(SurfaceMeshSmoothing, NoMotionIsTheIdentityBitForBit)
{
  for (const Mesh& mesh : { shapes::boxWithHole(16, 3, 2), shapes::cylinder(6, 3),
         meshes::quadraticTets(3, 3, 3), meshes::hexesAndPyramids(4, 4, 4), shapes::ball(4) })
  {
    const Case c(mesh);
    Monitor monitor;
    BoundaryMotion motion = beginMotion(
      mesh, c.faces, c.geometry, { c.faces.nodes[0] }, Points(mesh.points.row(c.faces.nodes[0])));
    morphCurves(c.geometry, UnattachedMotion::FollowAffinely, motion, monitor);
    morphSurfaces(c.faces, c.geometry, {}, motion, monitor);
    const SurfaceMeshSmoothing report = c.smooth(motion, monitor);
    EXPECT_EQ(motion.moved(), mesh.points);
    EXPECT_EQ(report.steps, 0);
  }
}

TEST(SurfaceMeshSmoothing, AffineMotionsAreExact)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  for (const Mesh& mesh : { shapes::boxWithHole(16, 3, 2), shapes::cylinder(6, 3),
         meshes::quadraticTets(3, 3, 3), meshes::hexesAndPyramids(4, 4, 4) })
  {
    Eigen::Matrix3d A;
    do
    {
      A = Eigen::Matrix3d::NullaryExpr([&] { return number(random); });
    } while (A.determinant() < 0.2);
    const Map map = [&](const Row& x) { return Row(x * A.transpose() + Row(1, 2, 3)); };
    const Case c(mesh);
    Monitor monitor;
    BoundaryMotion motion = c.follow(map, monitor);
    c.smooth(motion, monitor);
    const Points moved = motion.moved();
    for (const Index node : c.faces.nodes)
    {
      EXPECT_LE(
        (Row(moved.row(node)) - map(mesh.points.row(node))).norm(), 1e-10 * meshes::size(moved));
    }
  }
}

TEST(SurfaceMeshSmoothing, RoundingOfCoordinatesHidesNoAffineMotion)
{
  Mesh mesh = shapes::boxWithHole(16, 3, 2);
  const Row away(4e6, -3e6, 1e6);
  mesh.points.rowwise() += away;
  const Case c(mesh);
  Monitor monitor;
  BoundaryMotion motion =
    c.follow([&](const Row& x) { return Row(x + 1e-3 * (x - away).reverse()); }, monitor);
  EXPECT_EQ(c.smooth(motion, monitor).steps, 0);
}

TEST(SurfaceMeshSmoothing, FoldsOpen)
{
  // The hole comes near the plate's side.
  for (const bool isFine : { false, true })
  {
    const Case c(isFine ? shapes::boxWithHole(48, 10, 1) : shapes::boxWithHole(24, 5, 1));
    Monitor monitor;
    BoundaryMotion motion = c.follow(holeMoved(0.9), monitor);
    // Some nodes are thrown over others.
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> number(-0.3, 0.3);
    for (const Index node : c.faces.nodes)
    {
      if (motion.state[node] == BoundaryMotion::OnSurface &&
          std::abs(c.mesh.points(node, 2) - 1) < 1e-9)
      {
        motion.displacement.row(node) += Row(number(random), number(random), 0);
      }
    }
    const FaceQuality before = c.quality(motion.moved());
    ASSERT_FALSE(before.folded.empty());
    c.smooth(motion, monitor);
    const FaceQuality after = c.quality(motion.moved());
    EXPECT_TRUE(after.folded.empty());
    EXPECT_GT(after.minimum, 0.1);
  }
}

// As a surface without volume cells has them.
TEST(SurfaceMeshSmoothing, FacesNeedNoCells)
{
  Case c(shapes::boxWithHole(16, 3, 2));
  Monitor monitor;
  const BoundaryMotion start = c.follow(holeMoved(0.3), monitor);
  BoundaryMotion expected = start, motion = start;
  EXPECT_GT(c.smooth(expected, monitor).steps, 0);
  c.faces.cells = {};
  c.faces.sides = {};
  c.smooth(motion, monitor);
  EXPECT_EQ(motion.moved(), expected.moved());
}

TEST(SurfaceMeshSmoothing, NeverWorse)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-0.25, 0.25);
  Index better = 0;
  for (int round = 0; round < 20; ++round)
  {
    const double a = number(random), b = number(random), d = number(random);
    const Map map = [&](const Row& x)
    {
      return Row(x[0] + a * std::sin(x[1]) + d * x[0] * x[1], x[1] + b * std::cos(2 * x[0]),
        x[2] + d * std::sin(x[0]));
    };
    for (const Mesh& mesh :
      { shapes::boxWithHole(16, 4, 2), shapes::cylinder(8, 3), meshes::tets(5, 5, 2) })
    {
      const Case c(mesh);
      Monitor monitor;
      BoundaryMotion motion = c.follow(map, monitor);
      const FaceQuality before = c.quality(motion.moved());
      c.smooth(motion, monitor);
      const FaceQuality after = c.quality(motion.moved());
      EXPECT_LE(after.folded.size(), before.folded.size());
      if (after.folded.size() == before.folded.size())
      {
        EXPECT_GE(after.minimum, before.minimum);
      }
      better += after.mean > before.mean;
    }
  }
  EXPECT_GT(better, 30);
}

TEST(SurfaceMeshSmoothing, NodesStayOnTheirShape)
{
  // The curves of a cylinder turn against each other: its side is a hyperboloid.
  const Case c(shapes::cylinder(16, 12));
  Monitor monitor;
  BoundaryMotion motion = c.follow(
    [](const Row& x)
    {
      const double turn = 0.3 * x[2] * x[0];
      return Row(x[0] * std::cos(turn) - x[1] * std::sin(turn),
        x[0] * std::sin(turn) + x[1] * std::cos(turn), x[2]);
    },
    monitor);
  // On the cylinder again, as where the surface is known.
  for (const Index node : c.faces.nodes)
  {
    const Row x = c.mesh.points.row(node) + motion.displacement.row(node);
    if (motion.state[node] == BoundaryMotion::OnSurface &&
        std::abs(c.mesh.points.row(node).head<2>().norm() - 1) < 1e-9)
    {
      Row y = x;
      y.head<2>() /= x.head<2>().norm();
      motion.displacement.row(node) = y - c.mesh.points.row(node);
    }
  }
  const Points start = motion.moved();
  c.smooth(motion, monitor);
  const Points moved = motion.moved();
  double most = 0;
  for (const Index node : c.faces.nodes)
  {
    if (std::abs(c.mesh.points.row(node).head<2>().norm() - 1) < 1e-9)
    {
      // 64 faces around: the sagitta of a facet is 1.2e-3.
      EXPECT_NEAR(moved.row(node).head<2>().norm(), 1, 2e-4);
      most = std::max(most, (moved.row(node) - start.row(node)).norm());
    }
    else
    {
      EXPECT_NEAR(moved(node, 2), start(node, 2), 1e-12);
    }
  }
  EXPECT_GT(most, 0.01);
}

TEST(SurfaceMeshSmoothing, ThreadsDoNotShow)
{
  const Case c(shapes::boxWithHole(48, 8, 4));
  std::vector<Points> results;
  for (const int threads : { 1, 3 })
  {
    meshes::ThreadedMonitor monitor(threads);
    BoundaryMotion motion = c.follow(holeMoved(0.6), monitor);
    c.smooth(motion, monitor);
    results.push_back(motion.moved());
  }
  EXPECT_EQ(results[0], results[1]);
}
