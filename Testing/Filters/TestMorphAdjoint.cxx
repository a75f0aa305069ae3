// SPDX-License-Identifier: BSD-3-Clause
// vtkMorphAdjoint against finite differences through the morphing filters, and its inputs.
#include "../Core/BoundaryShapes.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSmoothingMorph.h"

#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTransform.h>
#include <vtkTransformFilter.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace
{
using morph::Index;
using morph::Points;

Points randomVectors(Index rows, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Points result(rows, 3);
  return result.unaryExpr([&](double) { return value(random); });
}

Points gradients(vtkPointSet* data)
{
  auto* array = vtkDoubleArray::SafeDownCast(data->GetPointData()->GetArray("MorphGradient"));
  EXPECT_TRUE(array);
  return array
           ? Points(Eigen::Map<const Points>(array->GetPointer(0), array->GetNumberOfTuples(), 3))
           : Points();
}

void move(vtkPointSet* data, const Points& step, double factor)
{
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double x[3];
    data->GetPoint(i, x);
    for (int j = 0; j < 3; ++j)
    {
      x[j] += factor * step(i, j);
    }
    data->GetPoints()->SetPoint(i, x);
  }
  data->GetPoints()->Modified();
}

/// An objective that is not linear: half the sum of the nodes' squared distances to their targets.
double objective(const Points& nodes, const Points& targets)
{
  return 0.5 * (nodes - targets).squaredNorm();
}

vtkSmartPointer<vtkMorphAdjoint> adjointOf(vtkMorphAlgorithm* morph, vtkUnstructuredGrid* grid,
  vtkDataObject* boundary, vtkDataObject* carrier)
{
  auto adjoint = vtkSmartPointer<vtkMorphAdjoint>::New();
  adjoint->SetInputData(grid);
  adjoint->SetBoundaryData(boundary);
  adjoint->SetGradientData(carrier);
  adjoint->SetGradientArray("Gradient");
  adjoint->SetMorph(morph);
  return adjoint;
}

class MorphAdjoint : public testing::TestWithParam<grids::MorphFilter>
{
};
}

TEST_P(MorphAdjoint, IsTheDerivativeThroughTheFilter)
{
  for (auto& [name, mesh] : meshes::all(3, 4, 3))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    auto grid = grids::make(mesh);
    auto boundary = grids::boundary(grid, grids::twist);
    const Points targets = mesh.points + randomVectors(mesh.numberOfNodes(), meshes::seed());
    auto morph = GetParam().of(grid, boundary);
    morph->SetScaleFactor(0.7);
    morph->Update();

    auto carrier = grids::copy(morph->GetOutput());
    grids::addVectors(carrier, "Gradient", grids::points(carrier) - targets);
    auto adjoint = adjointOf(morph, grid, boundary, carrier);
    const grids::Run listener(adjoint);
    if (!GetParam().linear)
    {
      listener.ExpectError("not a linear method");
      continue;
    }
    EXPECT_TRUE(listener.Errors.empty());
    EXPECT_EQ(morph->GetPrepareCount(), 1);
    const Points gradient = gradients(adjoint->GetOutput());
    ASSERT_EQ(gradient.rows(), boundary->GetNumberOfPoints());

    // The objective is quadratic and the map linear: central differences are exact but for
    // rounding.
    const Points step = randomVectors(gradient.rows(), meshes::seed() + 1);
    const auto objectiveAt = [&](double factor)
    {
      auto moved = vtkSmartPointer<vtkPolyData>::New();
      moved->DeepCopy(boundary);
      move(moved, step, factor);
      morph->SetBoundaryData(moved);
      morph->Update();
      return objective(grids::points(morph->GetOutput()), targets);
    };
    const double h = 0.1, change = (objectiveAt(h) - objectiveAt(-h)) / (2 * h);
    EXPECT_NEAR(gradient.cwiseProduct(step).sum(), change, 1e-8 * std::abs(change) + 1e-8);
  }
}

