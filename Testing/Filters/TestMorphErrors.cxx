// SPDX-License-Identifier: BSD-3-Clause
// Bad input: one error each, that says what is wrong; the undeformed mesh, or an empty output where
// that cannot be read; and the next good execution works.
#include "../Core/BoundaryShapes.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOverlappingAMR.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <limits>
#include <utility>

using morph::Index;
using morph::Points;

namespace
{
const double NaN = std::numeric_limits<double>::quiet_NaN();

}

class MorphErrors : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Grid = grids::hexes(3);
    this->Boundary = grids::boundary(this->Grid, grids::twist);
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(this->Boundary);
  }

  void TearDown() override
  {
    // Whatever came before, good input works.
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(this->Boundary);
    this->Filter->SetBoundaryIdArray(nullptr);
    this->Filter->SetDisplacementArray(nullptr);
    grids::update(this->Filter);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 64);
    EXPECT_EQ(this->Filter->GetInvertedCells(), 0);
  }

  /// Updates and expects one error that contains all of `telling`. The filter had a result before.
  void ExpectError(std::initializer_list<const char*> telling)
  {
    const std::string error = grids::errorOf(this->Filter);
    for (const char* words : telling)
    {
      EXPECT_NE(error.find(words), std::string::npos) << "'" << words << "' in " << error;
    }
    this->ExpectNoResult();
  }
  void ExpectNoResult()
  {
    vtkUnstructuredGrid* output = this->Filter->GetOutput();
    auto* given = vtkUnstructuredGrid::SafeDownCast(this->Filter->GetInputDataObject(0, 0));
    const bool isUndeformed = this->IsReadable && given;
    ASSERT_EQ(output->GetNumberOfPoints(), isUndeformed ? given->GetNumberOfPoints() : 0);
    EXPECT_EQ(output->GetNumberOfCells(), isUndeformed ? given->GetNumberOfCells() : 0);
    if (isUndeformed)
    {
      EXPECT_TRUE(grids::points(output) == grids::points(given));
    }
    EXPECT_STREQ(this->Filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(this->Filter->GetMinScaledJacobian(), -1);
    EXPECT_EQ(this->Filter->GetInvertedCells(), -1);
    EXPECT_EQ(this->Filter->GetWorstCellId(), -1);
    vtkFieldData* field = output->GetFieldData();
    EXPECT_EQ(field->GetAbstractArray("MorphStatus")->GetVariantValue(0).ToString(), "Failed");
    EXPECT_EQ(field->GetArray("MinScaledJacobian")->GetComponent(0, 0), -1);
    EXPECT_EQ(field->GetArray("InvertedCells")->GetComponent(0, 0), -1);
  }
  void ExpectGridError(vtkDataObject* grid, std::initializer_list<const char*> telling)
  {
    this->Filter->Update();
    this->Filter->SetInputDataObject(0, grid);
    this->ExpectError(telling);
  }
  void ExpectBoundaryError(vtkDataObject* boundary, std::initializer_list<const char*> telling)
  {
    this->Filter->Update();
    this->Filter->SetBoundaryData(boundary);
    this->ExpectError(telling);
  }
  /// The good boundary without its arrays.
  vtkSmartPointer<vtkPolyData> Cloud() { return grids::cloud(grids::points(this->Boundary)); }
  std::vector<Index> Ids()
  {
    std::vector<Index> ids;
    auto* array = this->Boundary->GetPointData()->GetArray("MorphPointId");
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      ids.push_back(static_cast<Index>(array->GetComponent(i, 0)));
    }
    return ids;
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkSmartPointer<vtkPolyData> Boundary;
  vtkNew<vtkFEMWarpMorph> Filter;
  bool IsReadable = true; ///< the grid, so that the output is as it was given
};

TEST_F(MorphErrors, EmptyGrid)
{
  this->ExpectGridError(vtkNew<vtkUnstructuredGrid>(), { "no cells" });
}

TEST_F(MorphErrors, LinesOnly)
{
  morph::Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  meshes::add(mesh, VTK_LINE, { 0, 1 });
  this->ExpectGridError(grids::make(mesh), { "1 cells", "volume cell", "line" });
}

