// SPDX-License-Identifier: BSD-3-Clause
// Steps in time: parts of a still boundary's motion or those of a boundary that varies, each from
// the undeformed mesh or from the mesh of the step before.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphAlgorithm.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
/// A boundary whose points at time t lie t of the way from `From` to `To`, at its own time steps or
/// in a range; at time 1 while it is `Still`.
class MovingBoundary : public vtkPolyDataAlgorithm
{
public:
  static MovingBoundary* New();
  vtkTypeMacro(MovingBoundary, vtkPolyDataAlgorithm);
  vtkSmartPointer<vtkPolyData> From, To;
  std::vector<double> Steps;     ///< empty: the range alone
  std::vector<double> Delivered; ///< the times of its executions
  double FailsAt = -1;
  bool Still = false;

protected:
  MovingBoundary() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    info->Remove(Pipeline::TIME_STEPS());
    info->Remove(Pipeline::TIME_RANGE());
    if (this->Still)
    {
      return 1;
    }
    const double range[2] = { this->Steps.empty() ? 0 : this->Steps.front(),
      this->Steps.empty() ? 1 : this->Steps.back() };
    if (!this->Steps.empty())
    {
      info->Set(Pipeline::TIME_STEPS(), this->Steps.data(), static_cast<int>(this->Steps.size()));
    }
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double time = this->Still ? 1
                        : info->Has(Pipeline::UPDATE_TIME_STEP())
                          ? info->Get(Pipeline::UPDATE_TIME_STEP())
                          : 0;
    this->Delivered.push_back(time);
    if (time == this->FailsAt)
    {
      return 0;
    }
    auto* output = vtkPolyData::GetData(info);
    output->DeepCopy(this->From);
    const morph::Points from = grids::points(this->From);
    output->SetPoints(grids::cloud(from + time * (grids::points(this->To) - from))->GetPoints());
    if (!this->Still)
    {
      output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    }
    return 1;
  }
};
vtkStandardNewMacro(MovingBoundary);

/// A bulge that is not affine, and mild enough for all methods.
grids::Row bulge(const grids::Row& x)
{
  return x * (1 + 0.1 * std::sin(x[0] + 2 * x[1] - x[2]));
}

class MorphSteps : public testing::TestWithParam<std::size_t>
{
protected:
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(3);
  vtkSmartPointer<vtkPolyData> Rest = grids::boundary(Grid, [](const grids::Row& x) { return x; });
  vtkSmartPointer<vtkPolyData> Moved = grids::boundary(Grid, bulge);

  vtkSmartPointer<vtkMorphAlgorithm> Make() const
  {
    auto filter = grids::morphFilters()[GetParam()].make();
    filter->SetInputData(this->Grid);
    filter->SetBoundaryData(this->Moved);
    filter->SetValidityToNone();
    return filter;
  }
  static morph::Points At(vtkMorphAlgorithm* filter, double time)
  {
    filter->UpdateTimeStep(time);
    EXPECT_EQ(filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    return grids::points(filter->GetOutput());
  }
};

std::vector<double> timesOf(vtkAlgorithm* filter)
{
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(0);
  const double* times = info->Get(Pipeline::TIME_STEPS());
  return { times, times + info->Length(Pipeline::TIME_STEPS()) };
}
}

TEST_P(MorphSteps, AnAbsoluteStepIsThatPartOfTheMotion)
{
  auto steps = this->Make();
  steps->SetScaleFactor(0.7);
  steps->SetNumberOfSteps(5);
  EXPECT_EQ(timesOf(steps), (std::vector<double>{ 0, 1, 2, 3, 4, 5 }));
  auto whole = this->Make();
  for (const int i : { 3, 0, 5, 1 })
  {
    whole->SetScaleFactor(0.7 * (i / 5.));
    whole->Update();
    EXPECT_TRUE(At(steps, i) == grids::points(whole->GetOutput())) << i;
    if (i == 0)
    {
      EXPECT_TRUE(At(steps, i) == grids::points(this->Grid));
    }
  }
  EXPECT_EQ(steps->GetPrepareCount(), 1);
}

