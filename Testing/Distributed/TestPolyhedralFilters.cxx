// SPDX-License-Identifier: BSD-3-Clause
// Filters on random partitions of meshes with polyhedra, against the same filters on one rank.
#include "BlockGrids.h"
#include "Meshes.h"
#include "MorphFilters.h"
#include "Pieces.h"
#include "PolyhedralMeshes.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "RankTrees.h"
#include "TestGrids.h"

#include <vtkCell.h>
#include <vtkDataArray.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInversionFreeMorph.h>
#include <vtkMorphShapes.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkScaledJacobian.h>
#include <vtkSmoothingMorph.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace
{
using grids::Row;
using morph::Index;
using morph::distributed::Ranks;

Row bent(const Row& x)
{
  return x + Row(0.1 * std::sin(x[2]), 0.06 * x[0] * x[1] / 4, 0.1 * std::cos(x[0]));
}

/// FEMWARP inverts cells of the honeycomb.
Row waves(const Row& x)
{
  return { x[0], x[1], x[2] + 2.2 * std::sin(x[0]) };
}

/// Those that no other test of ranks has: prisms, split faces, and a mix with other cells.
std::vector<std::pair<std::string, morph::Mesh>> polyhedral()
{
  std::vector<std::pair<std::string, morph::Mesh>> chosen;
  for (auto& one : meshes::polyhedral())
  {
    if (one.first == "honeycomb" || one.first == "refined layer" || one.first == "mixed")
    {
      chosen.push_back(std::move(one));
    }
  }
  return chosen;
}

vtkUnstructuredGrid* outputOf(vtkMorphAlgorithm* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

void expectSameNumbers(vtkMorphAlgorithm* mine, vtkMorphAlgorithm* serial)
{
  EXPECT_STREQ(mine->GetMorphStatus(), serial->GetMorphStatus());
  EXPECT_EQ(mine->GetInvertedCells(), serial->GetInvertedCells());
  EXPECT_EQ(mine->GetWorstCellId(), serial->GetWorstCellId());
  EXPECT_EQ(mine->GetPrescribedPoints(), serial->GetPrescribedPoints());
  EXPECT_EQ(mine->GetSurfaceInvertedCells(), serial->GetSurfaceInvertedCells());
  EXPECT_EQ(mine->GetSubSteps(), serial->GetSubSteps());
  EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
  EXPECT_NEAR(mine->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-8);
  EXPECT_NEAR(mine->GetWorstMeanScaledJacobian(), serial->GetWorstMeanScaledJacobian(), 1e-8);
}

/// Updates a filter of the whole grid on one process, and one of this rank's part of it.
void run(vtkMorphAlgorithm* serial, vtkMorphAlgorithm* mine, vtkUnstructuredGrid* whole,
  vtkUnstructuredGrid* part, const grids::Map& map)
{
  rank_grids::alone(
    [&]
    {
      serial->SetInputData(whole);
      serial->SetBoundaryData(grids::boundary(whole, map));
      serial->Update();
    });
  mine->SetInputData(part);
  mine->SetBoundaryData(grids::boundary(part, map));
  grids::update(mine);
}
}

TEST(RankPolyhedra, LinearMethodsMoveThemAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (const auto& [name, mesh] : polyhedral())
  {
    const auto whole = grids::make(mesh);
    const auto part = rank_grids::part(ranks, whole, mesh, ++seed);
    const double size = meshes::size(mesh.points);
    for (const grids::MorphFilter& method : grids::morphFilters())
    {
      SCOPED_TRACE(method.name + ", " + name);
      auto serial = method.make(), mine = method.make();
      run(serial, mine, whole, part, bent);
      EXPECT_LT(rank_grids::distance(ranks, outputOf(mine), outputOf(serial)), 1e-8 * size);
      expectSameNumbers(mine, serial);
      mine->SetBoundaryData(grids::boundary(part, grids::affine));
      mine->Update();
      const morph::Points expected = grids::mapped(grids::points(part), grids::affine);
      const double most =
        expected.rows() == 0 ? 0 : (grids::points(outputOf(mine)) - expected).cwiseAbs().maxCoeff();
      EXPECT_LT(ranks.maximum(most), 1e-10 * size);
    }
    vtkNew<vtkScaledJacobian> serial, mine;
    for (vtkScaledJacobian* filter : { serial.Get(), mine.Get() })
    {
      filter->SetCriteria(
        "NonOrthogonality=1, FaceSkewness=.1, FacePyramid, FirstHeight, Skewness");
    }
    serial->SetInputData(whole);
    rank_grids::alone([&] { serial->Update(); });
    mine->SetInputData(part);
    mine->Update();
    // A cell's center is summed in the order of its nodes here.
    EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-14);
    EXPECT_EQ(mine->GetMeasuredCells(), serial->GetMeasuredCells());
    for (const char* column : { "CriterionWorst", "CriterionCellsBeyond" })
    {
      for (int row = 0; row < 5; ++row)
      {
        const auto number = [&](vtkScaledJacobian* filter)
        { return filter->GetOutput()->GetFieldData()->GetArray(column)->GetTuple1(row); };
        EXPECT_NEAR(number(mine), number(serial), 1e-10) << column << row;
      }
    }
  }
}

