// SPDX-License-Identifier: BSD-3-Clause
// The filters as a VTK application on MPI ranks uses them: vtkMPIController is the global
// controller, and each rank gives its piece.
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "TestGrids.h"

#include <vtkAlgorithm.h>
#include <vtkFEMWarpMorph.h>
#include <vtkNew.h>
#include <vtkSmoothingMorph.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

namespace
{
using morph::distributed::Ranks;

/// This rank's cells of a block, with global ids.
vtkSmartPointer<vtkUnstructuredGrid> piece(const Ranks& ranks)
{
  return rank_grids::piece(ranks, meshes::hexes(6, 5, 4));
}
}

TEST(DistributedFilters, PrepareOnceAndTellAllRanksTheSame)
{
  const Ranks ranks = pieces::world();
  const auto grid = piece(ranks);
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  grids::Listener listener(filter);
  filter->Update();
  filter->SetBoundaryData(grids::boundary(grid, grids::affine));
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_TRUE(listener.Errors.empty());
  for (const double value : { filter->GetMinScaledJacobian(), filter->GetMeanScaledJacobian(),
         static_cast<double>(filter->GetWorstCellId()),
         static_cast<double>(filter->GetPrescribedPoints()),
         static_cast<double>(filter->GetSolverIterations()) })
  {
    EXPECT_EQ(ranks.minimum(value), ranks.maximum(value));
  }
  EXPECT_EQ(filter->GetPrescribedPoints(), 7 * 6 * 5 - 5 * 4 * 3);
  EXPECT_LT((grids::points(filter->GetOutput()) - grids::mapped(grids::points(grid), grids::affine))
              .cwiseAbs()
              .maxCoeff(),
    1e-9);
}

TEST(DistributedFilters, AnAbortOnOneRankEndsAllWithoutAMessage)
{
  const Ranks ranks = pieces::world();
  const auto grid = piece(ranks);
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  rank_grids::abortOnLastRank(ranks, filter);
  grids::Listener listener(filter);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty());
  EXPECT_STREQ(filter->GetMorphStatus(), "Cancelled");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), grid->GetNumberOfPoints());
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
}

TEST(DistributedFilters, NameThemselvesWhereTheyNeedOneRank)
{
  const Ranks ranks = pieces::world();
  const auto grid = piece(ranks);
  const auto boundary = grids::boundary(grid, grids::affine);
  vtkNew<vtkSmoothingMorph> smoothing;
  smoothing->SetInputData(grid);
  smoothing->SetBoundaryData(boundary);
  grids::Listener listener(smoothing);
  smoothing->Update();
  EXPECT_EQ(listener.Errors.size(), ranks.count() > 1 && ranks.rank() == 0 ? 1u : 0u);
  if (!listener.Errors.empty())
  {
    EXPECT_NE(listener.Errors[0].find("vtkSmoothingMorph needs one MPI rank"), std::string::npos);
  }
}
