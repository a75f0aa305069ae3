// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"
#include "vtkScaledJacobian.h"

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkMeshQuality.h>
#include <vtkNew.h>
#include <vtkOverlappingAMR.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using Corners = std::vector<std::array<double, 3>>;

const Corners Cube = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
  { 1, 1, 1 }, { 0, 1, 1 } };
const Corners RightTet = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
const Corners UnitTriangle = { { 0, 0, 0 }, { 1, 0, 0 }, { .5, std::sqrt(.75), 0 } };
const Corners PyramidCorners = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { .5, .5, std::sqrt(.5) } };
const Corners UnitWedge = { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0, 1, 1 },
  { 1, 0, 1 } };

vtkSmartPointer<vtkUnstructuredGrid> emptyGrid(int precision = VTK_DOUBLE)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  grid->SetPoints(points);
  return grid;
}

/// A cell with its own points: it is a body of its own.
void add(vtkUnstructuredGrid* grid, int type, const Corners& corners, double shift = 0)
{
  std::vector<vtkIdType> ids;
  for (const auto& x : corners)
  {
    ids.push_back(grid->GetPoints()->InsertNextPoint(x[0] + shift, x[1], x[2]));
  }
  grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
}

Corners jittered(Corners corners, double size, std::mt19937& random)
{
  std::uniform_real_distribution<double> jitter(-size, size);
  for (auto& x : corners)
  {
    for (double& c : x)
    {
      c += jitter(random);
    }
  }
  return corners;
}

void markGhosts(vtkUnstructuredGrid* grid, const std::vector<int>& flags)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int flag : flags)
  {
    ghosts->InsertNextValue(static_cast<unsigned char>(flag));
  }
  grid->GetCellData()->AddArray(ghosts);
}

vtkSmartPointer<vtkScaledJacobian> measured(vtkUnstructuredGrid* grid)
{
  auto filter = vtkSmartPointer<vtkScaledJacobian>::New();
  filter->SetInputData(grid);
  filter->Update();
  return filter;
}

vtkDataArray* quality(vtkUnstructuredGrid* output)
{
  return output->GetCellData()->GetArray("ScaledJacobian");
}
}

TEST(ScaledJacobianFilter, AgreesWithVerdictOnRandomValidCells)
{
  std::mt19937 random(meshes::seed());
  auto grid = emptyGrid();
  for (int i = 0; i < 2000; ++i)
  {
    add(grid, VTK_TETRA, jittered(RightTet, .3, random));
    add(grid, VTK_HEXAHEDRON, jittered(Cube, .35, random));
  }
  vtkNew<vtkMeshQuality> verdict;
  verdict->SetInputData(grid);
  verdict->SetTetQualityMeasureToScaledJacobian();
  verdict->SetHexQualityMeasureToScaledJacobian();
  verdict->Update();
  auto filter = measured(grid);
  vtkDataArray* theirs = verdict->GetOutput()->GetCellData()->GetArray("Quality");
  vtkDataArray* ours = quality(filter->GetOutput());
  int valid[2] = {};
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    // Body signs aside (every cell here is a body): hexes and tets that Verdict calls valid.
    if (theirs->GetTuple1(c) > 0)
    {
      ++valid[c % 2];
      ASSERT_NEAR(ours->GetTuple1(c), theirs->GetTuple1(c), 1e-12) << "cell " << c;
    }
  }
  EXPECT_GT(valid[0], 1000);
  EXPECT_GT(valid[1], 1000);
}

