// SPDX-License-Identifier: BSD-3-Clause
// vtkMorphMesh against the filters that it is made of.
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkBox.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>

#include <gtest/gtest.h>

#include <cmath>

using grids::Row;

namespace
{
const Row Up(0.1, -0.2, 0.5);

bool onTop(const Row& x)
{
  return x[2] == 4;
}

/// A box of 4 x 4 x 4 hexahedra, [0, 4] in each direction.
vtkSmartPointer<vtkUnstructuredGrid> box()
{
  return grids::make(meshes::hexes(4, 4, 4));
}

std::string topSurface(vtkDataObject* grid)
{
  auto filter = displaced::make(grid);
  return displaced::surfaceName(filter, onTop);
}

/// Moves the top up.
vtkSmartPointer<vtkMorphMesh> make(vtkUnstructuredGrid* grid)
{
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetInputData(grid);
  filter->AddSurface(topSurface(grid).c_str());
  grids::moveBy(filter, Up[0], Up[1], Up[2]);
  return filter;
}

/// The same by two filters.
template <typename Method>
vtkSmartPointer<vtkUnstructuredGrid> byTwoFilters(vtkUnstructuredGrid* grid, const Row& up = Up)
{
  auto displace = displaced::make(grid);
  displace->SetMovingToSurfaces();
  displace->AddSurface(topSurface(grid).c_str());
  grids::moveBy(displace, up[0], up[1], up[2]);
  auto morph = grids::of<Method>(grid);
  morph->SetBoundaryConnection(displace->GetOutputPort());
  morph->SetValidityToRepair();
  morph->Update();
  return morph->GetOutput();
}

/// Returns whether each node of the top moved by `up`, and no node of the bottom.
bool topMovedBy(vtkUnstructuredGrid* before, vtkUnstructuredGrid* after, const Row& up)
{
  const morph::Points x = grids::points(before), y = grids::points(after);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if ((onTop(x.row(i)) && y.row(i) != Row(x.row(i) + up)) ||
        (x(i, 2) == 0 && y.row(i) != x.row(i)))
    {
      return false;
    }
  }
  return true;
}

std::string statusOf(vtkDataObject* data)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("MorphStatus"));
  return array ? array->GetValue(0) : std::string();
}
}

TEST(MorphMesh, SurfacesFollowByTheSurfaceMethod)
{
  auto grid = box();
  std::vector<morph::Points> results;
  for (int method = 0; method < 3; ++method)
  {
    const double rotation[] = { 0, 0, 40 }, scale[] = { 1.5, 0.8, 1 };
    auto filter = make(grid);
    filter->SetDisplacementToTranslateRotateScale();
    filter->SetRotation(rotation);
    filter->SetScale(scale);
    filter->SetSurroundingsToFollowEverywhere();
    filter->SetSurfaceMethod(method);
    const grids::Run silence(filter);

    auto displace = displaced::make(grid);
    displace->SetMovingToSurfaces();
    displace->AddSurface(topSurface(grid).c_str());
    displace->SetDisplacementToTranslateRotateScale();
    displace->SetRotation(rotation);
    displace->SetScale(scale);
    displace->SetSurroundingsToFollowEverywhere();
    displace->SetSurfaceMethod(method);
    auto morph = grids::of<vtkFEMWarpMorph>(grid);
    morph->SetBoundaryConnection(displace->GetOutputPort());
    morph->SetValidityToRepair();
    const grids::Run silent(morph);
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(morph->GetOutput()));
    results.push_back(grids::points(filter->GetOutput()));
  }
  EXPECT_NE(results[0], results[1]);
}

TEST(MorphMesh, IsBoundaryDisplacementAndAMethodInOne)
{
  auto grid = box();
  using Chain = vtkSmartPointer<vtkUnstructuredGrid> (*)(vtkUnstructuredGrid*, const Row&);
  const Chain chains[] = { byTwoFilters<vtkFEMWarpMorph>, byTwoFilters<vtkLBWarpMorph>,
    byTwoFilters<vtkWeightedResidualMorph>, byTwoFilters<vtkSimplexLinearMorph>,
    byTwoFilters<vtkSimplexNaturalNeighborMorph>, byTwoFilters<vtkRadialBasisMorph>,
    byTwoFilters<vtkSmoothingMorph>, byTwoFilters<vtkInversionFreeMorph> };
  auto filter = make(grid);
  grids::Listener listener(filter);
  for (int method = 0; method < 8; ++method)
  {
    SCOPED_TRACE(method);
    filter->SetMethod(method);
    filter->Update();
    ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    auto expected = chains[method](grid, Up);
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(expected));
    EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 64);
    EXPECT_STREQ(filter->GetOutput()->GetCellData()->GetScalars()->GetName(), "ScaledJacobian");
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_GT(filter->GetMinScaledJacobian(), 0.5);
    EXPECT_EQ(filter->GetLargestValidStep(), 1);
  }
}

