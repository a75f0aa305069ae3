// SPDX-License-Identifier: BSD-3-Clause
// Data sets that VTK lets through although they are not consistent: every filter refuses them by
// name, and no number in them is too large or too small to compute with.
#include "AllFilters.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "../Core/BoundaryShapes.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphBoundary.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkTransform.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using grids::Row;

grids::Map times(double factor)
{
  return [factor](const Row& x) { return Row(factor * x); };
}

vtkSmartPointer<vtkUnstructuredGrid> scaled(double factor)
{
  auto grid = grids::hexes(3);
  const morph::Points x = factor * grids::points(grid);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (morph::Index n = 0; n < x.rows(); ++n)
  {
    points->InsertNextPoint(x.row(n).data());
  }
  grid->SetPoints(points);
  return grid;
}

template <typename Array>
void addArray(vtkDataSetAttributes* data, const char* name, vtkIdType tuples)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(tuples);
  array->Fill(0);
  data->AddArray(array);
}

/// Executes, and expects one error that contains all of `telling`.
void expectError(vtkAlgorithm* filter, std::initializer_list<std::string> telling)
{
  const std::string error = grids::errorOf(filter);
  for (const std::string& words : telling)
  {
    EXPECT_NE(error.find(words), std::string::npos) << "'" << words << "' in " << error;
  }
}

void expectFinite(vtkPointSet* data)
{
  EXPECT_TRUE(grids::points(data).allFinite());
}
}

