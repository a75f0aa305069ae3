// SPDX-License-Identifier: BSD-3-Clause
// What is particular to weighted residuals; TestMorphFilters.cxx has what they share with the other
// filters.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkWeightedResidualMorph.h"

#include <gtest/gtest.h>

namespace
{
morph::Points moved(vtkUnstructuredGrid* grid, int neighbors)
{
  auto filter = grids::morphed<vtkWeightedResidualMorph>(grid, grids::twist);
  filter->SetNumberOfNeighbors(neighbors);
  filter->Update();
  return grids::points(filter->GetOutput());
}
}

TEST(WeightedResidualMorph, OptionsReachTheMethod)
{
  auto grid = grids::hexes(6); // 218 prescribed nodes
  const morph::Points all = moved(grid, 218);
  EXPECT_TRUE(moved(grid, 100000) == all);
  EXPECT_FALSE(moved(grid, 80) == all);
  EXPECT_FALSE(moved(grid, 4) == moved(grid, 5));
}

TEST(WeightedResidualMorph, ABoundaryTurnedInsideOutIsAWarning)
{
  auto grid = grids::hexes(4);
  auto filter = grids::morphed<vtkWeightedResidualMorph>(
    grid, grids::boundary(grid, [](const grids::Row& x) { return grids::Row(x[0], x[1], -x[2]); }));
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  ASSERT_EQ(listener.Warnings.size(), 2u);
  EXPECT_NE(listener.Warnings[1].find("64 cells are inverted"), std::string::npos);
  EXPECT_NE(listener.Warnings[0].find("determinant -1"), std::string::npos) << listener.Warnings[0];
  EXPECT_EQ(filter->GetInvertedCells(), 64);
}
