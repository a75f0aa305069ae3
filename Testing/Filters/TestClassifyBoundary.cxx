// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include "../Core/BoundaryShapes.h"
#include "Mesh/Topology.h"
#include "vtkClassifyBoundary.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkOverlappingAMR.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

namespace
{
vtkSmartPointer<vtkClassifyBoundary> classifier(vtkDataObject* input)
{
  auto filter = vtkSmartPointer<vtkClassifyBoundary>::New();
  filter->SetInputDataObject(input);
  return filter;
}

std::array<vtkIdType, 3> counts(vtkClassifyBoundary* filter)
{
  return { filter->GetNumberOfVertices(), filter->GetNumberOfCurves(),
    filter->GetNumberOfSurfaces() };
}
using Counts = std::array<vtkIdType, 3>;

double at(vtkDataSetAttributes* data, const char* name, vtkIdType i)
{
  return data->GetArray(name)->GetComponent(i, 0);
}

/// Adds one quad per boundary face of a grid of hexahedra, with the cell array `Side`: `ids` by
/// the face's center.
vtkSmartPointer<vtkUnstructuredGrid> withSides(
  const morph::Mesh& volume, const std::function<int(const grids::Row&)>& ids)
{
  morph::Monitor monitor;
  const morph::BoundaryFaces faces = morph::boundaryFaces(volume, monitor);
  morph::Mesh mesh = volume;
  std::vector<morph::Index> side(mesh.numberOfCells(), 0);
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    std::vector<morph::Index> nodes(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
    side.push_back(ids(meshes::rows(mesh.points, nodes).colwise().mean()));
    std::rotate(nodes.begin(), nodes.begin() + 1, nodes.end());
    if (side.back() >= 0)
    {
      meshes::add(mesh, VTK_QUAD, nodes);
    }
    else
    {
      side.pop_back();
    }
  }
  auto grid = grids::make(mesh);
  vtkNew<vtkIdTypeArray> array;
  array->SetName("Side");
  for (morph::Index id : side)
  {
    array->InsertNextValue(id);
  }
  grid->GetCellData()->AddArray(array);
  return grid;
}
}

TEST(ClassifyBoundary, ArraysOfEveryCellType)
{
  for (const auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    SCOPED_TRACE(name);
    auto grid = grids::make(mesh);
    auto filter = classifier(grid);
    filter->Update();
    EXPECT_EQ(counts(filter), (Counts{ 8, 12, 6 }));
    vtkUnstructuredGrid* output = filter->GetOutput();
    ASSERT_EQ(output->GetNumberOfCells(), grid->GetNumberOfCells());
    vtkPointData* data = output->GetPointData();
    EXPECT_NE(vtkSignedCharArray::SafeDownCast(data->GetArray("GeometryDimension")), nullptr);
    EXPECT_NE(vtkIdTypeArray::SafeDownCast(data->GetArray("GeometryId")), nullptr);
    EXPECT_NE(vtkDoubleArray::SafeDownCast(data->GetArray("CurveParameter")), nullptr);
    EXPECT_NE(data->GetArray("Number"), nullptr);
    for (morph::Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      const auto p = mesh.points.row(n).array();
      const auto planes = (p == 0).count() + (p == grids::Row(3, 4, 2).array()).count();
      EXPECT_EQ(at(data, "GeometryDimension", n), 3 - planes);
      EXPECT_EQ(at(data, "CurveParameter", n) > 0, planes == 2);
    }
    EXPECT_EQ(grid->GetPointData()->GetArray("GeometryId"), nullptr); // the input is not touched
  }
}