#ifdef MESHMORPHING_NEW_VERDICT
TEST(ScaledJacobianFilter, CriteriaAgreeWithVerdictOnRandomCells)
{
  using Measure = vtkMeshQuality::QualityMeasureTypes;
  std::mt19937 random(meshes::seed());
  auto grid = emptyGrid();
  for (int i = 0; i < 300; ++i)
  {
    add(grid, VTK_TETRA, jittered(RightTet, .2, random));
    add(grid, VTK_HEXAHEDRON, jittered(Cube, .2, random));
    add(grid, VTK_PYRAMID, jittered(PyramidCorners, .1, random));
    add(grid, VTK_WEDGE, jittered(UnitWedge, .15, random));
  }
  auto flat = emptyGrid();
  for (int i = 0; i < 300; ++i)
  {
    add(flat, VTK_TRIANGLE, jittered(UnitTriangle, .2, random));
    add(flat, VTK_QUAD, jittered({ Cube.begin(), Cube.begin() + 4 }, .2, random));
  }
  const auto expectVerdicts =
    [&](const char* criterion, vtkUnstructuredGrid* cells, int type, Measure measure)
  {
    vtkNew<vtkMeshQuality> verdict;
    verdict->SetInputData(cells);
    type == VTK_TRIANGLE  ? verdict->SetTriangleQualityMeasure(measure)
    : type == VTK_QUAD    ? verdict->SetQuadQualityMeasure(measure)
    : type == VTK_TETRA   ? verdict->SetTetQualityMeasure(measure)
    : type == VTK_PYRAMID ? verdict->SetPyramidQualityMeasure(measure)
    : type == VTK_WEDGE   ? verdict->SetWedgeQualityMeasure(measure)
                          : verdict->SetHexQualityMeasure(measure);
    verdict->Update();
    auto filter = grids::of<vtkScaledJacobian>(cells);
    filter->SetCriteria(criterion);
    filter->Update();
    vtkDataArray* theirs = verdict->GetOutput()->GetCellData()->GetArray("Quality");
    vtkDataArray* ours = filter->GetOutput()->GetCellData()->GetArray(criterion);
    for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
    {
      if (cells->GetCellType(c) == type)
      {
        // VTK's warpage is the cube alone, not 1 - the cube of Verdict's report.
        const double value = theirs->GetTuple1(c);
        ASSERT_NEAR(ours->GetTuple1(c), measure == Measure::WARPAGE ? 1 - value : value, 1e-12)
          << criterion << ", " << c;
      }
    }
  };
  // That of a tetrahedron has its dihedral angles, too.
  for (const int type : { VTK_HEXAHEDRON, VTK_PYRAMID, VTK_WEDGE })
  {
    expectVerdicts("Skewness", grid, type, Measure::EQUIANGLE_SKEW);
  }
  for (const int type : { VTK_TRIANGLE, VTK_QUAD })
  {
    expectVerdicts("Skewness", flat, type, Measure::EQUIANGLE_SKEW);
    expectVerdicts("AspectRatio", flat, type, Measure::ASPECT_RATIO);
  }
  expectVerdicts("AspectRatio", grid, VTK_TETRA, Measure::ASPECT_RATIO);
  expectVerdicts("AspectRatio", grid, VTK_WEDGE, Measure::EDGE_RATIO);
  expectVerdicts("JacobianRatio", grid, VTK_HEXAHEDRON, Measure::NODAL_JACOBIAN_RATIO);
  expectVerdicts("Warpage", flat, VTK_QUAD, Measure::WARPAGE);
  expectVerdicts("Taper", flat, VTK_QUAD, Measure::TAPER);
  expectVerdicts("Taper", grid, VTK_HEXAHEDRON, Measure::TAPER);
}
#endif

