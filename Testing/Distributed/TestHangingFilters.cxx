// SPDX-License-Identifier: BSD-3-Clause
// Filters on random partitions of meshes with hanging nodes, against the same filters on one rank.
#include "MorphFilters.h"
#include "Octree.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>
#include <vtkInversionFreeMorph.h>
#include <vtkMorphMesh.h>
#include <vtkMorphShapes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmoothingMorph.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace
{
using grids::Row;
using morph::Index;
using morph::Points;
using morph::distributed::Ranks;

Row bent(const Row& x)
{
  return x + Row(0.1 * std::sin(2 * x[2]), 0.06 * x[0] * x[1], 0.1 * std::cos(2 * x[0]));
}

/// FEMWARP inverts linear cells.
Row dented(const Row& x)
{
  const double r = std::hypot(x[0] - 1.5, x[1] - 1.5), dent = std::cos(r / 1.4 * M_PI / 2);
  return { x[0], x[1], x[2] == 0 && r < 1.4 ? 1.2 * dent * dent : x[2] };
}

class RankHangingFilters : public testing::TestWithParam<int>
{
protected:
  const Ranks Processes = pieces::world();
  const meshes::Octree Octree{ meshes::seed(), this->GetParam() };
  const vtkSmartPointer<vtkUnstructuredGrid> Whole = grids::make(this->Octree.mesh);
  const vtkSmartPointer<vtkUnstructuredGrid> Part =
    rank_grids::part(this->Processes, this->Whole, this->Octree.mesh, meshes::seed());
  const double Size = meshes::size(this->Octree.mesh.points);

  static vtkUnstructuredGrid* OutputOf(vtkAlgorithm* filter)
  {
    return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  }
  void Run(
    vtkMorphAlgorithm* serial, vtkMorphAlgorithm* mine, const grids::Map& map, double time = -1)
  {
    const auto update = [&](vtkMorphAlgorithm* filter, vtkUnstructuredGrid* grid)
    {
      filter->SetInputData(grid);
      filter->SetBoundaryData(grids::boundary(grid, map));
      const grids::Listener listener(filter);
      time < 0 ? filter->Update() : static_cast<void>(filter->UpdateTimeStep(time));
      EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
      std::vector<std::string> texts; // without the addresses of the filters
      for (const std::string& warning : listener.Warnings)
      {
        texts.push_back(warning.substr(warning.find("): ")));
      }
      return texts;
    };
    std::vector<std::string> warnings;
    rank_grids::alone([&] { warnings = update(serial, this->Whole); });
    const std::vector<std::string> told = update(mine, this->Part);
    EXPECT_EQ(told, this->Processes.rank() == 0 ? warnings : std::vector<std::string>());
  }
  /// Of what this rank has, the rest being where one rank has it.
  void ExpectNoGap(vtkAlgorithm* mine)
  {
    Points all = Points::Zero(this->Octree.mesh.numberOfNodes(), 3);
    const Points own = grids::points(OutputOf(mine));
    const std::vector<Index> ids = rank_grids::globalIds(OutputOf(mine), "GlobalIds");
    std::vector<double> rows;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      const auto x = own.row(static_cast<Index>(i));
      rows.insert(rows.end(), { static_cast<double>(ids[i]), x[0], x[1], x[2] });
    }
    rows = this->Processes.gather(rows);
    for (std::size_t i = 0; i < rows.size(); i += 4)
    {
      all.row(static_cast<Index>(rows[i])) << rows[i + 1], rows[i + 2], rows[i + 3];
    }
    EXPECT_LT(this->Octree.gap(all), 1e-12 * this->Size);
  }
};
}

TEST_P(RankHangingFilters, TheBoundaryOfAPieceHasPointsOfThePieceAlone)
{
  const auto extracted = [](vtkUnstructuredGrid* grid)
  {
    vtkNew<vtkExtractMorphBoundary> extract;
    extract->SetInputData(grid);
    extract->Update();
    return vtkSmartPointer<vtkPolyData>(extract->GetOutput());
  };
  vtkSmartPointer<vtkPolyData> whole;
  rank_grids::alone([&] { whole = extracted(this->Whole); });
  std::vector<Index> own = rank_grids::globalIds(this->Part, "GlobalIds");
  std::sort(own.begin(), own.end());

  const auto boundary = extracted(this->Part);

  EXPECT_EQ(this->Processes.sum(Index(boundary->GetNumberOfCells())), whole->GetNumberOfCells());
  for (const Index id : rank_grids::globalIds(boundary, "MorphPointId"))
  {
    EXPECT_TRUE(std::binary_search(own.begin(), own.end(), id)) << id;
  }
}