TEST(RankPolyhedra, StepsAndStiffnessAreThoseOfOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed() + 40;
  using Setting = std::function<void(vtkFEMWarpMorph*)>;
  const std::vector<std::pair<std::string, Setting>> settings = {
    { "relative",
      [](vtkFEMWarpMorph* filter)
      {
        filter->SetNumberOfSteps(2);
        filter->SetSteppingToRelative();
      } },
    { "sub-steps", [](vtkFEMWarpMorph* filter) { filter->SetValidityToSubStep(); } },
    { "walls", [](vtkFEMWarpMorph* filter) { filter->SetStiffness(2); } },
  };
  for (const auto& [name, mesh] : polyhedral())
  {
    const auto whole = grids::make(mesh);
    for (const auto& [what, set] : settings)
    {
      SCOPED_TRACE(what + ", " + name);
      vtkNew<vtkFEMWarpMorph> serial, mine;
      for (vtkFEMWarpMorph* filter : { serial.Get(), mine.Get() })
      {
        filter->SetTolerance(1e-12);
        set(filter);
      }
      run(serial, mine, whole, rank_grids::part(ranks, whole, mesh, ++seed), bent);
      if (what == "relative")
      {
        rank_grids::alone([&] { serial->UpdateTimeStep(1); });
        mine->UpdateTimeStep(1);
      }
      EXPECT_LT(rank_grids::distance(ranks, outputOf(mine), outputOf(serial)),
        1e-8 * meshes::size(mesh.points));
      expectSameNumbers(mine, serial);
    }
  }
}

TEST(RankPolyhedra, ShapesBlendAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed() + 80;
  const auto shifted = [](const Row& x) -> Row { return x + Row(0, 0.1 * x[2], 0); };
  for (const auto& [name, mesh] : polyhedral())
  {
    SCOPED_TRACE(name);
    const auto whole = grids::make(mesh);
    const auto shapesOf = [&](vtkUnstructuredGrid* grid)
    {
      auto shapes = vtkSmartPointer<vtkMorphShapes>::New();
      shapes->SetInputData(grid);
      shapes->AddShapeData(grids::boundary(grid, bent));
      shapes->AddShapeData(grids::boundary(grid, shifted));
      shapes->SetTolerance(1e-12);
      shapes->SetWeight(0, 0.25);
      shapes->SetWeight(1, -0.5);
      grids::update(shapes);
      return shapes;
    };
    vtkSmartPointer<vtkMorphShapes> serial;
    rank_grids::alone([&] { serial = shapesOf(whole); });
    const auto mine = shapesOf(rank_grids::part(ranks, whole, mesh, ++seed));
    EXPECT_LT(
      rank_grids::distance(ranks, vtkUnstructuredGrid::SafeDownCast(mine->GetOutputDataObject(0)),
        vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0))),
      1e-8 * meshes::size(mesh.points));
    EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
    EXPECT_NEAR(mine->GetLargestFactor(), serial->GetLargestFactor(), 1e-6);
    for (int i = 0; i < 2; ++i)
    {
      EXPECT_NEAR(mine->GetLowestWeight(i), serial->GetLowestWeight(i), 1e-6);
      EXPECT_NEAR(mine->GetHighestWeight(i), serial->GetHighestWeight(i), 1e-6);
    }
  }
}

