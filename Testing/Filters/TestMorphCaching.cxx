// SPDX-License-Identifier: BSD-3-Clause
// What the method prepared is used again while content, not time stamps, is the same; and makes no
// difference to results.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "LinearMethods/FemWarp.h"
#include "vtkFEMWarpMorph.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTrivialProducer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
/// A method with an option that prepare() reads.
class OptionWarp : public morph::FemWarp
{
public:
  int Option = 0;

protected:
  bool hasPrepareOptionsOf(const morph::Morpher& other) const override
  {
    return this->Option == static_cast<const OptionWarp&>(other).Option;
  }
};

class OptionMorph : public vtkMorphAlgorithm
{
public:
  static OptionMorph* New();
  vtkTypeMacro(OptionMorph, vtkMorphAlgorithm);
  vtkSetMacro(Option, int);

protected:
  std::unique_ptr<morph::Morpher> CreateMorpher() override
  {
    auto morpher = std::make_unique<OptionWarp>();
    morpher->Option = this->Option;
    return morpher;
  }
  int Option = 0;
};
vtkStandardNewMacro(OptionMorph);

class MorphCaching : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Grid = grids::hexes(4);
    this->Source->SetOutput(this->Grid);
    this->Filter->SetInputConnection(this->Source->GetOutputPort());
    this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
    this->Filter->Update();
    ASSERT_EQ(this->Filter->GetPrepareCount(), 1);
    this->First = grids::points(this->Filter->GetOutput());
  }
  /// Hands the filter another grid through the same source.
  void Replace(vtkUnstructuredGrid* grid)
  {
    this->Source->SetOutput(grid);
    this->Source->Modified();
  }
  int PreparesAfterUpdate()
  {
    this->Filter->Update();
    return this->Filter->GetPrepareCount();
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkNew<vtkTrivialProducer> Source;
  vtkNew<OptionMorph> Filter;
  morph::Points First;
};
}