TEST(MorphMesh, WithNothingChosenTheBoundaryIsShownAndNothingIsWrong)
{
  auto grid = box();
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetVector(1, 2, 3);
  grids::Listener listener(filter);
  struct Case
  {
    int Moving, Displacement;
    const char* Advice;
  };
  for (const Case& one :
    { Case{ vtkMorphMesh::MOVING_SURFACES, vtkMorphMesh::DISPLACEMENT_VECTOR, "Tick surfaces" },
      Case{ vtkMorphMesh::MOVING_SELECTION, vtkMorphMesh::DISPLACEMENT_VECTOR, "Select points" },
      Case{ vtkMorphMesh::MOVING_SURFACES, vtkMorphMesh::DISPLACEMENT_TARGET, "Choose the Target" },
      Case{ vtkMorphMesh::MOVING_SURFACES, vtkMorphMesh::DISPLACEMENT_HANDLES, "Give a handle" },
      Case{
        vtkMorphMesh::MOVING_EVERYTHING, vtkMorphMesh::DISPLACEMENT_HANDLES, "Give a handle" } })
  {
    filter->SetMoving(one.Moving);
    filter->SetDisplacement(one.Displacement);
    filter->Update();
    EXPECT_NE(std::string(filter->GetAdvice()).find(one.Advice), std::string::npos)
      << filter->GetAdvice();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
    vtkUnstructuredGrid* output = filter->GetOutput();
    EXPECT_EQ(grids::points(output), grids::points(grid));
    ASSERT_EQ(output->GetNumberOfCells(), 6 * 16);
    EXPECT_NE(output->GetPointData()->GetArray("Number"), nullptr);
    vtkDataArray* surface = output->GetCellData()->GetScalars();
    ASSERT_NE(surface, nullptr);
    EXPECT_STREQ(surface->GetName(), "SurfaceId");
    const std::string top = topSurface(grid);
    for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
    {
      double bounds[6];
      output->GetCellBounds(cell, bounds);
      EXPECT_EQ(
        "Surface " + std::to_string(static_cast<int>(surface->GetComponent(cell, 0))) == top,
        bounds[4] == 4);
    }
    EXPECT_EQ(filter->GetOutput(1)->GetNumberOfCells(), 0);
    EXPECT_STREQ(filter->GetMorphStatus(), "None");
    EXPECT_EQ(statusOf(output), "None");
    EXPECT_EQ(filter->GetInvertedCells(), -1);
  }
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 6 + 12);

  filter->AddHandle(0, 0, 4, 0, 0, 0.5, 0); // one handle translates everything
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_STREQ(filter->GetAdvice(), "None");
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  const morph::Points shifted = grids::points(grid).rowwise() + Row(0, 0, 0.5);
  EXPECT_LT((grids::points(filter->GetOutput()) - shifted).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(MorphMesh, SurfacesAreListedBeforeTheFirstExecution)
{
  auto filter = grids::of<vtkMorphMesh>(box());
  filter->UpdateInformation();
  ASSERT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 18);
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(0), "Surface 0");
}

TEST(MorphMesh, ASelectionMovesWhereNoSurfaceIsChosen)
{
  auto grid = box();
  auto filter = make(grid);
  auto corner = displaced::indices(vtkSelectionNode::POINT,
    displaced::nodesWhere(grid, [](const Row& x) { return x.norm() == 0; }));
  filter->SetSelectionData(corner);
  filter->SetSurroundings(vtkBoundaryDisplacement::SURROUNDINGS_STAY);
  const auto movedNodes = [&]
  {
    filter->Update();
    return ((grids::points(filter->GetOutput()) - grids::points(grid)).rowwise().norm().array() > 0)
      .count();
  };
  EXPECT_GE(movedNodes(), 25); // the chosen surface, and what is inside
  filter->RemoveAllSurfaces();
  filter->SetVector(-0.1, -0.1, -0.1);
  filter->Update();
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x.row(i).norm() == 0)
    {
      EXPECT_EQ(y.row(i), Row(-0.1, -0.1, -0.1));
    }
    else if (x(i, 2) == 4)
    {
      EXPECT_EQ(y.row(i), x.row(i));
    }
  }
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
}

