// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

#include "BoundaryMorphing/PhongSurface.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;
using shapes::Row;

namespace
{
using Case = shapes::ClassifiedShape;

/// The largest distance of `x` from the sphere of radius 1, after random steps along it.
double worstOnBall(int n, double& ofFacets)
{
  const Case c(shapes::ball(n));
  const PhongSurface surface(c.mesh.points, c.faces, c.geometry.surfaces[0].faces);
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  double worst = 0;
  ofFacets = 0;
  for (const Index node : c.geometry.surfaces[0].nodes)
  {
    const Row x = c.mesh.points.row(node);
    Row step(number(random), number(random), number(random));
    step = (step - step.dot(x) * x) / n;
    Index triangle = surface.triangleAt(node);
    const Row y = surface.closest(x + step, triangle);
    worst = std::max(worst, std::abs(y.norm() - 1));
    // The facet's own point: straight below.
    ofFacets = std::max(ofFacets, 1 - std::cos(1. / n));
  }
  return worst;
}
}

TEST(PhongSurface, GoesThroughItsNodes)
{
  for (const Mesh& mesh : { shapes::ball(6), shapes::cylinder(8, 4), shapes::creasedPlate() })
  {
    const Case c(mesh);
    for (const GeometrySurface& surface : c.geometry.surfaces)
    {
      const PhongSurface shape(c.mesh.points, c.faces, surface.faces);
      for (const Index node : surface.nodes)
      {
        Index triangle = shape.triangleAt(node);
        const Row x = c.mesh.points.row(node);
        EXPECT_LE((shape.closest(x, triangle) - x).norm(), 1e-14);
      }
    }
  }
}

TEST(PhongSurface, ReproducesCurvatureToSecondOrder)
{
  double facets = 0;
  const double coarse = worstOnBall(6, facets), fine = worstOnBall(12, facets);
  EXPECT_LT(coarse, 0.02);
  // As fast as that of facets, and a fifth of it.
  EXPECT_LT(fine, coarse / 3);
  EXPECT_LT(fine, facets / 5);
}

TEST(PhongSurface, WalksAcrossTheSurface)
{
  const Case c(shapes::ball(8));
  const PhongSurface shape(c.mesh.points, c.faces, c.geometry.surfaces[0].faces);
  const std::vector<Index>& nodes = c.geometry.surfaces[0].nodes;
  for (std::size_t i = 0; i < nodes.size(); i += 7)
  {
    // From one place to all others that are not behind it.
    Index triangle = shape.triangleAt(nodes[0]);
    const Row x = c.mesh.points.row(nodes[i]);
    EXPECT_LE((shape.closest(1.01 * x, triangle) - x).norm(), 0.02);
  }
}

TEST(PhongSurface, PlanesAreFoundAndHaveNoEnd)
{
  const Case c(meshes::tets(3, 3, 3));
  ASSERT_EQ(c.geometry.surfaces.size(), 6u);
  for (const GeometrySurface& surface : c.geometry.surfaces)
  {
    const PhongSurface shape(c.mesh.points, c.faces, surface.faces);
    ASSERT_TRUE(shape.isPlane());
    // Outwards, as the faces.
    const Row x = c.mesh.points.row(surface.nodes[0]);
    EXPECT_GT(shape.planeNormal().dot(x - Row(1.5, 1.5, 1.5)), 0);
    Index triangle = shape.triangleAt(surface.nodes[0]);
    const Row far = x + 100 * shape.planeNormal().unitOrthogonal();
    EXPECT_LE((shape.closest(far + 3 * shape.planeNormal(), triangle) - far).norm(), 1e-12);
  }
}