TEST_P(MorphSteps, ARelativeStepIsTheSamePlayedOrJumpedTo)
{
  auto played = this->Make();
  played->SetNumberOfSteps(4);
  played->SetSteppingToRelative();
  std::vector<morph::Points> meshes;
  for (int i = 0; i <= 4; ++i)
  {
    meshes.push_back(At(played, i));
    // Steps 0 and 1 both start from the undeformed mesh.
    EXPECT_EQ(played->GetPrepareCount(), std::max(1, i));
  }
  EXPECT_TRUE(meshes[0] == grids::points(this->Grid));
  auto jumped = this->Make();
  jumped->SetNumberOfSteps(4);
  jumped->SetSteppingToRelative();
  EXPECT_TRUE(At(jumped, 4) == meshes[4]);
  EXPECT_EQ(jumped->GetPrepareCount(), 4);
  // Kept on the way.
  EXPECT_TRUE(At(jumped, 2) == meshes[2]);
  EXPECT_EQ(jumped->GetPrepareCount(), 4);
  EXPECT_EQ(jumped->GetPrepareSeconds(), 0);
  EXPECT_EQ(jumped->GetEvaluateSeconds(), 0);
}

TEST_P(MorphSteps, ARelativeStepStartsFromTheMeshBefore)
{
  auto steps = this->Make();
  steps->SetNumberOfSteps(2);
  steps->SetSteppingToRelative();
  const morph::Points half = At(steps, 1), whole = At(steps, 2);

  // By hand: half way, and from there on.
  auto first = this->Make();
  first->SetScaleFactor(0.5);
  first->Update();
  EXPECT_TRUE(grids::points(first->GetOutput()) == half);
  vtkNew<vtkPolyData> moved;
  moved->ShallowCopy(this->Moved);
  moved->GetPointData()->RemoveArray("RestPosition");
  auto second = this->Make();
  second->SetInputData(grids::copy(first->GetOutput()));
  second->SetBoundaryData(moved);
  second->Update();
  const morph::Points byHand = grids::points(second->GetOutput());
  EXPECT_LT((byHand - whole).cwiseAbs().maxCoeff(), 1e-12 * meshes::size(byHand));
}

TEST_P(MorphSteps, ABoundaryThatVariesSuppliesTheSteps)
{
  vtkNew<MovingBoundary> boundary;
  boundary->From = this->Rest;
  boundary->To = this->Moved;
  boundary->Steps = { 0, 0.25, 0.5, 1 };
  auto jumped = this->Make();
  jumped->SetBoundaryConnection(boundary->GetOutputPort());
  jumped->SetNumberOfSteps(7); // without effect
  jumped->SetSteppingToRelative();
  EXPECT_EQ(timesOf(jumped), boundary->Steps);
  const morph::Points last = At(jumped, 1);
  EXPECT_EQ(boundary->Delivered, boundary->Steps);
  EXPECT_EQ(jumped->GetPrepareCount(), 3);

  auto played = this->Make();
  played->SetBoundaryConnection(boundary->GetOutputPort());
  played->SetSteppingToRelative();
  std::vector<morph::Points> meshes;
  for (const double time : boundary->Steps)
  {
    meshes.push_back(At(played, time));
  }
  EXPECT_TRUE(meshes.back() == last);
  boundary->Delivered.clear();
  EXPECT_TRUE(At(jumped, 0.5) == meshes[2]);
  EXPECT_TRUE(At(jumped, 0) == grids::points(this->Grid));
  EXPECT_TRUE(At(jumped, 0.25) == meshes[1]);
  EXPECT_EQ(jumped->GetPrepareCount(), 3);
  EXPECT_EQ(boundary->Delivered, (std::vector<double>{ 0.5, 0, 0.25 }));

  // A boundary that was modified is another series.
  boundary->To = grids::boundary(this->Grid, grids::affine);
  boundary->Modified();
  EXPECT_FALSE(At(jumped, 1) == last);
  EXPECT_EQ(jumped->GetPrepareCount(), 6);
}

INSTANTIATE_TEST_SUITE_P(Methods, MorphSteps,
  testing::Range<std::size_t>(0, grids::morphFilters().size()),
  [](const auto& info) { return grids::morphFilters()[info.param].name; });

namespace
{
class RelativeSteps : public testing::Test
{
protected:
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(4);
  vtkNew<vtkWeightedResidualMorph> Filter;

