// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include "../Core/BoundaryShapes.h"
#include "vtkClassifyBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphBoundary.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace
{
using grids::Row;

vtkSmartPointer<vtkMorphBoundary> morpher(vtkUnstructuredGrid* grid, vtkDataObject* moved)
{
  auto filter = vtkSmartPointer<vtkMorphBoundary>::New();
  filter->SetInputData(grid);
  filter->SetBoundaryData(moved);
  return filter;
}

/// Largest distance of the output's points from the map of their undeformed positions.
double worst(vtkPolyData* output, const grids::Map& map)
{
  const morph::Points x = grids::points(output);
  vtkDataArray* rest = output->GetPointData()->GetArray("RestPosition");
  double largest = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const Row from(rest->GetComponent(i, 0), rest->GetComponent(i, 1), rest->GetComponent(i, 2));
    largest = std::max(largest, (x.row(i) - map(from)).norm());
  }
  return largest;
}

/// A closed surface of revolution about z from z = 0 to 2, with flat ends.
vtkSmartPointer<vtkPolyData> lathe(
  const std::function<double(double)>& radius, int around, int along, bool inwards)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  const auto add = [&](std::vector<vtkIdType> corners)
  {
    if (inwards)
    {
      std::reverse(corners.begin(), corners.end());
    }
    polygons->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
  };
  const auto point = [&](int a, int k)
  {
    const double angle = 2 * std::acos(-1.) * (a + 0.5) / around, z = 2. * k / along;
    return points->InsertNextPoint(radius(z) * std::cos(angle), radius(z) * std::sin(angle), z);
  };
  for (int a = 0; a < around; ++a)
  {
    for (int k = 0; k < along; ++k)
    {
      // A soup, as in an STL file: each polygon has its own points.
      add({ point(a, k), point(a + 1, k), point(a + 1, k + 1), point(a, k + 1) });
    }
    add({ points->InsertNextPoint(0, 0, 0), point(a + 1, 0), point(a, 0) });
    add({ points->InsertNextPoint(0, 0, 2), point(a, along), point(a + 1, along) });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(polygons);
  return surface;
}
}

TEST(MorphBoundary, NoMotionIsTheIdentityBitForBit)
{
  for (const int type : { VTK_DOUBLE, VTK_FLOAT })
  {
    morph::Mesh mesh = meshes::quadraticTets(3, 2, 2);
    meshes::transform(mesh, [](const Row& x) { return Row(0.1 * x); });
    auto grid = grids::make(mesh, type);
    for (int method = 0; method < 3; ++method)
    {
      for (int dimension = 0; dimension <= 2; ++dimension)
      {
        auto filter = morpher(grid, grids::boundary(grid, grids::same));
        filter->SetSurfaceMethod(method);
        filter->SetPrescribedDimension(dimension);
        filter->Update();
        EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), type);
        EXPECT_EQ(worst(filter->GetOutput(), grids::same), 0);
        EXPECT_EQ(filter->GetFoldedFaces(), 0);
      }
    }
  }
}

