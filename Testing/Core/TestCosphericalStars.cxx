// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/CosphericalStars.h"

#include "BoundaryShapes.h"
#include "Interpolation/PointLocation.h"
#include "LinearMethods/SimplexLinear.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace morph;
using Row = Eigen::RowVector3d;

namespace
{
struct Star
{
  explicit Star(const Points& sites)
  {
    Monitor monitor;
    this->delaunay.build(sites, monitor);
    this->before = this->delaunay.tetrahedra();
    this->means = starCosphericalCells(this->delaunay, monitor);
  }

  Index numberOfMeans() const { return static_cast<Index>(this->means.offsets.size()) - 1; }

  Delaunay delaunay;
  std::vector<Delaunay::Tetrahedron> before;
  Adjacency means;
};

Points random(Index n, std::mt19937& generator)
{
  std::uniform_real_distribution<double> value(-1, 1);
  return Points(n, 3).unaryExpr([&](double) { return value(generator); });
}

Eigen::Matrix3d rotation(std::mt19937& generator)
{
  std::normal_distribution<double> value;
  return Eigen::Quaterniond(value(generator), value(generator), value(generator), value(generator))
    .normalized()
    .toRotationMatrix();
}

Points morphed(const Mesh& mesh, const NodePartition& partition, const Points& target)
{
  Monitor monitor;
  SimplexLinear method;
  return motions::morphed(method, mesh, partition, target, monitor);
}

/// How far sites lie on both sides of the plane of the face opposite corner k, the lesser of the
/// two; 0 of a face that is almost a line.
double depth(const Star& star, const Delaunay::Tetrahedron& tetrahedron, int k)
{
  const Points& sites = star.delaunay.sites();
  Row corners[3];
  for (int i = 0, c = 0; i < 4; ++i)
  {
    if (i != k)
    {
      corners[c++] = sites.row(tetrahedron.sites[i]);
    }
  }
  const Row area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (area.norm() < 1e-3 * (corners[1] - corners[0]).squaredNorm())
  {
    return 0;
  }
  const Row normal = area.normalized();
  const Eigen::VectorXd heights = (sites.rowwise() - corners[0]) * normal.transpose();
  return std::min(heights.maxCoeff(), -heights.minCoeff());
}

/// Neighbors see each other, a face without one is on the hull, and the volumes add up to the
/// hull's. `rounding`: how negative a volume may be, as a part of the hull's.
void expectTessellation(const Star& star, double rounding = 1e-12)
{
  const auto& now = star.delaunay.tetrahedra();
  double volume = 0, hull = 0;
  for (const auto& t : star.before)
  {
    hull += Delaunay::sixVolumes(t, star.delaunay.sites());
  }
  for (std::size_t t = 0; t < now.size(); ++t)
  {
    const double own = Delaunay::sixVolumes(now[t], star.delaunay.sites());
    EXPECT_GT(own, -rounding * hull);
    volume += own;
    for (int k = 0; k < 4; ++k)
    {
      const int next = now[t].neighbors[k];
      if (next != Delaunay::Outside)
      {
        const auto& back = now[next].neighbors;
        EXPECT_EQ(std::count(back.begin(), back.end(), static_cast<int>(t)), 1);
        std::set<int> face(now[t].sites.begin(), now[t].sites.end());
        face.erase(now[t].sites[k]);
        std::set<int> other(now[next].sites.begin(), now[next].sites.end());
        EXPECT_TRUE(std::includes(other.begin(), other.end(), face.begin(), face.end()));
      }
      else
      {
        EXPECT_LT(depth(star, now[t], k), 1e-3 * meshes::size(star.delaunay.sites()));
      }
    }
  }
  EXPECT_NEAR(volume, hull, 1e-10 * hull);
}
}

TEST(CosphericalStars, ABoxIsDividedFromItsMeanAndThoseOfItsFaces)
{
  const Star star(meshes::hexes(1, 1, 1).points);
  EXPECT_EQ(star.delaunay.tetrahedra().size(), 24u);
  ASSERT_EQ(star.numberOfMeans(), 7);
  EXPECT_EQ(star.means.values.size(), 6u * 4 + 8);
  for (Index m = 0; m < 7; ++m)
  {
    const bool isCell = star.means.end(m) - star.means.begin(m) == 8;
    const Row place = star.delaunay.sites().row(8 + m);
    EXPECT_NEAR((place.array() - .5).matrix().norm(), isCell ? 0 : .5, 1e-15);
  }
  expectTessellation(star);
}

TEST(CosphericalStars, AnOctahedronKeepsItsFaces)
{
  Points corners(6, 3);
  corners << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  const Star star(corners);
  EXPECT_EQ(star.delaunay.tetrahedra().size(), 8u);
  EXPECT_EQ(star.numberOfMeans(), 1);
  expectTessellation(star);
}