TEST(MorphMesh, MovesARegionAnArrayAndEverything)
{
  auto grid = box();
  auto filter = make(grid);
  filter->RemoveAllSurfaces();
  vtkNew<vtkBox> region;
  region->SetBounds(-1, 5, -1, 5, 3.5, 4.5);
  filter->SetRegion(region);
  filter->SetMovingToRegion();
  filter->Update();
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
  const morph::Points byRegion = grids::points(filter->GetOutput());
  EXPECT_EQ(byRegion, grids::points(byTwoFilters<vtkFEMWarpMorph>(grid)));

  vtkNew<vtkDoubleArray> marks;
  marks->SetName("Top");
  const morph::Points x = grids::points(grid);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    marks->InsertNextValue(onTop(x.row(i)) ? -2 : i % 2 ? 0. : std::nan(""));
  }
  grid->GetPointData()->AddArray(marks);
  filter->SetMovingToArray();
  filter->SetMovingArray("Top");
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), byRegion);

  filter->SetMovingToEverything();
  filter->Update();
  const morph::Points shift = grids::points(filter->GetOutput()) - x;
  EXPECT_LE((shift.rowwise() - Up).cwiseAbs().maxCoeff(), 1e-12);

  region->SetBounds(-1, 5, -1, 5, -0.5, 0.5); // a change of the region is one of the filter
  filter->SetMovingToRegion();
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()).row(0), Row(x.row(0) + Up));
}

TEST(MorphMesh, RepairsUnlessItIsLive)
{
  auto grid = box();
  const auto wave = [](const Row& x) { return Row(0, 0, 1.6 * std::sin(M_PI / 2 * x[0])); };
  grids::addVectors(grid, "Waves", grids::mapped(grids::points(grid), wave));
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMovingToEverything();
  filter->SetDisplacementToArray();
  filter->SetDisplacementArray("Waves");
  grids::Listener listener(filter);
  filter->LiveOn();
  filter->Update();
  const vtkIdType inverted = filter->GetInvertedCells();
  EXPECT_GT(inverted, 0);
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_EQ(filter->GetOutput(1)->GetNumberOfCells(), inverted);
  filter->LiveOff();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Repaired");
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_EQ(filter->GetOutput(1)->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  filter->Update();
  EXPECT_EQ(filter->GetInvertedCells(), inverted);
}

// A drag is solved as finely as a picture shows; what comes on release knows nothing of it.
TEST(MorphMesh, OnReleaseIsAsFineAsWithoutADrag)
{
  const auto makeWaving = []
  {
    auto grid = box();
    const auto wave = [](const Row& x) { return Row(0, 0, 0.2 * std::sin(x[0]) * std::cos(x[1])); };
    grids::addVectors(grid, "Waves", grids::mapped(grids::points(grid), wave));
    auto filter = vtkSmartPointer<vtkMorphMesh>::New();
    filter->SetInputData(grid);
    filter->SetMovingToEverything();
    filter->SetDisplacementToArray();
    filter->SetDisplacementArray("Waves");
    return filter;
  };
  auto dragged = makeWaving(), atOnce = makeWaving();
  dragged->LiveOn();
  dragged->Update();
  const morph::Points during = grids::points(dragged->GetOutput());
  dragged->LiveOff();
  dragged->Update();
  atOnce->Update();
  const morph::Points after = grids::points(atOnce->GetOutput());
  EXPECT_TRUE(grids::points(dragged->GetOutput()) == after); // the same bits
  EXPECT_EQ(dragged->GetPrepareCount(), 1);
  EXPECT_LT((during - after).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_GT((during - after).cwiseAbs().maxCoeff(), 0);
}

TEST(MorphMesh, PreparesOnceForADrag)
{
  auto grid = box();
  auto filter = make(grid);
  vtkNew<vtkTransform> transform;
  filter->SetDisplacementToTransform();
  filter->SetTransform(transform);
  for (int i = 1; i <= 5; ++i)
  {
    transform->Identity();
    transform->Translate(0, 0, 0.1 * i);
    filter->Update();
    EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Row(0, 0, 0.1 * i))) << i;
    EXPECT_EQ(filter->GetPrepareCount(), 1);
  }
  // What was kept has no effect.
  auto fresh = make(grid);
  fresh->SetDisplacementToTransform();
  fresh->SetTransform(transform);
  fresh->Update();
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(fresh->GetOutput()));
}