TEST(ClassifyBoundary, SurfacesAreTheBoundaryThatTravels)
{
  auto grid = grids::make(meshes::quadraticTets(3, 2, 2));
  auto filter = classifier(grid);
  filter->Update();
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  extract->Update();
  vtkPolyData* surfaces = filter->GetSurfaces();
  ASSERT_EQ(surfaces->GetNumberOfCells(), extract->GetOutput()->GetNumberOfCells());
  EXPECT_EQ(grids::points(surfaces), grids::points(extract->GetOutput()));
  for (const char* name : { "MorphPointId", "RestPosition", "GeometryDimension", "GeometryId",
         "CurveParameter", "Number" })
  {
    EXPECT_NE(surfaces->GetPointData()->GetArray(name), nullptr) << name;
  }
  // All polygons of a side of the box, and no other, share an id.
  std::map<std::string, std::set<double>> idsOfSide;
  std::set<double> ids;
  vtkNew<vtkIdList> corners;
  const morph::Points x = grids::points(surfaces);
  for (vtkIdType c = 0; c < surfaces->GetNumberOfCells(); ++c)
  {
    surfaces->GetCellPoints(c, corners);
    std::string side;
    for (int j = 0; j < 3; ++j)
    {
      bool flat = true;
      for (vtkIdType k = 1; k < corners->GetNumberOfIds(); ++k)
      {
        flat = flat && x(corners->GetId(k), j) == x(corners->GetId(0), j);
      }
      side += flat ? std::to_string(j) + "=" + std::to_string(x(corners->GetId(0), j)) : "";
    }
    idsOfSide[side].insert(at(surfaces->GetCellData(), "GeometryId", c));
    ids.insert(at(surfaces->GetCellData(), "GeometryId", c));
  }
  EXPECT_EQ(idsOfSide.size(), 6u);
  EXPECT_EQ(ids, (std::set<double>{ 0, 1, 2, 3, 4, 5 }));

  // A morph takes them as they are.
  auto morph = grids::of<vtkFEMWarpMorph>(grid);
  morph->SetBoundaryConnection(filter->GetOutputPort(1));
  grids::update(morph);
  EXPECT_EQ(grids::points(morph->GetOutput()), grids::points(grid));
}

TEST(ClassifyBoundary, CurvesToLookAt)
{
  auto filter = classifier(grids::make(shapes::boxWithHole(16, 2, 3)));
  filter->Update();
  vtkPolyData* curves = filter->GetCurves();
  EXPECT_EQ(curves->GetNumberOfVerts(), 8);
  EXPECT_EQ(curves->GetNumberOfLines(), 14);
  int closed = 0;
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < curves->GetNumberOfCells(); ++c)
  {
    curves->GetCellPoints(c, points);
    const bool isLine = points->GetNumberOfIds() > 1;
    EXPECT_EQ(at(curves->GetCellData(), "GeometryDimension", c), isLine);
    closed += isLine && points->GetId(0) == points->GetId(points->GetNumberOfIds() - 1);
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      const vtkIdType p = points->GetId(k);
      if (at(curves->GetPointData(), "GeometryDimension", p) == isLine)
      {
        EXPECT_EQ(
          at(curves->GetPointData(), "GeometryId", p), at(curves->GetCellData(), "GeometryId", c));
      }
    }
  }
  EXPECT_EQ(closed, 2);
}

TEST(ClassifyBoundary, SurfaceIdsFromCells)
{
  const morph::Mesh box = meshes::hexes(4, 2, 2);
  // The top in two halves, one of them together with the sides; the bottom has no cells.
  auto grid = withSides(
    box, [](const grids::Row& c) { return c[2] == 0               ? -1
                                          : c[2] == 2 && c[0] < 2 ? 11
                                                                  : 12; });
  auto filter = classifier(grid);
  filter->SetSurfaceIdArray("Side");
  filter->Update();
  EXPECT_EQ(counts(filter)[2], 3);
  vtkPolyData* surfaces = filter->GetSurfaces();
  const morph::Points x = grids::points(surfaces);
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < surfaces->GetNumberOfCells(); ++c)
  {
    surfaces->GetCellPoints(c, corners);
    grids::Row center = grids::Row::Zero();
    for (vtkIdType k = 0; k < 4; ++k)
    {
      center += x.row(corners->GetId(k)) / 4;
    }
    const double expected = center[2] == 0 ? 13 : center[2] == 2 && center[0] < 2 ? 11 : 12;
    EXPECT_EQ(at(surfaces->GetCellData(), "GeometryId", c), expected);
  }

  // Without two-dimensional cells, the volume cells' own: two materials.
  auto plain = grids::make(box);
  vtkNew<vtkIdTypeArray> material;
  material->SetName("Material");
  for (vtkIdType c = 0; c < plain->GetNumberOfCells(); ++c)
  {
    material->InsertNextValue(c % 4 < 2 ? 5 : 6);
  }
  plain->GetCellData()->AddArray(material);
  filter->SetInputData(plain);
  filter->SetSurfaceIdArray("Material");
  filter->Update();
  EXPECT_EQ(counts(filter), (Counts{ 4, 4, 2 }));
  filter->FeaturesInsideOn();
  filter->Update();
  EXPECT_EQ(counts(filter), (Counts{ 12, 20, 10 }));
}