TEST(MorphBoundary, AffineMotionOfTheVerticesMovesAllAndTheVolumeFollows)
{
  for (auto& [name, mesh] : meshes::all(3, 4, 2))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    auto grid = grids::make(mesh);
    for (int method = 0; method < 3; ++method)
    {
      auto filter = morpher(grid, grids::boundary(grid, grids::affine));
      filter->SetSurfaceMethod(method);
      filter->SetPrescribedDimension(0);
      filter->Update();
      EXPECT_EQ(filter->GetGivenPoints(), 8);
      EXPECT_EQ(filter->GetFixedVertices(), 0);
      EXPECT_LE(worst(filter->GetOutput(), grids::affine), 1e-10 * meshes::size(mesh.points));

      auto volume = grids::of<vtkFEMWarpMorph>(grid);
      volume->SetBoundaryConnection(filter->GetOutputPort());
      volume->Update();
      const morph::Points moved = grids::points(volume->GetOutput());
      const morph::Points expected = grids::mapped(mesh.points, grids::affine);
      EXPECT_LE((moved - expected).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(MorphBoundary, MeshSmoothingIsAsGoodAsSmoothingAndNamesWhatItKept)
{
  // The hole comes near a side. Top and bottom are smoothed; the hole moves as it is.
  auto grid = grids::make(shapes::boxWithHole(48, 8, 2));
  const auto map = [](const Row& x)
  { return Row(x.head<2>().norm() < 1.01 ? Row(x + Row(0.8, 0, 0)) : x); };
  auto filter = morpher(grid, grids::boundary(grid, map));
  grids::Listener silence(filter);
  filter->SetSurfaceMethodToSmoothing();
  filter->Update();
  const double minimum = filter->GetMinScaledJacobian(), mean = filter->GetMeanScaledJacobian();
  EXPECT_EQ(filter->GetSmoothedSurfaces(), 0);
  filter->SetSurfaceMethodToMeshSmoothing();
  filter->Update();
  EXPECT_EQ(filter->GetFoldedFaces(), 0);
  EXPECT_GE(filter->GetMinScaledJacobian(), minimum);
  const bool allKept = filter->GetSmoothedSurfaces() == 0;
  EXPECT_TRUE(
    allKept || filter->GetMinScaledJacobian() > minimum || filter->GetMeanScaledJacobian() > mean);
  EXPECT_EQ(allKept, std::string(filter->GetKeptSurfaces()).find(", ") != std::string::npos);
  EXPECT_NE(filter->GetOutput()->GetFieldData()->GetAbstractArray("KeptSurfaces"), nullptr);
}

TEST(MorphBoundary, MeshSmoothingKeepsNodesOnTheTarget)
{
  auto grid = grids::make(shapes::cylinder(8, 8));
  const auto turn = [](const Row& x)
  {
    const double angle = 0.2 * x[0] * x[2];
    return Row(x[0] * std::cos(angle) - x[1] * std::sin(angle),
      x[0] * std::sin(angle) + x[1] * std::cos(angle), x[2]);
  };
  auto filter = morpher(grid, grids::boundary(grid, turn));
  grids::Listener silence(filter);
  filter->SetTargetData(lathe([](double) { return 1.; }, 200, 1, false));
  filter->SetSurfaceMethodToMeshSmoothing();
  filter->Update();
  EXPECT_EQ(filter->GetUnprojectedPoints(), 0);
  EXPECT_EQ(filter->GetFoldedFaces(), 0);
  EXPECT_GT(filter->GetSmoothedSurfaces(), 0);
  const morph::Points moved = grids::points(filter->GetOutput());
  vtkDataArray* dimension = filter->GetOutput()->GetPointData()->GetArray("GeometryDimension");
  for (morph::Index i = 0; i < moved.rows(); ++i)
  {
    const bool isCap = moved(i, 2) < 1e-9 || moved(i, 2) > 2 - 1e-9;
    if (dimension->GetComponent(static_cast<vtkIdType>(i), 0) == 2 && !isCap)
    {
      // On one of 200 flat sides.
      EXPECT_LE(moved.row(i).head<2>().norm(), 1 + 1e-9);
      EXPECT_GE(moved.row(i).head<2>().norm(), std::cos(std::acos(-1.) / 200) - 1e-9);
    }
  }
}

TEST(MorphBoundary, WhatIsWritten)
{
  auto grid = grids::hexes(4);
  auto filter = morpher(grid, grids::boundary(grid, grids::twist));
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  for (const char* name : { "MorphPointId", "RestPosition", "GeometryDimension", "GeometryId",
         "CurveParameter", "MorphDisplacement", "Number" })
  {
    EXPECT_NE(output->GetPointData()->GetArray(name), nullptr) << name;
  }
  for (const char* name : { "GeometryId", "MorphCellId", "ScaledJacobian", "Cell" })
  {
    EXPECT_NE(output->GetCellData()->GetArray(name), nullptr) << name;
  }
  vtkDataArray* quality = output->GetCellData()->GetArray("ScaledJacobian");
  EXPECT_EQ(quality, output->GetCellData()->GetScalars());
  EXPECT_NEAR(quality->GetRange()[0], filter->GetMinScaledJacobian(), 1e-15);
  EXPECT_EQ(output->GetFieldData()->GetArray("MinScaledJacobian")->GetComponent(0, 0),
    filter->GetMinScaledJacobian());
  // Curve nodes were given and are exact.
  const morph::Points x = grids::points(output), rest = grids::points(grid);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    if (output->GetPointData()->GetArray("GeometryDimension")->GetComponent(i, 0) <= 1)
    {
      const auto id = static_cast<morph::Index>(
        output->GetPointData()->GetArray("MorphPointId")->GetComponent(i, 0));
      EXPECT_EQ(Row(x.row(i)), grids::twist(rest.row(id)));
    }
  }
}

TEST(MorphBoundary, AFewVerticesByIdAndClassifiedInput)
{
  // Two vertices as bare points with ids; the others are held. Ids of interior nodes are ignored.
  auto classify = grids::of<vtkClassifyBoundary>(grids::hexes(4));
  classify->Update();
  auto* grid = classify->GetOutput();
  morph::Points targets(3, 3);
  targets << -1, 0, 0, 5, 0, 0, 9, 9, 9;
  auto moved = grids::cloud(targets);
  grids::addIds(moved, "Node", { 0, 4, 62 });
  auto filter = morpher(grid, moved);
  filter->SetBoundaryIdArray("Node");
  filter->Update();
  EXPECT_EQ(filter->GetGivenPoints(), 2);
  EXPECT_EQ(filter->GetFixedVertices(), 6);
  const morph::Points x = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i <= 4; ++i)
  {
    EXPECT_LE((x.row(i) - Row(-1 + 1.5 * static_cast<double>(i), 0, 0)).norm(), 1e-14);
  }
  EXPECT_EQ(filter->GetFoldedFaces(), 0);

  filter->SetScaleFactor(0.5);
  filter->Update();
  EXPECT_LE((grids::points(filter->GetOutput()).row(0) - Row(-0.5, 0, 0)).norm(), 1e-14);
}

TEST(MorphBoundary, ThreadsDoNotShow)
{
  auto grid = grids::make(shapes::boxWithHole(32, 8, 8));
  auto filter = morpher(grid, grids::boundary(grid, grids::twist));
  filter->SetNumberOfThreads(1);
  filter->Update();
  const morph::Points one = grids::points(filter->GetOutput());
  filter->SetNumberOfThreads(3);
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), one);
}