TEST_P(MorphAdjoint, DoesNotDependOnThreadsOrWhoPrepared)
{
  if (!GetParam().linear)
  {
    GTEST_SKIP();
  }
  auto grid = grids::hexes(6);
  auto boundary = grids::boundary(grid, grids::twist);
  grids::addVectors(grid, "Gradient", randomVectors(grid->GetNumberOfPoints(), meshes::seed()));
  Points first;
  for (const int threads : { 1, 2, 5 })
  {
    auto morph = GetParam().make();
    morph->SetNumberOfThreads(threads);
    auto adjoint = adjointOf(morph, grid, boundary, nullptr);
    adjoint->Update();
    EXPECT_EQ(morph->GetPrepareCount(), 1);
    const Points fresh = gradients(adjoint->GetOutput());
    first = first.rows() ? first : fresh;
    EXPECT_TRUE(fresh == first) << threads;

    morph->SetInputData(grid);
    morph->SetBoundaryData(boundary);
    morph->Update();
    EXPECT_EQ(morph->GetPrepareCount(), 1) << "what the adjoint prepared is used by the execution";
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, MorphAdjoint, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });

namespace
{
class AdjointInputs : public testing::Test
{
protected:
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(3);
  vtkSmartPointer<vtkPolyData> Boundary = grids::boundary(this->Grid, grids::twist);
  vtkNew<vtkFEMWarpMorph> Morph;

  AdjointInputs() { grids::addVectors(this->Grid, "Gradient", randomVectors(64, meshes::seed())); }

  /// The only message of an adjoint with these inputs, which has no output then.
  std::string ErrorOf(vtkMorphAdjoint* adjoint)
  {
    const grids::Run listener(adjoint);
    EXPECT_EQ(listener.Errors.size(), 1u);
    EXPECT_EQ(adjoint->GetOutput()->GetNumberOfPoints(), 0);
    return listener.Errors.empty() ? "" : listener.Errors.front();
  }
};
}

TEST_F(AdjointInputs, OutputIsTheBoundaryWithTheGradient)
{
  auto adjoint = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  adjoint->Update();
  auto* output = vtkPolyData::SafeDownCast(adjoint->GetOutput());
  ASSERT_TRUE(output);
  EXPECT_EQ(output->GetNumberOfCells(), this->Boundary->GetNumberOfCells());
  EXPECT_TRUE(output->GetPointData()->GetArray("MorphPointId"));
  EXPECT_STREQ(output->GetPointData()->GetVectors()->GetName(), "MorphGradient");
  EXPECT_FALSE(this->Boundary->GetPointData()->GetArray("MorphGradient"))
    << "the input is never touched";
}

TEST_F(AdjointInputs, CoordinatesThatAreNotFiniteAreRefusedWhereNothingElseLooksAtThem)
{
  grids::addVectors(this->Boundary, "Move", morph::Points::Zero(56, 3));
  this->Boundary->GetPoints()->SetPoint(5, NAN, 0, 0);
  this->Morph->SetDisplacementArray("Move");
  auto adjoint = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  EXPECT_NE(this->ErrorOf(adjoint).find("not finite (NaN or infinite), at its points 5"),
    std::string::npos);
}

TEST_F(AdjointInputs, AMeshWithoutPointsDrawsAnError)
{
  vtkNew<vtkUnstructuredGrid> empty; // its GetPoints() is null
  auto carrier = grids::cloud(grids::Row(0, 0, 0));
  grids::addVectors(carrier, "Gradient", Points::Zero(1, 3));
  auto adjoint = adjointOf(this->Morph, empty, this->Boundary, carrier);
  EXPECT_NE(this->ErrorOf(adjoint), "");
}

TEST_F(AdjointInputs, GradientsThatOverflow)
{
  this->Grid->GetPointData()->GetArray("Gradient")->Fill(1e308);
  vtkNew<vtkSimplexLinearMorph> morph; // without a solver, which would overflow before
  morph->SetScaleFactor(1e3);
  auto adjoint = adjointOf(morph, this->Grid, this->Boundary, nullptr);
  EXPECT_NE(
    this->ErrorOf(adjoint).find("with respect to the boundary is not finite"), std::string::npos);
}

