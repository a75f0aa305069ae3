// SPDX-License-Identifier: BSD-3-Clause
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "vtkClassifyBoundary.h"
#include "vtkExtractMorphBoundary.h"

#include <vtkBox.h>
#include <vtkCallbackCommand.h>
#include <vtkCellType.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace displaced;
using grids::Row;

namespace
{
using Change = std::function<void(vtkBoundaryDisplacement*)>;

vtkSmartPointer<vtkTransform> transformWith(int row, int column, double value)
{
  auto transform = vtkSmartPointer<vtkTransform>::New();
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(row, column, value);
  transform->SetMatrix(matrix);
  return transform;
}

void select(vtkBoundaryDisplacement* f, vtkSelection* selection)
{
  f->SetMovingToSelection();
  f->SetSelectionData(selection);
}

/// Moves by a point array of the input.
void byArray(
  vtkBoundaryDisplacement* f, const char* name, int components, vtkIdType n, double value)
{
  auto* data = vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0));
  grids::addNumbers(data->GetPointData(), name, n, value, components);
  f->SetDisplacementToArray();
  f->SetDisplacementArray(name);
}

/// One error with that text, nothing on the output, and a good input afterwards works.
void expectError(vtkBoundaryDisplacement* filter, const std::string& telling)
{
  SCOPED_TRACE(telling);
  const grids::Run listener(filter);
  listener.ExpectError(telling);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetMovingPoints(), 0);
  filter->SetInputData(grids::hexes(2));
  filter->SetMovingToEverything();
  filter->SetDisplacementToVector();
  filter->RemoveAllFixedSurfaces();
  filter->SetSurfaceIdArray(nullptr);
  filter->SetScaleFactor(1);
  filter->SetVector(1, 1, 1);
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 26);
  EXPECT_EQ(listener.Errors.size(), 1u);
}
}

TEST(BoundaryDisplacementErrors, WhatIsChosen)
{
  const std::vector<std::pair<std::string, Change>> cases = {
    { "Nothing is selected", [](auto* f) { f->SetMovingToSelection(); } },
    { "Nothing is selected", [](auto* f) { select(f, vtkSmartPointer<vtkSelection>::New()); } },
    { "is on the boundary", [](auto* f) { select(f, indices(vtkSelectionNode::POINT, {})); } },
    { "is on the boundary",
      [](auto* f) { select(f, indices(vtkSelectionNode::POINT, { 13 })); } }, // the one inside
    { "is on the boundary", [](auto* f) { select(f, indices(vtkSelectionNode::CELL, { 5000 })); } },
    { "neither points nor cells",
      [](auto* f) { select(f, indices(vtkSelectionNode::ROW, { 0 })); } },
    { "No surface is chosen", [](auto* f) { f->SetMovingToSurfaces(); } },
    { "'Surface 99', which the boundary does not have; it has Surface 0, Surface 1",
      [](auto* f)
      {
        f->SetMovingToSurfaces();
        f->AddSurface("Surface 0");
        f->AddSurface("Surface 99");
      } },
    { "`FixedSurfaces` names 'Top'", [](auto* f) { f->AddFixedSurface("Top"); } },
    { "'Surface 0' is in `Surfaces` and `FixedSurfaces`, which contradict each other",
      [](auto* f)
      {
        f->SetMovingToSurfaces();
        f->AddSurface("Surface 0");
        f->AddFixedSurface("Surface 0");
      } },
    { "No region", [](auto* f) { f->SetMovingToRegion(); } },
    { "inside the region",
      [](auto* f)
      {
        vtkNew<vtkBox> box;
        box->SetBounds(0.5, 1.5, 0.5, 1.5, 0.5, 1.5);
        f->SetMovingToRegion();
        f->SetRegion(box);
      } },
    { "`SurfaceIdArray` names 'Absent'", [](auto* f) { f->SetSurfaceIdArray("Absent"); } },
  };
  for (const auto& [telling, change] : cases)
  {
    auto filter = displaced::make(grids::hexes(2));
    change(filter);
    expectError(filter, telling);
  }
}

TEST(BoundaryDisplacementErrors, AContradictionLeavesTheListOfSurfaces)
{
  auto filter = displaced::make(grids::hexes(2));
  filter->SetMovingToSurfaces();
  filter->AddSurface("Surface 0");
  filter->AddFixedSurface("Surface 0");
  expectError(filter, "contradict each other");
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(0), "Surface 0");
}

