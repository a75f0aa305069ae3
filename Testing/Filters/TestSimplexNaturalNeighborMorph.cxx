// SPDX-License-Identifier: BSD-3-Clause
// What is particular to natural neighbors; TestMorphFilters.cxx has what they share with the other
// filters.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkSimplexNaturalNeighborMorph.h"

#include <gtest/gtest.h>

TEST(SimplexNaturalNeighborMorph, TheMemoryLimitChangesNoResult)
{
  auto grid = grids::hexes(5);
  auto filter = grids::morphed<vtkSimplexNaturalNeighborMorph>(grid, grids::twist);
  filter->Update();
  EXPECT_EQ(filter->GetWeightsStored(), 1);
  const morph::Points stored = grids::points(filter->GetOutput());

  filter->SetMemoryLimit(1e-4); // 100 bytes
  const grids::Run listener(filter);
  EXPECT_EQ(filter->GetWeightsStored(), 0);
  listener.ExpectWarning("memory limit");
  EXPECT_TRUE(grids::points(filter->GetOutput()) == stored);
}
