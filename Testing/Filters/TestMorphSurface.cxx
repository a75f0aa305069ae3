// SPDX-License-Identifier: BSD-3-Clause
// The third output of the morphing filters: the outer boundary of the mesh, whose polygons stay.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkMorphMesh.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
/// A motion of part of a 4 x 4 x 4 cube's boundary that grows with `size`.
auto bulge(double size)
{
  return [size](const grids::Row& x) -> grids::Row {
    return { x[0], x[1] + 0.02 * size * x[0] * x[2], x[2] };
  };
}

vtkPolyData* surfaceOf(vtkAlgorithm* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
}

/// That the surface has the points and the quality of the mesh, node by node and cell by cell.
void expectSurfaceOf(vtkUnstructuredGrid* mesh, vtkPolyData* surface)
{
  const morph::Points nodes = grids::points(mesh), outer = grids::points(surface);
  vtkDataArray* ids = surface->GetPointData()->GetArray("MorphPointId");
  ASSERT_NE(ids, nullptr);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(outer.row(i), nodes.row(static_cast<morph::Index>(ids->GetComponent(i, 0))));
  }
  vtkDataArray* owners = surface->GetCellData()->GetArray("MorphCellId");
  vtkDataArray* quality = surface->GetCellData()->GetScalars();
  ASSERT_NE(owners, nullptr);
  ASSERT_NE(quality, nullptr);
  EXPECT_STREQ(quality->GetName(), "ScaledJacobian");
  vtkDataArray* expected = mesh->GetCellData()->GetArray("ScaledJacobian");
  for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i)
  {
    const auto owner = static_cast<vtkIdType>(owners->GetComponent(i, 0));
    EXPECT_EQ(quality->GetComponent(i, 0), expected->GetComponent(owner, 0));
  }
}

void expectUndeformed(vtkUnstructuredGrid* grid, vtkPolyData* surface)
{
  ASSERT_EQ(surface->GetNumberOfCells(), 6 * 16);
  EXPECT_EQ(surface->GetCellData()->GetArray("ScaledJacobian"), nullptr);
  const morph::Points outer = grids::points(surface), rest = grids::points(grid);
  vtkDataArray* ids = surface->GetPointData()->GetArray("MorphPointId");
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(outer.row(i), rest.row(static_cast<morph::Index>(ids->GetComponent(i, 0))));
  }
}

class MorphSurface : public testing::TestWithParam<grids::MorphFilter>
{
};
}

TEST_P(MorphSurface, FollowsTheMeshAndKeepsItsPolygons)
{
  auto grid = grids::hexes(4);
  auto filter = GetParam().of(grid, bulge(1));
  filter->Update();
  vtkCellArray* polygons = surfaceOf(filter)->GetPolys();
  EXPECT_EQ(surfaceOf(filter)->GetNumberOfCells(), 6 * 16);
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));

  filter->SetBoundaryData(grids::boundary(grid, bulge(2)));
  filter->Update();
  EXPECT_EQ(surfaceOf(filter)->GetPolys(), polygons);
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));

  auto other = grids::hexes(3);
  filter->SetInputData(other);
  filter->SetBoundaryData(grids::boundary(other, bulge(1)));
  filter->Update();
  EXPECT_EQ(surfaceOf(filter)->GetNumberOfCells(), 6 * 9);
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));
}

