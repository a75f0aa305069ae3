// SPDX-License-Identifier: BSD-3-Clause
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkLBWarpMorph.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>

#include <gtest/gtest.h>

namespace
{
/// A grid of 6 x 6 x 6 hexahedra with one node shifted out of its neighbors' hull.
vtkSmartPointer<vtkUnstructuredGrid> withNodeOutside()
{
  morph::Mesh mesh = meshes::hexes(6, 6, 6);
  mesh.points.row(171) += Eigen::RowVector3d(1.3, .1, .2);
  return grids::make(mesh);
}
}

TEST(LBWarpMorph, FreeNodesStayInTheBoundarysHull)
{
  auto grid = grids::hexes(6);
  auto boundary = grids::boundary(grid, grids::twist);
  auto filter = grids::morphed<vtkLBWarpMorph>(grid, boundary);
  filter->Update();
  EXPECT_GT(filter->GetSolverIterations(), 0);
  const morph::Points moved = grids::points(filter->GetOutput()), hull = grids::points(boundary);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_LE(moved.col(c).maxCoeff(), hull.col(c).maxCoeff());
    EXPECT_GE(moved.col(c).minCoeff(), hull.col(c).minCoeff());
  }
}

TEST(LBWarpMorph, OutsideHullIsAnErrorOrRelaxed)
{
  auto grid = withNodeOutside();
  auto filter = grids::morphed<vtkLBWarpMorph>(grid, grids::affine);
  EXPECT_EQ(filter->GetOutsideHull(), vtkLBWarpMorph::OUTSIDE_HULL_ERROR);
  {
    grids::expectError(filter, "node ids 171.");
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  }
  filter->SetOutsideHullToRelax();
  // A node outside its neighbors: cells are inverted, and that is not the point here.
  filter->SetValidityToNone();
  grids::expectWarning(filter, "171");
  EXPECT_EQ(filter->GetOutsideHullNodes(), 1);
  EXPECT_EQ(filter->GetTwoRingNodes(), 1);
  EXPECT_EQ(filter->GetAffineNodes(), 0);
  EXPECT_EQ(filter->GetStiffnessNodes(), 0);
  EXPECT_EQ(grids::field(filter->GetOutput(), "TwoRingNodes"), 1);
  EXPECT_LT((grids::points(filter->GetOutput()) - grids::mapped(grids::points(grid), grids::affine))
              .cwiseAbs()
              .maxCoeff(),
    1e-8);
}