TEST(MorphBoundary, FoldedFacesAreNamed)
{
  // One corner of the box is pulled through its face.
  auto grid = grids::hexes(4);
  morph::Points targets(1, 3);
  targets << 3, 3, 0;
  auto moved = grids::cloud(targets);
  grids::addIds(moved, "MorphPointId", { 0 });
  auto filter = morpher(grid, moved);
  const grids::Run listener(filter);
  EXPECT_LT(filter->GetMinScaledJacobian(), 0);
  EXPECT_GT(filter->GetFoldedFaces(), 0);
  listener.ExpectWarning("folded");
  EXPECT_TRUE(listener.Errors.empty());
}

TEST(MorphBoundary, ProjectsOntoATarget)
{
  // A cylinder whose wall bulges while its rims stay round.
  auto grid = grids::make(shapes::cylinder(8, 8));
  const auto radius = [](double z) { return 1 + 0.15 * std::sin(std::acos(-1.) * z / 2); };
  for (const bool inwards : { false, true })
  {
    auto filter = morpher(grid, grids::boundary(grid, grids::same));
    filter->SetTargetData(lathe(radius, 64, 32, inwards));
    grids::updateQuietly(filter);
    EXPECT_EQ(filter->GetUnprojectedPoints(), 0);
    EXPECT_EQ(filter->GetProjectedPoints(), 32 * 7 + 2 * 49);
    EXPECT_EQ(filter->GetFoldedFaces(), 0);
    const morph::Points x = grids::points(filter->GetOutput());
    double off = 0, bulge = 0;
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      const double r = x.row(i).head(2).norm();
      const bool onEnd = x(i, 2) < 1e-9 || x(i, 2) > 2 - 1e-9;
      off = std::max(off, onEnd ? 0 : std::abs(r - radius(x(i, 2))));
      bulge = std::max(bulge, r);
    }
    EXPECT_LE(off, 1e-3 * std::sqrt(12.)); // the target's own polygons are nearer than that
    EXPECT_GT(bulge, 1.14);
  }
}