TEST(ClassifyBoundary, GeometryArraysComeBack)
{
  auto filter = classifier(grids::make(shapes::cylinder(4, 3)));
  filter->SetFeatureAngle(20);
  filter->Update();
  const Counts fine = counts(filter);
  EXPECT_EQ(fine[2], 18);
  vtkNew<vtkUnstructuredGrid> classified;
  classified->ShallowCopy(filter->GetOutput());

  auto again = classifier(classified);
  const grids::Run listener(again);
  EXPECT_EQ(counts(again), fine);
  EXPECT_TRUE(listener.Warnings.empty());
  for (vtkIdType n = 0; n < classified->GetNumberOfPoints(); ++n)
  {
    for (const char* name : { "GeometryDimension", "GeometryId" })
    {
      EXPECT_EQ(
        at(again->GetOutput()->GetPointData(), name, n), at(classified->GetPointData(), name, n));
    }
  }
  again->UseGeometryArraysOff();
  again->Update();
  EXPECT_EQ(counts(again), (Counts{ 0, 2, 3 }));
}

TEST(ClassifyBoundary, OneErrorAndNoOutput)
{
  auto good = grids::hexes(2);
  vtkNew<vtkOverlappingAMR> levels;
  vtkNew<vtkUnstructuredGrid> empty;
  const auto with = [&](const std::function<void(vtkUnstructuredGrid*)>& change)
  {
    auto grid = grids::copy(good);
    change(grid);
    return grid;
  };
  using grids::addNumbers;
  struct Case
  {
    vtkSmartPointer<vtkDataObject> Input;
    const char* SurfaceIds;
    std::string Telling;
  };
  const std::vector<Case> cases = { { empty.Get(), nullptr, "no cells" },
    { levels.Get(), nullptr, "vtkOverlappingAMR" }, { good, "Absent", "no cell array" },
    { with(
        [](vtkUnstructuredGrid* g)
        {
          vtkNew<vtkStringArray> names;
          names->SetName("Side");
          names->SetNumberOfValues(8);
          g->GetCellData()->AddArray(names);
        }),
      "Side", "not numeric" },
    { with([&](vtkUnstructuredGrid* g) { addNumbers(g->GetCellData(), "Side", 7, 1); }), "Side",
      "7 tuples for 8 cells" },
    { with([&](vtkUnstructuredGrid* g) { addNumbers(g->GetCellData(), "Side", 8, 1.5); }), "Side",
      "whole numbers" },
    { with([&](vtkUnstructuredGrid* g) { addNumbers(g->GetPointData(), "GeometryId", 27, 1); }),
      nullptr, "no GeometryDimension" },
    { with(
        [&](vtkUnstructuredGrid* g)
        {
          addNumbers(g->GetPointData(), "GeometryId", 27, 1);
          addNumbers(g->GetPointData(), "GeometryDimension", 27, 3);
        }),
      nullptr, "another dimension" },
    { with(
        [&](vtkUnstructuredGrid* g)
        {
          addNumbers(g->GetPointData(), "GeometryId", 27, 1);
          addNumbers(g->GetPointData(), "GeometryDimension", 26, 2);
        }),
      nullptr, "26 tuples for 27 points" },
    { with([](vtkUnstructuredGrid* g) { g->GetPoints()->SetPoint(3, 0, NAN, 0); }), nullptr,
      "not finite" } };
  for (const Case& c : cases)
  {
    SCOPED_TRACE(c.Telling);
    auto filter = classifier(good);
    filter->Update();
    EXPECT_EQ(counts(filter), (Counts{ 8, 12, 6 }));
    grids::Listener listener(filter);
    filter->SetInputDataObject(c.Input);
    filter->SetSurfaceIdArray(c.SurfaceIds);
    filter->Update();
    listener.ExpectError(c.Telling);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetSurfaces()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetCurves()->GetNumberOfPoints(), 0);
    EXPECT_EQ(counts(filter), (Counts{ 0, 0, 0 }));
    filter->SetInputData(good);
    filter->SetSurfaceIdArray("None");
    filter->Update();
    EXPECT_EQ(counts(filter), (Counts{ 8, 12, 6 }));
    EXPECT_EQ(listener.Errors.size(), 1u);
  }
}
