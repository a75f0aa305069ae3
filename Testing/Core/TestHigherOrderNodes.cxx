// SPDX-License-Identifier: BSD-3-Clause
// Where mid-side nodes of single cells go, flat and nearly flat ones as well.
#include "Mesh/CellShape.h"
#include "Mesh/HigherOrderNodes.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cstdlib>

namespace
{
using namespace morph;

using Corners = Eigen::Matrix<double, 5, 3>;

/// Its mid-side nodes divide their edges at `part`.
Mesh pyramid(const Corners& corners, double part)
{
  Mesh mesh;
  mesh.points.resize(13, 3);
  mesh.points.topRows(5) = corners;
  const int edges[8][2] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 }, { 2, 4 },
    { 3, 4 } };
  for (int k = 0; k < 8; ++k)
  {
    mesh.points.row(5 + k) =
      (1 - part) * corners.row(edges[k][0]) + part * corners.row(edges[k][1]);
  }
  meshes::add(mesh, morph::QuadraticPyramid, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 });
  return mesh;
}

/// Over the unit square.
Corners upTo(double height)
{
  Corners corners;
  corners << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.1, 0.2, height;
  return corners;
}

/// The displacement of all nodes by that of the corners.
Points followed(const Mesh& mesh, Points displacement)
{
  morph::HigherOrderNodes nodes;
  nodes.prepare(mesh, morph::partitionNodes(mesh, { 0, 1, 2, 3, 4 }));
  nodes.apply(displacement);
  return displacement;
}

Points cornersAtRandom()
{
  std::srand(meshes::seed());
  Points displacement = Points::Zero(13, 3);
  displacement.topRows(5).setRandom();
  return displacement;
}
}

TEST(HigherOrderNodes, DivideTheMotionOfTheirEdgeEvenInFlatPyramids)
{
  for (const double height : { 1., 1e-3, 1e-6, 1e-9, 0., -0.3 })
  {
    const Points corners = cornersAtRandom();
    const Points moved = followed(pyramid(upTo(height), 0.25), corners);
    for (int side = 0; side < 4; ++side)
    {
      const motions::Row first = corners.row(side), apex = corners.row(4);
      EXPECT_LT((moved.row(9 + side) - 0.75 * first - 0.25 * apex).norm(), 1e-9) << height;
    }
  }
}

TEST(HigherOrderNodes, MoveAlikeInEveryFrame)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  for (int i = 0; i < 2000; ++i)
  {
    std::srand(meshes::seed() + i);
    Mesh mesh = pyramid(upTo(0.5) + 0.5 * Corners::Random(), 0.5);
    const Points corners = cornersAtRandom();
    const Points moved = followed(mesh, corners);
    mesh.points = (1e-3 * mesh.points * turn).rowwise() + motions::Row(1e3, -2e3, 3e3);
    EXPECT_LT((followed(mesh, corners) - moved).norm(), 1e-7);
  }
}

TEST(HigherOrderNodes, InTheMiddleOfNearlyFlatFacesTheyMoveByTheMean)
{
  const int faces[6][4] = { { 0, 4, 7, 3 }, { 1, 2, 6, 5 }, { 0, 1, 5, 4 }, { 3, 7, 6, 2 },
    { 0, 3, 2, 1 }, { 4, 5, 6, 7 } }; // of VTK's nodes 20 to 25
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  for (const double uneven : { 0., 1e-12, 1e-9, 1e-7, 1e-5, 1e-3 })
  {
    Mesh mesh = meshes::quadraticHexes(1, 1, 1, true);
    const std::vector<Index> cell(mesh.cell(0), mesh.cell(0) + 27);
    const std::vector<Index> corners(cell.begin(), cell.begin() + 8);
    mesh.points.row(cell[6]) += motions::Row(uneven, uneven, uneven); // opposite corners
    mesh.points.row(cell[0]) += motions::Row(uneven, uneven, uneven);
    mesh.points = mesh.points * turn;
    std::srand(meshes::seed());
    Points displacement = Points::Zero(27, 3);
    displacement(corners, morph::allColumns) = Points::Random(8, 3);
    morph::HigherOrderNodes nodes;
    nodes.prepare(mesh, morph::partitionNodes(mesh, corners));
    nodes.apply(displacement);
    for (int side = 0; side < 6; ++side)
    {
      motions::Row mean = motions::Row::Zero();
      for (const int corner : faces[side])
      {
        mean += displacement.row(cell[corner]) / 4;
      }
      EXPECT_LT((displacement.row(cell[20 + side]) - mean).norm(), 1e-9 + 3 * uneven) << uneven;
    }
  }
}

TEST(HigherOrderNodes, OffTheirEdgeTheyFollowAffineMotionsOfThinCells)
{
  for (const double height : { 1., 1e-2, 1e-4 })
  {
    Mesh mesh = pyramid(upTo(height), 0.5);
    std::srand(meshes::seed());
    mesh.points.bottomRows(8) += 0.2 * Points::Random(8, 3);
    const Points expected = motions::mapped(mesh.points, motions::affine) - mesh.points;
    Points corners = expected;
    corners.bottomRows(8).setZero();
    EXPECT_LT((followed(mesh, corners) - expected).norm(), 1e-7) << height;
  }
}