TEST(BoundaryDisplacementErrors, TheMotion)
{
  const std::vector<std::pair<std::string, Change>> cases = {
    { "`Transform` moves nodes to places that are not finite",
      [](auto* f) { f->SetTransform(transformWith(0, 3, NAN)); } },
    { "`Transform` moves nodes to places that are not finite",
      [](auto* f) { f->SetTransform(transformWith(1, 1, INFINITY)); } },
    { "`Translation`, `Rotation` or `Scale` moves nodes beyond 1e50",
      [](auto* f)
      {
        f->SetDisplacementToTranslateRotateScale();
        f->SetTranslation(1e60, 0, 0);
      } },
    { "`Vector` moves nodes beyond 1e50", [](auto* f) { grids::moveBy(f, 0, 1e60, 0); } },
    { "`Distance` moves nodes beyond 1e50",
      [](auto* f)
      {
        f->SetDisplacementToAlongNormals();
        f->SetDistance(1e60);
      } },
    { "No array is named", [](auto* f) { f->SetDisplacementToArray(); } },
    { "'Gone', which the input does not have",
      [](auto* f)
      {
        f->SetDisplacementToArray();
        f->SetDisplacementArray("Gone");
      } },
    { "has 2 components", [](auto* f) { byArray(f, "Two", 2, 27, 1); } },
    { "has 26 tuples for 27 points", [](auto* f) { byArray(f, "Short", 3, 26, 1); } },
    { "at all of its nodes 'Wild' is NaN, or vtkValidPointMask 0",
      [](auto* f) { byArray(f, "Wild", 3, 27, NAN); } },
    { "`DisplacementArray` moves nodes to places that are not finite (NaN or infinite): point ids "
      "0, "
      "1",
      [](auto* f) { byArray(f, "Wild", 3, 27, INFINITY); } },
    { "is not numeric",
      [](auto* f)
      {
        vtkNew<vtkStringArray> text;
        text->SetName("Text");
        text->SetNumberOfValues(27);
        vtkDataSet::SafeDownCast(f->GetInputDataObject(0, 0))->GetPointData()->AddArray(text);
        f->SetDisplacementToArray();
        f->SetDisplacementArray("Text");
      } },
  };
  for (const auto& [telling, change] : cases)
  {
    auto filter = displaced::make(grids::hexes(2));
    change(filter);
    expectError(filter, telling);
  }
}

TEST(BoundaryDisplacementErrors, TheInput)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkUnstructuredGrid> line;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  line->SetPoints(points);
  const vtkIdType ends[] = { 0, 1 };
  line->InsertNextCell(VTK_LINE, 2, ends);
  auto classify = grids::of<vtkClassifyBoundary>(grids::hexes(2));
  classify->Update();
  auto moved = grids::boundary(grids::hexes(2), grids::affine);
  moved->GetPoints()->SetPoint(3, NAN, 0, 0);
  auto broken = grids::copy(grids::hexes(2));
  broken->GetPoints()->SetPoint(3, NAN, 0, 0);
  const std::vector<std::pair<std::string, vtkSmartPointer<vtkDataObject>>> cases = {
    { "is a vtkImageData", image.Get() },
    { "no cells", blocks.Get() },
    { "no cells", vtkSmartPointer<vtkUnstructuredGrid>::New() },
    { "is a volume cell", line.Get() },
    { "without polygons", vtkSmartPointer<vtkPolyData>::New() },
    { "without polygons", classify->GetCurves() },
    { "not finite", moved },
    { "not finite", broken },
  };
  for (const auto& [telling, input] : cases)
  {
    expectError(displaced::make(input), telling);
  }
}

TEST(BoundaryDisplacementErrors, ACollapseIsAllowedAndNamed)
{
  auto filter =
    displaced::moving(grids::make(meshes::hexes(2, 2, 2)), [](const Row& x) { return x[2] == 2; });
  vtkNew<vtkTransform> transform;
  transform->Scale(0, 1, 1);
  filter->SetTransform(transform);
  filter->SetSurroundingsToStay();
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  listener.ExpectWarning("without area");
  EXPECT_EQ(filter->GetMovingPoints(), 9);
  // Across the flat patch a scale of zero moves it, and collapses nothing.
  transform->Identity();
  transform->Scale(1, 1, 0);
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
}

TEST(BoundaryDisplacementErrors, AnExecutionThatIsAbortedIsSilent)
{
  auto filter = displaced::make(grids::hexes(3));
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  filter->AddObserver(vtkCommand::ProgressEvent, abort);
  grids::update(filter);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}
