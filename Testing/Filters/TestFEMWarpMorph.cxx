// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP, and what is tested of vtkMorphAlgorithm with one method; TestMorphFilters.cxx has what
// every method does.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"

#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace
{
}

TEST(FEMWarpMorph, QualityIsThatOfThePointsAsWritten)
{
  // Far from the origin, rounding to float moves the points by about a tenth of a cell.
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  const grids::Map shift = [](const grids::Row& x)
  { return grids::Row(x + grids::Row::Constant(3e6 + 0.1)); };
  auto grid = grids::make(mesh);
  auto filter = grids::morphed<vtkFEMWarpMorph>(
    grid, [&](const grids::Row& x) { return shift(grids::Row(x[0], x[1] + 0.3 * x[0], x[2])); });
  filter->Update();
  const double asDouble = filter->GetMinScaledJacobian();
  EXPECT_NEAR(asDouble, 1 / std::sqrt(1.09), 1e-8);
  filter->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  filter->Update();
  EXPECT_GT(std::abs(filter->GetMinScaledJacobian() - asDouble), 1e-3);
}

TEST(FEMWarpMorph, GhostCellsAreNotCounted)
{
  auto grid = grids::hexes(3);
  vtkUnsignedCharArray* ghosts = grid->AllocateCellGhostArray();
  ghosts->SetValue(5, vtkDataSetAttributes::DUPLICATECELL);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  filter->Update();
  auto* quality = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
  EXPECT_TRUE(std::isnan(quality->GetComponent(5, 0)));
  EXPECT_FALSE(std::isnan(quality->GetComponent(6, 0)));
}

TEST(FEMWarpMorph, IntegersAreClampedAndAllIsPrinted)
{
  vtkNew<vtkFEMWarpMorph> filter;
  EXPECT_EQ(filter->GetTolerance(), 1e-10);
  filter->SetTolerance(0.999);
  filter->SetNumberOfThreads(-3);
  EXPECT_EQ(filter->GetNumberOfThreads(), 0);
  filter->SetOutputPointsPrecision(9);
  EXPECT_EQ(filter->GetOutputPointsPrecision(), vtkAlgorithm::DEFAULT_PRECISION);
  filter->SetDisplacementArray("Wind");
  std::ostringstream text;
  filter->Print(text);
  for (const char* expected :
    { "Tolerance: 0.999", "DisplacementArray: Wind", "BoundaryIdArray: (none)", "PrepareCount: 0" })
  {
    EXPECT_NE(text.str().find(expected), std::string::npos) << expected;
  }
}