TEST(MorphBoundary, CurveNodesGoToTheTargetsFeatures)
{
  // Nothing but the plate's vertices is given; the cylinder's rims are found on the target.
  auto grid = grids::make(shapes::cylinder(8, 4));
  auto all = grids::boundary(grid, grids::same);
  auto filter = morpher(grid, all);
  filter->SetTargetData(lathe([](double) { return 1.05; }, 128, 8, false));
  // One node of each surface keeps them in place; rims have no vertex, so nothing else is given.
  filter->SetPrescribedDimension(2);
  morph::Points targets(1, 3);
  targets.row(0) = grids::points(grid).row(4 * 9 + 4);
  auto one = grids::cloud(targets);
  grids::addIds(one, "MorphPointId", { 4 * 9 + 4 });
  filter->SetBoundaryData(one);
  filter->Update();
  const morph::Points x = grids::points(filter->GetOutput());
  auto* dimension = filter->GetOutput()->GetPointData()->GetArray("GeometryDimension");
  int onCurves = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (dimension->GetComponent(i, 0) == 1)
    {
      ++onCurves;
      EXPECT_NEAR(x.row(i).head(2).norm(), 1.05, 1e-3);
    }
  }
  EXPECT_EQ(onCurves, 64);
}

TEST(MorphBoundary, AThinWallKeepsItsSides)
{
  // A plate of thickness 0.1 is to become 0.3 thick; the middle of the target's bottom is nearer to
  // the plate's top than its top is.
  morph::Mesh mesh = meshes::hexes(6, 6, 1);
  meshes::transform(mesh, [](const Row& x) { return Row(x[0], x[1], 0.1 * x[2]); });
  auto grid = grids::make(mesh);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  for (const double z : { 0.05, 0.35 })
  {
    for (const auto& [x, y] : { std::pair(-1., -1.), { 7., -1. }, { 7., 7. }, { -1., 7. } })
    {
      points->InsertNextPoint(x, y, z);
    }
  }
  const vtkIdType bottom[] = { 3, 2, 1, 0 }, top[] = { 4, 5, 6, 7 };
  polygons->InsertNextCell(4, bottom);
  polygons->InsertNextCell(4, top);
  vtkNew<vtkPolyData> target;
  target->SetPoints(points);
  target->SetPolys(polygons);
  auto filter = morpher(grid, grids::boundary(grid, grids::same));
  filter->SetTargetData(target);
  filter->Update();
  int tops = 0;
  const morph::Points x = grids::points(filter->GetOutput());
  vtkDataArray* rest = filter->GetOutput()->GetPointData()->GetArray("RestPosition");
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (filter->GetOutput()->GetPointData()->GetArray("GeometryDimension")->GetComponent(i, 0) == 2)
    {
      const bool isTop = rest->GetComponent(i, 2) > 0.05;
      tops += isTop;
      EXPECT_NEAR(x(i, 2), isTop ? 0.35 : 0.05, 1e-12);
    }
  }
  EXPECT_EQ(tops, 25);
}

TEST(MorphBoundary, WallsOfATubeStayApart)
{
  // A tube that is to bend sideways by more than its radius while its ends stay: the nearest places
  // with a fitting normal are on the other wall, but each wall's rims lie on its own.
  const auto tube = [](int around, int layers, double bend)
  {
    morph::Mesh mesh = shapes::boxWithHole(around, 1, layers);
    meshes::transform(mesh,
      [&](const Row& x)
      {
        const double z = 6 * x[2] / layers, r = x.head(2).norm();
        const double scale = (r > 1 + 1e-9 ? 1 : 0.8) / r;
        const double shift = bend * std::sin(std::acos(-1.) * z / 6);
        return Row(x[0] * scale + shift, x[1] * scale, z);
      });
    return mesh;
  };
  auto classify = grids::of<vtkClassifyBoundary>(grids::make(tube(24, 24, 0)));
  classify->Update();
  ASSERT_EQ(classify->GetNumberOfSurfaces(), 4);
  auto* grid = classify->GetOutput();
  auto filter = morpher(grid, grids::boundary(grid, grids::same));
  filter->SetTargetData(grids::boundary(grids::make(tube(64, 64, 1.2)), grids::same));
  filter->SetTargetReach(0.5);
  filter->Update();
  EXPECT_EQ(filter->GetUnprojectedPoints(), 0);
  EXPECT_EQ(filter->GetProjectedPoints(), 2 * 24 * 23);
  EXPECT_EQ(filter->GetFoldedFaces(), 0);
  const morph::Points x = grids::points(filter->GetOutput());
  vtkDataArray* rest = filter->GetOutput()->GetPointData()->GetArray("RestPosition");
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const double wall = std::hypot(rest->GetComponent(i, 0), rest->GetComponent(i, 1));
    const double shift = 1.2 * std::sin(std::acos(-1.) * x(i, 2) / 6);
    EXPECT_NEAR(std::hypot(x(i, 0) - shift, x(i, 1)), wall, 3e-3);
  }
}

