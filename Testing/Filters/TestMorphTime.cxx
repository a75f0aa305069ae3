// SPDX-License-Identifier: BSD-3-Clause
// The mesh at its rest time, the boundary at the time that is asked for.
#include "TestGrids.h"

#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGridAlgorithm.h>

#include <gtest/gtest.h>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
/// A hexahedral grid that grows with time: all coordinates are multiplied by 1 + time.
class GrowingGrid : public vtkUnstructuredGridAlgorithm
{
public:
  static GrowingGrid* New();
  vtkTypeMacro(GrowingGrid, vtkUnstructuredGridAlgorithm);
  std::vector<double> Steps;
  std::vector<double> Delivered; ///< the times of its executions
  double FailsAt = -1;

protected:
  GrowingGrid() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    if (!this->Steps.empty())
    {
      const double range[2] = { this->Steps.front(), this->Steps.back() };
      info->Set(Pipeline::TIME_STEPS(), this->Steps.data(), static_cast<int>(this->Steps.size()));
      info->Set(Pipeline::TIME_RANGE(), range, 2);
    }
    return 1;
  }
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    double time = 0;
    auto* output = vtkUnstructuredGrid::GetData(info);
    if (!this->Steps.empty())
    {
      time = info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP())
                                                     : this->Steps.front();
    }
    if (time == this->FailsAt)
    {
      return 0;
    }
    morph::Mesh mesh = meshes::hexes(3, 3, 3);
    mesh.points *= 1 + time;
    output->ShallowCopy(grids::make(mesh));
    if (!this->Steps.empty())
    {
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    }
    this->Delivered.push_back(time);
    return 1;
  }
};
vtkStandardNewMacro(GrowingGrid);

/// A boundary that moves up by its time.
class RisingBoundary : public vtkExtractMorphBoundary
{
public:
  static RisingBoundary* New();
  vtkTypeMacro(RisingBoundary, vtkExtractMorphBoundary);
  std::vector<double> Steps;

protected:
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    info->Remove(Pipeline::TIME_STEPS());
    info->Remove(Pipeline::TIME_RANGE());
    if (!this->Steps.empty())
    {
      const double range[2] = { this->Steps.front(), this->Steps.back() };
      info->Set(Pipeline::TIME_STEPS(), this->Steps.data(), static_cast<int>(this->Steps.size()));
      info->Set(Pipeline::TIME_RANGE(), range, 2);
    }
    return 1;
  }
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    if (!this->Superclass::RequestData(request, inputVector, outputVector))
    {
      return 0;
    }
    vtkInformation* info = outputVector->GetInformationObject(0);
    auto* output = vtkPolyData::GetData(info);
    if (!this->Steps.empty() && info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      const double time = info->Get(Pipeline::UPDATE_TIME_STEP());
      output->SetPoints(grids::cloud(
        grids::mapped(grids::points(output),
          [time](const grids::Row& x) {
            return grids::Row(x + grids::Row(0, 0, time));
          }))->GetPoints());
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    }
    return 1;
  }
};
vtkStandardNewMacro(RisingBoundary);

class PassGrid : public vtkUnstructuredGridAlgorithm
{
public:
  static PassGrid* New();
  vtkTypeMacro(PassGrid, vtkUnstructuredGridAlgorithm);

protected:
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    vtkUnstructuredGrid::GetData(outputVector)
      ->ShallowCopy(vtkUnstructuredGrid::GetData(inputVector[0]));
    return 1;
  }
};
vtkStandardNewMacro(PassGrid);

std::vector<double> stepsOf(vtkAlgorithm* filter)
{
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(0);
  const int count = info->Length(Pipeline::TIME_STEPS());
  const double* steps = info->Get(Pipeline::TIME_STEPS());
  return count ? std::vector<double>(steps, steps + count) : std::vector<double>();
}

/// The edge length of the mesh, and how far it has moved up.
std::pair<double, double> sizeAndHeight(vtkUnstructuredGrid* grid)
{
  const morph::Points x = grids::points(grid);
  return { x.col(0).maxCoeff() - x.col(0).minCoeff(), x.col(2).minCoeff() };
}
using Place = std::pair<double, double>;

morph::Points vectorsOf(vtkDataArray* array)
{
  morph::Points result(array->GetNumberOfTuples(), 3);
  for (vtkIdType i = 0; i < result.rows(); ++i)
  {
    array->GetTuple(i, result.row(i).data());
  }
  return result;
}
}

