// SPDX-License-Identifier: BSD-3-Clause
// Every way in which VTK keeps cells gives the same results.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Private/Data/Version.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkScaledJacobian.h>
#include <vtkTypeInt16Array.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace
{
/// Gives the cells of a grid of hexahedra another storage.
using Convert = std::function<void(vtkUnstructuredGrid*)>;

std::vector<std::pair<std::string, Convert>> storages()
{
  std::vector<std::pair<std::string, Convert>> all = {
    { "64 bit",
      [](vtkUnstructuredGrid* grid) { ASSERT_TRUE(grid->GetCells()->ConvertTo64BitStorage()); } },
    { "32 bit",
      [](vtkUnstructuredGrid* grid) { ASSERT_TRUE(grid->GetCells()->ConvertTo32BitStorage()); } },
  };
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  all.emplace_back("fixed size, 64 bit", [](vtkUnstructuredGrid* grid)
    { ASSERT_TRUE(grid->GetCells()->ConvertToFixedSize64BitStorage()); });
  all.emplace_back("fixed size, 32 bit", [](vtkUnstructuredGrid* grid)
    { ASSERT_TRUE(grid->GetCells()->ConvertToFixedSize32BitStorage()); });
  all.emplace_back("arrays of another type",
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkTypeInt16Array> offsets, ids;
      offsets->DeepCopy(grid->GetCells()->GetOffsetsArray());
      ids->DeepCopy(grid->GetCells()->GetConnectivityArray());
      vtkNew<vtkCellArray> cells;
      ASSERT_TRUE(cells->SetData(offsets, ids));
      grid->SetCells(VTK_HEXAHEDRON, cells);
    });
  all.emplace_back("one type for all cells",
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkCellArray> cells;
      cells->DeepCopy(grid->GetCells());
      grid->SetCells(VTK_HEXAHEDRON, cells);
      ASSERT_FALSE(vtkUnsignedCharArray::FastDownCast(grid->GetCellTypes()));
    });
#endif
  return all;
}

class CellStorage : public testing::TestWithParam<grids::MorphFilter>
{
};
}

TEST_P(CellStorage, EveryStorageGivesTheSameMeshAndKeepsWhatIsPrepared)
{
  const auto grid = grids::hexes(4);
  const auto boundary = grids::boundary(grid, grids::twist);
  const auto run = [&](vtkUnstructuredGrid* input)
  {
    auto filter = GetParam().make();
    filter->SetInputData(input);
    filter->SetBoundaryData(boundary);
    filter->Update();
    return filter;
  };
  const auto expected = run(grid);
  ASSERT_GT(expected->GetMinScaledJacobian(), 0);
  for (const auto& [name, convert] : storages())
  {
    SCOPED_TRACE(name);
    const auto other = grids::copy(grid);
    convert(other);
    const auto filter = run(other);
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(expected->GetOutput()));
    EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
    ASSERT_EQ(filter->GetOutput()->GetNumberOfCells(), grid->GetNumberOfCells());
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), VTK_HEXAHEDRON);
    // The same cells in another storage are the same cells.
    filter->SetInputData(grid);
    filter->Update();
    EXPECT_EQ(filter->GetPrepareCount(), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(, CellStorage, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });

TEST(CellStorageOfScaledJacobian, EveryStorageGivesTheSameQuality)
{
  const auto grid = grids::hexes(4);
  vtkNew<vtkScaledJacobian> expected;
  expected->SetInputData(grid);
  expected->Update();
  for (const auto& [name, convert] : storages())
  {
    SCOPED_TRACE(name);
    const auto other = grids::copy(grid);
    convert(other);
    vtkNew<vtkScaledJacobian> filter;
    filter->SetInputData(other);
    filter->Update();
    EXPECT_GT(filter->GetMinScaledJacobian(), 0);
    EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
    EXPECT_EQ(filter->GetMeanScaledJacobian(), expected->GetMeanScaledJacobian());
  }
}
