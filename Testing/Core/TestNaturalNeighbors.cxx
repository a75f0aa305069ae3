// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/NaturalNeighbors.h"

#include "Meshes.h"
#include "Motions.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/natural_neighbor_coordinates_3.h>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <random>

using namespace morph;

namespace
{
using Row = Eigen::RowVector3d;

/// Another implementation.
class Reference
{
public:
  explicit Reference(const Points& sites)
    : count_(sites.rows())
  {
    std::vector<std::pair<Point, int>> points;
    for (Index i = 0; i < sites.rows(); ++i)
    {
      points.emplace_back(Point(sites(i, 0), sites(i, 1), sites(i, 2)), static_cast<int>(i));
    }
    this->triangulation_.insert(points.begin(), points.end());
  }

  /// One weight a site.
  Eigen::VectorXd weights(const Row& x) const
  {
    std::vector<std::pair<Triangulation::Vertex_handle, double>> found;
    double norm = 0;
    const Point q(x[0], x[1], x[2]);
    EXPECT_TRUE(CGAL::sibson_natural_neighbor_coordinates_3(
      this->triangulation_, q, std::back_inserter(found), norm)
                  .third);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(this->count_);
    for (const auto& [vertex, weight] : found)
    {
      result[vertex->info()] += weight / norm;
    }
    return result;
  }

private:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Point = Kernel::Point_3;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
  Index count_;
  Triangulation triangulation_;
};

struct Diagram
{
  explicit Diagram(const Points& sites)
  {
    Monitor monitor;
    this->delaunay.build(sites, monitor);
    this->neighbors = NaturalNeighbors(this->delaunay, monitor);
  }

  /// One weight a site; empty where there are none.
  Eigen::VectorXd weights(const Row& x) const
  {
    NaturalNeighbors::Workspace work(this->neighbors);
    const int inside = this->delaunay.locate(x, this->delaunay.startNear(x));
    if (!this->neighbors.compute(x, inside, work))
    {
      return {};
    }
    Eigen::VectorXd result = Eigen::VectorXd::Zero(this->delaunay.sites().rows());
    for (std::size_t i = 0; i < work.sites.size(); ++i)
    {
      result[work.sites[i]] = work.weights[i];
    }
    return result;
  }

  Delaunay delaunay;
  NaturalNeighbors neighbors;
};

Points cube()
{
  return meshes::hexes(1, 1, 1).points;
}

Points randomSites(Index n)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(0, 1);
  Points sites(n + 8, 3);
  sites = sites.unaryExpr([&](double) { return value(random); });
  sites.topRows(8) = cube();
  return sites;
}
}

TEST(NaturalNeighbors, AgreeWithAnotherImplementation)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(.1, .9);
  const Points sites = randomSites(60);
  const Diagram diagram(sites);
  const Reference reference(sites);
  for (int i = 0; i < 60; ++i)
  {
    const Row x(value(random), value(random), value(random));
    const Eigen::VectorXd found = diagram.weights(x);
    ASSERT_EQ(found.size(), sites.rows());
    EXPECT_LT((found - reference.weights(x)).cwiseAbs().maxCoeff(), 1e-8) << x;
  }
}

TEST(NaturalNeighbors, KnownValues)
{
  const Diagram box(cube());
  Points corners(6, 3);
  corners << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  const Diagram octahedron(corners);
  EXPECT_LT((box.weights(Row(.5, .5, .5)).array() - 1. / 8).abs().maxCoeff(), 1e-14);
  EXPECT_LT((octahedron.weights(Row(0, 0, 0)).array() - 1. / 6).abs().maxCoeff(), 1e-14);
  const Eigen::VectorXd atSite = box.weights(cube().row(5));
  EXPECT_EQ(atSite, Eigen::VectorXd::Unit(8, 5));
  // All corners of a box lie on one sphere: trilinear weights have the same symmetries, and these
  // differ.
  const Eigen::VectorXd weights = box.weights(Row(.5, .5, .25));
  EXPECT_NEAR(weights.head<4>().maxCoeff(), weights.head<4>().minCoeff(), 1e-14);
  EXPECT_NEAR(weights.head<4>().sum(), .75, 1e-14);
}

TEST(NaturalNeighbors, ReproduceLinearFieldsAndAreNotNegative)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(.01, .99);
  for (const Points& sites : { randomSites(150), Points(meshes::hexes(5, 5, 5).points / 5) })
  {
    const Diagram diagram(sites);
    for (int i = 0; i < 200; ++i)
    {
      const Row x(value(random), value(random), value(random));
      const Eigen::VectorXd weights = diagram.weights(x);
      ASSERT_EQ(weights.size(), sites.rows()) << x;
      EXPECT_NEAR(weights.sum(), 1, 1e-14);
      EXPECT_LT((weights.transpose() * sites - x).norm(), 1e-14);
      EXPECT_GE(weights.minCoeff(), -1e-8);
    }
  }
}

// The place is on the spheres of many tetrahedra, in whatever position the box is.
TEST(NaturalNeighbors, TheCenterOfATurnedBoxHasThem)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  const Points lattice = meshes::hexes(2, 2, 2).points.rowwise() - Row(1, 1, 1);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Eigen::Vector3d axis(value(random), value(random), value(random));
    const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(3 * value(random), axis.normalized()).toRotationMatrix();
    const Points box = lattice * Row(1.2, 1.4, 1).asDiagonal() * turn * (2 + value(random));
    Points sites(26, 3);
    sites << box.topRows(13), box.bottomRows(13);
    const Eigen::VectorXd weights = Diagram(sites).weights(box.row(13));
    ASSERT_EQ(weights.size(), 26) << turn;
    EXPECT_LT((weights - weights.reverse()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(NaturalNeighbors, AreContinuous)
{
  // Through a face of a lattice's cells, where the tessellation changes.
  const Points sites = meshes::hexes(4, 4, 4).points;
  const Diagram diagram(sites);
  const Row x(2.3, 1.6, 2);
  const Eigen::VectorXd on = diagram.weights(x);
  for (double step : { -1e-6, 1e-6 })
  {
    EXPECT_LT((diagram.weights(x + Row(0, 0, step)) - on).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(NaturalNeighbors, InASideOfTheHullTheyAreTheLimitFromInside)
{
  // Of four corners on a circle: no diagonal counts, and no site behind.
  const Eigen::VectorXd center = Diagram(cube()).weights(Row(.5, .5, 0));
  const Points corners = cube();
  for (Index i = 0; i < corners.rows(); ++i)
  {
    EXPECT_NEAR(center[i], corners(i, 2) == 0 ? .25 : 0, 1e-14);
  }
  const Diagram diagram(meshes::hexes(4, 4, 4).points);
  const Row x(2.3, 1.6, 0);
  const Eigen::VectorXd on = diagram.weights(x);
  EXPECT_LT((diagram.weights(x + Row(0, 0, 1e-6)) - on).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(NaturalNeighbors, ThereAreNoneOnEdgesOfTheHullAndOutside)
{
  const Diagram diagram(cube());
  for (const Row& x : { Row(.5, 0, 0), Row(.5, .5, 2) })
  {
    EXPECT_EQ(diagram.weights(x).size(), 0) << x;
  }
}