TEST(ScaledJacobianFilter, CriteriaOfTwoShearedCubes)
{
  auto grid = emptyGrid(); // one above the other, sheared along x by 45 degrees
  for (int k = 0; k < 3; ++k)
  {
    for (const auto& x : Corners(Cube.begin(), Cube.begin() + 4))
    {
      grid->GetPoints()->InsertNextPoint(x[0] + k, x[1], k);
    }
  }
  for (vtkIdType cell = 0; cell < 2; ++cell)
  {
    vtkIdType ids[8];
    std::iota(ids, ids + 8, 4 * cell);
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  auto filter = grids::of<vtkScaledJacobian>(grid);
  filter->SetCriteria("NonOrthogonality=40, FaceSkewness, FacePyramid, FirstHeight, Skewness=.6");
  filter->Update();
  vtkFieldData* found = filter->GetOutput()->GetFieldData();
  // On the boundary the center of a face is off the normal by half the shear, 0.5; its extent is
  // 0.5, too.
  const double worst[] = { 45, 1, 1. / 6, std::sqrt(.5), .5 }, limit[] = { 40, 4, 0, 0, .6 };
  const double beyond[] = { 2, 0, 0, 0, 0 };
  for (int i = 0; i < 5; ++i)
  {
    EXPECT_NEAR(found->GetArray("CriterionWorst")->GetTuple1(i), worst[i], 1e-12) << i;
    EXPECT_EQ(found->GetArray("CriterionLimit")->GetTuple1(i), limit[i]) << i;
    EXPECT_EQ(found->GetArray("CriterionCellsBeyond")->GetTuple1(i), beyond[i]) << i;
    EXPECT_EQ(found->GetArray("CriterionWorstCellId")->GetTuple1(i), 0) << i;
  }

  // A wall that an array marks: the bottom, which the upper cell does not have.
  vtkNew<vtkDoubleArray> wall;
  wall->SetName("Bottom wall");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    wall->InsertNextValue(grid->GetPoint(i)[2] == 0 ? 1 : 0);
  }
  grid->GetPointData()->AddArray(wall);
  filter->SetCriteria("FirstHeight:Bottom wall=1.5");
  filter->Update();
  vtkDataArray* height = filter->GetOutput()->GetCellData()->GetArray("FirstHeight:Bottom wall");
  EXPECT_NEAR(height->GetTuple1(0), 1, 1e-12);
  EXPECT_TRUE(std::isnan(height->GetTuple1(1)));
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("CriterionCellsBeyond")->GetTuple1(0), 1);

  // Off again, neither the arrays of the input stay nor those of a user go.
  vtkNew<vtkUnstructuredGrid> measured;
  measured->ShallowCopy(filter->GetOutput());
  vtkNew<vtkDoubleArray> own;
  own->SetName("Taper");
  own->SetNumberOfValues(2);
  measured->GetCellData()->AddArray(own);
  filter->SetInputData(measured);
  filter->SetCriteria("");
  filter->Update();
  EXPECT_FALSE(filter->GetOutput()->GetFieldData()->HasArray("Criterion"));
  EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("NonOrthogonality"));
  EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("Taper"));
}

TEST(ScaledJacobianFilter, RefusesCriteriaThatThereAreNot)
{
  auto grid = emptyGrid();
  add(grid, VTK_HEXAHEDRON, Cube);
  for (const char* text : { "Orthogonality", "Taper=", "Taper=much", "=3", "Taper,,Warpage",
         "Taper:Wall", "FirstHeight:", "FirstHeight:Wall" })
  {
    auto filter = grids::of<vtkScaledJacobian>(grid);
    grids::Listener listener(filter);
    filter->SetCriteria(text);
    filter->Update();
    const bool lacksArray = std::string(text) == "FirstHeight:Wall";
    listener.ExpectError(lacksArray ? "no point or cell array 'Wall'" : "There are AspectRatio, ");
    EXPECT_EQ(filter->GetInvertedCells(), -1);
  }
}

