// SPDX-License-Identifier: BSD-3-Clause
// What of the inverted cells a motion has made.
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/InvertedBefore.h"
#include "Quality/ValidRange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

using namespace morph;
using Row = Eigen::RowVector3d;

namespace
{
struct Case
{
  explicit Case(Mesh m)
    : mesh(std::move(m))
    , orientation(mesh.numberOfCells(), 1)
    , before(mesh, orientation, measureQuality(mesh, mesh.points, orientation, {}, monitor))
  {
  }
  std::vector<Index> added(const Points& points)
  {
    return this->before.added(
      points, invertedCells(this->mesh, points, this->orientation, this->monitor));
  }

  Monitor monitor;
  Mesh mesh;
  std::vector<std::int8_t> orientation;
  InvertedBefore before;
};

/// Two boxes in a row, the first of which is a hexahedron with two nodes twice: a wedge.
Mesh withWedge()
{
  Mesh mesh = meshes::hexes(2, 1, 1);
  mesh.connectivity[3] = mesh.connectivity[0];
  mesh.connectivity[7] = mesh.connectivity[4];
  return mesh;
}
}

TEST(InvertedBefore, AMotionThatKeepsTheOrientationAddsNothing)
{
  for (auto& [name, mesh] : meshes::all(3, 3, 3))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.9, meshes::seed());
    Case tangled(std::move(mesh));
    ASSERT_FALSE(tangled.before.cells().empty());
    EXPECT_EQ(tangled.before.cells(),
      invertedCells(tangled.mesh, tangled.mesh.points, tangled.orientation, tangled.monitor));
    EXPECT_TRUE(tangled.added(tangled.mesh.points).empty());
    // The scaled Jacobians change, some for the worse.
    EXPECT_TRUE(tangled
                  .added(motions::mapped(tangled.mesh.points, [](const Row& x)
                    { return Row(3 * x[0] + x[1], x[1] - 0.4 * x[2], 0.5 * x[2]); }))
                  .empty());
  }
}

TEST(InvertedBefore, WhatWasValidOrHasOneMoreInvertedCornerIsAdded)
{
  Mesh mesh = meshes::hexes(2, 1, 1);
  mesh.points.row(0) << 0.8, 0.8, 0.8; // the first cell's lowest corner
  Case pushed(std::move(mesh));
  ASSERT_EQ(pushed.before.cells(), std::vector<Index>{ 0 });
  EXPECT_EQ(pushed.before.without({ 0, 1 }), std::vector<Index>{ 1 });

  Points points = pushed.mesh.points;
  points.row(0) << 0.9, 0.9, 0.9; // the same corner, farther
  EXPECT_TRUE(pushed.added(points).empty());
  const double sheared = 1e11; // nearly flat, and not inverted
  points.col(0) += sheared * points.col(1);
  EXPECT_TRUE(pushed.added(points).empty());
  points.col(0) -= sheared * points.col(1);
  const Index top = pushed.mesh.cell(0)[6];
  points.row(top) << -0.2, -0.2, -0.2; // the opposite one, too, which both cells share
  EXPECT_EQ(pushed.added(points), (std::vector<Index>{ 0, 1 }));
}

TEST(InvertedBefore, ACollapsedHexahedronIsJudgedAsTheWedgeThatItIs)
{
  Case wedge(withWedge());
  ASSERT_EQ(wedge.before.cells(), std::vector<Index>{ 0 });
  Points points = wedge.mesh.points;
  points.col(2) *= 1e-3;
  EXPECT_TRUE(wedge.added(points).empty());
  points = wedge.mesh.points;
  points.row(wedge.mesh.cell(0)[5]) << 1, 0, -0.5; // an edge along z turns round
  EXPECT_EQ(wedge.added(points), (std::vector<Index>{ 0, 1 }));
}

TEST(InvertedBefore, AnEdgeThatRoundingMadeWasNotPositive)
{
  Mesh mesh = meshes::hexes(2, 1, 1);
  mesh.points.rowwise() += Row(1e6, 0, 0);
  const std::vector<Index> cell(mesh.cell(0), mesh.cell(0) + 8);
  const Row rounding(2e-10, 0, 0);
  mesh.points.row(cell[7]) = mesh.points.row(cell[6]) + rounding;
  mesh.points.row(cell[3]) = mesh.points.row(cell[2]) - rounding;
  Case wedge(std::move(mesh));
  ASSERT_EQ(wedge.before.cells(), std::vector<Index>{ 0 });
  Points points = wedge.mesh.points;
  points.row(cell[3]) = points.row(cell[2]) + rounding;
  EXPECT_TRUE(wedge.added(points).empty());
  points.row(cell[1]) -= Row(1.5, 0, 0); // an edge turns round
  EXPECT_EQ(wedge.added(points), (std::vector<Index>{ 0 }));
}

TEST(InvertedBefore, RangesLeaveOutWhatWasNotPositive)
{
  Case wedge(withWedge());
  Points first = Points::Zero(wedge.mesh.points.rows(), 3);
  first.col(2) = -.25 * wedge.mesh.points.col(2);
  const NodeMotion flattened = { &wedge.mesh.points, &first, {} };
  EXPECT_TRUE(validRange(wedge.mesh, flattened, {}, {}, wedge.monitor).isEmpty);
  const ValidRange range = validRange(wedge.mesh, flattened, {}, wedge.before, wedge.monitor);
  EXPECT_NEAR(range.highest, 4, 1e-11);
  EXPECT_EQ(range.highestCell, 0); // the wedge itself is among them

  // With a turn, which changes nothing.
  Points turn = Points::Zero(first.rows(), 3), back = turn;
  turn.col(0) = -wedge.mesh.points.col(1);
  turn.col(1) = wedge.mesh.points.col(0);
  back.leftCols(2) = -wedge.mesh.points.leftCols(2);
  const NodeMotion both = { &wedge.mesh.points, &first, { { &turn, &back, .5 } } };
  EXPECT_TRUE(std::isnan(validRange(wedge.mesh, both, {}, {}, wedge.monitor).highest));
  EXPECT_NEAR(validRange(wedge.mesh, both, {}, wedge.before, wedge.monitor).highest, 4, 1e-6);
}
