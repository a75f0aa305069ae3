// SPDX-License-Identifier: BSD-3-Clause
// Every way in which VTK keeps cells gives the same results.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Private/Data/Version.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkScaledJacobian.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkTypeInt16Array.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace
{
/// Gives cells another storage.
template <typename Cells>
using Converts = std::vector<std::pair<std::string, std::function<void(Cells*)>>>;

/// Whether cells of one size need no offsets, as since VTK 9.6.
template <typename Cells, typename = void>
struct HasFixedSize : std::false_type
{
};
template <typename Cells>
struct HasFixedSize<Cells,
  std::void_t<decltype(std::declval<Cells&>().ConvertToFixedSize64BitStorage())>> : std::true_type
{
};

/// Those of cells of one size.
template <typename Cells>
Converts<Cells> storages()
{
  Converts<Cells> all = {
    { "64 bit", [](Cells* cells) { ASSERT_TRUE(cells->ConvertTo64BitStorage()); } },
    { "32 bit", [](Cells* cells) { ASSERT_TRUE(cells->ConvertTo32BitStorage()); } },
  };
  if constexpr (HasFixedSize<Cells>::value)
  {
    all.emplace_back("fixed size, 64 bit",
      [](Cells* cells) { ASSERT_TRUE(cells->ConvertToFixedSize64BitStorage()); });
    all.emplace_back("fixed size, 32 bit",
      [](Cells* cells) { ASSERT_TRUE(cells->ConvertToFixedSize32BitStorage()); });
    all.emplace_back("arrays of another type",
      [](Cells* cells)
      {
        vtkNew<vtkTypeInt16Array> offsets, ids;
        offsets->DeepCopy(cells->GetOffsetsArray());
        ids->DeepCopy(cells->GetConnectivityArray());
        ASSERT_TRUE(cells->SetData(offsets, ids));
      });
  }
  return all;
}

/// Of a grid of hexahedra.
Converts<vtkUnstructuredGrid> gridStorages()
{
  Converts<vtkUnstructuredGrid> all;
  for (const auto& [name, convert] : storages<vtkCellArray>())
  {
    all.emplace_back(name,
      [convert = convert](vtkUnstructuredGrid* grid)
      {
        vtkNew<vtkCellArray> cells;
        cells->DeepCopy(grid->GetCells());
        convert(cells);
        vtkNew<vtkUnsignedCharArray> types;
        types->DeepCopy(morph::filters::Version::CellTypes(grid));
        grid->SetCells(types, cells);
      });
  }
  all.emplace_back("one type for all cells",
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkCellArray> cells;
      cells->DeepCopy(grid->GetCells());
      grid->SetCells(VTK_HEXAHEDRON, cells);
      // The array of types is a constant one where cells can have a fixed size.
      ASSERT_EQ(!vtkUnsignedCharArray::FastDownCast(morph::filters::Version::CellTypes(grid)),
        HasFixedSize<vtkCellArray>::value);
    });
  return all;
}

/// The surface in each storage.
std::vector<std::pair<std::string, vtkSmartPointer<vtkPolyData>>> inEveryStorage(
  vtkPolyData* surface)
{
  std::vector<std::pair<std::string, vtkSmartPointer<vtkPolyData>>> all;
  for (const auto& [name, convert] : storages<vtkCellArray>())
  {
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->ShallowCopy(surface);
    vtkNew<vtkCellArray> polygons;
    polygons->DeepCopy(surface->GetPolys());
    convert(polygons);
    copy->SetPolys(polygons);
    all.emplace_back(name, copy);
  }
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
  const auto run = [&](vtkUnstructuredGrid* input, vtkPolyData* moved)
  {
    auto filter = GetParam().of(input, moved);
    filter->Update();
    return filter;
  };
  const auto expected = run(grid, boundary);
  ASSERT_GT(expected->GetMinScaledJacobian(), 0);
  for (const auto& [name, convert] : gridStorages())
  {
    SCOPED_TRACE(name);
    const auto other = grids::copy(grid);
    convert(other);
    const auto filter = run(other, boundary);
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(expected->GetOutput()));
    EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
    ASSERT_EQ(filter->GetOutput()->GetNumberOfCells(), grid->GetNumberOfCells());
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), VTK_HEXAHEDRON);
    // The same cells in another storage are the same cells.
    filter->SetInputData(grid);
    filter->Update();
    EXPECT_EQ(filter->GetPrepareCount(), 1);
  }
  for (const auto& [name, surface] : inEveryStorage(boundary))
  {
    SCOPED_TRACE("boundary, " + name);
    const auto filter = run(grid, surface);
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(expected->GetOutput()));
    EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
  }
}

INSTANTIATE_TEST_SUITE_P(, CellStorage, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });

TEST(CellStorageOfScaledJacobian, EveryStorageGivesTheSameQuality)
{
  const auto grid = grids::hexes(4);
  auto expected = grids::of<vtkScaledJacobian>(grid);
  expected->Update();
  for (const auto& [name, convert] : gridStorages())
  {
    SCOPED_TRACE(name);
    const auto other = grids::copy(grid);
    convert(other);
    auto filter = grids::of<vtkScaledJacobian>(other);
    filter->Update();
    EXPECT_GT(filter->GetMinScaledJacobian(), 0);
    EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
    EXPECT_EQ(filter->GetMeanScaledJacobian(), expected->GetMeanScaledJacobian());
  }
}

TEST(CellStorageOfSurfaces, EveryStorageOfAMovedBoundaryMovesTheOthersAlike)
{
  const auto grid = grids::hexes(4);
  const auto run = [&](vtkPolyData* moved)
  {
    auto filter = grids::of<vtkMorphBoundary>(grid);
    filter->SetBoundaryData(moved);
    filter->SetPrescribedDimension(1);
    filter->Update();
    return grids::points(filter->GetOutput());
  };
  const auto boundary = grids::boundary(grid, grids::twist);
  const morph::Points expected = run(boundary);
  ASSERT_GT((expected - grids::points(grids::boundary(grid, [](auto& x) { return x; }))).norm(), 0);
  for (const auto& [name, surface] : inEveryStorage(boundary))
  {
    SCOPED_TRACE(name);
    EXPECT_TRUE(run(surface) == expected);
  }
}

TEST(CellStorageOfSurfaces, EveryStorageOfATargetIsTheSameSurface)
{
  const auto grid = grids::make(meshes::hexes(6, 4, 3));
  vtkNew<vtkPlaneSource> plane; // over the top, and larger
  plane->SetOrigin(-1, -1, 3.4);
  plane->SetPoint1(7, -1, 3.6);
  plane->SetPoint2(-1, 5, 3.5);
  plane->SetResolution(5, 7);
  plane->Update();
  const auto run = [&](vtkPolyData* target)
  {
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->SetTargetData(target);
    filter->SetDisplacementToTarget();
    filter->Update();
    return std::pair(grids::points(filter->GetOutput()), filter->GetMaxTargetDistance());
  };
  const auto expected = run(plane->GetOutput());
  ASSERT_GT((expected.first - grids::points(grid)).norm(), 0);
  for (const auto& [name, surface] : inEveryStorage(plane->GetOutput()))
  {
    SCOPED_TRACE(name);
    EXPECT_TRUE(run(surface) == expected);
  }
}
