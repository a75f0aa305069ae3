// SPDX-License-Identifier: BSD-3-Clause
// The filters as a VTK application on MPI ranks uses them: vtkMPIController is the global
// controller, and each rank gives its piece.
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "TestGrids.h"

#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmoothingMorph.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

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
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  const grids::Run listener(filter);
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
  EXPECT_EQ(filter->GetSolverIterations(), 0); // the fit of an affine motion is the solution
  EXPECT_LT((grids::points(filter->GetOutput()) - grids::mapped(grids::points(grid), grids::affine))
              .cwiseAbs()
              .maxCoeff(),
    1e-12);
}

TEST(DistributedFilters, AMirroredBodyIsNamedByItsFirstCellOfAllRanks)
{
  const Ranks ranks = pieces::world();
  morph::Mesh whole = meshes::hexes(6, 5, 4);
  whole.points.col(0) *= -1;
  const auto grid = rank_grids::piece(ranks, whole);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  const grids::Run listener(filter);
  EXPECT_EQ(filter->GetMirroredBodies(), 1);
  ASSERT_EQ(listener.Warnings.size(), ranks.rank() == 0 ? 1u : 0u);
  for (const std::string& warning : listener.Warnings)
  {
    EXPECT_NE(warning.find("the first is cell 0."), std::string::npos) << warning;
  }
}

TEST(DistributedFilters, ShellsFollowTheVolumeAcrossRanks)
{
  // A row of quads stands on the block from end to end, so that all ranks have some.
  const Ranks ranks = pieces::world();
  morph::Mesh whole = meshes::hexes(6, 5, 4);
  const morph::Index foot = 7 * (2 + 6 * 4), first = whole.numberOfNodes();
  whole.points.conservativeResize(first + 7, 3);
  for (morph::Index i = 0; i < 7; ++i)
  {
    whole.points.row(first + i) << static_cast<double>(i), 2, 5;
  }
  for (morph::Index i = 0; i < 6; ++i)
  {
    meshes::add(whole, VTK_QUAD, { foot + i, foot + i + 1, first + i + 1, first + i });
  }
  const auto grid = rank_grids::piece(ranks, whole);
  const grids::Map rigid = [](const grids::Row& x)
  { return grids::Row(0.6 * x[0] - 0.8 * x[2], x[1] + 2, 0.8 * x[0] + 0.6 * x[2]); };
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(grid, rigid));
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty() && listener.Warnings.empty());
  EXPECT_EQ(filter->GetAttachedPoints(), 7);
  EXPECT_LT((grids::points(filter->GetOutput()) - grids::mapped(grids::points(grid), rigid))
              .cwiseAbs()
              .maxCoeff(),
    1e-12);
}

TEST(DistributedFilters, OfCellsThatTwoRanksHaveOneIsMeasured)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh once = meshes::hexes(6, 5, 4);
  morph::Mesh whole = once;
  for (morph::Index c = 0; c < once.numberOfCells(); ++c)
  {
    meshes::add(whole, morph::Hexahedron, { once.cell(c), once.cell(c) + 8 });
  }
  const auto grid = rank_grids::piece(ranks, whole);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->CertifyOn();
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  EXPECT_EQ(filter->GetCertifiedCells(), once.numberOfCells());
  ASSERT_EQ(listener.Warnings.size(), ranks.rank() == 0 ? 1u : 0u);
  for (const std::string& warning : listener.Warnings)
  {
    EXPECT_NE(warning.find("Cells are there twice: cell ids 0, 1, 2,"), std::string::npos)
      << warning;
  }
}

TEST(DistributedFilters, AnAbortOnOneRankEndsAllWithoutAMessage)
{
  const Ranks ranks = pieces::world();
  const auto grid = piece(ranks);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  rank_grids::abortOnLastRank(ranks, filter);
  grids::update(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "Cancelled");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), grid->GetNumberOfPoints());
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
}

