// SPDX-License-Identifier: BSD-3-Clause
// What is particular to natural neighbors; TestMorphFilters.cxx has what they share with the other
// filters.
#include "TestGrids.h"

#include "vtkSimplexNaturalNeighborMorph.h"

#include <vtkNew.h>

#include <gtest/gtest.h>

TEST(SimplexNaturalNeighborMorph, TheMemoryLimitChangesNoResult)
{
  auto grid = grids::hexes(5);
  vtkNew<vtkSimplexNaturalNeighborMorph> filter;
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->Update();
  EXPECT_EQ(filter->GetWeightsStored(), 1);
  const morph::Points stored = grids::points(filter->GetOutput());

  filter->SetMemoryLimit(1e-4); // 100 bytes
  grids::Listener listener(filter);
  filter->Update();
  EXPECT_EQ(filter->GetWeightsStored(), 0);
  ASSERT_EQ(listener.Warnings.size(), 1u);
  EXPECT_NE(listener.Warnings[0].find("memory limit"), std::string::npos) << listener.Warnings[0];
  EXPECT_TRUE(grids::points(filter->GetOutput()) == stored);
}
