// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
/// Steep waves that turn cells over before the last step.
grids::Row waves(const grids::Row& x)
{
  return { x[0], x[1], x[2] + 1.5 * std::sin(M_PI / 2 * x[0]) };
}

class CompareMorphMethods : public testing::Test
{
protected:
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(4);
  vtkNew<vtkCompareMorphMethods> Filter;

  void SetUp() override
  {
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(grids::boundary(this->Grid, waves));
    this->Filter->SetNumberOfSteps(4);
    this->Filter->RelativeOn();
  }
  void Choose(bool fem, bool residual, bool others = false)
  {
    this->Filter->SetFEMWARP(fem);
    this->Filter->SetWeightedResidual(residual);
    this->Filter->SetSmoothing(others);
    this->Filter->SetSimplexLinear(others);
    this->Filter->SetSimplexNaturalNeighbor(others);
    this->Filter->SetRadialBasis(others);
    this->Filter->SetLBWARP(others);
    this->Filter->SetInversionFree(others);
  }
  vtkVariant At(int port, vtkIdType row, const char* column)
  {
    vtkTable* table = this->Filter->GetOutput(port);
    EXPECT_NE(table->GetColumnByName(column), nullptr) << column;
    return table->GetValueByName(row, column);
  }
  double Number(int port, vtkIdType row, const char* column)
  {
    return this->At(port, row, column).ToDouble();
  }
  std::string Text(int port, vtkIdType row, const char* column)
  {
    return this->At(port, row, column).ToString();
  }
  vtkIdType Rows(int port) { return this->Filter->GetOutput(port)->GetNumberOfRows(); }
};
}

TEST_F(CompareMorphMethods, RowsAreWhatTheFiltersThemselvesGive)
{
  this->Choose(true, true);
  this->Filter->SetPercentile(10);
  this->Filter->SetCriteria("Skewness=.3");
  this->Filter->Update();
  ASSERT_EQ(this->Rows(0), 2 * 2 * 5);
  vtkIdType row = 0;
  bool inverted = false;
  for (const bool relative : { false, true })
  {
    for (const char* name : { "Weighted residual", "FEMWARP" })
    {
      vtkSmartPointer<vtkMorphAlgorithm> filter = vtkSmartPointer<vtkFEMWarpMorph>::New();
      if (name[0] == 'W')
      {
        filter = vtkSmartPointer<vtkWeightedResidualMorph>::New();
      }
      filter->SetInputData(this->Grid);
      filter->SetBoundaryData(grids::boundary(this->Grid, waves));
      filter->SetNumberOfSteps(4);
      filter->SetValidityToNone();
      filter->SetStepping(relative);
      for (int step = 0; step <= 4; ++step, ++row)
      {
        SCOPED_TRACE(
          std::string(name) + (relative ? " relative " : " absolute ") + std::to_string(step));
        filter->UpdateTimeStep(step);
        EXPECT_EQ(this->Text(0, row, "Method"), name);
        EXPECT_EQ(this->Text(0, row, "Stepping"), relative ? "Relative" : "Absolute");
        EXPECT_EQ(this->Number(0, row, "Step"), step);
        EXPECT_EQ(this->Number(0, row, "Time"), step);
        EXPECT_EQ(this->Number(0, row, "MinScaledJacobian"), filter->GetMinScaledJacobian());
        EXPECT_EQ(this->Number(0, row, "MeanScaledJacobian"), filter->GetMeanScaledJacobian());
        EXPECT_EQ(this->Number(0, row, "InvertedCells"), filter->GetInvertedCells());
        EXPECT_EQ(this->Number(0, row, "DegenerateCells"), filter->GetDegenerateCells());
        EXPECT_EQ(
          this->Number(0, row, "BoundaryInvertedCells"), filter->GetBoundaryInvertedCells());
        EXPECT_GT(this->Number(0, row, "EvaluateSeconds"), 0);
        EXPECT_EQ(this->Number(0, row, "PrepareSeconds") > 0, relative ? step != 1 : step == 0);
        inverted = inverted || filter->GetInvertedCells() > 0;

        auto measure = grids::of<vtkScaledJacobian>(filter->GetOutput());
        measure->SetCriteria("Skewness=.3");
        measure->Update();
        for (const char* column : { "Limit", "Worst", "WorstCellId", "CellsBeyond" })
        {
          const std::string name = column;
          EXPECT_EQ(this->Number(0, row, ("Skewness" + name).c_str()),
            measure->GetOutput()
              ->GetFieldData()
              ->GetArray(("Criterion" + name).c_str())
              ->GetComponent(0, 0))
            << name;
        }

        vtkDataArray* cells = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
        std::vector<double> sorted;
        for (vtkIdType c = 0; c < 64; ++c)
        {
          sorted.push_back(cells->GetComponent(c, 0));
        }
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(this->Number(0, row, "LowScaledJacobian"), sorted[6]); // 10 % of 63 below
      }
    }
  }
  EXPECT_TRUE(inverted);
}

