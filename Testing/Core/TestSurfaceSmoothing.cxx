// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace morph;
using shapes::Row;

namespace
{
struct Case : shapes::ClassifiedShape
{
  using ClassifiedShape::ClassifiedShape;

  Monitor monitor;

  /// All nodes known; those of surfaces by their surface.
  BoundaryMotion moved(const std::function<Row(const Row&)>& map) const
  {
    BoundaryMotion motion = this->withEdgesMoved(map);
    for (Index node : this->faces.nodes)
    {
      if (this->geometry.dimension[node] == 2)
      {
        motion.displacement.row(node) =
          map(this->mesh.points.row(node)) - this->mesh.points.row(node);
        motion.state[node] = BoundaryMotion::OnSurface;
      }
    }
    return motion;
  }

  FaceQuality quality(const BoundaryMotion& motion) const
  {
    return faceQuality(this->mesh.points, motion.moved(), this->faces, this->geometry);
  }
};

Row same(const Row& x)
{
  return x;
}

/// A node of dimension 2 near the middle of the surface z = `z`.
Index middleOf(const Case& c, double z, const Row& middle)
{
  Index best = -1;
  double nearest = 1e300;
  for (Index node : c.faces.nodes)
  {
    const Row x = c.mesh.points.row(node);
    if (std::abs(x[2] - z) < 1e-12 && c.geometry.dimension[node] == 2 &&
        (x - middle).norm() < nearest)
    {
      nearest = (x - middle).norm();
      best = node;
    }
  }
  return best;
}

/// The cylinder of radius 1 about z.
class Cylinder : public ProjectionTarget
{
public:
  bool closestOnSurface(Index, const Row& x, const Row& normal, Row& y) const override
  {
    y = x;
    if (std::abs(normal[2]) < 0.5)
    {
      y.head<2>() /= x.head<2>().norm();
    }
    return true;
  }
  bool closestOnFeatures(Index, const Row&, Row&) const override { return false; }
};
}

TEST(SurfaceSmoothing, GoodSurfacesStayBitForBit)
{
  for (const auto& [name, mesh] : meshes::all(3, 3, 3))
  {
    SCOPED_TRACE(name);
    Case c(mesh);
    BoundaryMotion motion = c.moved([](const Row& x) { return Row(1.1 * x + Row(1, 2, 3)); });
    const Points before = motion.displacement;
    smoothSurfaces(c.faces, c.geometry, nullptr, motion, c.monitor);
    EXPECT_EQ(motion.displacement, before);
  }
}

TEST(SurfaceSmoothing, FoldsOfTheUndeformedSurfaceStay)
{
  Mesh mesh = meshes::hexes(6, 6, 2);
  mesh.points.row(middleOf(Case(mesh), 2, Row(3, 3, 2))) += Row(1.5, 0, 0);
  Case c(mesh);
  BoundaryMotion motion = c.moved(same);
  const std::vector<double> quality = c.quality(motion).scaledJacobian;
  ASSERT_LT(*std::min_element(quality.begin(), quality.end()), 0);
  smoothSurfaces(c.faces, c.geometry, nullptr, motion, c.monitor);
  EXPECT_TRUE(motion.displacement.isZero(0));
}

TEST(SurfaceSmoothing, AffineImagesStay)
{
  Mesh mixed = meshes::hexesAndPyramids(6, 6, 2); // with triangles and quadrilaterals
  {
    const Case even(mixed);
    std::mt19937 random(meshes::seed());
    std::uniform_real_distribution<double> number(-0.2, 0.2);
    for (Index node : even.faces.nodes)
    {
      if (even.geometry.dimension[node] == 2 && std::abs(mixed.points(node, 2) - 2) < 1e-12)
      {
        mixed.points.row(node) += Row(number(random), number(random), 0);
      }
    }
  }
  for (const Mesh& mesh : { meshes::hexes(6, 6, 2), meshes::tets(6, 6, 2), mixed })
  {
    Case c(mesh);
    // Sheared until the angles are poor.
    BoundaryMotion motion = c.moved([](const Row& x) { return Row(x[0] + 8 * x[1], x[1], x[2]); });
    const Points before = motion.displacement;
    ASSERT_LT(c.quality(motion).minimum, 0.2);
    smoothSurfaces(c.faces, c.geometry, nullptr, motion, c.monitor);
    EXPECT_EQ(motion.displacement, before);
  }
}

TEST(SurfaceSmoothing, FoldsOpenInThePlane)
{
  for (const Mesh& mesh :
    { meshes::hexes(8, 8, 2), meshes::tets(8, 8, 2), meshes::quadraticHexes(8, 8, 2, true) })
  {
    Case c(mesh);
    BoundaryMotion motion = c.moved(same);
    const Index node = middleOf(c, 2, Row(4, 4, 2));
    motion.displacement.row(node) += Row(1.6, 0.3, 0);
    const Points before = motion.displacement;
    ASSERT_FALSE(c.quality(motion).folded.empty());
    smoothSurfaces(c.faces, c.geometry, nullptr, motion, c.monitor);
    const FaceQuality after = c.quality(motion);
    EXPECT_TRUE(after.folded.empty());
    EXPECT_GT(after.minimum, 0.6);
    for (Index n = 0; n < before.rows(); ++n)
    {
      if (motion.displacement.row(n) != before.row(n))
      {
        EXPECT_EQ(motion.state[n], BoundaryMotion::OnSurface);
        EXPECT_NEAR(motion.displacement(n, 2), 0, 1e-12);
        // Two faces around the folded ones, and no further.
        EXPECT_LT((c.mesh.points.row(n) - Row(4, 4, 2)).cwiseAbs().maxCoeff(), 4);
      }
    }
  }
}

TEST(SurfaceSmoothing, KeepsToTheTarget)
{
  Case c(shapes::cylinder(10, 6));
  BoundaryMotion motion = c.moved(same);
  Index turned = -1;
  for (Index node : c.faces.nodes)
  {
    const Row x = c.mesh.points.row(node);
    if (c.geometry.dimension[node] == 2 && std::abs(x[2] - 1) < 1e-9 &&
        std::abs(x.head<2>().norm() - 1) < 1e-9)
    {
      turned = node;
    }
  }
  ASSERT_GE(turned, 0);
  const Row x = c.mesh.points.row(turned);
  const double angle = 0.3;
  motion.displacement.row(turned) = Row(x[0] * std::cos(angle) - x[1] * std::sin(angle),
                                      x[0] * std::sin(angle) + x[1] * std::cos(angle), x[2]) -
                                    x;
  ASSERT_FALSE(c.quality(motion).folded.empty());
  const Points before = motion.moved();
  smoothSurfaces(c.faces, c.geometry, std::make_unique<Cylinder>().get(), motion, c.monitor);
  EXPECT_TRUE(c.quality(motion).folded.empty());
  const Points moved = motion.moved();
  for (Index node : c.faces.nodes)
  {
    EXPECT_TRUE(moved.row(node) == before.row(node) ||
                std::abs(moved.row(node).head<2>().norm() - 1) < 1e-12);
  }
}