TEST(MorphTime, TheBoundaryFollowsTimeAndTheMeshStaysAtRest)
{
  vtkNew<GrowingGrid> mesh, other;
  mesh->Steps = { 0, 1, 2 };
  vtkNew<RisingBoundary> boundary;
  boundary->Steps = { 0, 0.25, 0.5, 4 };
  boundary->SetInputConnection(other->GetOutputPort());
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputConnection(mesh->GetOutputPort());
  filter->SetBoundaryConnection(boundary->GetOutputPort());
  EXPECT_EQ(stepsOf(filter), boundary->Steps);
  const double* range = filter->GetOutputInformation(0)->Get(Pipeline::TIME_RANGE());
  ASSERT_NE(range, nullptr);
  EXPECT_EQ(range[1], 4);
  for (const double time : { 0.25, 4.0, 0.5, 0.0 })
  {
    filter->UpdateTimeStep(time);
    EXPECT_EQ(sizeAndHeight(filter->GetOutput()), Place(3, time));
    EXPECT_EQ(filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
  }
  EXPECT_EQ(mesh->Delivered, std::vector<double>{ 0 });
  EXPECT_EQ(filter->GetPrepareCount(), 1);
}

TEST(MorphTime, ATimeThatIsThereIsNotComputedAgain)
{
  vtkNew<GrowingGrid> mesh;
  mesh->Steps = { 0, 1 };
  vtkNew<GrowingGrid> other;
  vtkNew<RisingBoundary> boundary;
  boundary->Steps = { 0, 2 };
  boundary->SetInputConnection(other->GetOutputPort());
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputConnection(mesh->GetOutputPort());
  filter->SetBoundaryConnection(boundary->GetOutputPort());
  filter->UpdateTimeStep(2);
  const vtkMTimeType made = filter->GetOutput()->GetMTime();
  filter->UpdateTimeStep(2);
  EXPECT_EQ(filter->GetOutput()->GetMTime(), made);
}

TEST(MorphTime, RestTime)
{
  vtkNew<GrowingGrid> mesh;
  mesh->Steps = { 1, 3, 5 };
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputConnection(mesh->GetOutputPort());
  // Each rest time, and the time step that it selects.
  const std::vector<std::pair<double, double>> cases = { { filter->GetRestTime(), 1 }, { -7, 1 },
    { 1, 1 }, { 2.9, 1 }, { 3, 3 }, { 4, 3 }, { 5, 5 }, { 1e9, 5 } };
  for (const auto& [restTime, step] : cases)
  {
    SCOPED_TRACE(restTime);
    morph::Mesh rest = meshes::hexes(3, 3, 3);
    rest.points *= 1 + step;
    filter->SetRestTime(restTime);
    filter->SetBoundaryData(
      grids::boundary(grids::make(rest), [](const grids::Row& x) { return x; }));
    grids::update(filter);
    EXPECT_EQ(sizeAndHeight(filter->GetOutput()), Place(3 * (1 + step), 0));
    EXPECT_EQ(mesh->Delivered.back(), step);
  }
}

TEST(MorphTime, BadCellsHaveTheTimesOfTheMesh)
{
  vtkNew<GrowingGrid> mesh, other;
  mesh->Steps = { 0, 1, 2 };
  vtkNew<RisingBoundary> boundary;
  boundary->SetInputConnection(other->GetOutputPort());
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputConnection(mesh->GetOutputPort());
  filter->SetBoundaryConnection(boundary->GetOutputPort());
  filter->UpdateInformation();
  EXPECT_FALSE(filter->GetOutputInformation(1)->Has(Pipeline::TIME_STEPS()));
  boundary->Steps = { 0, 5 };
  boundary->Modified();
  filter->UpdateInformation();
  ASSERT_EQ(filter->GetOutputInformation(1)->Length(Pipeline::TIME_STEPS()), 2);
  EXPECT_EQ(filter->GetOutputInformation(1)->Get(Pipeline::TIME_RANGE())[1], 5);
}

TEST(MorphTime, AStaticBoundaryHasNoSteps)
{
  vtkNew<GrowingGrid> mesh;
  mesh->Steps = { 0, 1, 2 };
  vtkNew<GrowingGrid> still;
  vtkNew<vtkExtractMorphBoundary> boundary;
  boundary->SetInputConnection(still->GetOutputPort());
  vtkNew<vtkFEMWarpMorph> filter;
  filter->SetInputConnection(mesh->GetOutputPort());
  filter->SetBoundaryConnection(boundary->GetOutputPort());
  EXPECT_TRUE(stepsOf(filter).empty());
  EXPECT_FALSE(filter->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
  filter->Update();
  EXPECT_EQ(sizeAndHeight(filter->GetOutput()), Place(3, 0));
  EXPECT_FALSE(filter->GetOutput()->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()));
}

/// The mesh from the source at its rest time, the boundary from the same source at others.
class MorphTimeOneSource : public testing::TestWithParam<std::tuple<bool, double>>
{
protected:
  vtkNew<GrowingGrid> Source;
  vtkNew<PassGrid> Between;
  vtkNew<vtkFEMWarpMorph> Filter;

  void SetUp() override
  {
    const auto& [direct, restTime] = GetParam();
    this->Source->Steps = { 0, 1, 2 };
    this->Between->SetInputConnection(this->Source->GetOutputPort());
    this->Filter->SetInputConnection(this->Source->GetOutputPort());
    this->Filter->SetBoundaryConnection(
      direct ? this->Source->GetOutputPort() : this->Between->GetOutputPort());
    this->Filter->SetRestTime(restTime);
  }
};

TEST_P(MorphTimeOneSource, RestMeshIsNotOverwritten)
{
  // Fetching the boundary leaves the source's grid, port 0's data, at the boundary's time.
  const double restTime = std::get<1>(GetParam());
  EXPECT_EQ(stepsOf(this->Filter), this->Source->Steps);
  for (const double time : { 2.0, 0.0, 1.0, 2.0 })
  {
    SCOPED_TRACE(time);
    grids::Listener listener(this->Filter);
    this->Filter->UpdateTimeStep(time);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_EQ(sizeAndHeight(this->Filter->GetOutput()), Place(3 * (1 + time), 0));
    EXPECT_EQ(
      this->Filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    auto* vectors = this->Filter->GetOutput()->GetPointData()->GetArray("MorphDisplacement");
    ASSERT_NE(vectors, nullptr);
    const morph::Points expected = meshes::hexes(3, 3, 3).points * (time - restTime);
    EXPECT_LT((vectorsOf(vectors) - expected).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_EQ(this->Filter->GetPrepareCount(), 1);
}

TEST_P(MorphTimeOneSource, ATimeThatFailsEndsTheExecution)
{
  const double restTime = std::get<1>(GetParam());
  this->Source->FailsAt = 2;
  this->Filter->UpdateTimeStep(restTime);
  EXPECT_EQ(sizeAndHeight(this->Filter->GetOutput()), Place(3 * (1 + restTime), 0));
  // Where one port feeds both inputs the filter itself asks for that time, and reports the failure.
  grids::Listener listener(this->Filter);
  const bool isReported = std::get<0>(GetParam());
  EXPECT_EQ(this->Filter->UpdateTimeStep(2), isReported ? 1 : 0);
  EXPECT_EQ(listener.Errors.size(), isReported ? 1u : 0u);
  EXPECT_STREQ(this->Filter->GetMorphStatus(), isReported ? "Failed" : "Valid");
  this->Source->FailsAt = -1;
  this->Source->Modified();
  EXPECT_EQ(this->Filter->UpdateTimeStep(2), 1);
  EXPECT_EQ(sizeAndHeight(this->Filter->GetOutput()), Place(9, 0));
}

INSTANTIATE_TEST_SUITE_P(
  Routes, MorphTimeOneSource, testing::Combine(testing::Bool(), testing::Values(0.0, 1.0)));

TEST(MorphTime, OfSeveralStepsWithNothingToFollowOneIsTakenWithAWarning)
{
  vtkNew<GrowingGrid> mesh;
  vtkNew<RisingBoundary> boundary;
  boundary->Steps = { 0.25, 0.5, 4 };
  boundary->SetInputConnection(mesh->GetOutputPort());
  vtkNew<vtkMorphShapes> shapes;
  shapes->SetInputConnection(mesh->GetOutputPort());
  shapes->AddShapeConnection(boundary->GetOutputPort());
  grids::expectWarning(shapes, "A shape has 3 time steps, and is taken at one.");

  vtkNew<vtkMorphMesh> fit;
  fit->SetInputConnection(mesh->GetOutputPort());
  fit->SetTargetConnection(boundary->GetOutputPort());
  fit->SetMovingToEverything();
  fit->SetDisplacementToTarget();
  fit->SetRestTime(1);
  fit->SetNumberOfSteps(2);
  grids::expectWarning(fit, "The target has 3 time steps, and is taken at one, 0.5.");
  EXPECT_NEAR(sizeAndHeight(fit->GetOutput()).second, 0.5, 1e-6);
}