TEST_F(CompareMorphMethods, TheChartHasAColumnForEachMethod)
{
  this->Choose(true, true);
  this->Filter->Update();
  vtkTable* chart = this->Filter->GetOutput(1);
  ASSERT_EQ(chart->GetNumberOfRows(), 5);
  ASSERT_EQ(chart->GetNumberOfColumns(), 5);
  for (vtkIdType row = 0; row < this->Rows(0); ++row)
  {
    const std::string title = this->Text(0, row, "Method") + ", " + this->Text(0, row, "Stepping");
    EXPECT_EQ(this->Number(1, row % 5, title.c_str()), this->Number(0, row, "MinScaledJacobian"));
    EXPECT_EQ(this->Number(1, row % 5, "Time"), row % 5);
  }
}

TEST_F(CompareMorphMethods, RankingIsByValidityThenQuality)
{
  this->Choose(true, true, true);
  this->Filter->Update();
  ASSERT_EQ(this->Rows(0), 8 * 2 * 5);
  ASSERT_EQ(this->Rows(2), 8 * 2);
  EXPECT_EQ(this->Text(2, 0, "Method"), this->Filter->GetBestMethod());
  EXPECT_EQ(this->Text(2, 0, "Stepping"), this->Filter->GetBestStepping());
  // What never inverts a cell is first.
  EXPECT_STREQ(this->Filter->GetBestMethod(), "Inversion-free");
  EXPECT_EQ(this->Number(2, 0, "FirstInvertedStep"), -1);
  EXPECT_GT(this->Number(2, 15, "FirstInvertedStep"), 0);
  double steps = 6, quality = 0;
  for (vtkIdType rank = 0; rank < 16; ++rank)
  {
    SCOPED_TRACE(rank);
    EXPECT_EQ(this->Number(2, rank, "Rank"), rank + 1);
    // Found again among the steps.
    const std::string method = this->Text(2, rank, "Method"),
                      stepping = this->Text(2, rank, "Stepping");
    int valid = 0;
    double minimum = NAN, seconds = 0;
    bool open = true;
    for (vtkIdType row = 0; row < this->Rows(0); ++row)
    {
      if (this->Text(0, row, "Method") == method && this->Text(0, row, "Stepping") == stepping)
      {
        open = open && this->Number(0, row, "InvertedCells") == 0;
        valid += open;
        minimum = open ? this->Number(0, row, "MinScaledJacobian") : minimum;
        seconds += this->Number(0, row, "PrepareSeconds") + this->Number(0, row, "EvaluateSeconds");
      }
    }
    EXPECT_EQ(this->Number(2, rank, "FirstInvertedStep"), valid < 5 ? valid : -1);
    EXPECT_EQ(this->Number(2, rank, "LastValidTime"), valid - 1);
    EXPECT_EQ(this->Number(2, rank, "LastValidMinScaledJacobian"), minimum);
    EXPECT_NEAR(this->Number(2, rank, "Seconds"), seconds, 1e-9);
    EXPECT_LE(valid, steps);
    if (valid == steps)
    {
      EXPECT_LE(minimum, quality + 0.01);
    }
    steps = valid;
    quality = minimum;
  }
}

