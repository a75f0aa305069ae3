// SPDX-License-Identifier: BSD-3-Clause
// What is particular to radial basis functions; TestMorphFilters.cxx has what they share with the
// other filters.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkRadialBasisMorph.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace
{
morph::Points moved(vtkUnstructuredGrid* grid, int kernel, double radius, int centers)
{
  auto filter = grids::morphed<vtkRadialBasisMorph>(grid, grids::twist);
  filter->SetKernel(kernel);
  filter->SetSupportRadius(radius);
  filter->SetNumberOfCenters(centers);
  filter->Update();
  return grids::points(filter->GetOutput());
}
}

TEST(RadialBasisMorph, OptionsReachTheMethod)
{
  auto grid = grids::hexes(6); // 218 prescribed nodes
  const morph::Points all = moved(grid, 0, 1, 0);
  EXPECT_TRUE(moved(grid, 0, 2, 0) == all); // the radius is another kernel's
  EXPECT_TRUE(moved(grid, 0, 1, 218) == all);
  EXPECT_TRUE(moved(grid, 0, 1, 4000) == all);
  EXPECT_FALSE(moved(grid, 0, 1, 100) == all);
  EXPECT_TRUE(moved(grid, 0, 1, 1) == moved(grid, 0, 1, 4));
  EXPECT_FALSE(moved(grid, 1, 1, 0) == all);
  EXPECT_FALSE(moved(grid, 2, 1, 0) == moved(grid, 2, 0.5, 0));
}

TEST(RadialBasisMorph, CountsItsCenters)
{
  auto grid = grids::hexes(6);
  auto filter = grids::morphed<vtkRadialBasisMorph>(grid, grids::twist);
  filter->Update();
  EXPECT_EQ(filter->GetCenters(), 218);
  EXPECT_EQ(filter->GetCorrectedSites(), 0);
  EXPECT_EQ(filter->GetLargestResidualPPM(), 0);
  filter->SetNumberOfCenters(50);
  filter->Update();
  EXPECT_EQ(filter->GetCenters(), 50);
  EXPECT_EQ(filter->GetCorrectedSites(), 168);
  EXPECT_GT(filter->GetLargestResidualPPM(), 0);
  EXPECT_LT(filter->GetLargestResidualPPM(), 50000);
}

TEST(RadialBasisMorph, ABoundaryInOnePlaneIsAnError)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  std::vector<morph::Index> bottom(16);
  std::iota(bottom.begin(), bottom.end(), 0);
  auto boundary = grids::cloud(meshes::rows(grids::points(grid), bottom));
  grids::addIds(boundary, "MorphPointId", bottom);
  auto filter = grids::morphed<vtkRadialBasisMorph>(grid, boundary);
  filter->FixUnnamedBoundaryOff();
  grids::expectError(filter, "lie in one plane");
}