TEST(MorphMesh, ExecutesOnlyWhereSomethingChanged)
{
  auto grid = box();
  auto filter = make(grid);
  filter->Update();
  const vtkMTimeType first = filter->GetOutput()->GetMTime();
  filter->Update();
  filter->UpdateInformation();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetMTime(), first);

  // Options of the method itself are found by a change of its filter.
  vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(0.5);
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetMTime(), first);
}

TEST(MorphMesh, AfterAnErrorTheUndeformedMeshStays)
{
  auto grid = box();
  auto filter = make(grid);
  filter->AddSurface("Surface 77");
  grids::Listener listener(filter);
  for (int run = 0; run < 2; ++run)
  {
    listener.Errors.clear();
    filter->Modified();
    filter->Update();
    listener.ExpectError("): `Surfaces` names 'Surface 77'");
    EXPECT_TRUE(listener.ExecutiveErrors.empty());
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 64);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(statusOf(filter->GetOutput()), "Failed");
    EXPECT_EQ(filter->GetInvertedCells(), -1);
    EXPECT_EQ(filter->GetMinScaledJacobian(), -1);
  }
  listener.Errors.clear();
  filter->SetSurfaceStatus("Surface 77", 0);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty());
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
  filter->AddFixedSurface("Surface 78");
  filter->Update();
  listener.ExpectError("): `FixedSurfaces` names 'Surface 78'");
}

TEST(MorphMesh, AMorphThatFailsIsAnErrorOfThisFilter)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetVector(0, 0, -5); // through the bottom
  grids::Listener listener(filter);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REFUSE);
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
  filter->SetVector(Up[0], Up[1], Up[2]);
  filter->Update();
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
}

TEST(MorphMesh, HasStepsInTime)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetNumberOfSteps(4);
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(0);
  ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 5);
  filter->UpdateTimeStep(2);
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Row(0.5 * Up)));
  filter->UpdateTimeStep(0);
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
  filter->UpdateTimeStep(4);
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  filter->SetNumberOfSteps(0);
  filter->UpdateInformation();
  EXPECT_FALSE(info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));
}

TEST(MorphMesh, RelativeStepsTurnWithThePart)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetMovingToEverything();
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetRotation(0, 0, 360);
  filter->SetNumberOfSteps(8);
  filter->SetSteppingToRelative();
  const morph::Points rest = grids::points(grid);
  for (const int step : { 3, 1, 8 }) // jumped to, and back
  {
    filter->UpdateTimeStep(step);
    const double angle = step * EIGEN_PI / 4;
    morph::Points turned = rest;
    for (morph::Index i = 0; i < rest.rows(); ++i)
    {
      const double x = rest(i, 0) - 2, y = rest(i, 1) - 2;
      turned(i, 0) = 2 + std::cos(angle) * x - std::sin(angle) * y;
      turned(i, 1) = 2 + std::sin(angle) * x + std::cos(angle) * y;
    }
    EXPECT_LT((grids::points(filter->GetOutput()) - turned).cwiseAbs().maxCoeff(), 1e-9) << step;
  }
  const int prepared = filter->GetPrepareCount();
  filter->UpdateTimeStep(5); // kept
  EXPECT_EQ(filter->GetPrepareCount(), prepared);
}

TEST(MorphMesh, TheFirstRelativeStepsServeTheNext)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetNumberOfSteps(4);
  filter->SetSteppingToRelative();
  filter->UpdateTimeStep(2);
  const int prepared = filter->GetPrepareCount();
  filter->UpdateTimeStep(3);
  EXPECT_EQ(filter->GetPrepareCount(), prepared + 1);
}

TEST(MorphMesh, RelativeStepsOfAnotherMotionAreAnotherSeries)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetNumberOfSteps(2);
  filter->SetSteppingToRelative();
  filter->UpdateTimeStep(2);
  filter->SetVector(2 * Up[0], 2 * Up[1], 0);
  filter->UpdateTimeStep(1);
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Row(Up[0], Up[1], 0)));
  auto other = box();
  other->GetPoints()->SetPoint(62, 2, 2, 2.1); // an inner node
  filter->SetInputData(other);
  filter->UpdateTimeStep(2);
  EXPECT_TRUE(topMovedBy(other, filter->GetOutput(), Row(2 * Up[0], 2 * Up[1], 0)));
}

