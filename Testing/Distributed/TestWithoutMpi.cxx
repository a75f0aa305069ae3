// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre, as an application on two MPI ranks uses it.
#include "Meshes.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include <vtkCommunicator.h>
#include <vtkCompareMorphMethods.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkMorphMesh.h>
#include <vtkMultiProcessController.h>

#include <gtest/gtest.h>

#include <string>

namespace
{
/// Expects one error on all ranks together.
void expectOneError(vtkAlgorithm* filter, const std::string& text)
{
  const grids::Run listener(filter);
  vtkMultiProcessController* ranks = vtkMultiProcessController::GetGlobalController();
  const int mine = static_cast<int>(listener.Errors.size());
  int all = 0;
  ranks->AllReduce(&mine, &all, 1, vtkCommunicator::SUM_OP);
  EXPECT_EQ(all, 1) << filter->GetClassName();
  for (const std::string& error : listener.Errors)
  {
    EXPECT_NE(error.find(text), std::string::npos) << error;
    EXPECT_NE(error.find("Build with MESHMORPHING_USE_MPI, or run on one rank."), std::string::npos)
      << error;
  }
}
}

TEST(WithoutMpi, AMeshOnTwoRanksIsOneError)
{
  ASSERT_EQ(vtkMultiProcessController::GetGlobalController()->GetNumberOfProcesses(), 2);
  const auto grid = grids::make(meshes::hexes(3, 3, 3));
  const std::string text =
    "The mesh is distributed over 2 MPI ranks, and this plugin was built without MPI or hypre";
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    const auto filter = method.make();
    filter->SetInputData(grid);
    filter->SetBoundaryData(grid);
    expectOneError(filter, text);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  }
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  expectOneError(extract, text);
  auto mesh = grids::of<vtkMorphMesh>(grid);
  expectOneError(mesh, text);
  auto compare = grids::of<vtkCompareMorphMethods>(grid);
  compare->SetBoundaryData(grid);
  expectOneError(compare, "This plugin was built without MPI or hypre");
}