TEST_F(AdjointInputs, APointThatStandsForSeveralNodesGetsTheirSum)
{
  // Two bodies that touch: nodes of both in the same place follow one point by its position.
  const morph::Mesh one = meshes::hexes(2, 2, 2);
  const morph::Mesh mesh = shapes::together(one, meshes::shifted(one, grids::Row(2, 0, 0)));
  const Index half = one.numberOfNodes();
  auto grid = grids::make(mesh);
  const Points gradient = randomVectors(2 * half, meshes::seed());
  grids::addVectors(grid, "Gradient", gradient);
  auto cloud = grids::cloud(grids::Row(2, 0, 0)); // node 2 of the first, node 0 of the second
  grids::addVectors(cloud, "Shift", grids::Row(0.1, 0, 0));
  this->Morph->SetDisplacementArray("Shift");
  this->Morph->SetTolerance(1e-14);
  auto adjoint = adjointOf(this->Morph, grid, cloud, nullptr);
  adjoint->Update();
  const Points together = gradients(adjoint->GetOutput());

  vtkNew<vtkFEMWarpMorph> byIds;
  byIds->SetTolerance(1e-14);
  byIds->SetDisplacementArray("Shift");
  auto both = grids::cloud((Points(2, 3) << 2, 0, 0, 2, 0, 0).finished());
  grids::addIds(both, "MorphPointId", { 2, half });
  grids::addVectors(both, "Shift", (Points(2, 3) << 0.1, 0, 0, 0.1, 0, 0).finished());
  auto apart = adjointOf(byIds, grid, both, nullptr);
  apart->Update();
  EXPECT_LT((gradients(apart->GetOutput()).colwise().sum() - together.row(0)).norm(), 1e-12);
}

TEST_F(AdjointInputs, ANodeNamedTwiceGoesByTheFirst)
{
  auto cloud = grids::cloud((Points(2, 3) << 0, 0, 0, 0, 0, 0).finished());
  grids::addIds(cloud, "MorphPointId", { 0, 0 });
  auto adjoint = adjointOf(this->Morph, this->Grid, cloud, nullptr);
  adjoint->Update();
  const Points gradient = gradients(adjoint->GetOutput());
  EXPECT_GT(gradient.row(0).norm(), 0);
  EXPECT_EQ(gradient.row(1).norm(), 0);
}

TEST_F(AdjointInputs, MissingInputsAreNamed)
{
  EXPECT_NE(
    this->ErrorOf(adjointOf(nullptr, this->Grid, this->Boundary, nullptr)).find("set Morph"),
    std::string::npos);
  EXPECT_NE(this->ErrorOf(adjointOf(this->Morph, this->Grid, nullptr, nullptr))
              .find("Boundary: nothing is connected"),
    std::string::npos);
  vtkNew<vtkMultiBlockDataSet> blocks;
  EXPECT_NE(this->ErrorOf(adjointOf(this->Morph, this->Grid, blocks, nullptr)).find("no points"),
    std::string::npos);
  auto unnamed = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  unnamed->SetGradientArray("None");
  EXPECT_NE(this->ErrorOf(unnamed).find("`GradientArray` is not set"), std::string::npos);
  unnamed->SetGradientArray("Wind");
  EXPECT_NE(this->ErrorOf(unnamed).find("'Wind'"), std::string::npos);
}

TEST_F(AdjointInputs, GradientsOfTheWrongShapeAreRefused)
{
  auto carrier = grids::copy(this->Grid);
  carrier->GetPointData()
    ->GetArray("Gradient")
    ->SetComponent(7, 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(
    this->ErrorOf(adjointOf(this->Morph, this->Grid, this->Boundary, carrier)).find("node ids 7"),
    std::string::npos);
  carrier = grids::hexes(4);
  grids::addVectors(carrier, "Gradient", randomVectors(125, meshes::seed()));
  EXPECT_NE(
    this->ErrorOf(adjointOf(this->Morph, this->Grid, this->Boundary, carrier)).find("125 tuples"),
    std::string::npos);
}

TEST_F(AdjointInputs, MethodsThatAreNotLinearAreRefused)
{
  vtkNew<vtkInversionFreeMorph> inversionFree;
  vtkNew<vtkSmoothingMorph> smoothing;
  for (vtkMorphAlgorithm* morph : { static_cast<vtkMorphAlgorithm*>(inversionFree.Get()),
         static_cast<vtkMorphAlgorithm*>(smoothing.Get()) })
  {
    EXPECT_NE(this->ErrorOf(adjointOf(morph, this->Grid, this->Boundary, nullptr))
                .find(std::string(morph->GetClassName()) + " is not a linear method"),
      std::string::npos);
  }
}

TEST_F(AdjointInputs, RelativeStepsAreRefused)
{
  this->Morph->SetSteppingToRelative();
  this->Morph->SetNumberOfSteps(3);
  EXPECT_NE(this->ErrorOf(adjointOf(this->Morph, this->Grid, this->Boundary, nullptr))
              .find("Relative steps have no adjoint"),
    std::string::npos);
}

TEST_F(AdjointInputs, SmoothingAfterTheMethodDrawsAWarning)
{
  this->Morph->PostSmoothOn();
  auto adjoint = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  grids::expectWarning(adjoint, "PostSmooth");
}

TEST_F(AdjointInputs, NodesThatTurnWithTheVolumeDrawAWarning)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3); // and a beam
  mesh.points.conservativeResize(65, 3);
  mesh.points.row(64) << 3, 3, 4;
  mesh.add(morph::Line, { 63, 64 });
  auto grid = grids::make(mesh);
  grids::addVectors(grid, "Gradient", randomVectors(65, meshes::seed()));
  auto adjoint = adjointOf(this->Morph, grid, this->Boundary, nullptr);
  grids::expectWarning(adjoint, "about the undeformed mesh");
}