class InputChecks : public testing::TestWithParam<grids::AnyFilter>
{
protected:
  void SetUp() override
  {
    this->Grid = grids::hexes(3);
    grids::addVectors(this->Grid, "Gradient", morph::Points::Ones(64, 3));
    this->Boundary = grids::boundary(this->Grid, grids::twist);
  }
  vtkSmartPointer<vtkAlgorithm> Filter()
  {
    return this->GetParam().connected(this->Grid, this->Boundary);
  }
  void ExpectGridError(std::initializer_list<std::string> telling)
  {
    expectError(this->Filter(), telling);
  }
  void ExpectBoundaryError(std::initializer_list<std::string> telling)
  {
    if (this->GetParam().hasBoundary)
    {
      expectError(this->Filter(), telling);
    }
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkSmartPointer<vtkPolyData> Boundary;
};

INSTANTIATE_TEST_SUITE_P(AllFilters, InputChecks, testing::ValuesIn(grids::allFilters()),
  [](const auto& info) { return info.param.name; });

TEST_P(InputChecks, GoodInputIsTaken)
{
  auto filter = this->Filter();
  grids::update(filter);
}

TEST_P(InputChecks, ShortGhostArray)
{
  addArray<vtkUnsignedCharArray>(
    this->Grid->GetCellData(), vtkDataSetAttributes::GhostArrayName(), 3);
  this->ExpectGridError({ "The input's cell array 'vtkGhostType' has 3 tuples for 27 cells",
    "Give it one for each, or remove the array" });
}

TEST_P(InputChecks, ShortCellArray)
{
  addArray<vtkDoubleArray>(this->Grid->GetCellData(), "Pressure", 26);
  this->ExpectGridError({ "The input's cell array 'Pressure' has 26 tuples for 27 cells" });
}

TEST_P(InputChecks, ShortPointArray)
{
  addArray<vtkFloatArray>(this->Grid->GetPointData(), "Temperature", 0);
  this->ExpectGridError({ "The input's point array 'Temperature' has 0 tuples for 64 points" });
}

TEST_P(InputChecks, ShortArraysOfTheBoundary)
{
  const vtkSmartPointer<vtkPolyData> good = this->Boundary;
  this->Boundary = vtkSmartPointer<vtkPolyData>::New();
  this->Boundary->DeepCopy(good);
  addArray<vtkDoubleArray>(this->Boundary->GetCellData(), "Pressure", 53);
  this->ExpectBoundaryError({ "The boundary's cell array 'Pressure' has 53 tuples for 54 cells" });
  this->Boundary->DeepCopy(good);
  addArray<vtkDoubleArray>(this->Boundary->GetPointData(), "Temperature", 55);
  this->ExpectBoundaryError(
    { "The boundary's point array 'Temperature' has 55 tuples for 56 points" });
}

TEST_P(InputChecks, LongArraysDoNoHarm)
{
  for (vtkDataSet* data :
    { static_cast<vtkDataSet*>(this->Grid), static_cast<vtkDataSet*>(this->Boundary) })
  {
    addArray<vtkDoubleArray>(data->GetPointData(), "Temperature", 1000);
    addArray<vtkDoubleArray>(data->GetCellData(), "Pressure", 1000);
    // More than an allocator's slack beyond the cells: what writes there ends the test.
    addArray<vtkUnsignedCharArray>(
      data->GetCellData(), vtkDataSetAttributes::GhostArrayName(), 1000000);
  }
  auto filter = this->Filter();
  grids::update(filter);
}

TEST_P(InputChecks, FewerTypesThanCells)
{
  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(5);
  types->Fill(VTK_HEXAHEDRON);
  this->Grid->SetCells(types, this->Grid->GetCells());
  this->ExpectGridError({ "The input has 5 cell types for 27 cells" });
}

TEST_P(InputChecks, CellsThatNamePointsThatAreNotThere)
{
  for (const vtkIdType wrong : { vtkIdType(64), vtkIdType(-1), VTK_ID_MAX })
  {
    this->SetUp();
    vtkNew<vtkIdList> ids;
    this->Grid->GetCellPoints(11, ids);
    ids->SetId(4, wrong);
    this->Grid->GetCells()->ReplaceCellAtId(11, ids);
    this->ExpectGridError({ "Cells that name nodes outside 0 to 63", "11" });
  }
}

TEST_P(InputChecks, BoundaryCellsThatNamePointsThatAreNotThere)
{
  vtkNew<vtkCellArray> polygons;
  polygons->DeepCopy(this->Boundary->GetPolys());
  const vtkIdType ids[] = { 0, 1, 56, 3 };
  polygons->ReplaceCellAtId(7, 4, ids);
  this->Boundary->SetPolys(polygons);
  this->ExpectBoundaryError({ "The boundary has cells that name points outside 0 to 55", "7" });
}

TEST_P(InputChecks, OffsetsThatDoNotMatch)
{
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  for (const vtkIdType offset : { 0, 8, 4, 1000 })
  {
    offsets->InsertNextValue(offset);
  }
  for (vtkIdType i = 0; i < 24; ++i)
  {
    connectivity->InsertNextValue(i);
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  this->Boundary->SetPolys(cells);
  this->Boundary->GetCellData()->Initialize();
  this->ExpectBoundaryError({ "The boundary's cell offsets do not match its connectivity" });
  this->Grid->SetCells(VTK_HEXAHEDRON, cells);
  this->Grid->GetCellData()->Initialize();
  this->ExpectGridError({ "cell offsets" });
}

TEST_P(InputChecks, HugeAndTinyGrids)
{
  this->Grid = scaled(1e60);
  this->ExpectGridError({ "The input has coordinates above 1e50", "Use another unit" });
  this->Grid = scaled(1e-60);
  this->ExpectGridError({ "The input is only", "long, less than 1e-50" });
}

TEST_P(InputChecks, HugeBoundary)
{
  this->Boundary->GetPoints()->SetPoint(17, 0, -1e200, 0);
  this->ExpectBoundaryError({ "The boundary has coordinates above 1e50, at point ids 17" });
}

class MorphBoundaryInputs : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(this->Boundary);
  }
  vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::hexes(3);
  vtkSmartPointer<vtkPolyData> Boundary = grids::boundary(Grid, times(1));
  vtkNew<vtkMorphBoundary> Filter;
};

TEST_F(MorphBoundaryInputs, TargetPolygonsThatNamePointsThatAreNotThere)
{
  for (const vtkIdType wrong : { vtkIdType(8), vtkIdType(-3), vtkIdType(1) << 40 })
  {
    for (const bool strip : { false, true })
    {
      auto target = grids::cloud(grids::points(scaled(1)).topRows(8));
      vtkNew<vtkCellArray> cells;
      const vtkIdType good[] = { 0, 1, 2, 3 }, bad[] = { 0, 1, 2, wrong };
      cells->InsertNextCell(4, good);
      cells->InsertNextCell(4, bad);
      strip ? target->SetStrips(cells) : target->SetPolys(cells);
      this->Filter->SetTargetData(target);
      expectError(
        this->Filter, { "The target has cells that name points outside 0 to 7: cell ids 1" });
    }
  }
}