TEST(RankPolyhedra, InversionFreeRepairAndSmoothingAreAsValidAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed() + 120;
  for (const auto& [name, mesh] : polyhedral())
  {
    const auto whole = grids::make(mesh);
    const auto part = rank_grids::part(ranks, whole, mesh, ++seed);
    for (const std::string what : { "inversion-free", "smoothing", "repair", "smooth" })
    {
      for (const bool hard : { false, true })
      {
        SCOPED_TRACE(what + ", " + name + (hard ? ", hard" : ""));
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
          if (what == "repair")
          {
            filter->SetValidityToRepair();
          }
          else
          {
            filter->PostSmoothOn();
          }
          return filter;
        };
        const grids::Map map = hard ? waves : bent;
        auto serial = make(), mine = make();
        rank_grids::alone(
          [&]
          {
            serial->SetInputData(whole);
            serial->SetBoundaryData(grids::boundary(whole, map));
            const grids::Run quiet(serial);
          });
        mine->SetInputData(part);
        mine->SetBoundaryData(grids::boundary(part, map));
        const grids::Run listener(mine);
        if (ranks.rank() == 0)
        {
          std::cout << what << ", " << name << (hard ? ", hard" : "") << ": minimum "
                    << mine->GetMinScaledJacobian() << ", on one rank "
                    << serial->GetMinScaledJacobian() << "; inverted " << mine->GetInvertedCells()
                    << ", " << serial->GetInvertedCells() << '\n';
        }
        if (serial->GetInvertedCells() == 0)
        {
          EXPECT_EQ(mine->GetInvertedCells(), 0);
          // Patches, which are those of a partition, are repaired up to a valid mesh.
          EXPECT_GT(mine->GetMinScaledJacobian(),
            what == "repair" ? 0 : 0.99 * serial->GetMinScaledJacobian());
        }
        EXPECT_EQ(
          ranks.minimum(mine->GetMinScaledJacobian()), ranks.maximum(mine->GetMinScaledJacobian()));
        const bool fails = mine->GetInvertedCells() > 0 && what == "repair";
        EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), fails ? 1 : 0);
      }
    }
  }
}

TEST(RankPolyhedra, BlocksOfThemMoveAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  const auto whole = grids::make(meshes::honeycomb(3));
  vtkNew<vtkMultiBlockDataSet> tree;
  for (unsigned int block = 0; block < 2; ++block)
  {
    vtkNew<vtkIdList> cells;
    for (vtkIdType c = 0; c < whole->GetNumberOfCells(); ++c)
    {
      if ((whole->GetCell(c)->GetBounds()[4] < 1.5) == (block == 0))
      {
        cells->InsertNextId(c);
      }
    }
    tree->SetBlock(block, rank_trees::cellsOf(whole, cells));
  }
  const auto moved = [](vtkDataObject* mesh)
  {
    auto extract = grids::of<vtkExtractMorphBoundary>(mesh);
    extract->Update();
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->ShallowCopy(extract->GetOutput());
    result->SetPoints(grids::cloud(grids::mapped(grids::points(result), bent))->GetPoints());
    return result;
  };
  vtkNew<vtkFEMWarpMorph> serial, mine;
  serial->SetTolerance(1e-12);
  mine->SetTolerance(1e-12);
  rank_grids::alone(
    [&]
    {
      serial->SetInputDataObject(tree);
      serial->SetBoundaryData(moved(tree));
      serial->Update();
    });
  const auto part = rank_trees::part(ranks, tree, meshes::seed() + 160);
  mine->SetInputDataObject(part);
  mine->SetBoundaryData(moved(part));
  grids::update(mine);
  const auto expected = blocks::pointsByNumber(serial->GetOutputDataObject(0));
  for (const auto& [number, x] : blocks::pointsByNumber(mine->GetOutputDataObject(0)))
  {
    EXPECT_LT((x - expected.at(number)).norm(), 1e-7);
  }
  EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
}