TEST(CosphericalStars, SitesWithoutTiesKeepTheirTetrahedra)
{
  std::mt19937 generator(meshes::seed());
  const Star star(random(200, generator));
  EXPECT_EQ(star.numberOfMeans(), 0);
  ASSERT_EQ(star.delaunay.tetrahedra().size(), star.before.size());
  for (std::size_t t = 0; t < star.before.size(); ++t)
  {
    EXPECT_EQ(star.delaunay.tetrahedra()[t].sites, star.before[t].sites);
  }
}

TEST(CosphericalStars, ManySitesOnOneSphereAreOneCell)
{
  // Along a spiral they lie evenly, and no four in one plane.
  Points sites(3000, 3);
  for (Index i = 0; i < sites.rows(); ++i)
  {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(sites.rows());
    const double angle = 2.399963229728653 * static_cast<double>(i);
    const double r = std::sqrt(1 - z * z);
    sites.row(i) << r * std::cos(angle), r * std::sin(angle), z;
  }
  const Star star(sites);
  EXPECT_EQ(star.numberOfMeans(), 1);
  EXPECT_EQ(star.delaunay.tetrahedra().size(), 2u * 3000 - 4); // Euler's formula
  expectTessellation(star);
}

TEST(CosphericalStars, FillTheHullOfTurnedLatticesAndCylinders)
{
  std::mt19937 generator(meshes::seed());
  for (const Mesh& mesh :
    { meshes::hexes(6, 6, 6), meshes::hexes(5, 3, 9), shapes::cylinder(6, 8, 8 / 3.) })
  {
    const std::vector<Index> outer = motions::outerPartition(mesh).prescribed;
    for (int trial = 0; trial < 5; ++trial)
    {
      const Points sites = meshes::rows(mesh.points, outer) * rotation(generator);
      const Star star(sites);
      EXPECT_GT(star.numberOfMeans(), 10);
      expectTessellation(star);
      // A place that a walk finds is in the tetrahedron where it ends.
      const Points places = random(200, generator) * 0.1;
      const Row middle =
        (star.delaunay.sites().colwise().minCoeff() + star.delaunay.sites().colwise().maxCoeff()) /
        2;
      for (Index i = 0; i < places.rows(); ++i)
      {
        const Row x = middle + places.row(i);
        const auto& found =
          star.delaunay.tetrahedra()[star.delaunay.locate(x, star.delaunay.startNear(x))];
        Points corners = star.delaunay.sites();
        const double whole = Delaunay::sixVolumes(found, corners);
        for (int k = 0; k < 4; ++k)
        {
          corners = star.delaunay.sites();
          corners.row(found.sites[k]) = x;
          EXPECT_GE(Delaunay::sixVolumes(found, corners), -1e-9 * whole);
        }
      }
    }
  }
}

// Its pyramids are so flat that some overlap.
TEST(CosphericalStars, EachWalkEndsInAFlatLattice)
{
  std::mt19937 generator(meshes::seed());
  std::uniform_real_distribution<double> value(0, 1);
  const Mesh mesh = meshes::hexes(2, 2, 2);
  const std::vector<Index> outer = motions::outerPartition(mesh).prescribed;
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Row stretch(std::pow(10, 5 * value(generator)), std::pow(10, 4 * value(generator)), 1);
    const Eigen::Matrix3d map = stretch.asDiagonal() * rotation(generator);
    const Star star(meshes::rows(mesh.points, outer) * map);
    const Points places = (random(8, generator).array() + 1).matrix() * map;
    for (Index i = 0; i < places.rows(); ++i)
    {
      const Row x = places.row(i) - star.delaunay.origin();
      const int found = star.delaunay.locate(x, star.delaunay.startNear(x));
      ASSERT_TRUE(found >= 0 && found < static_cast<int>(star.delaunay.tetrahedra().size()));
    }
  }
}

// Tetrahedra of coplanar sites lie in the sides of the box, flat to rounding.
TEST(CosphericalStars, NodesInTheSidesOfATurnedBoxAreFound)
{
  const Mesh mesh = meshes::hexes(4, 2, 2);
  const std::vector<Index> outer = motions::outerPartition(mesh).prescribed;
  std::mt19937 generator(21); // at trial 300 a walk ends in a flat tetrahedron
  for (int trial = 0; trial < 1000; ++trial)
  {
    if (trial == 500)
    {
      generator.seed(meshes::seed());
    }
    const Points points = mesh.points * rotation(generator);
    std::vector<Index> sites, places;
    for (const Index node : outer)
    {
      const Row x = mesh.points.row(node);
      const bool isCorner = (x.array() == 0 || x.array() == Row(4, 2, 2).array()).all();
      (isCorner || generator() % 4 > 0 ? sites : places).push_back(node);
    }
    const Star star(meshes::rows(points, sites));
    Monitor monitor;
    const PointLocation found = locatePoints(star.delaunay, points, places, monitor);
    EXPECT_TRUE(found.extrapolated.empty())
      << "trial " << trial << ", seed " << meshes::seed() << "\n"
      << found.barycentric;
  }
}