TEST_P(RankHangingFilters, LinearMethodsMoveThemAsOnOneRank)
{
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    if (!method.linear)
    {
      continue;
    }
    SCOPED_TRACE(method.name);
    auto serial = method.make(), mine = method.make();
    this->Run(serial, mine, bent);
    EXPECT_LT(
      rank_grids::distance(this->Processes, OutputOf(mine), OutputOf(serial)), 1e-9 * this->Size);
    EXPECT_STREQ(mine->GetMorphStatus(), serial->GetMorphStatus());
    EXPECT_EQ(mine->GetPrescribedPoints(), serial->GetPrescribedPoints());
    EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
    this->ExpectNoGap(mine);
  }
}

TEST_P(RankHangingFilters, StepsAndShapesAreThoseOfOneRank)
{
  vtkNew<vtkFEMWarpMorph> serial, mine;
  for (vtkFEMWarpMorph* filter : { serial.Get(), mine.Get() })
  {
    filter->SetTolerance(1e-12);
    filter->SetNumberOfSteps(2);
    filter->SetSteppingToRelative();
  }
  this->Run(serial, mine, bent, 2);
  EXPECT_LT(
    rank_grids::distance(this->Processes, OutputOf(mine), OutputOf(serial)), 1e-8 * this->Size);
  this->ExpectNoGap(mine);

  const auto shapesOf = [&](vtkUnstructuredGrid* grid)
  {
    auto shapes = vtkSmartPointer<vtkMorphShapes>::New();
    shapes->SetInputDataObject(grid);
    shapes->AddShapeData(grids::boundary(grid, bent));
    shapes->SetTolerance(1e-12);
    shapes->SetWeight(0, 0.5);
    grids::update(shapes);
    return shapes;
  };
  vtkSmartPointer<vtkMorphShapes> alone;
  rank_grids::alone([&] { alone = shapesOf(this->Whole); });
  const auto together = shapesOf(this->Part);
  EXPECT_LT(
    rank_grids::distance(this->Processes, OutputOf(together), OutputOf(alone)), 1e-8 * this->Size);
  EXPECT_NEAR(together->GetMinScaledJacobian(), alone->GetMinScaledJacobian(), 1e-8);
  this->ExpectNoGap(together);
}

TEST_P(RankHangingFilters, RepairAndSmoothingLeaveNoGap)
{
  for (const std::string what : { "inversion-free", "smoothing", "repair", "smooth" })
  {
    if (what == "repair" && this->GetParam() == 2)
    {
      continue; // it sees corners alone
    }
    SCOPED_TRACE(what);
    const auto make = [&]() -> vtkSmartPointer<vtkMorphAlgorithm>
    {
      if (what == "inversion-free")
      {
        return vtkSmartPointer<vtkInversionFreeMorph>::New();
      }
      if (what == "smoothing")
      {
        return vtkSmartPointer<vtkSmoothingMorph>::New();
      }
      auto filter = vtkSmartPointer<vtkFEMWarpMorph>::New();
      filter->SetTolerance(1e-12);
      filter->SetValidity(
        what == "repair" ? vtkMorphAlgorithm::VALIDITY_REPAIR : vtkMorphAlgorithm::VALIDITY_NONE);
      filter->SetPostSmooth(what == "smooth");
      return filter;
    };
    auto serial = make(), mine = make();
    this->Run(serial, mine, what == "repair" ? dented : bent);
    this->ExpectNoGap(mine);
    // Smoothing sees the corners of quadratic cells alone, and may leave one inverted between them.
    const double least = serial->GetMinScaledJacobian();
    EXPECT_EQ(mine->GetInvertedCells(), serial->GetInvertedCells());
    EXPECT_TRUE(what == "smoothing" || serial->GetInvertedCells() == 0);
    EXPECT_GT(mine->GetMinScaledJacobian(), what == "repair" ? 0 : least - 0.05 * std::abs(least));
  }
}

TEST_P(RankHangingFilters, MorphMeshMovesSurfacesAsOnOneRank)
{
  const auto moved = [](vtkUnstructuredGrid* grid)
  {
    auto filter = vtkSmartPointer<vtkMorphMesh>::New();
    vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
    filter->SetInputData(grid);
    filter->AddSurface("Surface 1");
    filter->AddFixedSurface("Surface 0");
    filter->SetDisplacementToTranslateRotateScale();
    filter->SetTranslation(0.05, 0.1, 0.05);
    filter->SetRotation(3, 0, 5);
    filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPORT);
    grids::update(filter);
    return filter;
  };
  vtkSmartPointer<vtkMorphMesh> alone;
  rank_grids::alone([&] { alone = moved(this->Whole); });
  const auto together = moved(this->Part);
  EXPECT_LT(
    rank_grids::distance(this->Processes, OutputOf(together), OutputOf(alone)), 1e-8 * this->Size);
  EXPECT_EQ(together->GetPrescribedPoints(), alone->GetPrescribedPoints());
  EXPECT_NEAR(together->GetMinScaledJacobian(), alone->GetMinScaledJacobian(), 1e-8);
  this->ExpectNoGap(together);
}

INSTANTIATE_TEST_SUITE_P(Orders, RankHangingFilters, testing::Values(0, 1, 2));