  void SetUp() override
  {
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(grids::boundary(this->Grid, bulge));
    this->Filter->SetNumberOfSteps(16);
    this->Filter->SetSteppingToRelative();
  }
  int PreparesAt(int step)
  {
    const int before = this->Filter->GetPrepareCount();
    this->Filter->UpdateTimeStep(step);
    return this->Filter->GetPrepareCount() - before;
  }
  morph::Points Result() { return grids::points(this->Filter->GetOutput()); }
};
}

TEST_F(RelativeSteps, MeshesAreKeptWithinALimit)
{
  std::vector<morph::Points> meshes;
  for (int i = 0; i <= 16; ++i)
  {
    this->PreparesAt(i);
    meshes.push_back(this->Result());
  }
  // Room for 5 meshes: 0, 4, 8, 12 and 16 are there.
  this->Filter->SetStepMemoryLimit(5.5 * 24 * static_cast<double>(meshes[0].rows()) / 1e6);
  EXPECT_EQ(this->PreparesAt(16), 16);
  for (const auto& [step, prepares] :
    { std::pair(12, 0), { 8, 0 }, { 11, 3 }, { 10, 2 }, { 4, 0 }, { 16, 0 }, { 0, 0 } })
  {
    EXPECT_EQ(this->PreparesAt(step), prepares) << step;
    EXPECT_TRUE(this->Result() == meshes[step]) << step;
  }
  // With no room at all the last one is still there to go on from.
  this->Filter->SetStepMemoryLimit(0);
  EXPECT_EQ(this->PreparesAt(7), 7);
  EXPECT_EQ(this->PreparesAt(8), 1);
  EXPECT_TRUE(this->Result() == meshes[8]);
  EXPECT_EQ(this->PreparesAt(3), 3);
  EXPECT_TRUE(this->Result() == meshes[3]);
}

TEST_F(RelativeSteps, OtherContentIsAnotherSeries)
{
  EXPECT_EQ(this->PreparesAt(2), 2);
  EXPECT_EQ(this->PreparesAt(3), 1);
  const morph::Points third = this->Result();
  // The boundary executes again and is the same.
  this->Filter->GetInputAlgorithm(1, 0)->Modified();
  EXPECT_EQ(this->PreparesAt(3), 0);
  EXPECT_TRUE(this->Result() == third);

  this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
  EXPECT_EQ(this->PreparesAt(3), 3);
  EXPECT_FALSE(this->Result() == third);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, bulge));
  EXPECT_EQ(this->PreparesAt(3), 3);
  EXPECT_TRUE(this->Result() == third);

  this->Filter->SetNumberOfNeighbors(9);
  EXPECT_EQ(this->PreparesAt(3), 3);
  EXPECT_FALSE(this->Result() == third);

  auto grid = grids::copy(this->Grid);
  grid->GetPoints()->SetPoint(62, 2.1, 2, 2);
  this->Filter->SetInputData(grid);
  EXPECT_EQ(this->PreparesAt(0), 1);
}

TEST_F(RelativeSteps, WithoutATimeTheLastStep)
{
  this->Filter->SetNumberOfSteps(3);
  this->Filter->Update();
  const morph::Points last = this->Result();
  this->Filter->UpdateTimeStep(3);
  EXPECT_TRUE(this->Result() == last);
  // Between steps the one before.
  this->Filter->UpdateTimeStep(2);
  const morph::Points second = this->Result();
  this->Filter->UpdateTimeStep(2.9);
  EXPECT_TRUE(this->Result() == second);
}

TEST_F(RelativeSteps, AnErrorNamesItsStep)
{
  grids::Listener listener(this->Filter);
  this->Filter->SetValidityToRefuse();
  this->Filter->SetNumberOfSteps(4);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid,
    [](const grids::Row& x) { return grids::Row(x[0], x[1], x[2] == 4 ? 1.6 : x[2]); }));
  this->Filter->UpdateTimeStep(4);
  listener.ExpectError("Step 2: ");
  EXPECT_STREQ(this->Filter->GetMorphStatus(), "Failed");
  EXPECT_TRUE(this->Result() == grids::points(this->Grid));
  // The step before it is valid.
  this->Filter->UpdateTimeStep(1);
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_EQ(this->Filter->GetInvertedCells(), 0);
}