TEST_F(MorphErrors, CoordinatesThatAreNotFinite)
{
  auto grid = grids::copy(this->Grid);
  grid->GetPoints()->SetPoint(21, NaN, 0, 0);
  this->IsReadable = false;
  this->ExpectGridError(grid, { "not finite", "21" });
}

TEST_F(MorphErrors, TargetsThatAreNotFinite)
{
  const std::vector<Index> ids = this->Ids();
  for (const double bad : { NaN, std::numeric_limits<double>::infinity() })
  {
    auto boundary = this->Cloud();
    grids::addIds(boundary, "MorphPointId", ids);
    boundary->GetPoints()->SetPoint(7, 0, bad, 0);
    this->ExpectBoundaryError(boundary, { "not finite", std::to_string(ids[7]).c_str() });
  }
}

TEST_F(MorphErrors, OpenPolyhedron)
{
  auto grid = grids::copy(this->Grid);
  vtkNew<vtkIdList> faces;
  for (const vtkIdType id : { 4, 3, 0, 2, 1, 3, 0, 1, 4, 3, 1, 2, 4, 3, 2, 0, 5 })
  {
    faces->InsertNextId(id);
  }
  grid->InsertNextCell(VTK_POLYHEDRON, faces);
  grid->GetCellData()->Initialize();
  this->IsReadable = false;
  this->ExpectGridError(grid, { "Polyhedra", "not closed", "27" });
}

TEST_F(MorphErrors, OverlappingLevels)
{
  vtkNew<vtkOverlappingAMR> levels;
  this->ExpectGridError(levels, { "The input", "vtkOverlappingAMR", "unstructured grid" });
}

TEST_F(MorphErrors, CompositeBoundaryWithoutIds)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, this->Cloud());
  this->ExpectBoundaryError(blocks, { "Nothing says which nodes" });
}

TEST_F(MorphErrors, NoBoundary)
{
  this->Filter->Update();
  this->Filter->SetBoundaryConnection(nullptr);
  // ParaView asks for this as soon as the filter is made.
  EXPECT_EQ(this->Filter->GetExecutive()->UpdateInformation(), 1);
  this->ExpectError({ "Boundary: nothing is connected", "Extract Morph Boundary" });
}

TEST_F(MorphErrors, GridOfAnotherType)
{
  this->ExpectGridError(this->Boundary, { "The input", "vtkPolyData", "unstructured grid" });
}

TEST_F(MorphErrors, SwappedInputs)
{
  const auto expect = [this](vtkDataObject* grid)
  {
    this->Filter->SetInputDataObject(grid);
    this->Filter->SetBoundaryData(this->Grid);
    this->ExpectError({ "swapped", "volume mesh as Input" });
  };
  expect(this->Boundary);
  vtkNew<vtkUnstructuredGrid> faces;
  faces->SetPoints(this->Boundary->GetPoints());
  faces->SetCells(VTK_QUAD, this->Boundary->GetPolys());
  expect(faces);
}

TEST_F(MorphErrors, UnknownIds)
{
  std::vector<Index> ids = this->Ids();
  ids[3] = 64;
  ids[9] = -2;
  auto boundary = this->Cloud();
  grids::addIds(boundary, "MorphPointId", ids);
  this->ExpectBoundaryError(boundary, { "outside", "0 to 63", "64 for instance", "points 3, 9" });
}

TEST_F(MorphErrors, UnknownIdsAreShownAsTheyAre)
{
  for (const auto& [value, shown] :
    { std::pair(1e300, ", 1e+300 "), std::pair(std::numeric_limits<double>::infinity(), ", inf "),
      std::pair(-4e15, ", -4e+15 "), std::pair(123456789.0, ", 123456789 ") })
  {
    auto boundary = this->Cloud();
    vtkNew<vtkDoubleArray> ids;
    ids->SetName("MorphPointId");
    for (Index id : this->Ids())
    {
      ids->InsertNextValue(static_cast<double>(id));
    }
    ids->SetValue(4, value);
    boundary->GetPointData()->AddArray(ids);
    this->ExpectBoundaryError(boundary, { "outside", shown, "points 4" });
  }
}