TEST(MorphBoundary, WhatATargetLacksIsNamed)
{
  auto grid = grids::hexes(4);
  auto filter = morpher(grid, grids::boundary(grid, grids::same));
  filter->SetPrescribedDimension(0);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(2, 2, 2);
  sphere->SetRadius(2.3);
  sphere->SetThetaResolution(64);
  sphere->SetPhiResolution(64);
  filter->SetTargetConnection(sphere->GetOutputPort());
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  ASSERT_FALSE(listener.Warnings.empty());
  EXPECT_NE(listener.Warnings[0].find("no feature edges"), std::string::npos)
    << listener.Warnings[0];
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 98);
  EXPECT_GE(filter->GetUnprojectedPoints(), 36);
  EXPECT_GT(filter->GetProjectedPoints(), 0);
  EXPECT_EQ(filter->GetFoldedFaces(), 0);
}

TEST(MorphBoundary, NonManifoldBoundaries)
{
  // Boxes that share an edge, boxes that share a node, and a box with a hole through it.
  const morph::Mesh box = meshes::hexes(4, 4, 4);
  const auto low = [](double x) { return x < 2; };
  for (const morph::Mesh& mesh :
    {
      shapes::cut(box, [&](const Row& x) { return low(x[0]) == low(x[1]); }),
      shapes::cut(
        box, [&](const Row& x) { return low(x[0]) == low(x[1]) && low(x[1]) == low(x[2]); }),
      shapes::cut(box, [](const Row& x) { return (x.head(2).array() - 2).abs().maxCoeff() > 1; }),
    })
  {
    auto grid = grids::make(mesh);
    for (int method = 0; method < 3; ++method)
    {
      auto filter = morpher(grid, grids::boundary(grid, grids::affine));
      grids::Listener listener(filter);
      filter->SetSurfaceMethod(method);
      filter->SetPrescribedDimension(0);
      filter->Update();
      EXPECT_TRUE(listener.Errors.empty() && listener.Warnings.empty());
      EXPECT_LE(worst(filter->GetOutput(), grids::affine), 1e-10 * meshes::size(mesh.points));
      EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
      EXPECT_EQ(filter->GetFoldedFaces(), 0);
    }
  }
}

TEST(MorphBoundary, AnOpenTargetIsProjectedOntoWhereItIs)
{
  // Half of the top has a target, 0.1 above it; the other nodes find none, stay and are named.
  auto grid = grids::make(meshes::hexes(6, 6, 2));
  morph::Points corners(4, 3);
  corners << -1, -1, 2.1, 3.4, -1, 2.1, 3.4, 7, 2.1, -1, 7, 2.1;
  auto target = grids::cloud(corners);
  vtkNew<vtkCellArray> polygons;
  const vtkIdType ids[] = { 0, 1, 2, 3 };
  polygons->InsertNextCell(4, ids);
  target->SetPolys(polygons);
  auto filter = morpher(grid, grids::boundary(grid, grids::same));
  filter->SetTargetData(target);
  filter->SetTargetReach(0.15 / std::sqrt(76.));
  grids::expectWarning(filter, "no place within `TargetReach`");
  EXPECT_EQ(filter->GetProjectedPoints(), 3 * 5);
  EXPECT_EQ(filter->GetUnprojectedPoints(), 2 * 5 + 25 + 4 * 5);
  const morph::Points x = grids::points(filter->GetOutput());
  EXPECT_EQ((x.col(2).array() > 2).count(), 3 * 5);
  EXPECT_EQ((x.col(2).array() == 2.1).count(), 3 * 5);
  EXPECT_EQ(worst(filter->GetOutput(),
              [](const Row& p) {
                return p[2] == 2 && p[0] > 0 && p[0] < 3.5 && p[1] > 0 && p[1] < 6
                         ? Row(p[0], p[1], 2.1)
                         : p;
              }),
    0);
}