TEST_F(RelativeSteps, InvertedCellsOfAStepThatWasKeptAreReportedToo)
{
  this->Filter->SetNumberOfSteps(4);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid,
    [](const grids::Row& x) { return grids::Row(x[0], x[1], x[2] == 4 ? 1.6 : x[2]); }));
  for (const int step : { 4, 3, 1, 3 })
  {
    grids::Listener listener(this->Filter);
    EXPECT_EQ(this->PreparesAt(step), step == 4 ? 4 : 0) << step;
    EXPECT_EQ(this->Filter->GetInvertedCells() > 0, step > 1);
    // That the boundary runs into itself is a warning of its own.
    const auto ofCells = std::count_if(listener.Warnings.begin(), listener.Warnings.end(),
      [](const std::string& text) { return text.find("scaled Jacobian") != std::string::npos; });
    EXPECT_EQ(ofCells, step > 1 ? 1 : 0) << step;
  }
}

TEST_F(RelativeSteps, ABoundaryThatVariedMeanwhileIsAnotherSeries)
{
  vtkNew<MovingBoundary> boundary;
  boundary->From = grids::boundary(this->Grid, [](const grids::Row& x) { return x; });
  boundary->To = grids::boundary(this->Grid, bulge);
  boundary->Still = true;
  this->Filter->SetBoundaryConnection(boundary->GetOutputPort());
  this->Filter->SetNumberOfSteps(4);
  this->Filter->UpdateTimeStep(4);
  const morph::Points still = this->Result();
  boundary->Still = false;
  boundary->Steps = { 0, 1, 2, 3, 4 };
  boundary->Modified();
  this->Filter->UpdateTimeStep(4);
  EXPECT_FALSE(this->Result() == still);
  boundary->Still = true;
  boundary->Modified();
  this->Filter->UpdateTimeStep(4);
  EXPECT_TRUE(this->Result() == still);
}

TEST_F(RelativeSteps, ATimeAtWhichTheBoundaryFailsEndsTheExecution)
{
  vtkNew<MovingBoundary> boundary;
  boundary->From = grids::boundary(this->Grid, [](const grids::Row& x) { return x; });
  boundary->To = grids::boundary(this->Grid, bulge);
  boundary->Steps = { 0, 0.25, 0.5, 0.75, 1 };
  boundary->FailsAt = 0.5;
  this->Filter->SetBoundaryConnection(boundary->GetOutputPort());
  grids::Listener listener(this->Filter);
  this->Filter->UpdateTimeStep(1);
  ASSERT_EQ(listener.Errors.size(), 1u);
  EXPECT_TRUE(listener.ExecutiveErrors.empty());
  EXPECT_NE(listener.Errors[0].find("The boundary is not available at time 0.5"), std::string::npos)
    << listener.Errors[0];
  EXPECT_STREQ(this->Filter->GetMorphStatus(), "Failed");
  // The steps before it are kept.
  EXPECT_EQ(this->PreparesAt(0), 0);
  EXPECT_STREQ(this->Filter->GetMorphStatus(), "Valid");
  boundary->FailsAt = -1;
  boundary->Modified();
  EXPECT_EQ(this->Filter->UpdateTimeStep(1), 1);
  EXPECT_EQ(listener.Errors.size(), 1u);
}

TEST(MorphStepsOfARange, AreEqualPartsOfIt)
{
  auto grid = grids::hexes(3);
  vtkNew<MovingBoundary> boundary;
  boundary->From = grids::boundary(grid, [](const grids::Row& x) { return x; });
  boundary->To = grids::boundary(grid, bulge);
  auto filter = grids::of<vtkSimplexLinearMorph>(grid);
  filter->SetBoundaryConnection(boundary->GetOutputPort());
  filter->SetNumberOfSteps(4);
  EXPECT_EQ(timesOf(filter), (std::vector<double>{ 0, 0.25, 0.5, 0.75, 1 }));
  filter->SetSteppingToRelative();
  filter->UpdateTimeStep(0.75);
  EXPECT_EQ(boundary->Delivered, (std::vector<double>{ 0, 0.25, 0.5, 0.75 }));
  EXPECT_EQ(filter->GetPrepareCount(), 3);
  filter->SetSteppingToAbsolute();
  filter->UpdateTimeStep(0.6);
  EXPECT_EQ(boundary->Delivered.back(), 0.5);
}