namespace
{
/// The waves' boundary at times 2, 3 and 5, where it has made 0, a quarter and all of its motion.
class WavingBoundary : public vtkPolyDataAlgorithm
{
public:
  static WavingBoundary* New();
  vtkTypeMacro(WavingBoundary, vtkPolyDataAlgorithm);
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::vector<double> Delivered;

protected:
  WavingBoundary() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    const double steps[] = { 2, 3, 5 }, range[] = { 2, 5 };
    vtkInformation* info = outputVector->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), steps, 3);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double time = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    this->Delivered.push_back(time);
    const double part = time == 2 ? 0 : time == 3 ? 0.25 : 1;
    auto* output = vtkPolyData::GetData(info);
    output->ShallowCopy(grids::boundary(
      this->Grid, [part](const grids::Row& x) { return grids::Row(x + part * (waves(x) - x)); }));
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};
vtkStandardNewMacro(WavingBoundary);
}

TEST_F(CompareMorphMethods, ABoundaryThatVariesSuppliesTheSteps)
{
  this->Choose(true, false);
  this->Filter->SetRelative(false);
  this->Filter->Update();
  const double quarter = this->Number(0, 1, "MinScaledJacobian"),
               whole = this->Number(0, 4, "MinScaledJacobian");
  vtkNew<WavingBoundary> boundary;
  boundary->Grid = this->Grid;
  this->Filter->SetBoundaryConnection(boundary->GetOutputPort());
  for (const int executions : { 1, 2 })
  {
    this->Filter->Modified();
    this->Filter->Update();
    ASSERT_EQ(this->Rows(0), 3);
    for (int step = 0; step < 3; ++step)
    {
      EXPECT_EQ(this->Number(0, step, "Step"), step);
      EXPECT_EQ(this->Number(0, step, "Time"), step == 2 ? 5 : 2 + step);
    }
    EXPECT_NEAR(this->Number(0, 1, "MinScaledJacobian"), quarter, 1e-8);
    EXPECT_NEAR(this->Number(0, 2, "MinScaledJacobian"), whole, 1e-8);
    EXPECT_EQ(boundary->Delivered.size(), 3u * executions);
  }
  const std::size_t before = boundary->Delivered.size();
  this->Filter->Update();
  EXPECT_EQ(boundary->Delivered.size(), before);
}

TEST_F(CompareMorphMethods, AMethodThatFailsEndsItsRun)
{
  // Nodes of one plane have no tessellation, and weighted residuals need none.
  const morph::Points points = grids::points(this->Grid);
  std::vector<morph::Index> ids;
  for (morph::Index i = 0; i < points.rows(); ++i)
  {
    if (points(i, 2) == 0)
    {
      ids.push_back(i);
    }
  }
  const morph::Points targets = 1.1 * points(ids, morph::allColumns);
  auto boundary = grids::cloud(targets);
  grids::addIds(boundary, "MorphPointId", ids);
  this->Choose(false, true);
  this->Filter->SetSimplexLinear(true);
  this->Filter->SetInputData(this->Grid);
  this->Filter->SetBoundaryData(boundary);
  this->Filter->SetFixUnnamedBoundary(false);
  const grids::Run listener(this->Filter);
  EXPECT_TRUE(listener.Errors.empty());
  ASSERT_EQ(listener.Warnings.size(), 2u);
  EXPECT_NE(listener.Warnings[0].find("Simplex-linear, Absolute, step 0: "), std::string::npos)
    << listener.Warnings[0];
  EXPECT_EQ(this->Rows(0), 2 * 5);
  EXPECT_EQ(this->Rows(2), 4);
  EXPECT_STREQ(this->Filter->GetBestMethod(), "Weighted residual");
  EXPECT_TRUE(std::isnan(this->Number(2, 3, "LastValidTime")));
  EXPECT_TRUE(std::isnan(this->Number(1, 0, "Simplex-linear, Relative")));
}

