// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "Motions.h"

#include "Interpolation/InterpolationSites.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

using namespace morph;

namespace
{
std::vector<Index> allIds(Index n)
{
  std::vector<Index> ids(n);
  std::iota(ids.begin(), ids.end(), Index(0));
  return ids;
}

/// Points of a unit square lattice in the plane z = 0, turned in space; n x n of them.
Points plane(int n)
{
  Points points(n * n, 3);
  for (int i = 0; i < n * n; ++i)
  {
    const double u = i % n / double(n), v = i / n / double(n);
    points.row(i) << .6 * u, .8 * u, v;
  }
  return points;
}
}

TEST(InterpolationSites, EachBoundaryNodeOfAMeshIsASite)
{
  Monitor monitor;
  for (const auto& [name, mesh] : meshes::all(4, 3, 5))
  {
    const std::vector<Index> ids = boundaryFaces(mesh, monitor).nodes;
    const InterpolationSites sites(mesh.points, ids);
    ASSERT_EQ(sites.size(), static_cast<Index>(ids.size())) << name;
    std::set<Index> seen;
    for (Index s = 0; s < sites.size(); ++s)
    {
      ASSERT_EQ(sites.prescribed().end(s) - sites.prescribed().begin(s), 1) << name;
      const Index i = *sites.prescribed().begin(s);
      seen.insert(i);
      EXPECT_EQ(sites.siteOf()[i], s) << name;
      EXPECT_EQ(sites.coordinates().row(s), mesh.points.row(ids[i])) << name;
      if (s > 0)
      {
        const auto before = sites.coordinates().row(s - 1), here = sites.coordinates().row(s);
        EXPECT_TRUE(std::lexicographical_compare(
          before.data(), before.data() + 3, here.data(), here.data() + 3))
          << name;
      }
    }
    EXPECT_EQ(seen.size(), ids.size()) << name;
  }
}

TEST(InterpolationSites, NodesAtOnePlaceAreOneSite)
{
  const Points base = plane(20);
  const double size = meshes::size(base);
  Points points(3 * base.rows(), 3);
  for (Index i = 0; i < base.rows(); ++i)
  {
    points.row(3 * i) = base.row(i);
    points.row(3 * i + 1) = base.row(i);                        // exactly
    points.row(3 * i + 2) = base.row(i).array() + 4e-13 * size; // 7e-13 away
  }
  const InterpolationSites sites(points, allIds(points.rows()));
  ASSERT_EQ(sites.size(), base.rows());
  for (Index i = 0; i < points.rows(); ++i)
  {
    EXPECT_EQ(sites.siteOf()[i], sites.siteOf()[i - i % 3]);
  }
  // A little farther they are two.
  for (Index i = 0; i < base.rows(); ++i)
  {
    points.row(3 * i + 2) = base.row(i).array() + 1e-12 * size; // 1.7e-12 away
  }
  EXPECT_EQ(InterpolationSites(points, allIds(points.rows())).size(), 2 * base.rows());
}

TEST(InterpolationSites, ChainsOfNearNodesAreOneSite)
{
  Points points(6, 3);
  points.setZero();
  points(5, 0) = 1;
  for (Index i = 1; i < 5; ++i)
  {
    points(i, 1) = static_cast<double>(i) * .9e-12;
  }
  const InterpolationSites sites(points, { 4, 2, 0, 5, 3, 1 });
  ASSERT_EQ(sites.size(), 2);
  EXPECT_EQ(sites.coordinates(), (Points(2, 3) << 0, 0, 0, 1, 0, 0).finished());
  EXPECT_EQ(sites.siteOf(), (std::vector<Index>{ 0, 0, 0, 1, 0, 0 }));
}

TEST(InterpolationSites, AgreesWithComparingAllPairs)
{
  std::mt19937 random(meshes::seed());
  std::uniform_int_distribution<int> step(0, 4);
  for (int round = 0; round < 5; ++round)
  {
    // Clusters whose members lie 0 to 4 steps of 0.6e-12 apart: near, chained or separate.
    Points points = meshes::randomPoints(60, random);
    points.row(0) << -1, -1, -1;
    points.row(1) << 1, 1, 1;
    const double tolerance = 1e-12 * meshes::size(points);
    for (Index i = 2; i < points.rows(); ++i)
    {
      points.row(i) = points.row(i % 6);
      points(i, round % 3) += .6 * tolerance * step(random);
    }
    const InterpolationSites sites(points, allIds(points.rows()));
    std::vector<Index> group = allIds(points.rows());
    for (bool changed = true; changed;)
    {
      changed = false;
      for (Index i = 0; i < points.rows(); ++i)
      {
        for (Index j = 0; j < points.rows(); ++j)
        {
          if ((points.row(i) - points.row(j)).norm() <= sites.tolerance() && group[j] < group[i])
          {
            group[i] = group[j];
            changed = true;
          }
        }
      }
    }
    for (Index i = 0; i < points.rows(); ++i)
    {
      for (Index j = 0; j < points.rows(); ++j)
      {
        EXPECT_EQ(sites.siteOf()[i] == sites.siteOf()[j], group[i] == group[j]) << i << " " << j;
      }
    }
    EXPECT_EQ(sites.size(), static_cast<Index>(std::set<Index>(group.begin(), group.end()).size()));
  }
}