TEST(ScaledJacobianFilter, NumbersInArrayFieldDataAndGetters)
{
  auto grid = emptyGrid();
  add(grid, VTK_HEXAHEDRON, Cube);
  add(grid, VTK_TETRA, RightTet, 2);
  add(grid, VTK_TETRA, { RightTet[1], RightTet[0], RightTet[2], RightTet[3] }, 4);
  add(grid, VTK_TETRA, { RightTet[0], RightTet[0], RightTet[2], RightTet[3] }, 6);
  vtkNew<vtkScaledJacobian> filter;
  EXPECT_TRUE(std::isnan(filter->GetMinScaledJacobian()));
  EXPECT_EQ(filter->GetWorstCellId(), -1);
  filter->SetInputData(grid);
  filter->Update();
  vtkUnstructuredGrid* output = filter->GetOutput();
  vtkDataArray* values = quality(output);
  ASSERT_NE(values, nullptr);
  EXPECT_EQ(values->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(output->GetCellData()->GetScalars(), values);
  const double root = std::sqrt(.5);
  EXPECT_NEAR(values->GetTuple1(0), 1, 1e-14);
  EXPECT_NEAR(values->GetTuple1(1), root, 1e-14);
  EXPECT_NEAR(values->GetTuple1(2), -root, 1e-14);
  EXPECT_EQ(values->GetTuple1(3), 0);

  EXPECT_NEAR(filter->GetMinScaledJacobian(), -root, 1e-14);
  EXPECT_NEAR(filter->GetMeanScaledJacobian(), .25, 1e-14);
  EXPECT_EQ(filter->GetMeasuredCells(), 4);
  EXPECT_EQ(filter->GetInvertedCells(), 1);
  EXPECT_EQ(filter->GetDegenerateCells(), 1);
  EXPECT_EQ(filter->GetWorstCellId(), 2);
  EXPECT_EQ(filter->GetUnmeasuredCells(), 0);
  EXPECT_EQ(filter->GetMirroredBodies(), 0);
  EXPECT_EQ(grids::field(output, "MinScaledJacobian"), filter->GetMinScaledJacobian());
  EXPECT_EQ(grids::field(output, "MeanScaledJacobian"), filter->GetMeanScaledJacobian());
  EXPECT_EQ(grids::field(output, "InvertedCells"), 1);
  EXPECT_EQ(grids::field(output, "DegenerateCells"), 1);
  EXPECT_EQ(grids::field(output, "WorstCellId"), 2);
  EXPECT_EQ(grids::field(output, "MirroredBodies"), 0);

  std::ostringstream printed;
  filter->Print(printed);
  EXPECT_NE(printed.str().find("InvertedCells: 1"), std::string::npos);
}

TEST(ScaledJacobianFilter, InputStaysAsItWas)
{
  auto grid = emptyGrid();
  add(grid, VTK_HEXAHEDRON, Cube);
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  height->SetNumberOfValues(8);
  height->Fill(1);
  grid->GetPointData()->SetScalars(height);
  const vtkMTimeType before = grid->GetMTime();
  auto filter = measured(grid);
  EXPECT_EQ(grid->GetMTime(), before);
  EXPECT_EQ(grid->GetCellData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(grid->GetFieldData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(grid->GetPointData()->GetScalars(), height.Get());
  // The array travels on, but is not what a viewer colors by.
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("Height"), height.Get());
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), nullptr);
  EXPECT_EQ(filter->GetOutput()->GetPoints(), grid->GetPoints());
}

TEST(ScaledJacobianFilter, GhostCellsAreNotMeasured)
{
  auto grid = emptyGrid();
  add(grid, VTK_HEXAHEDRON, Cube);
  add(grid, VTK_TETRA, RightTet, 2);
  add(grid, VTK_TETRA, { RightTet[1], RightTet[0], RightTet[2], RightTet[3] }, 4);
  add(grid, VTK_TETRA, RightTet, 6);
  markGhosts(grid, { 0, vtkDataSetAttributes::DUPLICATECELL, vtkDataSetAttributes::HIDDENCELL,
                     vtkDataSetAttributes::REFINEDCELL });
  auto filter = grids::of<vtkScaledJacobian>(grid);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Warnings.empty());
  EXPECT_EQ(filter->GetMeasuredCells(), 2);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_EQ(filter->GetUnmeasuredCells(), 0);
  EXPECT_TRUE(std::isnan(quality(filter->GetOutput())->GetTuple1(1)));
  EXPECT_TRUE(std::isnan(quality(filter->GetOutput())->GetTuple1(2)));
}

TEST(ScaledJacobianFilter, VoxelsAreHexahedra)
{
  Corners shifted = Cube;
  for (auto& x : shifted)
  {
    x = { x[0] + .5 * x[2], 2 * x[1], x[2] };
  }
  auto hex = emptyGrid(), voxel = emptyGrid();
  add(hex, VTK_HEXAHEDRON, shifted);
  add(voxel, VTK_VOXEL,
    { shifted[0], shifted[1], shifted[3], shifted[2], shifted[4], shifted[5], shifted[7],
      shifted[6] });
  auto filter = measured(hex);
  const double expected = filter->GetMinScaledJacobian();
  EXPECT_NEAR(expected, 1 / std::sqrt(1.25), 1e-14);
  filter->SetInputData(voxel);
  filter->Update();
  EXPECT_EQ(filter->GetMinScaledJacobian(), expected);
  EXPECT_EQ(filter->GetMirroredBodies(), 0);
}

