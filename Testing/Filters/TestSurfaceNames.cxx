// SPDX-License-Identifier: BSD-3-Clause
// Names that a mesh's file gives parts of its boundary, and how large surfaces are.
#include "DisplacedBoundaries.h"

#include "vtkMorphMesh.h"

#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

using grids::Row;

namespace
{
bool onWall(const Row& x)
{
  return x[1] == 0 || x[1] == 3 || x[2] == 0 || x[2] == 3;
}

bool onInlet(const Row& x)
{
  return x[0] == 0 && x[1] <= 2;
}

/// A bar of 6 x 3 x 3 hexahedra. "inlet", a part of one end, is a set of points; "wall", its four
/// sides, one of quadrilaterals.
vtkSmartPointer<vtkUnstructuredGrid> bar()
{
  auto grid = grids::make(meshes::hexes(6, 3, 3));
  auto boundary = grids::boundary(grid, [](const Row& x) { return x; });
  vtkDataArray* ids = boundary->GetPointData()->GetArray("MorphPointId");
  vtkNew<vtkIdList> corners;
  const vtkIdType volumes = grid->GetNumberOfCells();
  for (vtkIdType face = 0; face < boundary->GetNumberOfCells(); ++face)
  {
    boundary->GetCellPoints(face, corners);
    Row center = Row::Zero();
    for (vtkIdType k = 0; k < 4; ++k)
    {
      Row x;
      boundary->GetPoint(corners->GetId(k), x.data());
      center += x / 4;
      corners->SetId(k, static_cast<vtkIdType>(ids->GetComponent(corners->GetId(k), 0)));
    }
    if (onWall(center))
    {
      grid->InsertNextCell(VTK_QUAD, corners);
    }
  }
  grid->GetCellData()->Initialize();
  const auto marks = [](const char* name, vtkIdType count)
  {
    auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
    array->SetName(name);
    array->SetNumberOfValues(count);
    array->FillValue(0);
    return array;
  };
  auto wall = marks("wall", grid->GetNumberOfCells());
  for (vtkIdType cell = volumes; cell < grid->GetNumberOfCells(); ++cell)
  {
    wall->SetValue(cell, 1);
  }
  grid->GetCellData()->AddArray(wall);
  auto inlet = marks("inlet", grid->GetNumberOfPoints());
  const morph::Points x = grids::points(grid);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    inlet->SetValue(i, onInlet(x.row(i)));
  }
  grid->GetPointData()->AddArray(inlet);
  vtkNew<vtkStringArray> names;
  names->SetName("SurfaceNames");
  names->InsertNextValue("inlet");
  names->InsertNextValue("wall");
  grid->GetFieldData()->AddArray(names);
  return grid;
}
}

TEST(SurfaceNames, NamesOfTheFileAreListedWithTheirSizes)
{
  vtkNew<vtkMorphMesh> filter;
  filter->SetInputData(bar());
  filter->UpdateInformation();
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  ASSERT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 2 + 6 + 12);
  ASSERT_EQ(sizes->GetNumberOfValues(), 3 * 20);
  EXPECT_EQ(sizes->GetValue(0), "inlet");
  EXPECT_EQ(sizes->GetValue(1), "6");
  EXPECT_EQ(sizes->GetValue(2), "6");
  EXPECT_EQ(sizes->GetValue(3), "wall");
  EXPECT_EQ(sizes->GetValue(4), "72");
  EXPECT_EQ(sizes->GetValue(5), "72");
  double area = 0, length = 0;
  for (int i = 0; i < 20; ++i)
  {
    EXPECT_EQ(sizes->GetValue(3 * i), filter->GetSurfaceList()->GetArrayName(i));
    (i < 8 ? area : length) += i < 2 ? 0 : std::stod(sizes->GetValue(3 * i + 2));
  }
  EXPECT_DOUBLE_EQ(area, 2 * 9 + 4 * 18);
  EXPECT_DOUBLE_EQ(length, 8 * 3 + 4 * 6);

  vtkDoubleArray* bounds = filter->GetSurfaceBounds();
  ASSERT_EQ(bounds->GetNumberOfTuples(), 20);
  double whole[6], wall[6];
  vtkDataSet::SafeDownCast(filter->GetInputDataObject(0, 0))->GetBounds(whole);
  bounds->GetTypedTuple(1, wall);
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_EQ(wall[k], whole[k]) << k;
  }
}

TEST(SurfaceNames, ANameThatIsThereTwiceCountsOnce)
{
  auto part = bar();
  vtkStringArray::SafeDownCast(part->GetFieldData()->GetAbstractArray("SurfaceNames"))
    ->InsertNextValue("wall");
  vtkNew<vtkMorphMesh> filter;
  filter->SetInputData(part);
  filter->UpdateInformation();
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 2 + 6 + 12);
  EXPECT_EQ(filter->GetSurfaceSizes()->GetNumberOfValues(), 3 * 20);
}

TEST(SurfaceNames, WhatHasANameMovesAndSlides)
{
  auto grid = bar();
  vtkNew<vtkMorphMesh> filter;
  filter->SetInputData(grid);
  filter->AddSurface("inlet");
  filter->AddSlidingSurface("wall");
  filter->SetDisplacementToVector();
  filter->SetVector(-0.25, 0.1, 0);
  grids::Listener listener(filter);
  filter->Update();
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_EQ(y(i, 0) == x(i, 0) - 0.25, onInlet(x.row(i))) << i;
    for (const int j : { 1, 2 })
    {
      // The wall's four planes stay planes.
      EXPECT_TRUE((x(i, j) != 0 && x(i, j) != 3) || std::abs(y(i, j) - x(i, j)) < 1e-14) << i;
    }
  }
}

TEST(SurfaceNames, APartOfASurfaceCannotSlide)
{
  vtkNew<vtkMorphMesh> filter;
  filter->SetInputData(bar());
  filter->AddSurface("wall");
  filter->AddFreeSurface("inlet");
  grids::Listener listener(filter);
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_NE(
    listener.Errors[0].find("FreeSurfaces names 'inlet', which has a part alone of Surface"),
    std::string::npos)
    << listener.Errors[0];
  listener.Errors.clear();
  filter->RemoveAllFreeSurfaces();
  filter->AddSurface("walls");
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_NE(
    listener.Errors[0].find("which the boundary does not have; it has inlet, wall, Surface 0"),
    std::string::npos)
    << listener.Errors[0];
}
