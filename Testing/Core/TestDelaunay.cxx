// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/Delaunay.h"

#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

using namespace morph;

namespace
{
using Row = Eigen::RowVector3d;

Points randomPoints(Index n)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(0, 1);
  Points points(n, 3);
  return points.unaryExpr([&](double) { return value(random); });
}

Points lattice(int n)
{
  return meshes::hexes(n, n, n).points;
}

/// Two rings of n sites: every four of a plane and every pair of opposite edges are cospherical.
Points rings(int n)
{
  Points points(2 * n, 3);
  for (int i = 0; i < n; ++i)
  {
    const double angle = 2 * 3.14159265358979 * i / n;
    points.row(i) = Row(std::cos(angle), std::sin(angle), 0);
    points.row(n + i) = Row(std::cos(angle), std::sin(angle), .25);
  }
  return points;
}

/// Sites on a slightly warped square, and few off it: most tetrahedra are slivers.
Points sliverSites()
{
  Points points = randomPoints(200);
  points.col(2) = 1e-9 * (points.col(0).array() * points.col(1).array()).matrix();
  points.row(0) = Row(.5, .5, 1);
  points.row(1) = Row(.4, .3, -1);
  return points;
}

std::vector<std::pair<std::string, Points>> siteSets()
{
  return { { "random", randomPoints(120) }, { "lattice", lattice(3) }, { "rings", rings(24) },
    { "slivers", sliverSites() } };
}

Delaunay built(const Points& sites)
{
  Monitor monitor;
  Delaunay delaunay;
  delaunay.build(sites, monitor);
  return delaunay;
}

/// Below 0 where `e` lies inside the sphere through the corners of a positively oriented
/// tetrahedron.
long double outsideSphere(
  const Delaunay::Tetrahedron& tetrahedron, const Points& sites, const Row& e)
{
  Eigen::Matrix<long double, 4, 4> m;
  for (int k = 0; k < 4; ++k)
  {
    const auto d =
      (sites.row(tetrahedron.sites[k]).cast<long double>() - e.cast<long double>()).eval();
    m.row(k) << d, d.squaredNorm();
  }
  const auto minor = [&m](int row)
  {
    Eigen::Matrix<long double, 3, 3> s;
    for (int k = 0, at = 0; k < 4; ++k)
    {
      if (k != row)
      {
        s.row(at++) = m.row(k).head<3>();
      }
    }
    return s.determinant();
  };
  long double sum = 0;
  for (int k = 0; k < 4; ++k)
  {
    sum += (k % 2 ? 1 : -1) * m(k, 3) * minor(k);
  }
  return sum;
}

Eigen::RowVector4d barycentric(const Delaunay& delaunay, int id, const Row& x)
{
  Eigen::Matrix4d m;
  for (int k = 0; k < 4; ++k)
  {
    m.col(k) << delaunay.sites().row(delaunay.tetrahedra()[id].sites[k]).transpose(), 1;
  }
  return m.fullPivLu().solve(Eigen::Vector4d(x[0], x[1], x[2], 1)).transpose();
}

double volume(const Delaunay& delaunay)
{
  double sum = 0;
  for (const auto& tetrahedron : delaunay.tetrahedra())
  {
    sum += Delaunay::sixVolumes(tetrahedron, delaunay.sites()) / 6;
  }
  return sum;
}

/// Each tetrahedron by its corners' coordinates, sorted.
std::set<std::vector<std::array<double, 3>>> byCoordinates(const Delaunay& delaunay)
{
  std::set<std::vector<std::array<double, 3>>> result;
  for (const auto& tetrahedron : delaunay.tetrahedra())
  {
    std::vector<std::array<double, 3>> corners;
    for (int site : tetrahedron.sites)
    {
      const Row x = delaunay.sites().row(site);
      corners.push_back({ x[0], x[1], x[2] });
    }
    std::sort(corners.begin(), corners.end());
    result.insert(corners);
  }
  return result;
}
}

TEST(Delaunay, SpheresAreEmpty)
{
  // The test itself: the center of a tetrahedron is inside, a far point is not.
  Points corners(4, 3);
  corners << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const Delaunay::Tetrahedron one{ { 0, 1, 2, 3 }, {} };
  ASSERT_GT(Delaunay::sixVolumes(one, corners), 0);
  ASSERT_LT(outsideSphere(one, corners, Row(.4, .4, .4)), 0);
  ASSERT_GT(outsideSphere(one, corners, Row(2, 0, 0)), 0);

  for (const auto& [name, sites] : siteSets())
  {
    const Delaunay delaunay = built(sites);
    const bool whole = name == "lattice"; // whole numbers: no rounding
    for (const auto& tetrahedron : delaunay.tetrahedra())
    {
      for (Index i = 0; i < sites.rows(); ++i)
      {
        ASSERT_GE(outsideSphere(tetrahedron, sites, sites.row(i)), whole ? 0 : -1e-17) << name;
      }
    }
  }
}