TEST(ScaledJacobianFilter, LowerDimensionsAreNaNAmongVolumes)
{
  auto grid = emptyGrid();
  add(grid, VTK_LINE, { { 0, 0, 0 }, { 1, 0, 0 } });
  add(grid, VTK_TRIANGLE, UnitTriangle);
  add(grid, VTK_HEXAHEDRON, Cube);
  vtkNew<vtkScaledJacobian> filter;
  grids::Listener listener(filter);
  filter->SetInputData(grid);
  filter->Update();
  vtkDataArray* values = quality(filter->GetOutput());
  EXPECT_TRUE(std::isnan(values->GetTuple1(0)));
  EXPECT_TRUE(std::isnan(values->GetTuple1(1)));
  EXPECT_EQ(filter->GetMeasuredCells(), 1);
  EXPECT_EQ(filter->GetWorstCellId(), 2);
  EXPECT_TRUE(listener.Warnings.empty());
}

TEST(ScaledJacobianFilter, SurfacesAreMeasured)
{
  auto grid = emptyGrid();
  add(grid, VTK_LINE, { { 0, 0, 0 }, { 1, 0, 0 } });
  add(grid, VTK_TRIANGLE, UnitTriangle);
  add(grid, VTK_QUAD, { { 0, 0, 0 }, { 1, 0, 0 }, { .2, .2, 0 }, { 0, 1, 0 } });
  add(grid, VTK_PIXEL, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } });
  auto filter = measured(grid);
  vtkDataArray* values = quality(filter->GetOutput());
  EXPECT_TRUE(std::isnan(values->GetTuple1(0)));
  EXPECT_NEAR(values->GetTuple1(1), 1, 1e-14);
  EXPECT_NEAR(values->GetTuple1(2), -15. / 17, 1e-14);
  EXPECT_NEAR(values->GetTuple1(3), 1, 1e-14);
  EXPECT_EQ(filter->GetInvertedCells(), 1);
}

TEST(ScaledJacobianFilter, UnknownCellsAreNamedAndCounted)
{
  auto grid = emptyGrid();
  add(grid, VTK_TRIANGLE, UnitTriangle);
  const vtkIdType first = grid->GetNumberOfPoints();
  for (const auto& x : RightTet)
  {
    grid->GetPoints()->InsertNextPoint(x.data());
  }
  const vtkIdType nodes[] = { first, first + 1, first + 2, first + 3 };
  grid->InsertNextCell(VTK_CONVEX_POINT_SET, 4, nodes);
  vtkNew<vtkScaledJacobian> filter;
  grids::Listener listener(filter);
  filter->SetInputData(grid);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty());
  listener.ExpectWarning("onvexPointSet");
  EXPECT_EQ(filter->GetUnmeasuredCells(), 1);
  // Not judged by its boundary triangle
  EXPECT_EQ(filter->GetMeasuredCells(), 0);
  EXPECT_TRUE(std::isnan(filter->GetMinScaledJacobian()));
  EXPECT_TRUE(std::isnan(quality(filter->GetOutput())->GetTuple1(1)));

  add(grid, VTK_HEXAHEDRON, Cube, 3);
  add(grid, VTK_PENTAGONAL_PRISM, Corners(10, { 0, 0, 0 }), 3);
  grid->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetMeasuredCells(), 1);
  EXPECT_EQ(filter->GetUnmeasuredCells(), 2);
  EXPECT_EQ(listener.Warnings.size(), 2u);
}

