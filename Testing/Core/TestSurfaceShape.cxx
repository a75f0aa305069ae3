// SPDX-License-Identifier: BSD-3-Clause
// Surfaces are recognized as planes, cylinders and spheres, if nothing else fits as well.
#include "BoundaryMover/SurfaceShape.h"
#include "ClassifiedShape.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
using morph::Index;
using morph::SurfaceShape;
using shapes::Row;

/// A block bent about the z axis and the origin: radius 2 to 3, `turn` degrees around, and from
/// `low` to `high` degrees above the equator.
morph::Mesh shell(int cells, double turn, double low, double high)
{
  morph::Mesh mesh = meshes::hexes(1, cells, cells);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const double toRadians = std::acos(-1.) / 180, r = 2 + x[0];
      const double phi = toRadians * turn * x[1] / cells;
      const double theta = toRadians * (low + (high - low) * x[2] / cells);
      return Row(r * std::cos(phi) * std::cos(theta), r * std::sin(phi) * std::cos(theta),
        r * std::sin(theta));
    });
  return mesh;
}

/// The surface of `shape` all of whose nodes are such.
const morph::GeometrySurface& surfaceWhere(
  const shapes::ClassifiedShape& shape, const std::function<bool(const Row&)>& is)
{
  const auto found = std::find_if(shape.geometry.surfaces.begin(), shape.geometry.surfaces.end(),
    [&](const morph::GeometrySurface& surface)
    {
      return std::all_of(surface.nodes.begin(), surface.nodes.end(),
        [&](Index n) { return is(shape.mesh.points.row(n)); });
    });
  EXPECT_NE(found, shape.geometry.surfaces.end());
  return *found;
}

std::string textOf(const shapes::ClassifiedShape& shape, const std::function<bool(const Row&)>& is)
{
  return SurfaceShape::text(shape.mesh.points, shape.faces, surfaceWhere(shape, is));
}

bool isInner(const Row& x)
{
  return x.norm() < 2 + 1e-3;
}
}

TEST(SurfaceShape, PartsOfASphereAreRecognized)
{
  // An octant, two cells each way; a cap of seven degrees; a closed ball.
  for (const auto& [turn, low, high] : { std::array{ 90., 0., 80. }, std::array{ 7., 20., 27. } })
  {
    const shapes::ClassifiedShape shape(shell(4, turn, low, high));
    EXPECT_EQ(textOf(shape, isInner), "sphere R 2") << turn;
    EXPECT_EQ(textOf(shape, [](const Row& x) { return x[1] == 0; }), "plane");
  }
  const shapes::ClassifiedShape ball(shapes::ball(4));
  EXPECT_EQ(textOf(ball, [](const Row& x) { return x.norm() > 0.5; }), "sphere R 1");
  const shapes::ClassifiedShape round(shapes::cylinder(4, 3));
  EXPECT_EQ(textOf(round, [](const Row& x) { return x.head<2>().norm() > 1 - 1e-6; }), "R 1");
}

TEST(SurfaceShape, ASphereIsNoneWhereAConeFitsAsWell)
{
  // One row of cells between two circles, as of a chamfer: on a sphere, and on a cone.
  morph::Mesh mesh = meshes::hexes(1, 12, 1);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double phi = std::acos(-1.) / 2 * x[1] / 12, r = 2 + x[0] + 0.3 * x[2];
      return Row(r * std::cos(phi), r * std::sin(phi), x[2]);
    });
  const shapes::ClassifiedShape chamfer(mesh);
  const auto isCone = [](const Row& x)
  { return std::abs(x.head<2>().norm() - 2 - 0.3 * x[2]) < 1e-9; };
  EXPECT_EQ(textOf(chamfer, isCone), "free form");
}

TEST(SurfaceShape, WhatIsNearlyASphereIsNone)
{
  for (const double stretch : { 1e-5, -1e-5 })
  {
    morph::Mesh mesh = shell(6, 90, 0, 80);
    meshes::transform(mesh, [&](const Row& x) { return Row(x[0], x[1], (1 + stretch) * x[2]); });
    EXPECT_EQ(textOf(shapes::ClassifiedShape(mesh), isInner), "free form") << stretch;
  }
}

TEST(SurfaceShape, NodesSlideAlongASphereAtTheirHeight)
{
  const shapes::ClassifiedShape shape(shell(6, 90, 0, 80));
  const SurfaceShape sphere(shape.mesh.points, shape.faces, surfaceWhere(shape, isInner));
  ASSERT_EQ(sphere.kind(), SurfaceShape::Kind::Sphere);
  EXPECT_NEAR(sphere.radius(), 2, 1e-12);
  const Row from(2.25, 0, 0), to(1, 4, 1);
  EXPECT_NEAR(sphere.slid(from, to).norm(), 2.25, 1e-12);
  EXPECT_LT(sphere.slid(from, to).normalized().cross(to.normalized()).norm(), 1e-12);
  EXPECT_NEAR((sphere.slid(from, from) - from).norm(), 0, 1e-12);
  EXPECT_NEAR(sphere.closest(to).norm(), 2, 1e-12);
  EXPECT_NEAR((sphere.outwards(to) - to.normalized()).norm(), 0, 1e-12);
}