TEST(Delaunay, TetrahedraFillTheHullOnceAndKnowTheirNeighbors)
{
  for (const auto& [name, sites] : siteSets())
  {
    const Delaunay delaunay = built(sites);
    const auto& tetrahedra = delaunay.tetrahedra();
    std::set<int> used;
    for (int t = 0; t < static_cast<int>(tetrahedra.size()); ++t)
    {
      EXPECT_GT(Delaunay::sixVolumes(tetrahedra[t], sites), -1e-17) << name;
      used.insert(tetrahedra[t].sites.begin(), tetrahedra[t].sites.end());
      for (int k = 0; k < 4; ++k)
      {
        const int other = tetrahedra[t].neighbors[k];
        if (other == Delaunay::Outside)
        {
          // A face of the hull: every site is on its inner side.
          Delaunay::Tetrahedron cap = tetrahedra[t];
          for (Index i = 0; i < sites.rows(); ++i)
          {
            cap.sites[k] = static_cast<int>(i);
            ASSERT_GT(Delaunay::sixVolumes(cap, sites), -1e-15) << name;
          }
          continue;
        }
        const auto& back = tetrahedra[other].neighbors;
        const auto at = std::find(back.begin(), back.end(), t) - back.begin();
        ASSERT_LT(at, 4) << name;
        std::array<int, 4> mine = tetrahedra[t].sites, theirs = tetrahedra[other].sites;
        mine[k] = theirs[at] = -1;
        std::sort(mine.begin(), mine.end());
        std::sort(theirs.begin(), theirs.end());
        EXPECT_EQ(mine, theirs) << name;
      }
    }
    EXPECT_EQ(static_cast<Index>(used.size()), sites.rows()) << name;
  }
  EXPECT_NEAR(volume(built(lattice(4))), 64, 1e-12);
  const double disc = 12 * std::sin(2 * 3.14159265358979 / 24); // a polygon of 24 corners
  EXPECT_NEAR(volume(built(rings(24))), .25 * disc, 1e-12);
}

TEST(Delaunay, WalksFromAnywhereEndInATetrahedronThatContains)
{
  std::mt19937 random(meshes::seed());
  for (const auto& [name, sites] : siteSets())
  {
    const Delaunay delaunay = built(sites);
    const int n = static_cast<int>(delaunay.tetrahedra().size());
    std::uniform_int_distribution<int> any(0, n - 1), kind(0, 3);
    std::exponential_distribution<double> weight(1);
    for (int i = 0; i < 400; ++i)
    {
      // Inside a tetrahedron, or on one of its faces, edges or corners.
      const auto& corners = delaunay.tetrahedra()[any(random)].sites;
      Eigen::RowVector4d b(weight(random), weight(random), weight(random), weight(random));
      b.tail(kind(random)).setZero();
      b /= b.sum();
      Row x = Row::Zero();
      for (int k = 0; k < 4; ++k)
      {
        x += b[k] * sites.row(corners[k]);
      }
      for (int start : { delaunay.startNear(x), any(random), any(random) })
      {
        const int found = delaunay.locate(x, start);
        ASSERT_GE(found, 0);
        ASSERT_LT(found, n);
        // In a sliver rounding alone is worth many of its heights.
        const double tolerance = name == "slivers" ? 1e-5 : 1e-12;
        EXPECT_GT(barycentric(delaunay, found, x).minCoeff(), -tolerance) << name;
      }
    }
  }
}

TEST(Delaunay, WalksToPointsOutsideEndAtTheHull)
{
  std::mt19937 random(meshes::seed());
  std::normal_distribution<double> value(0, 1);
  for (const auto& [name, sites] : siteSets())
  {
    const Delaunay delaunay = built(sites);
    std::uniform_int_distribution<int> any(0, static_cast<int>(delaunay.tetrahedra().size()) - 1);
    const Row middle = sites.colwise().mean();
    for (int i = 0; i < 100; ++i)
    {
      const Row x = middle + 10 * meshes::size(sites) *
                               Row(value(random), value(random), value(random)).normalized();
      const int found = delaunay.locate(x, any(random));
      const auto& neighbors = delaunay.tetrahedra()[found].neighbors;
      const Eigen::RowVector4d b = barycentric(delaunay, found, x);
      bool beyondHull = false;
      for (int k = 0; k < 4; ++k)
      {
        beyondHull |= neighbors[k] == Delaunay::Outside && b[k] < 0;
      }
      EXPECT_TRUE(beyondHull) << name;
    }
  }
}

TEST(Delaunay, TheOrderOfTheSitesDoesNotMatter)
{
  for (const auto& [name, sites] : siteSets())
  {
    const std::vector<Index> order = motions::shuffledNumbers(sites.rows());
    const Points shuffled = meshes::rows(sites, order);
    EXPECT_EQ(byCoordinates(built(shuffled)), byCoordinates(built(sites))) << name;
  }
}

TEST(Delaunay, SitesInAPlaneAreRefused)
{
  Points plane = randomPoints(30);
  plane.col(1).setConstant(.25);
  Points line = randomPoints(30);
  line.col(1) = line.col(0);
  line.col(2) = line.col(0);
  for (const Points& sites : { plane, line, Points(plane.topRows(3)), Points(plane.topRows(1)) })
  {
    motions::expectError(
      Error::Kind::Singular, [&] { built(sites); },
      std::to_string(sites.rows()) + " distinct places");
  }
}

TEST(Delaunay, FourSitesAreOneTetrahedron)
{
  Points sites(4, 3);
  sites << 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1;
  const Delaunay delaunay = built(sites);
  ASSERT_EQ(delaunay.tetrahedra().size(), 1u);
  EXPECT_EQ(Delaunay::sixVolumes(delaunay.tetrahedra()[0], sites), 1);
  EXPECT_EQ(delaunay.locate(Row(.1, .1, .1), delaunay.startNear(Row(9, 9, 9))), 0);
  for (int neighbor : delaunay.tetrahedra()[0].neighbors)
  {
    EXPECT_EQ(neighbor, Delaunay::Outside);
  }
}