TEST(ScaledJacobianFilter, MirroredBodiesAreValidAndReported)
{
  // Two hexes in a row, mirrored as a whole; the second body has one tet turned inside out.
  auto grid = emptyGrid();
  for (int k = 0; k < 3; ++k)
  {
    for (const auto& x : { Cube[0], Cube[3], Cube[7], Cube[4] })
    {
      grid->GetPoints()->InsertNextPoint(-k, x[1], x[2]);
    }
  }
  for (vtkIdType k = 0; k < 2; ++k)
  {
    const vtkIdType b = 4 * k, t = b + 4;
    const vtkIdType ids[] = { b, t, t + 1, b + 1, b + 3, t + 3, t + 2, b + 2 };
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  add(grid, VTK_PYRAMID, PyramidCorners, 5);
  auto filter = measured(grid);
  EXPECT_NEAR(filter->GetMinScaledJacobian(), 1, 1e-14);
  EXPECT_EQ(filter->GetMirroredBodies(), 1);
  EXPECT_EQ(grids::field(filter->GetOutput(), "MirroredBodies"), 1);
}

TEST(ScaledJacobianFilter, FloatPointsAreMeasuredAsTheyAre)
{
  std::mt19937 random(meshes::seed());
  auto floats = emptyGrid(VTK_FLOAT), doubles = emptyGrid();
  for (int i = 0; i < 50; ++i)
  {
    add(floats, VTK_HEXAHEDRON, jittered(Cube, .3, random));
  }
  doubles->GetPoints()->DeepCopy(floats->GetPoints());
  doubles->SetCells(VTK_HEXAHEDRON, floats->GetCells());
  auto filter = measured(floats);
  vtkNew<vtkDoubleArray> values;
  values->DeepCopy(quality(filter->GetOutput()));
  filter->SetInputData(doubles);
  filter->Update();
  for (vtkIdType c = 0; c < values->GetNumberOfTuples(); ++c)
  {
    EXPECT_EQ(values->GetValue(c), quality(filter->GetOutput())->GetTuple1(c));
  }
}

TEST(ScaledJacobianFilter, ThreadCountDoesNotShow)
{
  std::mt19937 random(meshes::seed());
  auto grid = emptyGrid();
  for (int i = 0; i < 20000; ++i)
  {
    add(grid, VTK_HEXAHEDRON, jittered(Cube, .5, random));
  }
  std::vector<double> expected;
  double mean = 0;
  for (int threads : { 1, 2, 4, 0 })
  {
    vtkNew<vtkScaledJacobian> filter;
    filter->SetNumberOfThreads(threads);
    EXPECT_EQ(filter->GetNumberOfThreads(), threads);
    filter->SetInputData(grid);
    filter->Update();
    auto* values = vtkDoubleArray::SafeDownCast(quality(filter->GetOutput()));
    std::vector<double> found(values->GetPointer(0), values->GetPointer(0) + 20000);
    if (expected.empty())
    {
      expected = found;
      mean = filter->GetMeanScaledJacobian();
    }
    EXPECT_EQ(found, expected) << threads << " threads";
    EXPECT_EQ(filter->GetMeanScaledJacobian(), mean);
  }
}

TEST(ScaledJacobianFilter, OverlappingLevelsAreRefused)
{
  vtkNew<vtkOverlappingAMR> levels;
  auto grid = emptyGrid();
  add(grid, VTK_HEXAHEDRON, Cube);
  auto filter = grids::of<vtkScaledJacobian>(levels);
  const grids::Run listener(filter);
  listener.ExpectError("vtkOverlappingAMR");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);

  filter->SetInputData(grid);
  filter->Update();
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_EQ(filter->GetMeasuredCells(), 1);

  // After an error no numbers of the grid before remain.
  filter->SetInputDataObject(levels);
  filter->Update();
  EXPECT_EQ(listener.Errors.size(), 2u);
  EXPECT_TRUE(listener.ExecutiveErrors.empty());
  EXPECT_EQ(filter->GetMeasuredCells(), 0);
  EXPECT_EQ(filter->GetMinScaledJacobian(), -1);
  EXPECT_EQ(filter->GetInvertedCells(), -1);
  vtkFieldData* field = filter->GetOutput()->GetFieldData();
  EXPECT_EQ(field->GetArray("InvertedCells")->GetComponent(0, 0), -1);
}