TEST_F(MorphBoundaryInputs, HugePlacesWithATarget)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  auto target = vtkSmartPointer<vtkPolyData>::New();
  target->DeepCopy(sphere->GetOutput());
  this->Filter->SetTargetData(target);
  this->Filter->SetScaleFactor(1e200);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, times(2)));
  expectError(this->Filter, { "`ScaleFactor` 1e+200 moves nodes beyond 1e50, at node ids" });
  this->Filter->SetScaleFactor(1);
  target->SetPoints(grids::cloud(1e200 * grids::points(target))->GetPoints());
  expectError(this->Filter, { "The target has coordinates above 1e50" });
}

TEST_F(MorphBoundaryInputs, PlacesAndTargetsOfAllSizes)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  for (const double size : { 0., 1e-49, 1e-20, 1e20, 1e49 })
  {
    auto target = vtkSmartPointer<vtkPolyData>::New();
    target->SetPolys(sphere->GetOutput()->GetPolys());
    target->SetPoints(grids::cloud(size * grids::points(sphere->GetOutput()))->GetPoints());
    for (const double scale : { 1e-49, 1., 1e20, 1e49 })
    {
      SCOPED_TRACE(std::to_string(size) + ", " + std::to_string(scale));
      this->Filter->SetTargetData(target);
      this->Filter->SetBoundaryData(grids::boundary(this->Grid, times(1 + scale)));
      this->Filter->SetTargetReach(10);
      const grids::Run listener(this->Filter);
      const bool isFar = size > 1;
      EXPECT_LE(listener.Errors.size(), size == 0 || isFar ? 1u : 0u);
      EXPECT_TRUE(!isFar || listener.Errors.at(0).find("farther from the mesh than 100,000") !=
                              std::string::npos);
      expectFinite(this->Filter->GetOutput());
    }
  }
}

TEST_F(MorphBoundaryInputs, HugeScaleFactorsGiveNoNaN)
{
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, times(1.1)));
  for (const double scale : { 1e49, 1e78, 1e160, 1e300 })
  {
    grids::Listener listener(this->Filter);
    this->Filter->SetScaleFactor(scale);
    this->Filter->Update();
    EXPECT_EQ(listener.Errors.size(), scale > 1e50 ? 1u : 0u);
    expectFinite(this->Filter->GetOutput());
  }
}

TEST(MorphBoundaryOutput, NodesThatFollowBeyondAllPlacesAreNamed)
{
  // The inner sphere is given; the outer one follows its expansion, twice as far.
  auto grid = grids::make(shapes::hollowBall(8));
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  extract->Update();
  const morph::Points x = grids::points(extract->GetOutput());
  vtkDataArray* numbers = extract->GetOutput()->GetPointData()->GetArray("MorphPointId");
  std::vector<morph::Index> ids;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x.row(i).norm() < 0.75)
    {
      ids.push_back(static_cast<morph::Index>(numbers->GetComponent(i, 0)));
    }
  }
  const morph::Points all = grids::points(grid);
  morph::Points inner(static_cast<morph::Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    inner.row(static_cast<morph::Index>(i)) = all.row(ids[i]);
  }
  for (const double factor : { 1e49, 1.5e50 })
  {
    auto moved = grids::cloud(factor * inner);
    grids::addIds(moved, "MorphPointId", ids);
    auto filter = grids::of<vtkMorphBoundary>(grid);
    filter->SetBoundaryData(moved);
    filter->SetPrescribedDimension(2);
    const grids::Run listener(filter);
    if (factor < 1e50)
    {
      EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
      const morph::Points result = grids::points(filter->GetOutput());
      ASSERT_EQ(result.rows(), x.rows());
      EXPECT_LE((result / factor - x).rowwise().norm().maxCoeff(), 1e-9);
    }
    else
    {
      ASSERT_EQ(listener.Errors.size(), 1u);
      const std::string expected =
        "The motion takes the boundary's nodes to places that are not finite or beyond 1e50";
      EXPECT_NE(listener.Errors[0].find(expected), std::string::npos) << listener.Errors[0];
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
      EXPECT_EQ(filter->GetFoldedFaces(), -1);
    }
  }
}

