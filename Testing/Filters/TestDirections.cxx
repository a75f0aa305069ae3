// SPDX-License-Identifier: BSD-3-Clause
// Arrays that give directions, in a mesh that turns.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkBoundaryDisplacement.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphBoundary.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using grids::Row;

vtkSmartPointer<vtkDoubleArray> rows(const char* name, vtkIdType count, const Row& row)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < count; ++i)
  {
    array->InsertNextTuple3(row[0], row[1], row[2]);
  }
  return array;
}

/// A grid with normals, fibers, velocities and, in some of its cells, orientations.
vtkSmartPointer<vtkUnstructuredGrid> directed()
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  const vtkIdType points = grid->GetNumberOfPoints(), cells = grid->GetNumberOfCells();
  grid->GetPointData()->SetNormals(rows("Outward", points, Row(0, 0, 1)));
  grid->GetCellData()->SetNormals(rows("Flat", cells, Row(0, 1, 0)));
  grid->GetCellData()->AddArray(rows("Fiber", cells, Row(0.6, 0, 0.8)));
  grid->GetPointData()->AddArray(rows("Velocity", points, Row(3, 0, 0)));
  vtkNew<vtkDoubleArray> frames;
  frames->SetName("Frame");
  frames->SetNumberOfComponents(9);
  for (vtkIdType c = 0; c < cells; ++c)
  {
    const double one = c < 5;
    frames->InsertNextTuple9(one, 0, 0, 0, one, 0, 0, 0, one);
  }
  grid->GetCellData()->AddArray(frames);
  return grid;
}

grids::Map turn(double degrees)
{
  const double a = degrees * std::acos(-1.) / 180;
  return [a](const Row& x)
  {
    return Row(
      std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1], x[2]);
  };
}

std::vector<std::string> warningsOf(const grids::Map& map)
{
  auto grid = directed();
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, map);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  return listener.Warnings;
}
}

TEST(Directions, NormalsAreLeftOut)
{
  auto grid = directed();
  auto volume = grids::morphed<vtkFEMWarpMorph>(grid, turn(90));
  auto displaced = grids::of<vtkBoundaryDisplacement>(grid);
  auto boundary = grids::of<vtkMorphBoundary>(grid);
  boundary->SetBoundaryData(grids::boundary(grid, turn(90)));
  for (vtkAlgorithm* filter : { static_cast<vtkAlgorithm*>(volume),
         static_cast<vtkAlgorithm*>(displaced), static_cast<vtkAlgorithm*>(boundary) })
  {
    filter->Update();
    auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    SCOPED_TRACE(filter->GetClassName());
    EXPECT_TRUE(output->GetPointData()->HasArray("Velocity"));
    EXPECT_FALSE(output->GetPointData()->HasArray("Outward"));
    EXPECT_FALSE(output->GetCellData()->HasArray("Flat"));
  }
  EXPECT_TRUE(volume->GetOutput()->GetCellData()->HasArray("Fiber"));
  EXPECT_TRUE(grid->GetPointData()->GetNormals() && grid->GetCellData()->GetNormals());
}

TEST(Directions, OthersAreNamedWhereCellsTurn)
{
  for (const double degrees : { 1.1, -30., 90., 180. })
  {
    const std::vector<std::string> warnings = warningsOf(turn(degrees));
    ASSERT_EQ(warnings.size(), 1u) << degrees;
    EXPECT_NE(warnings[0].find("'Fiber', 'Frame'"), std::string::npos) << warnings[0];
    EXPECT_EQ(warnings[0].find("Velocity"), std::string::npos) << warnings[0];
  }
}

TEST(Directions, NothingIsSaidWhereNoCellTurns)
{
  EXPECT_TRUE(warningsOf(turn(0.9)).empty());
  // A stretch along the diagonal has off-diagonal terms, and no rotation.
  EXPECT_TRUE(warningsOf(
    [](const Row& x) {
      return Row(2 * x[0] + x[1], x[0] + 2 * x[1], 5 * x[2]);
    }).empty());
}