TEST(ScaledJacobianFilter, BadGridsGiveOneError)
{
  auto notFinite = emptyGrid();
  add(notFinite, VTK_TETRA, RightTet);
  notFinite->GetPoints()->SetPoint(2, 0, std::numeric_limits<double>::quiet_NaN(), 0);
  auto outOfRange = emptyGrid();
  add(outOfRange, VTK_TETRA, RightTet);
  const vtkIdType ids[] = { 0, 1, 2, 17 };
  outOfRange->InsertNextCell(VTK_TETRA, 4, ids);
  for (vtkUnstructuredGrid* grid : { notFinite.Get(), outOfRange.Get() })
  {
    vtkNew<vtkScaledJacobian> filter;
    grids::Listener listener(filter);
    filter->SetInputData(grid);
    filter->Update();
    EXPECT_EQ(listener.Errors.size(), 1u);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  }
}

TEST(ScaledJacobianFilter, EmptyGridHasNoQuality)
{
  vtkNew<vtkUnstructuredGrid> grid;
  auto filter = grids::of<vtkScaledJacobian>(grid);
  grids::expectWarning(filter, "no cells");
  EXPECT_EQ(filter->GetMeasuredCells(), 0);
  EXPECT_EQ(filter->GetWorstCellId(), -1);
  EXPECT_TRUE(std::isnan(filter->GetMinScaledJacobian()));
}

TEST(ScaledJacobianFilter, CertifiesOnRequest)
{
  auto grid = emptyGrid(VTK_FLOAT);
  Corners inverted = RightTet;
  std::swap(inverted[0], inverted[1]);
  // Every corner and the center positive, the inside not.
  const Corners hidden = { { -.5, .4, .5 }, { 1.1, .4, .1 }, { 1.2, .6, .2 }, { -.4, 1, -.7 },
    { -.2, .5, 1.2 }, { .7, -.6, .6 }, { 1.5, .7, 1.7 }, { .3, 1.4, 1.2 } };
  add(grid, VTK_HEXAHEDRON, Cube);
  add(grid, VTK_HEXAHEDRON, hidden, 10);
  add(grid, VTK_TETRA, inverted, 20);
  add(grid, VTK_TRIANGLE, UnitTriangle, 30);
  add(grid, VTK_PYRAMID, PyramidCorners, 40);
  markGhosts(grid, { 0, 0, 0, 0, vtkDataSetAttributes::DUPLICATECELL });

  vtkNew<vtkScaledJacobian> filter;
  EXPECT_FALSE(filter->GetCertify());
  filter->SetInputData(grid);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetCellData()->GetArray("JacobianCertificate"), nullptr);
  EXPECT_EQ(filter->GetCertifiedCells(), 0);
  EXPECT_GT(quality(filter->GetOutput())->GetTuple1(1), .01);

  filter->CertifyOn();
  filter->Update();
  vtkDataArray* values = filter->GetOutput()->GetCellData()->GetArray("JacobianCertificate");
  ASSERT_NE(values, nullptr);
  const int expected[] = { 1, -1, -1, 0, 0 };
  for (int c = 0; c < 5; ++c)
  {
    EXPECT_EQ(values->GetTuple1(c), expected[c]) << c;
  }
  EXPECT_EQ(filter->GetCertifiedCells(), 1);
  EXPECT_EQ(filter->GetUncertifiedCells(), 2);
  EXPECT_EQ(filter->GetUndecidedCells(), 0);
  EXPECT_EQ(grids::field(filter->GetOutput(), "CertifiedCells"), 1);
  EXPECT_EQ(grids::field(filter->GetOutput(), "UncertifiedCells"), 2);
  EXPECT_EQ(grids::field(filter->GetOutput(), "UndecidedCells"), 0);

  // Once more without: the arrays that came with the input are not this mesh's.
  auto second = measured(filter->GetOutput());
  EXPECT_EQ(second->GetOutput()->GetCellData()->GetArray("JacobianCertificate"), nullptr);
  EXPECT_EQ(second->GetOutput()->GetFieldData()->GetArray("CertifiedCells"), nullptr);
}
