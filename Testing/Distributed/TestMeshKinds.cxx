// SPDX-License-Identifier: BSD-3-Clause
// Cells and nodes of engineers' meshes on MPI ranks, against one process.
#include "MeshKinds.h"
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "TestGrids.h"

#include <vtkCompareMorphMethods.h>
#include <vtkFEMWarpMorph.h>
#include <vtkMorphShapes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace
{
vtkSmartPointer<vtkPolyData> boundaryOf(vtkAlgorithm* filter, const grids::Map& map)
{
  return grids::boundary(vtkUnstructuredGrid::SafeDownCast(filter->GetInputDataObject(0, 0)), map);
}

class RankMeshKinds : public testing::TestWithParam<meshes::Kind>
{
protected:
  /// Calls `work` with the whole mesh on one process, and with this rank's piece.
  template <typename Filter>
  void Compare(const std::function<void(Filter*)>& configure,
    const std::function<void(Filter* filter, Filter* serial)>& expect) const
  {
    const auto whole = grids::make(GetParam().mesh);
    vtkNew<Filter> serial, filter;
    const auto run = [&](Filter* one, vtkUnstructuredGrid* grid)
    {
      one->SetInputData(grid);
      configure(one);
      EXPECT_TRUE(grids::Run(one).Errors.empty());
    };
    rank_grids::alone([&] { run(serial, whole); });
    run(filter, rank_grids::piece(this->Ranks, GetParam().mesh));
    expect(filter, serial);
  }
  const morph::distributed::Ranks Ranks = pieces::world();
};
}

TEST_P(RankMeshKinds, MoveInStepsAsOnOneRank)
{
  this->Compare<vtkFEMWarpMorph>(
    [](vtkFEMWarpMorph* filter)
    {
      filter->SetBoundaryData(boundaryOf(filter, grids::twist));
      filter->SetNumberOfSteps(2);
      filter->SetSteppingToRelative();
      filter->SetTolerance(1e-12);
      filter->CertifyOn();
      filter->UpdateTimeStep(2);
    },
    [this](vtkFEMWarpMorph* filter, vtkFEMWarpMorph* serial)
    {
      EXPECT_LT(rank_grids::distance(this->Ranks, filter->GetOutput(), serial->GetOutput()), 1e-8);
      EXPECT_NEAR(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-7);
      EXPECT_EQ(filter->GetInvertedCells(), serial->GetInvertedCells());
      EXPECT_EQ(filter->GetCertifiedCells(), serial->GetCertifiedCells());
      EXPECT_EQ(filter->GetUndecidedCells(), serial->GetUndecidedCells());
      EXPECT_EQ(filter->GetAttachedPoints(), serial->GetAttachedPoints());
    });
}

TEST_P(RankMeshKinds, FollowWeightedShapesAsOnOneRank)
{
  this->Compare<vtkMorphShapes>(
    [](vtkMorphShapes* shapes)
    {
      shapes->AddShapeData(boundaryOf(shapes, grids::twist));
      shapes->SetWeight(0, 0.5);
      shapes->SetTolerance(1e-12);
    },
    [this](vtkMorphShapes* shapes, vtkMorphShapes* serial)
    {
      EXPECT_LT(rank_grids::distance(this->Ranks, shapes->GetOutput(), serial->GetOutput()), 1e-8);
      EXPECT_NEAR(shapes->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-7);
    });
}

TEST_P(RankMeshKinds, AreComparedAsOnOneRank)
{
  this->Compare<vtkCompareMorphMethods>(
    [](vtkCompareMorphMethods* compare)
    {
      compare->SetBoundaryData(boundaryOf(compare, grids::twist));
      compare->SetNumberOfSteps(1);
    },
    [](vtkCompareMorphMethods* compare, vtkCompareMorphMethods* serial)
    {
      vtkTable *mine = compare->GetOutput(0), *whole = serial->GetOutput(0);
      ASSERT_EQ(mine->GetNumberOfRows(), whole->GetNumberOfRows());
      for (vtkIdType row = 0; row < whole->GetNumberOfRows(); ++row)
      {
        const std::string method = whole->GetValueByName(row, "Method").ToString();
        const auto value = [row](vtkTable* table, const char* column)
        { return table->GetValueByName(row, column).ToDouble(); };
        EXPECT_EQ(method, mine->GetValueByName(row, "Method").ToString());
        EXPECT_EQ(value(mine, "InvertedCells"), value(whole, "InvertedCells")) << method;
        // Where a minimum ends depends on rounding.
        const bool minimizes = method == "Smoothing" || method == "Inversion-free";
        const double least = value(whole, "MinScaledJacobian");
        EXPECT_NEAR(value(mine, "MinScaledJacobian"), least, minimizes ? 0.02 * least : 1e-6)
          << method;
      }
    });
}

INSTANTIATE_TEST_SUITE_P(All, RankMeshKinds, testing::ValuesIn(meshes::kinds()),
  [](const testing::TestParamInfo<meshes::Kind>& kind) { return kind.param.name; });