TEST_F(AdjointInputs, AChangedOptionOfTheMethodRunsAgain)
{
  auto adjoint = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  adjoint->Update();
  const Points full = gradients(adjoint->GetOutput());
  this->Morph->SetScaleFactor(0.5);
  adjoint->Update();
  EXPECT_LT((gradients(adjoint->GetOutput()) - 0.5 * full).norm(), 1e-12 * full.norm());
  std::ostringstream text;
  adjoint->Print(text);
  EXPECT_NE(text.str().find("Morph: vtkFEMWarpMorph"), std::string::npos);
  EXPECT_NE(text.str().find("GradientArray: Gradient"), std::string::npos);
}

TEST_F(AdjointInputs, TheMethodIsFoundBehindTheGradient)
{
  auto expected = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  expected->Update();
  this->Morph->SetInputData(this->Grid);
  this->Morph->SetBoundaryData(this->Boundary);
  vtkNew<vtkTransform> identity;
  vtkNew<vtkTransformFilter> between; // stands for the filters that evaluate the objective
  between->SetTransform(identity);
  between->SetInputConnection(this->Morph->GetOutputPort());
  auto adjoint = adjointOf(nullptr, this->Grid, this->Boundary, nullptr);
  adjoint->SetGradientConnection(between->GetOutputPort());
  adjoint->Update();
  EXPECT_TRUE(gradients(adjoint->GetOutput()) == gradients(expected->GetOutput()));
  EXPECT_EQ(this->Morph->GetPrepareCount(), 1);
}

TEST_F(AdjointInputs, FollowsTheStepsOfItsMorph)
{
  this->Morph->SetInputData(this->Grid);
  this->Morph->SetBoundaryData(this->Boundary);
  this->Morph->SetNumberOfSteps(2);
  auto adjoint = adjointOf(nullptr, this->Grid, this->Boundary, nullptr);
  adjoint->SetGradientConnection(this->Morph->GetOutputPort());
  adjoint->SetGradientArray("MorphDisplacement");
  adjoint->UpdateInformation();
  EXPECT_EQ(
    adjoint->GetOutputInformation(0)->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 3);
  adjoint->UpdateTimeStep(2);
  const morph::Points whole = gradients(adjoint->GetOutput());
  adjoint->UpdateTimeStep(1);
  const morph::Points half = gradients(adjoint->GetOutput());
  EXPECT_GT(whole.norm(), 0);
  EXPECT_LT((half - whole / 2).norm(), 1e-6 * whole.norm());
}

TEST_F(AdjointInputs, ApplyTransposeWithoutAPipeline)
{
  auto adjoint = adjointOf(this->Morph, this->Grid, this->Boundary, nullptr);
  adjoint->Update();
  vtkNew<vtkDoubleArray> result;
  EXPECT_TRUE(this->Morph->ApplyTranspose(
    this->Grid, this->Boundary, this->Grid->GetPointData()->GetArray("Gradient"), result));
  EXPECT_TRUE(Points(Eigen::Map<const Points>(result->GetPointer(0), result->GetNumberOfTuples(),
                3)) == gradients(adjoint->GetOutput()));
  grids::Listener listener(this->Morph);
  EXPECT_FALSE(this->Morph->ApplyTranspose(this->Grid, this->Boundary, nullptr, result));
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_EQ(result->GetNumberOfTuples(), 0);
}