TEST(MorphMesh, AnAbortGivesTheUndeformedMeshAndNoMessage)
{
  auto grid = box();
  auto filter = make(grid);
  filter->SetMethod(vtkMorphMesh::METHOD_INVERSION_FREE);
  grids::Listener listener(filter);
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* object, unsigned long, void*, void*)
    { vtkAlgorithm::SafeDownCast(object)->SetAbortExecute(1); });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, stop);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty());
  EXPECT_STREQ(filter->GetMorphStatus(), "Cancelled");
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_TRUE(topMovedBy(grid, filter->GetOutput(), Up));
}

TEST(MorphMesh, KeepsThePrecisionOfItsInput)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4), VTK_FLOAT);
  auto filter = make(grid);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST(MorphMesh, BodiesThatTouchAndPartAreWarnedOfUnlessTheyAreTied)
{
  morph::Mesh above = meshes::hexes(4, 4, 4);
  meshes::transform(above, [](const Row& x) { return Row(x + Row(0, 0, 4)); });
  const auto grid = grids::make(shapes::together(meshes::hexes(4, 4, 4), above));
  auto filter = grids::of<vtkMorphMesh>(grid);
  for (int below = 0; below < 6; ++below)
  {
    filter->AddSurface(("Surface " + std::to_string(below)).c_str());
  }
  grids::moveBy(filter, 0.25, 0, -0.125);
  grids::Run listener(filter);
  ASSERT_EQ(listener.Warnings.size(), 1u);
  for (const char* part :
    { "50 nodes part", "up to 0.2795", "Surface 5, Surface 6", "ContactDistance" })
  {
    EXPECT_NE(listener.Warnings[0].find(part), std::string::npos) << listener.Warnings[0];
  }
  listener.Warnings.clear();
  filter->SetContactDistance(1e-6);
  filter->Update();
  for (const std::string& warning : listener.Warnings)
  {
    EXPECT_EQ(warning.find("not tied"), std::string::npos) << warning;
  }
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const Row by = y.row(i) - x.row(i);
    EXPECT_TRUE(x(i, 2) != 4 || (by - Row(0.25, 0, -0.125)).norm() < 1e-9) << i;
  }
}

TEST(MorphMesh, ContactTakesAnotherBodyAlong)
{
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  morph::Mesh above = meshes::tets(3, 3, 3);
  meshes::transform(above, [](const Row& x) { return Row(x * 4 / 3 + Row(0, 0, 4.01)); });
  const morph::Index half = mesh.numberOfNodes();
  const auto grid = grids::make(shapes::together(mesh, above));
  const auto filter = make(grid); // its top, which is the lower body's, moves up
  const auto largestMotionAbove = [&]
  {
    filter->Update();
    const morph::Points moved = grids::points(filter->GetOutput()) - grids::points(grid);
    return moved.bottomRows(moved.rows() - half).rowwise().norm().maxCoeff();
  };

  EXPECT_EQ(largestMotionAbove(), 0);
  EXPECT_STREQ(filter->GetContactReport(), "None");

  filter->SetContactDistance(0.02);
  EXPECT_NEAR(largestMotionAbove(), Up.norm(), 1e-12);
  vtkDataArray* gaps = filter->GetOutput()->GetFieldData()->GetArray("ContactGaps");
  ASSERT_EQ(gaps->GetNumberOfTuples(), 2);
  EXPECT_NEAR(gaps->GetComponent(1, 0), 0.01, 1e-12) << filter->GetContactReport();

  // Where the surroundings move that body, its contact is not kept.
  grids::Listener dropped(filter);
  filter->SetSurroundings(vtkMorphMesh::SURROUNDINGS_FOLLOW_EVERYWHERE);
  filter->Update();
  EXPECT_TRUE(std::any_of(dropped.Warnings.begin(), dropped.Warnings.end(),
    [](const std::string& text) { return text.find("Contact is not kept") != text.npos; }));
  filter->SetSurroundings(vtkMorphMesh::SURROUNDINGS_FOLLOW);

  filter->AddContactSurface("Surface 0");
  grids::expectError(filter, "other `ContactSurfaces`");
}