TEST(SinglePrecision, PositionsBeyondItAreAnError)
{
  auto grid = grids::hexes(3);
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, times(1e40));
  morph->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  expectError(morph, { "Single precision does not hold", "`OutputPointsPrecision` to double" });
  expectFinite(morph->GetOutput());

  auto displace = grids::of<vtkBoundaryDisplacement>(grid);
  grids::moveBy(displace, 1e40, 0, 0);
  displace->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  expectError(displace, { "Single precision does not hold", "`OutputPointsPrecision` to double" });
  expectFinite(displace->GetOutput());

  auto boundary = grids::of<vtkMorphBoundary>(grid);
  boundary->SetBoundaryData(grids::boundary(grid, times(1e40)));
  boundary->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  expectError(boundary, { "Single precision does not hold", "`OutputPointsPrecision` to double" });
  expectFinite(boundary->GetOutput());
}

TEST(SinglePrecision, CellsThatRoundingInvertsAreSaid)
{
  auto grid = grids::hexes(3);
  const auto far = [](const Row& x) { return Row(x[0] + 1e9, x[1], x[2]); };
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, far);
  for (const int precision : { vtkAlgorithm::DOUBLE_PRECISION, vtkAlgorithm::SINGLE_PRECISION })
  {
    const bool isSingle = precision == vtkAlgorithm::SINGLE_PRECISION;
    grids::Listener listener(morph);
    morph->SetOutputPointsPrecision(precision);
    morph->Update();
    EXPECT_TRUE(listener.Errors.empty());
    EXPECT_EQ(morph->GetInvertedCells() + morph->GetDegenerateCells(), isSingle ? 27 : 0);
    EXPECT_STREQ(morph->GetMorphStatus(), isSingle ? "Inverted" : "Valid");
    EXPECT_EQ(std::isnan(morph->GetLargestValidStep()), isSingle);
    ASSERT_EQ(listener.Warnings.size(), isSingle ? 1u : 0u);
    EXPECT_TRUE(!isSingle || listener.Warnings[0].find("Rounding to single precision inverts 27") !=
                               std::string::npos);
  }
}

TEST(BoundaryDisplacementInputs, HugeMotions)
{
  auto grid = grids::hexes(3);
  auto filter = grids::of<vtkBoundaryDisplacement>(grid);
  grids::moveBy(filter, 1e60, 0, 0);
  expectError(filter, { "`Vector` moves nodes beyond 1e50: point ids" });
  filter->SetVector(1e30, 0, 0);
  filter->SetScaleFactor(1e30);
  expectError(filter, { "`ScaleFactor` moves nodes beyond 1e50: point ids" });
}

TEST(BoundaryDisplacementInputs, SurfaceWithAnotherNumberOfPoints)
{
  // The same polygons: only the sizes tell them apart.
  vtkSmartPointer<vtkPolyData> surface = grids::boundary(grids::hexes(3), times(1));
  auto filter = grids::of<vtkBoundaryDisplacement>(surface);
  filter->Update();
  auto longer = grids::cloud(grids::points(surface).replicate(2, 1));
  longer->SetPolys(surface->GetPolys());
  for (const char* name : { "MorphPointId", "RestPosition" })
  {
    vtkDataArray* from = surface->GetPointData()->GetArray(name);
    auto array = vtkSmartPointer<vtkDataArray>::Take(from->NewInstance());
    array->DeepCopy(from);
    array->InsertTuples(56, 56, 0, from);
    longer->GetPointData()->AddArray(array);
  }
  filter->SetInputData(longer);
  grids::update(filter);
  EXPECT_EQ(filter->GetClassifyCount(), 2);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 112);
}

TEST(EmptyBoundary, IsSaid)
{
  // A closed shell: the sides of a tetrahedron.
  morph::Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  meshes::add(mesh, morph::Triangle, { 0, 2, 1 });
  meshes::add(mesh, morph::Triangle, { 0, 1, 3 });
  meshes::add(mesh, morph::Triangle, { 1, 2, 3 });
  meshes::add(mesh, morph::Triangle, { 0, 3, 2 });
  auto filter = grids::of<vtkExtractMorphBoundary>(grids::make(mesh));
  grids::expectWarning(filter, "The boundary is empty");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}