TEST_F(CompareMorphMethods, CellsThatAreInvertedAtRestCountForNoMethod)
{
  this->Choose(true, true);
  auto grid = grids::copy(this->Grid);
  grid->GetPoints()->SetPoint(62, 0.4, 2, 2); // the middle, behind its neighbor
  this->Filter->SetInputData(grid);
  this->Filter->SetBoundaryData(
    grids::boundary(grid, [](const grids::Row& x) { return grids::Row(1.2 * x[0], x[1], x[2]); }));
  const grids::Run listener(this->Filter);
  ASSERT_FALSE(listener.Warnings.empty());
  EXPECT_NE(listener.Warnings[0].find("The undeformed mesh has "), std::string::npos)
    << listener.Warnings[0];
  ASSERT_GT(this->Number(0, 0, "InvertedCells"), 0);
  // An affine motion inverts no cell, and mends none.
  for (vtkIdType row = 0; row < 4; ++row)
  {
    EXPECT_EQ(this->Number(2, row, "FirstInvertedStep"), -1);
    EXPECT_EQ(this->Number(2, row, "LastValidTime"), 4);
  }
}

TEST_F(CompareMorphMethods, AMessageComesOnceARun)
{
  this->Choose(true, false);
  this->Filter->SetRelative(false);
  auto boundary = grids::boundary(this->Grid, waves);
  boundary->GetPointData()
    ->GetArray("MorphPointId")
    ->SetName("vtkOriginalPointIds"); // draws a warning
  this->Filter->SetBoundaryData(boundary);
  const grids::Run listener(this->Filter);
  EXPECT_EQ(this->Rows(0), 5);
  listener.ExpectWarning("FEMWARP, Absolute, step 0: ");
}

TEST_F(CompareMorphMethods, ErrorsGiveEmptyTables)
{
  const auto errorAfter = [this](const std::string& text)
  {
    this->Filter->Modified();
    grids::expectError(this->Filter, text);
    for (int port = 0; port < 3; ++port)
    {
      EXPECT_EQ(this->Rows(port), 0);
    }
    EXPECT_STREQ(this->Filter->GetBestMethod(), "");
  };
  this->Choose(true, false);
  this->Filter->Update();
  EXPECT_STREQ(this->Filter->GetBestMethod(), "FEMWARP");
  this->Choose(false, false);
  errorAfter("No method is chosen");
  this->Choose(true, false);
  this->Filter->SetAbsolute(false);
  this->Filter->SetRelative(false);
  errorAfter("Neither absolute nor relative");
  this->Filter->SetAbsolute(true);
  this->Filter->SetCriteria("Beauty");
  errorAfter("'Beauty' is not a criterion");
  this->Filter->SetCriteria("");
  this->Filter->SetBoundaryIdArray("Nonsense");
  errorAfter("No method gave a mesh. FEMWARP, Absolute: ");
  this->Filter->SetBoundaryIdArray(nullptr);
  this->Filter->SetBoundaryConnection(nullptr);
  errorAfter("Boundary: nothing is connected");
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, waves));
  vtkNew<vtkUnstructuredGrid> empty;
  this->Filter->SetInputData(empty);
  errorAfter("FEMWARP, Absolute: The input has no cells");
  this->Filter->SetInputData(this->Grid);
  this->Filter->Update();
  EXPECT_EQ(this->Rows(0), 5);
}

TEST_F(CompareMorphMethods, CanBeAborted)
{
  this->Choose(true, true);
  const auto abort = [](vtkObject* caller, unsigned long, void*, void*)
  { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); };
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(abort);
  this->Filter->AddObserver(vtkCommand::ProgressEvent, command);
  grids::update(this->Filter);
  EXPECT_EQ(this->Rows(0), 0);
}