TEST_F(MorphErrors, FractionalIds)
{
  auto boundary = this->Cloud();
  vtkNew<vtkDoubleArray> ids;
  ids->SetName("MorphPointId");
  for (Index id : this->Ids())
  {
    ids->InsertNextValue(static_cast<double>(id));
  }
  ids->SetValue(4, 2.5);
  ids->SetValue(6, NaN);
  boundary->GetPointData()->AddArray(ids);
  this->ExpectBoundaryError(boundary, { "whole numbers", "4, 6" });
}

TEST_F(MorphErrors, DuplicateIdsWithDifferentTargets)
{
  std::vector<Index> ids = this->Ids();
  const std::string node = std::to_string(ids[5]);
  ids[6] = ids[5];
  auto boundary = this->Cloud();
  grids::addIds(boundary, "MorphPointId", ids);
  this->ExpectBoundaryError(boundary, { "more than once", node.c_str() });
}

TEST_F(MorphErrors, NoWayToMatch)
{
  auto boundary = this->Cloud();
  grids::addIds(boundary, "Temperature", this->Ids());
  this->ExpectBoundaryError(boundary, { "56 points", "64", "MorphPointId", "Temperature",
                                        "Extract Morph Boundary", "BoundaryIdArray" });
}

TEST_F(MorphErrors, EmptyBoundary)
{
  this->ExpectBoundaryError(vtkNew<vtkPolyData>(), { "no points" });
}

TEST_F(MorphErrors, StaleIds)
{
  // Made from a mesh with other nodes in the same place.
  morph::Mesh other = meshes::hexes(3, 3, 3);
  other.points *= 1.01;
  this->ExpectBoundaryError(grids::boundary(grids::make(other), grids::same),
    { "stale", "RestPosition", "Extract Morph Boundary" });
}

TEST_F(MorphErrors, UnusedPointsDoNotLoosenTheTolerance)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  mesh.points.conservativeResize(65, 3);
  mesh.points.row(64) << 1e6, 0, 0;
  morph::Mesh other = meshes::hexes(3, 3, 3);
  other.points *= 1.01;
  this->Filter->Update();
  this->Filter->SetInputData(grids::make(mesh));
  this->Filter->SetBoundaryData(grids::boundary(grids::make(other), grids::same));
  this->ExpectError({ "stale" });
}

TEST_F(MorphErrors, RestPositionWithTooFewComponents)
{
  auto boundary = this->Cloud();
  grids::addIds(boundary, "MorphPointId", this->Ids());
  grids::addIds(boundary, "RestPosition", this->Ids());
  this->ExpectBoundaryError(boundary, { "RestPosition", "1 components" });
}

TEST_F(MorphErrors, ArraysThatAreNotThere)
{
  this->Filter->Update();
  this->Filter->SetBoundaryIdArray("Nowhere");
  this->ExpectError({ "BoundaryIdArray", "'Nowhere'", "MorphPointId, RestPosition" });
  this->Filter->SetBoundaryIdArray(nullptr);
  this->Filter->SetDisplacementArray("Never");
  this->ExpectError({ "DisplacementArray", "'Never'", "MorphPointId, RestPosition" });
}

TEST_F(MorphErrors, ArraysOfTheWrongSize)
{
  this->Filter->Update();
  this->Filter->SetBoundaryIdArray("RestPosition");
  this->ExpectError({ "RestPosition", "4 components", "`BoundaryIdArray` needs 1" });
  this->Filter->SetBoundaryIdArray(nullptr);
  this->Filter->SetDisplacementArray("Number");
  this->ExpectError({ "Number", "1 components", "`DisplacementArray` needs 3" });
}

