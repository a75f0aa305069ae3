// SPDX-License-Identifier: BSD-3-Clause
// What is particular to simplex-linear; TestMorphFilters.cxx has what it shares with the other
// filters.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkSimplexLinearMorph.h"

#include <gtest/gtest.h>

#include <cmath>

TEST(SimplexLinearMorph, FoldedTetrahedraComeWithInvertedCells)
{
  auto grid = grids::hexes(6);
  auto filter = grids::of<vtkSimplexLinearMorph>(grid);
  const auto turned = [](double degrees)
  {
    return [degrees](const grids::Row& x)
    {
      const double a = degrees * 3.14159265358979 / 180 * x[2] / 6;
      const double c = std::cos(a), s = std::sin(a);
      return grids::Row(
        3 + c * (x[0] - 3) - s * (x[1] - 3), 3 + s * (x[0] - 3) + c * (x[1] - 3), x[2]);
    };
  };
  filter->SetBoundaryData(grids::boundary(grid, turned(20)));
  filter->Update();
  EXPECT_EQ(filter->GetFoldedTetrahedra(), 0);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  filter->SetBoundaryData(grids::boundary(grid, turned(270)));
  filter->Update();
  EXPECT_GT(filter->GetFoldedTetrahedra(), 0);
  EXPECT_GT(filter->GetInvertedCells(), 0);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
}

TEST(SimplexLinearMorph, PrescribedNodesInOnePlaneAreOneError)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  std::vector<morph::Index> bottom;
  for (morph::Index i = 0; i < 16; ++i)
  {
    bottom.push_back(i);
  }
  auto boundary = grids::cloud(meshes::rows(grids::points(grid), bottom));
  grids::addIds(boundary, "MorphPointId", bottom);
  auto filter = grids::morphed<vtkSimplexLinearMorph>(grid, boundary);
  filter->FixUnnamedBoundaryOff();
  grids::expectError(filter, "one plane");
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
}