TEST(DistributedFilters, SmoothingIsAsGoodAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  morph::Mesh whole = meshes::hexes(5, 5, 5);
  meshes::jitterInterior(whole, 0.2, meshes::seed());
  const auto run = [](vtkSmoothingMorph* filter, vtkUnstructuredGrid* grid)
  {
    filter->SetInputData(grid);
    filter->SetBoundaryData(grids::boundary(grid, grids::twist));
    grids::update(filter);
  };
  for (const int target : { 0, 1 })
  {
    vtkNew<vtkSmoothingMorph> serial, filter;
    serial->SetTargetShape(target);
    filter->SetTargetShape(target);
    rank_grids::alone([&] { run(serial, grids::make(whole)); });
    run(filter, rank_grids::piece(ranks, whole));
    EXPECT_STREQ(serial->GetMorphStatus(), "Valid");
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
    EXPECT_GT(filter->GetMinScaledJacobian(), 0.99 * serial->GetMinScaledJacobian());
    EXPECT_EQ(
      ranks.minimum(filter->GetMinScaledJacobian()), ranks.maximum(filter->GetMinScaledJacobian()));
    EXPECT_EQ(filter->GetWorstCellId(), serial->GetWorstCellId());
    EXPECT_NEAR(filter->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-4);
  }
}

TEST(DistributedFilters, CrossingsAreThoseOfOneRank)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh whole = rank_grids::fork();
  const auto run = [](vtkFEMWarpMorph* filter, vtkUnstructuredGrid* grid, double way)
  {
    filter->SetInputData(grid);
    filter->SetBoundaryData(grids::boundary(grid, rank_grids::intoTheGap(way)));
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Errors.empty());
    return listener.Warnings;
  };
  vtkNew<vtkFEMWarpMorph> serial, filter;
  const auto piece = rank_grids::piece(ranks, whole);
  run(filter, piece, 1);
  EXPECT_EQ(filter->GetCrossingFaces(), 0);
  std::vector<std::string> wanted;
  rank_grids::alone([&] { wanted = run(serial, grids::make(whole), 3); });
  const std::vector<std::string> said = run(filter, piece, 3);
  EXPECT_GT(serial->GetCrossingFaces(), 0);
  EXPECT_EQ(filter->GetCrossingFaces(), serial->GetCrossingFaces());
  EXPECT_STREQ(filter->GetMorphStatus(), "CrossesItself");
  EXPECT_EQ(said.size(), ranks.rank() == 0 ? wanted.size() : 0);
}

TEST(DistributedFilters, BadCoordinatesOfOneRankAreOneErrorThatNamesTheRank)
{
  const Ranks ranks = pieces::world();
  const auto grid = piece(ranks);
  const int last = ranks.count() - 1;
  if (ranks.rank() == last)
  {
    grid->GetPoints()->SetPoint(3, std::nan(""), 0, 0);
  }
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::boundary(piece(ranks), grids::affine));
  const grids::Run listener(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  ASSERT_EQ(listener.Errors.size(), ranks.rank() == 0 ? 1u : 0u);
  const std::string whose = "Ids are those of MPI rank " + std::to_string(last);
  for (const std::string& error : listener.Errors)
  {
    EXPECT_NE(error.find("node ids 3. "), std::string::npos) << error;
    EXPECT_NE(error.find(whose), std::string::npos) << error;
  }
}

TEST(DistributedFilters, APointOfNoCellNeedsNoPlace)
{
  const auto grid = piece(pieces::world());
  grid->GetPointData()->Initialize(); // without ids, places tell which nodes are one
  grid->GetCellData()->RemoveArray("GlobalIds");
  const auto facesOf = [&]
  {
    vtkNew<vtkExtractMorphBoundary> filter;
    filter->SetInputData(grid);
    const grids::Listener listener(filter);
    filter->Update();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
    return filter->GetOutput()->GetNumberOfCells();
  };
  const vtkIdType faces = facesOf();
  for (const double x : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    grid->GetPoints()->InsertNextPoint(x, 0, 0);
    EXPECT_EQ(facesOf(), faces);
  }
}