TEST(MorphBoundary, ArraysOfTheWrongTypeOrLength)
{
  auto grid = grids::hexes(2);
  using grids::addNumbers;
  using Change =
    std::function<void(vtkMorphBoundary*, vtkUnstructuredGrid * grid, vtkPolyData * moved)>;
  const std::vector<std::pair<std::string, Change>> cases = {
    { "no cell array", [](auto* filter, auto*, auto*) { filter->SetSurfaceIdArray("Absent"); } },
    { "7 tuples for 8 cells",
      [&](auto* filter, auto* g, auto*)
      {
        addNumbers(g->GetCellData(), "Side", 7, 1);
        filter->SetSurfaceIdArray("Side");
      } },
    { "components",
      [&](auto* filter, auto* g, auto*)
      {
        addNumbers(g->GetCellData(), "Side", 8, 1, 3);
        filter->SetSurfaceIdArray("Side");
      } },
    { "26 tuples for 27 points",
      [&](auto*, auto* g, auto*)
      {
        addNumbers(g->GetPointData(), "GeometryDimension", 26, 2);
        addNumbers(g->GetPointData(), "GeometryId", 27, 1);
      } },
    { "Gone", [](auto* filter, auto*, auto*) { filter->SetBoundaryIdArray("Gone"); } },
    { "Gone", [](auto* filter, auto*, auto*) { filter->SetDisplacementArray("Gone"); } },
    { "5 ",
      [&](auto* filter, auto*, auto* moved)
      {
        addNumbers(moved->GetPointData(), "Move", 5, 1, 3);
        filter->SetDisplacementArray("Move");
      } },
    { "components",
      [&](auto* filter, auto*, auto* moved)
      {
        addNumbers(moved->GetPointData(), "Move", 26, 1, 2);
        filter->SetDisplacementArray("Move");
      } },
  };
  for (const auto& [telling, change] : cases)
  {
    SCOPED_TRACE(telling);
    auto own = grids::copy(grid);
    auto moved = grids::boundary(grid, grids::twist);
    auto filter = morpher(own, moved);
    filter->Update();
    ASSERT_EQ(filter->GetOutput()->GetNumberOfPoints(), 26);
    change(filter, own, moved);
    filter->Modified();
    grids::expectError(filter, telling);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(own->GetNumberOfPoints(), 27);
    EXPECT_EQ(moved->GetNumberOfPoints(), 26);
  }
}

TEST(MorphBoundary, OneErrorAndNoOutput)
{
  auto grid = grids::hexes(2);
  auto moved = grids::boundary(grid, grids::twist);
  vtkNew<vtkPolyData> empty;
  auto wrongTarget = lathe([](double) { return 1.; }, 8, 2, false);
  wrongTarget->GetPoints()->SetPoint(5, NAN, 0, 0);
  auto ball = grids::make(shapes::ball(8));
  morph::Points center(1, 3);
  center << 0, 0, 0;
  auto inside = grids::cloud(center);
  grids::addIds(inside, "MorphPointId", { 13 });
  struct Case
  {
    vtkSmartPointer<vtkUnstructuredGrid> Grid;
    vtkSmartPointer<vtkDataObject> Moved;
    vtkSmartPointer<vtkDataObject> Target;
    std::string Telling;
  };
  const std::vector<Case> cases = { { grid, nullptr, nullptr, "Boundary: nothing is connected" },
    { grid, empty.Get(), nullptr, "no points" }, { grid, moved, empty.Get(), "no polygons" },
    { grid, moved, wrongTarget, "not finite" }, { grid, moved, grid, "polygonal data" },
    { ball, grids::boundary(ball, grids::same), nullptr, "Raise `PrescribedDimension`" },
    { grid, inside, nullptr, "vertex or curve" } };
  for (const Case& c : cases)
  {
    SCOPED_TRACE(c.Telling);
    auto filter = morpher(c.Grid, c.Moved);
    filter->SetTargetData(c.Target);
    const grids::Run listener(filter);
    listener.ExpectError(c.Telling);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetMinScaledJacobian(), -1);
    EXPECT_EQ(filter->GetFoldedFaces(), -1);
    vtkFieldData* field = filter->GetOutput()->GetFieldData();
    EXPECT_EQ(field->GetArray("FoldedFaces")->GetComponent(0, 0), -1);
    filter->SetInputData(grid);
    filter->SetBoundaryData(moved);
    filter->SetTargetData(nullptr);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 26);
    EXPECT_EQ(listener.Errors.size(), 1u);
  }
}