TEST_P(MorphSurface, HasFeatureLinesIfAsked)
{
  auto grid = grids::hexes(4);
  auto filter = GetParam().of(grid, bulge(1));
  filter->FeatureLinesOn();
  filter->Update();
  vtkPolyData* surface = surfaceOf(filter);
  const vtkIdType lines = 12 * 4; // the edges of a box
  ASSERT_EQ(surface->GetNumberOfLines(), lines);
  ASSERT_EQ(surface->GetNumberOfCells(), lines + 6 * 16);
  vtkDataArray* cells = surface->GetCellData()->GetArray("MorphCellId");
  vtkDataArray* quality = surface->GetCellData()->GetArray("ScaledJacobian");
  vtkDataArray* ofMesh = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
  vtkDataArray* rest = surface->GetPointData()->GetArray("MorphPointId");
  const morph::Points before = grids::points(grid);
  for (vtkIdType i = 0; i < lines; ++i)
  {
    EXPECT_EQ(cells->GetComponent(i, 0), -1);
    EXPECT_TRUE(std::isnan(quality->GetComponent(i, 0)));
    // Both ends lie on the same two sides of the box.
    vtkIdList* ends = surface->GetCell(i)->GetPointIds();
    ASSERT_EQ(ends->GetNumberOfIds(), 2);
    int sides = 0;
    for (int j = 0; j < 3; ++j)
    {
      const double a = before(static_cast<vtkIdType>(rest->GetComponent(ends->GetId(0), 0)), j);
      const double b = before(static_cast<vtkIdType>(rest->GetComponent(ends->GetId(1), 0)), j);
      sides += a == b && (a == before.col(j).minCoeff() || a == before.col(j).maxCoeff());
    }
    EXPECT_EQ(sides, 2);
  }
  for (vtkIdType i = lines; i < surface->GetNumberOfCells(); ++i)
  {
    EXPECT_EQ(quality->GetComponent(i, 0),
      ofMesh->GetComponent(static_cast<vtkIdType>(cells->GetComponent(i, 0)), 0));
  }
  // Those of other points: the box gets a ridge along its top and its bottom.
  auto folded = grids::copy(grid);
  for (vtkIdType i = 0; i < folded->GetNumberOfPoints(); ++i)
  {
    double x[3];
    folded->GetPoint(i, x);
    folded->GetPoints()->SetPoint(i, x[0], x[1], x[2] - std::abs(x[0] - 2));
  }
  filter->SetInputData(folded);
  filter->SetBoundaryData(grids::boundary(folded, bulge(1)));
  filter->Update();
  EXPECT_EQ(surfaceOf(filter)->GetNumberOfLines(), lines + 2 * 4);
  filter->FeatureLinesOff();
  filter->Update();
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));
  EXPECT_EQ(surfaceOf(filter)->GetNumberOfLines(), 0);
}

TEST_P(MorphSurface, IsTheUndeformedOneAfterAnError)
{
  auto grid = grids::hexes(4);
  auto filter = GetParam().make();
  filter->SetInputData(grid);
  auto boundary = grids::boundary(grid, bulge(1));
  boundary->GetPoints()->SetPoint(0, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  filter->SetBoundaryData(boundary);
  const grids::Run listener(filter);
  ASSERT_EQ(listener.Errors.size(), 1u);
  expectUndeformed(grid, surfaceOf(filter));
  // Also where the mesh was not looked at.
  filter->SetInputConnection(1, nullptr);
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 2u);
  expectUndeformed(grid, surfaceOf(filter));
}

TEST_P(MorphSurface, MeasuresItsCellsAloneIfAsked)
{
  auto grid = grids::hexes(4);
  auto filter = GetParam().make(), all = GetParam().make();
  for (vtkMorphAlgorithm* each : { filter.Get(), all.Get() })
  {
    each->SetInputData(grid);
    each->SetBoundaryData(grids::boundary(grid, bulge(1)));
    each->CertifyOn();
  }
  filter->SetQualityToSurface();
  filter->Update();
  all->Update();
  vtkUnstructuredGrid* output = filter->GetOutput();
  EXPECT_EQ(grids::points(output), grids::points(all->GetOutput()));
  EXPECT_FALSE(output->GetCellData()->HasArray("ScaledJacobian"));
  EXPECT_FALSE(output->GetCellData()->HasArray("JacobianCertificate"));
  EXPECT_STREQ(filter->GetMorphStatus(), "Unmeasured");
  EXPECT_EQ(filter->GetMinScaledJacobian(), -1);
  EXPECT_EQ(filter->GetInvertedCells(), -1);
  EXPECT_EQ(filter->GetSurfaceInvertedCells(), 0);
  EXPECT_EQ(all->GetSurfaceInvertedCells(), 0);
  expectSurfaceOf(all->GetOutput(), surfaceOf(filter));

  // What was measured before, and the input's own arrays, do not pass for this result's.
  all->SetQualityToSurface();
  all->Update();
  EXPECT_FALSE(all->GetOutput()->GetCellData()->HasArray("ScaledJacobian"));
  EXPECT_EQ(all->GetInvertedCells(), -1);
  // A valid mesh that is asked for comes first.
  filter->SetValidityToRefuse();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

INSTANTIATE_TEST_SUITE_P(Filters, MorphSurface, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });

TEST(MorphMeshSurface, IsThatOfTheMethodOrTheBoundaryThatIsChosenFrom)
{
  auto grid = grids::hexes(4);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->Update();
  EXPECT_EQ(surfaceOf(filter)->GetNumberOfCells(), 6 * 16);
  EXPECT_NE(surfaceOf(filter)->GetCellData()->GetArray("SurfaceId"), nullptr);
  filter->SetMovingToEverything();
  grids::moveBy(filter, 1, 2, 3);
  filter->Update();
  vtkCellArray* polygons = surfaceOf(filter)->GetPolys();
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));
  filter->SetVector(1, 2, 4);
  filter->Update();
  EXPECT_EQ(surfaceOf(filter)->GetPolys(), polygons);
  expectSurfaceOf(filter->GetOutput(), surfaceOf(filter));
}