TEST_F(MorphCaching, AnotherMotionOfTheSameBoundary)
{
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::affine));
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_EQ(this->Filter->GetPrepareSeconds(), 0);
  EXPECT_GT((grids::points(this->Filter->GetOutput()) - this->First).cwiseAbs().maxCoeff(), 1);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST_F(MorphCaching, UpstreamExecutesAgainWithTheSameContent)
{
  this->Replace(grids::copy(this->Grid));
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST_F(MorphCaching, TheOrderOfTheBoundaryDoesNotMatter)
{
  auto boundary = grids::boundary(this->Grid, grids::twist);
  const vtkIdType count = boundary->GetNumberOfPoints();
  morph::Points reversed = grids::points(boundary).colwise().reverse();
  std::vector<morph::Index> ids;
  for (vtkIdType i = count - 1; i >= 0; --i)
  {
    ids.push_back(static_cast<morph::Index>(
      boundary->GetPointData()->GetArray("MorphPointId")->GetComponent(i, 0)));
  }
  auto other = grids::cloud(reversed);
  grids::addIds(other, "MorphPointId", ids);
  this->Filter->SetBoundaryData(other);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST_F(MorphCaching, OptionsOfEvaluateAndOutput)
{
  this->Filter->SetScaleFactor(0.5);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  this->Filter->SetNumberOfThreads(2);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  this->Filter->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
}

TEST_F(MorphCaching, OtherArraysOnTheGrid)
{
  auto grid = grids::copy(this->Grid);
  grids::addIds(grid, "Extra", std::vector<morph::Index>(grid->GetNumberOfPoints(), 1));
  this->Replace(grid);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_NE(this->Filter->GetOutput()->GetPointData()->GetArray("Extra"), nullptr);
}

TEST_F(MorphCaching, OptionOfPrepare)
{
  this->Filter->SetOption(1);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
  EXPECT_GT(this->Filter->GetPrepareSeconds(), 0);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, OneRestPointInTheLastBit)
{
  auto grid = grids::copy(this->Grid);
  double x[3];
  grid->GetPoint(62, x);
  x[1] = std::nextafter(x[1], 100);
  grid->GetPoints()->SetPoint(62, x);
  this->Replace(grid);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, PointsChangedInPlace)
{
  double x[3];
  this->Grid->GetPoint(62, x);
  this->Grid->GetPoints()->SetPoint(62, x[0] + 0.125, x[1], x[2]);
  this->Grid->GetPoints()->Modified();
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, CellsChangedInPlace)
{
  // As OneCellInAnotherOrder, and none but the array of the cells knows.
  vtkDataArray* ids = this->Grid->GetCells()->GetConnectivityArray();
  double nodes[8];
  for (int k = 0; k < 8; ++k)
  {
    nodes[k] = ids->GetComponent(5 * 8 + k, 0);
  }
  std::rotate(nodes, nodes + 1, nodes + 4);
  std::rotate(nodes + 4, nodes + 5, nodes + 8);
  for (int k = 0; k < 8; ++k)
  {
    ids->SetComponent(5 * 8 + k, 0, nodes[k]);
  }
  ids->Modified();
  this->Filter->Modified();
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, ArraysThatBecomeShorterInPlace)
{
  vtkNew<vtkDoubleArray> heat;
  heat->SetName("Heat");
  heat->SetNumberOfTuples(this->Grid->GetNumberOfPoints());
  heat->Fill(1);
  this->Grid->GetPointData()->AddArray(heat);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  heat->SetNumberOfTuples(3); // VTK takes no note of that
  this->Filter->SetScaleFactor(0.5);
  grids::expectError(this->Filter, "'Heat' has 3 tuples");
}

TEST_F(MorphCaching, OneCellOfAnotherType)
{
  // The same nodes and points, the last cell cut into tets.
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  mesh.points = grids::points(this->Grid);
  const std::vector<morph::Index> b(mesh.cell(63), mesh.cell(63) + 8);
  mesh.types.pop_back();
  mesh.offsets.pop_back();
  mesh.connectivity.resize(mesh.connectivity.size() - 8);
  meshes::add(mesh, morph::Wedge, { b[0], b[1], b[2], b[4], b[5], b[6] });
  meshes::add(mesh, morph::Wedge, { b[0], b[2], b[3], b[4], b[6], b[7] });
  this->Replace(grids::make(mesh));
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, OneCellInAnotherOrder)
{
  // The same types and offsets: a hexahedron that starts at its next corner.
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  mesh.points = grids::points(this->Grid);
  morph::Index* nodes = mesh.connectivity.data() + mesh.offsets[5];
  std::rotate(nodes, nodes + 1, nodes + 4);
  std::rotate(nodes + 4, nodes + 5, nodes + 8);
  this->Replace(grids::make(mesh));
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
}

TEST_F(MorphCaching, TheSameCellsInNarrowerIntegers)
{
  auto grid = grids::copy(this->Grid);
  ASSERT_TRUE(grid->GetCells()->ConvertTo32BitStorage());
  this->Replace(grid);
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST_F(MorphCaching, AnotherSetOfPrescribedNodes)
{
  auto inside = grids::cloud(grids::Row(2.1, 2, 2));
  grids::addIds(inside, "MorphPointId", { 62 });
  this->Filter->SetBoundaryData(inside);
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
  this->Filter->FixUnnamedBoundaryOff();
  EXPECT_EQ(this->PreparesAfterUpdate(), 3);
}

TEST_F(MorphCaching, AnErrorInBetweenKeepsWhatWasPrepared)
{
  auto wrong = grids::cloud(grids::Row(0, 0, 0));
  grids::addIds(wrong, "MorphPointId", { 99999 });
  this->Filter->SetBoundaryData(wrong);
  {
    grids::Listener listener(this->Filter);
    EXPECT_EQ(this->PreparesAfterUpdate(), 1);
    EXPECT_EQ(listener.Errors.size(), 1u);
  }
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
  EXPECT_EQ(this->PreparesAfterUpdate(), 1);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST_F(MorphCaching, AResultDoesNotDependOnTheOnesBefore)
{
  // The way back from elsewhere: another grid, then the first again.
  this->Replace(grids::hexes(3));
  this->Filter->SetBoundaryData(grids::boundary(grids::hexes(3), grids::affine));
  EXPECT_EQ(this->PreparesAfterUpdate(), 2);
  this->Replace(this->Grid);
  this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
  EXPECT_EQ(this->PreparesAfterUpdate(), 3);
  EXPECT_TRUE(grids::points(this->Filter->GetOutput()) == this->First);
}

TEST(FEMWarpCaching, ToleranceDoesNotPrepareAgain)
{
  auto grid = grids::hexes(4);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  filter->SetTolerance(1e-2);
  filter->Update();
  const int few = filter->GetSolverIterations();
  filter->SetTolerance(1e-12);
  filter->Update();
  EXPECT_GT(filter->GetSolverIterations(), few);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
}