// As a mesher places nodes on a turned solid: each ring a little off its plane. A tetrahedron of
// four nodes of a ring is flat.
TEST(CosphericalStars, FlatTetrahedraInsideDoNotPartTheirNeighbors)
{
  std::mt19937 generator(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  for (const auto& [around, noise] :
    { std::make_pair(16, 1e-5), std::make_pair(16, 1e-6), std::make_pair(62, 1e-4) })
  {
    constexpr int Rings = 10;
    const double angle = std::atan(1.) * 8 / around, spacing = 0.87 * angle;
    Points sites(around * Rings, 3);
    for (int i = 0; i < sites.rows(); ++i)
    {
      const int ring = i / around;
      const double u = angle * (i % around + 0.5 * (ring % 2) + 0.3 * value(generator));
      const bool isEnd = ring == 0 || ring + 1 == Rings; // in one plane
      sites.row(i) << std::cos(u), std::sin(u),
        spacing * ring + (isEnd ? 0 : noise * value(generator));
    }
    const Star star(sites);
    EXPECT_GT(star.numberOfMeans(), 0);
    expectTessellation(star, 1e-6); // faces are plane to that
    // A walk comes from each site to a place inside.
    const Row x = Row(0.1, 0.03, 0.55 * spacing * Rings) - star.delaunay.origin();
    for (Index i = 0; i < sites.rows(); ++i)
    {
      const int start = star.delaunay.startNear(star.delaunay.sites().row(i));
      const auto& found = star.delaunay.tetrahedra()[star.delaunay.locate(x, start)];
      for (int k = 0; k < 4; ++k)
      {
        Points corners = star.delaunay.sites();
        corners.row(found.sites[k]) = x;
        ASSERT_GE(Delaunay::sixVolumes(found, corners), -1e-12);
      }
    }
  }
}

TEST(CosphericalStars, ThreadsDoNotShow)
{
  // A lattice with enough sites, tetrahedra and cells for several threads, and turned, as rounding
  // then has a say.
  std::mt19937 generator(meshes::seed());
  const Points sites = meshes::hexes(17, 17, 17).points * rotation(generator);
  const Star one(sites);
  Delaunay delaunay;
  meshes::ThreadedMonitor monitor(3);
  delaunay.build(sites, monitor);
  const Adjacency means = starCosphericalCells(delaunay, monitor);
  EXPECT_GT(one.numberOfMeans(), 4096);
  EXPECT_EQ(means.offsets, one.means.offsets);
  EXPECT_EQ(means.values, one.means.values);
  EXPECT_TRUE(delaunay.sites() == one.delaunay.sites());
  ASSERT_EQ(delaunay.tetrahedra().size(), one.delaunay.tetrahedra().size());
  for (std::size_t t = 0; t < delaunay.tetrahedra().size(); ++t)
  {
    const auto &own = delaunay.tetrahedra()[t], &other = one.delaunay.tetrahedra()[t];
    ASSERT_EQ(own.sites, other.sites);
    ASSERT_EQ(own.neighbors, other.neighbors);
  }
}

TEST(CosphericalStars, SimplexLinearFollowsAnyRotation)
{
  std::mt19937 generator(meshes::seed());
  for (const auto& [name, mesh] : { std::make_pair("cube", meshes::hexes(12, 12, 12)),
         std::make_pair("box", meshes::hexes(5, 7, 4)),
         std::make_pair("cylinder", shapes::cylinder(8, 10, 2.5)) })
  {
    const NodePartition partition = motions::outerPartition(mesh);
    const double size = meshes::size(mesh.points);
    const double width = mesh.points.col(0).maxCoeff(), height = mesh.points.col(2).maxCoeff();
    const Points target = motions::targets(
      mesh, partition, [=](const Row& x) { return motions::twist(x, width, height, 1.2); });
    const Points reference = morphed(mesh, partition, target);
    double most = 0;
    for (int trial = 0; trial < 10; ++trial)
    {
      const Eigen::Matrix3d R = rotation(generator);
      const motions::Map rigid = [&](const Row& x) { return Row(x * R + Row(4, -3, 8)); };
      Mesh turned = mesh;
      meshes::transform(turned, rigid);
      const Points result = morphed(turned, partition, motions::mapped(target, rigid));
      most = std::max(most, motions::difference(result, motions::mapped(reference, rigid)) / size);
    }
    EXPECT_LT(most, 1e-8) << name;
  }
}