TEST(InterpolationSites, NumbersDoNotDependOnTheNodeNumbering)
{
  std::mt19937 random(meshes::seed());
  Points points = meshes::randomPoints(500, random);
  for (Index i = 400; i < 500; ++i)
  {
    points.row(i) =
      points.row(i - 400).array() + (i % 2 ? 1e-13 : 0.); // duplicates, some not exact
  }
  const InterpolationSites sites(points, allIds(500));
  ASSERT_EQ(sites.size(), 400);
  std::vector<Index> order = allIds(500);
  std::shuffle(order.begin(), order.end(), random);
  Points shuffled(500, 3);
  for (Index i = 0; i < 500; ++i)
  {
    shuffled.row(order[i]) = points.row(i);
  }
  const InterpolationSites again(shuffled, allIds(500));
  EXPECT_TRUE(motions::identical(sites.coordinates(), again.coordinates()));
  EXPECT_EQ(sites.tolerance(), again.tolerance());
  for (Index i = 0; i < 500; ++i)
  {
    EXPECT_EQ(sites.siteOf()[i], again.siteOf()[order[i]]);
  }
}

TEST(InterpolationSites, PlanarBoundariesAndPilesStayFast)
{
  // Quadratic work on these would take minutes.
  const Points lattice = plane(300);
  EXPECT_EQ(InterpolationSites(lattice, allIds(lattice.rows())).size(), 90000);
  Points pile = Points::Constant(200000, 3, .1);
  pile(7, 0) = 1;
  EXPECT_EQ(InterpolationSites(pile, allIds(pile.rows())).size(), 2);
}

TEST(InterpolationSites, ASinglePlaceIsASite)
{
  const InterpolationSites one(Points::Constant(3, 3, 5), { 1 });
  EXPECT_EQ(one.size(), 1);
  EXPECT_EQ(one.tolerance(), 0);
  EXPECT_EQ(InterpolationSites(Points::Constant(3, 3, 5), { 2, 0, 1 }).size(), 1);
  Points signs = Points::Zero(2, 3);
  signs(1, 1) = -0.;
  const InterpolationSites zero(signs, { 0, 1 });
  EXPECT_EQ(zero.size(), 1);
  EXPECT_FALSE(std::signbit(zero.coordinates()(0, 1)));
}

TEST(InterpolationSites, AverageIsTheMeanAndScatterItsAdjoint)
{
  std::mt19937 random(meshes::seed());
  Points points = meshes::randomPoints(90, random);
  for (Index i = 30; i < 90; ++i)
  {
    points.row(i) = points.row(i % 20);
  }
  std::vector<Index> ids = allIds(90);
  std::shuffle(ids.begin(), ids.end(), random);
  const InterpolationSites sites(points, ids);
  ASSERT_EQ(sites.size(), 30);
  const Points values = meshes::randomPoints(90, random);
  Monitor monitor;
  const Points mean = sites.average(values, monitor);
  Points expected = Points::Zero(30, 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(30);
  for (Index i = 0; i < 90; ++i)
  {
    expected.row(sites.siteOf()[i]) += values.row(i);
    count[sites.siteOf()[i]] += 1;
  }
  expected.array().colwise() /= count.array();
  EXPECT_LT((mean - expected).cwiseAbs().maxCoeff(), 1e-15);

  const Points gradient = meshes::randomPoints(30, random);
  Points scattered = Points::Ones(90, 3);
  sites.scatterTranspose(gradient, scattered);
  EXPECT_NEAR(gradient.cwiseProduct(mean).sum(),
    (scattered.array() - 1).matrix().cwiseProduct(values).sum(), 1e-13);

  // A node by itself keeps every bit.
  const InterpolationSites single(points, { 25, 27 });
  const Points pair = meshes::randomPoints(2, random);
  Points back = single.average(pair, monitor);
  EXPECT_EQ(back.row(single.siteOf()[0]), pair.row(0));
}

TEST(InterpolationSites, RefusesWhatItCannotUse)
{
  EXPECT_THROW(InterpolationSites(Points::Zero(3, 3), {}), Error);
  Points huge = Points::Zero(2, 3);
  huge(1, 0) = 1e200;
  EXPECT_THROW(InterpolationSites(huge, { 0, 1 }), Error);
  huge(1, 0) = 1e-200;
  EXPECT_THROW(InterpolationSites(huge, { 0, 1 }), Error);
}