TEST_F(MorphErrors, ArraysOfAnotherLength)
{
  const std::vector<Index> ids = this->Ids();
  const Points rest = meshes::rows(grids::points(this->Grid), ids);
  this->Filter->Update();
  for (const char* name : { "MorphPointId", "PointIds", "vtkOriginalPointIds", "Mine" })
  {
    this->Filter->SetBoundaryIdArray(std::string(name) == "Mine" ? name : nullptr);
    for (const std::size_t length : { std::size_t(55), std::size_t(57), std::size_t(100000) })
    {
      std::vector<Index> others = ids;
      others.resize(length, 0);
      auto boundary = this->Cloud();
      grids::addIds(boundary, name, others);
      this->ExpectBoundaryError(
        boundary, { name, (std::to_string(length) + " tuples").c_str(), "56 points" });
    }
  }
  this->Filter->SetBoundaryIdArray(nullptr);

  auto boundary = this->Cloud();
  grids::addIds(boundary, "MorphPointId", ids);
  grids::addVectors(boundary, "RestPosition", rest.topRows(20));
  this->ExpectBoundaryError(boundary, { "'RestPosition' has 20 tuples", "56 points" });

  boundary = this->Cloud();
  grids::addIds(boundary, "MorphPointId", ids);
  grids::addVectors(boundary, "Shift", rest.topRows(20));
  this->Filter->SetDisplacementArray("Shift");
  this->Filter->SetBoundaryData(boundary);
  this->ExpectError({ "'Shift' has 20 tuples", "56 points" });
}

TEST_F(MorphErrors, ArraysOfText)
{
  for (const char* name : { "MorphPointId", "RestPosition", "Mine" })
  {
    auto boundary = this->Cloud();
    vtkNew<vtkStringArray> texts;
    texts->SetName(name);
    texts->SetNumberOfValues(56);
    boundary->GetPointData()->AddArray(texts);
    if (std::string(name) == "RestPosition")
    {
      grids::addIds(boundary, "MorphPointId", this->Ids());
    }
    this->Filter->SetBoundaryIdArray(std::string(name) == "Mine" ? name : nullptr);
    this->ExpectBoundaryError(boundary, { name, "not numeric", "vtkStringArray" });
  }
}

TEST_F(MorphErrors, CellsButNoPoints)
{
  const vtkNew<vtkPoints> none;
  for (vtkPoints* points : { static_cast<vtkPoints*>(nullptr), none.Get() })
  {
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(points);
    grid->SetCells(VTK_HEXAHEDRON, this->Grid->GetCells());
    this->Filter->SetInputData(this->Grid);
    this->IsReadable = false;
    this->ExpectGridError(grid, { "27 cells but no points" });
  }
}

TEST_F(MorphErrors, NoBoundaryPointNearTheGrid)
{
  auto boundary = this->Cloud();
  boundary->SetPoints(grids::cloud(Points::Constant(10, 3, 50))->GetPoints());
  grids::addVectors(boundary, "Shift", Points::Constant(10, 3, 1));
  this->Filter->SetDisplacementArray("Shift");
  this->Filter->SetBoundaryData(boundary);
  this->ExpectError({ "None of the boundary's 10 points", "`MatchTolerance` (1e-06 of" });
}

TEST_F(MorphErrors, ABodyWithoutAPrescribedNodeStaysAndAWarningSaysSo)
{
  const morph::Mesh one = meshes::hexes(3, 3, 3);
  const morph::Mesh two = shapes::together(one, meshes::shifted(one, grids::Row(10, 10, 10)));
  auto boundary = grids::cloud(two.points.row(0));
  grids::addIds(boundary, "MorphPointId", { 0 });
  this->Filter->FixUnnamedBoundaryOff();
  this->Filter->SetInputData(grids::make(two));
  this->Filter->SetBoundaryData(boundary);
  grids::expectWarning(this->Filter, "64 nodes: node ids 64, 65");
  this->Filter->FixUnnamedBoundaryOn();
}

TEST_F(MorphErrors, InvertedRestCellsOnlyWarn)
{
  // A cell turned inside out among valid neighbors.
  auto grid = grids::copy(this->Grid);
  double a[3], b[3];
  grid->GetPoint(21, a);
  grid->GetPoint(22, b);
  grid->GetPoints()->SetPoint(21, b);
  grid->GetPoints()->SetPoint(22, a);
  this->Filter->SetInputData(grid);
  this->Filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  const grids::Run listener(this->Filter);
  EXPECT_TRUE(listener.Errors.empty());
  ASSERT_EQ(listener.Warnings.size(), 2u);
  EXPECT_NE(listener.Warnings[0].find("Unless they become worse"), std::string::npos);
  EXPECT_NE(listener.Warnings[1].find("The reference mesh has"), std::string::npos);
  EXPECT_GT(this->Filter->GetInvertedBefore(), 0);
  EXPECT_EQ(this->Filter->GetNewInvertedCells(), 0);
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 64);
}
