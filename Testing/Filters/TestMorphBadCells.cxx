// SPDX-License-Identifier: BSD-3-Clause
// The second output of the morphing filters: the cells that a morph has inverted.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
/// Steep waves along a 6 x 6 x 6 cube; they turn FEMWARP's cells over.
grids::Row waves(const grids::Row& x)
{
  return { x[0], x[1], x[2] + 2 * std::sin(M_PI / 3 * x[0]) };
}

vtkUnstructuredGrid* badCells(vtkMorphAlgorithm* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
}

vtkIdType id(vtkDataSetAttributes* arrays, const char* name, vtkIdType i)
{
  return static_cast<vtkIdType>(arrays->GetArray(name)->GetTuple1(i));
}

/// That the second output is the cells of the first that are inverted or degenerate, and no others.
void expectBadCellsOf(vtkMorphAlgorithm* filter)
{
  vtkUnstructuredGrid* mesh = filter->GetOutput();
  vtkUnstructuredGrid* bad = badCells(filter);
  ASSERT_EQ(bad->GetNumberOfCells(), filter->GetInvertedCells() + filter->GetDegenerateCells());
  ASSERT_EQ(bad->GetCellData()->GetNumberOfArrays(), mesh->GetCellData()->GetNumberOfArrays() + 1);
  ASSERT_EQ(
    bad->GetPointData()->GetNumberOfArrays(), mesh->GetPointData()->GetNumberOfArrays() + 1);
  EXPECT_STREQ(bad->GetCellData()->GetScalars()->GetName(), "ScaledJacobian");
  for (vtkIdType i = 0; i < bad->GetNumberOfCells(); ++i)
  {
    const vtkIdType cell = id(bad->GetCellData(), "MorphCellId", i);
    EXPECT_EQ(bad->GetCellType(i), mesh->GetCellType(cell));
    EXPECT_EQ(bad->GetCellData()->GetScalars()->GetTuple1(i),
      mesh->GetCellData()->GetScalars()->GetTuple1(cell));
    EXPECT_LE(bad->GetCellData()->GetScalars()->GetTuple1(i), 0);
    EXPECT_EQ(id(bad->GetCellData(), "Cell", i), id(mesh->GetCellData(), "Cell", cell));
    vtkNew<vtkIdList> here, there;
    bad->GetCellPoints(i, here);
    mesh->GetCellPoints(cell, there);
    ASSERT_EQ(here->GetNumberOfIds(), there->GetNumberOfIds());
    for (vtkIdType k = 0; k < here->GetNumberOfIds(); ++k)
    {
      EXPECT_EQ(id(bad->GetPointData(), "MorphPointId", here->GetId(k)), there->GetId(k));
    }
  }
  for (vtkIdType i = 0; i < bad->GetNumberOfPoints(); ++i)
  {
    const vtkIdType point = id(bad->GetPointData(), "MorphPointId", i);
    EXPECT_EQ(id(bad->GetPointData(), "Number", i), id(mesh->GetPointData(), "Number", point));
    double here[3], there[3];
    bad->GetPoint(i, here);
    mesh->GetPoint(point, there);
    EXPECT_TRUE(std::equal(here, here + 3, there)) << i;
  }
}

class MorphBadCells : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(grids::boundary(this->Grid, waves));
    this->Filter->SetValidityToNone();
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(6);
  vtkNew<vtkFEMWarpMorph> Filter;
};
}

TEST_F(MorphBadCells, AreTheInvertedCellsWithTheirIdsAndArrays)
{
  this->Filter->Update();
  ASSERT_GT(this->Filter->GetInvertedCells(), 0);
  expectBadCellsOf(this->Filter);
  EXPECT_EQ(badCells(this->Filter)->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST_F(MorphBadCells, DegenerateCellsAreAmongThem)
{
  // An edge of length 0 between two boundary nodes.
  auto boundary = grids::boundary(this->Grid, [](const grids::Row& x) { return x; });
  double first[3];
  vtkNew<vtkIdList> face;
  boundary->GetCellPoints(0, face);
  boundary->GetPoint(face->GetId(0), first);
  boundary->GetPoints()->SetPoint(face->GetId(1), first);
  this->Filter->SetBoundaryData(boundary);
  this->Filter->Update();
  ASSERT_GT(this->Filter->GetDegenerateCells(), 0);
  expectBadCellsOf(this->Filter);
}

TEST_F(MorphBadCells, ArraysInPlaceOfActiveOnesOfAnotherSizeAreNotActive)
{
  for (const char* name : { "MorphPointId", "MorphDisplacement" })
  {
    grids::addNumbers(this->Grid->GetPointData(), name, this->Grid->GetNumberOfPoints(), 1, 9);
    this->Grid->GetPointData()->SetActiveTensors(name);
    this->Filter->Modified();
    this->Filter->Update();
    ASSERT_GT(badCells(this->Filter)->GetNumberOfCells(), 0);
    for (vtkDataSet* output : { this->Filter->GetOutput(), badCells(this->Filter) })
    {
      vtkDataArray* tensors = output->GetPointData()->GetTensors();
      EXPECT_TRUE(!tensors || tensors->GetNumberOfComponents() == 9) << name;
    }
  }
}

TEST_F(MorphBadCells, ValidMeshesHaveNoneButTheirArrays)
{
  this->Filter->SetScaleFactor(0);
  this->Filter->Update();
  ASSERT_EQ(this->Filter->GetInvertedCells(), 0);
  EXPECT_EQ(badCells(this->Filter)->GetNumberOfPoints(), 0);
  expectBadCellsOf(this->Filter);
}

TEST_F(MorphBadCells, GoWithTheResult)
{
  this->Filter->Update();
  ASSERT_GT(badCells(this->Filter)->GetNumberOfCells(), 0);
  this->Filter->SetValidityToRefuse();
  const grids::Run listener(this->Filter);
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_EQ(badCells(this->Filter)->GetNumberOfPoints(), 0);
  EXPECT_EQ(badCells(this->Filter)->GetCellData()->GetNumberOfArrays(), 0);
}

TEST_F(MorphBadCells, AreThoseOfTheTimeThatTheirPortIsAskedFor)
{
  for (const int stepping :
    { vtkMorphAlgorithm::STEPPING_ABSOLUTE, vtkMorphAlgorithm::STEPPING_RELATIVE })
  {
    SCOPED_TRACE(stepping);
    this->Filter->SetNumberOfSteps(2);
    this->Filter->SetStepping(stepping);
    this->Filter->UpdateInformation();
    const auto time = [&](int port)
    {
      return this->Filter->GetOutputDataObject(port)->GetInformation()->Get(
        vtkDataObject::DATA_TIME_STEP());
    };
    // Ports are asked in turns: neither may be left with what the other was asked for.
    const std::pair<int, double> requests[] = { { 0, 0 }, { 1, 2 }, { 0, 0 }, { 0, 2 }, { 1, 2 },
      { 1, 0 }, { 0, 2 }, { 1, 0 } };
    for (const auto& [port, asked] : requests)
    {
      this->Filter->GetOutputInformation(port)->Set(
        vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), asked);
      this->Filter->Update(port);
      EXPECT_EQ(time(port), asked);
      EXPECT_EQ(badCells(this->Filter)->GetNumberOfCells() > 0, asked == 2);
      expectBadCellsOf(this->Filter);
    }
  }
}

TEST_F(MorphBadCells, ComeFromEveryFilter)
{
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    SCOPED_TRACE(method.name);
    auto filter = method.of(this->Grid, waves);
    filter->SetValidityToNone();
    filter->Update();
    expectBadCellsOf(filter);
  }
}
