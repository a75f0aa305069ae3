// SPDX-License-Identifier: BSD-3-Clause
// What every morphing filter has to do, for each of them.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Quality/ScaledJacobian.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace
{
class MorphFilters : public testing::TestWithParam<grids::MorphFilter>
{
protected:
  static vtkSmartPointer<vtkMorphAlgorithm> Make(vtkUnstructuredGrid* grid, vtkDataObject* boundary)
  {
    return GetParam().of(grid, boundary);
  }
};

}

TEST_P(MorphFilters, AffineMotionIsExact)
{
  for (auto& [name, mesh] : meshes::all(4, 3, 5))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    auto grid = grids::make(mesh);
    auto filter = Make(grid, grids::boundary(grid, grids::affine));
    filter->Update();
    const morph::Points expected = grids::mapped(mesh.points, grids::affine);
    EXPECT_LT((grids::points(filter->GetOutput()) - expected).cwiseAbs().maxCoeff(),
      1e-10 * meshes::size(expected));
    // Where middle nodes were moved, curved cells may be inverted before: then they stay it.
    morph::Monitor monitor;
    EXPECT_EQ(filter->GetInvertedCells(),
      morph::measureQuality(mesh, mesh.points, {}, {}, monitor).inverted);
  }
}

TEST_P(MorphFilters, NoMotionIsBitIdentical)
{
  for (auto& [name, mesh] : meshes::all(3, 3, 3))
  {
    for (const int type : { VTK_DOUBLE, VTK_FLOAT })
    {
      SCOPED_TRACE(name);
      meshes::jitterInterior(mesh, 0.1, meshes::seed());
      auto grid = grids::make(mesh, type);
      auto filter = Make(grid, grids::boundary(grid, grids::same));
      filter->Update();
      EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(grid));
      double range[2];
      filter->GetOutput()->GetPointData()->GetArray("MorphDisplacement")->GetRange(range, -1);
      EXPECT_EQ(range[1], 0);
    }
  }
}

TEST_P(MorphFilters, PrescribedNodesArriveExactly)
{
  auto grid = grids::hexes(5);
  auto boundary = grids::boundary(grid, grids::twist);
  auto filter = Make(grid, boundary);
  filter->Update();
  const morph::Points moved = grids::points(filter->GetOutput());
  auto* ids = boundary->GetPointData()->GetArray("MorphPointId");
  ASSERT_EQ(boundary->GetNumberOfPoints(), 6 * 6 * 6 - 4 * 4 * 4);
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    const Eigen::RowVector3d target(boundary->GetPoint(i));
    EXPECT_TRUE(moved.row(static_cast<vtkIdType>(ids->GetComponent(i, 0))) == target);
  }
  EXPECT_EQ(filter->GetPrescribedPoints(), boundary->GetNumberOfPoints());
  EXPECT_EQ(filter->GetUnmatchedPoints(), 0);
}

TEST_P(MorphFilters, MirroredMeshesAreToldOf)
{
  auto grid = grids::hexes(4);
  const auto mirror = [](const grids::Row& x) { return grids::Row(-x[0], x[1], x[2]); };
  auto filter = Make(grid, grids::boundary(grid, grids::twist));
  {
    const grids::Run listener(filter);
    EXPECT_TRUE(listener.Warnings.empty());
  }
  EXPECT_EQ(filter->GetMirroredBodies(), 0);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("MirroredBodies")->GetComponent(0, 0), 0);
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  meshes::transform(mesh, mirror);
  auto mirrored = grids::make(mesh);
  filter->SetInputData(mirrored);
  filter->SetBoundaryData(grids::boundary(mirrored, grids::twist));
  for (int again = 0; again < 2; ++again)
  {
    grids::Listener listener(filter);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(filter->GetMirroredBodies(), 1);
    EXPECT_EQ(
      filter->GetOutput()->GetFieldData()->GetArray("MirroredBodies")->GetComponent(0, 0), 1);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    listener.ExpectWarning("mirrored");
    listener.ExpectWarning("cell 0.");
  }
}

TEST_P(MorphFilters, ScaleFactor)
{
  auto grid = grids::hexes(4);
  auto boundary = grids::boundary(grid, grids::twist);
  auto filter = Make(grid, boundary);
  filter->Update();
  const morph::Points rest = grids::points(grid), full = grids::points(filter->GetOutput());
  filter->SetScaleFactor(0);
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == rest);
  for (const double scale : { 0.5, -0.25, 1.5 })
  {
    filter->SetScaleFactor(scale);
    filter->Update();
    const morph::Points expected = rest + scale * (full - rest);
    EXPECT_LT((grids::points(filter->GetOutput()) - expected).cwiseAbs().maxCoeff(), 1e-10);
  }
  filter->SetScaleFactor(1);
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == full);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
}

TEST_P(MorphFilters, OutputHasTheInputsCellsAndArrays)
{
  auto grid = grids::hexes(3);
  vtkNew<vtkDoubleArray> note;
  note->SetName("Note");
  note->InsertNextValue(42);
  grid->GetFieldData()->AddArray(note);
  auto kept = grids::copy(grid);
  auto filter = Make(grid, grids::boundary(grid, grids::twist));
  filter->Update();
  vtkUnstructuredGrid* output = filter->GetOutput();

  EXPECT_EQ(output->GetCells(), grid->GetCells());
  EXPECT_EQ(output->GetPointData()->GetArray("Number"), grid->GetPointData()->GetArray("Number"));
  EXPECT_EQ(output->GetCellData()->GetArray("Cell"), grid->GetCellData()->GetArray("Cell"));
  EXPECT_EQ(output->GetFieldData()->GetArray("Note")->GetComponent(0, 0), 42);
  const morph::Points displacement = grids::points(output) - grids::points(grid);
  auto* vectors = output->GetPointData()->GetVectors();
  ASSERT_NE(vectors, nullptr);
  EXPECT_STREQ(vectors->GetName(), "MorphDisplacement");
  EXPECT_STREQ(output->GetCellData()->GetScalars()->GetName(), "ScaledJacobian");
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    EXPECT_TRUE(displacement.row(i) == Eigen::RowVector3d(vectors->GetTuple3(i)));
  }

  EXPECT_TRUE(grids::points(grid) == grids::points(kept));
  EXPECT_EQ(grid->GetPointData()->GetNumberOfArrays(), kept->GetPointData()->GetNumberOfArrays());
  EXPECT_EQ(grid->GetCellData()->GetNumberOfArrays(), kept->GetCellData()->GetNumberOfArrays());
  EXPECT_EQ(grid->GetFieldData()->GetNumberOfArrays(), kept->GetFieldData()->GetNumberOfArrays());
}

TEST_P(MorphFilters, FieldDataAgreeWithGetters)
{
  auto grid = grids::hexes(4);
  auto filter = Make(grid, grids::boundary(grid, grids::twist));
  EXPECT_EQ(filter->GetMinScaledJacobian(), -1);
  filter->Update();
  const auto field = [&](const char* name)
  {
    auto* array = filter->GetOutput()->GetFieldData()->GetArray(name);
    EXPECT_NE(array, nullptr) << name;
    EXPECT_EQ(array->GetNumberOfValues(), 1) << name;
    return array->GetComponent(0, 0);
  };
  EXPECT_EQ(field("MinScaledJacobian"), filter->GetMinScaledJacobian());
  EXPECT_EQ(field("MeanScaledJacobian"), filter->GetMeanScaledJacobian());
  EXPECT_EQ(field("InvertedCells"), filter->GetInvertedCells());
  EXPECT_EQ(field("DegenerateCells"), filter->GetDegenerateCells());
  EXPECT_EQ(field("WorstCellId"), filter->GetWorstCellId());
  EXPECT_EQ(field("PrepareSeconds"), filter->GetPrepareSeconds());
  EXPECT_EQ(field("EvaluateSeconds"), filter->GetEvaluateSeconds());
  EXPECT_EQ(field("SolverIterations"), filter->GetSolverIterations());
  EXPECT_GT(filter->GetPrepareSeconds(), 0);
  EXPECT_GT(filter->GetEvaluateSeconds(), 0);
  for (const auto& [name, get] : GetParam().counts)
  {
    EXPECT_EQ(field(name.c_str()), get(filter)) << name;
  }

  auto* quality = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
  double sum = 0, least = 2;
  for (vtkIdType c = 0; c < quality->GetNumberOfTuples(); ++c)
  {
    sum += quality->GetComponent(c, 0);
    least = std::min(least, quality->GetComponent(c, 0));
  }
  EXPECT_EQ(filter->GetMinScaledJacobian(), least);
  EXPECT_NEAR(filter->GetMeanScaledJacobian(), sum / quality->GetNumberOfTuples(), 1e-14);
  EXPECT_EQ(quality->GetComponent(filter->GetWorstCellId(), 0), least);
}

TEST_P(MorphFilters, OutputPointsPrecision)
{
  for (const int input : { VTK_FLOAT, VTK_DOUBLE })
  {
    morph::Mesh mesh = meshes::hexes(3, 3, 3);
    meshes::jitterInterior(mesh, 0.15, meshes::seed());
    auto grid = grids::make(mesh, input);
    auto filter = Make(grid, grids::boundary(grid, grids::twist));
    EXPECT_EQ(filter->GetOutputPointsPrecision(), vtkAlgorithm::DEFAULT_PRECISION);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), input);
    filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_DOUBLE);
    const morph::Points exact = grids::points(filter->GetOutput());
    filter->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
    EXPECT_TRUE(grids::points(filter->GetOutput()) == exact.cast<float>().cast<double>().eval());
    EXPECT_EQ(filter->GetPrepareCount(), 1);
  }
}

TEST_P(MorphFilters, WholeNumberPointsAndNarrowCellsGiveDoublePoints)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3), VTK_INT);
  ASSERT_TRUE(grid->GetCells()->ConvertTo32BitStorage());
  auto filter = Make(grid, grids::boundary(grid, grids::affine));
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_LT((grids::points(filter->GetOutput()) - grids::mapped(grids::points(grid), grids::affine))
              .cwiseAbs()
              .maxCoeff(),
    1e-9);
}

TEST_P(MorphFilters, MirroredGridCountsAsValid)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  meshes::transform(mesh, [](const grids::Row& x) { return grids::Row(x[0], x[1], -x[2]); });
  auto grid = grids::make(mesh);
  auto filter = Make(grid, grids::boundary(grid, grids::same));
  filter->Update();
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_NEAR(filter->GetMinScaledJacobian(), 1, 1e-14);
  // The signs are those of the undeformed mesh: a reflected boundary does invert the cells.
  filter->SetBoundaryData(
    grids::boundary(grid, [](const grids::Row& x) { return grids::Row(x[0], x[1], -x[2]); }));
  filter->Update();
  EXPECT_EQ(filter->GetInvertedCells(), 27);
}

TEST_P(MorphFilters, VoxelsMoveAsHexahedra)
{
  morph::Mesh hexes = meshes::hexes(4, 4, 4), voxels = hexes;
  for (morph::Index c = 0; c < voxels.numberOfCells(); ++c)
  {
    voxels.types[c] = VTK_VOXEL;
    morph::Index* nodes = voxels.connectivity.data() + voxels.offsets[c];
    std::swap(nodes[2], nodes[3]);
    std::swap(nodes[6], nodes[7]);
  }
  auto first = grids::make(hexes), second = grids::make(voxels);
  auto one = Make(first, grids::boundary(first, grids::twist));
  auto other = Make(second, grids::boundary(second, grids::twist));
  one->Update();
  other->Update();
  EXPECT_LT(
    (grids::points(one->GetOutput()) - grids::points(other->GetOutput())).cwiseAbs().maxCoeff(),
    1e-9);
  EXPECT_NEAR(one->GetMinScaledJacobian(), other->GetMinScaledJacobian(), 1e-9);
}

TEST_P(MorphFilters, LowerDimensionCellsPassThrough)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  meshes::add(mesh, VTK_VERTEX, { 0 });
  meshes::add(mesh, VTK_LINE, { 0, 1 });
  meshes::add(mesh, VTK_QUAD, { 0, 1, 5, 4 });
  auto grid = grids::make(mesh);
  auto filter = Make(grid, grids::boundary(grid, grids::affine));
  grids::update(filter);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfCells(), 30);
  auto* quality = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
  for (vtkIdType c = 0; c < 30; ++c)
  {
    EXPECT_EQ(std::isnan(quality->GetComponent(c, 0)), c >= 27) << "cell " << c;
  }
}

TEST_P(MorphFilters, ShellsAndBeamsFollowTheVolume)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  mesh.points.conservativeResize(70, 3);
  mesh.points.bottomRows(6) << 1, 1, 4, 2, 1, 4, 1, 1, 5, 0, 0, 4, 8, 8, 8, 9, 8, 8;
  meshes::add(mesh, VTK_QUAD, { 53, 54, 65, 64 });
  meshes::add(mesh, VTK_LINE, { 64, 66 });
  meshes::add(mesh, VTK_LINE, { 48, 67 });
  meshes::add(mesh, VTK_LINE, { 68, 69 }); // hangs on nothing
  auto grid = grids::make(mesh);
  const grids::Map rigid = [](const grids::Row& x)
  { return grids::Row(0.6 * x[0] - 0.8 * x[2], x[1] + 2, 0.8 * x[0] + 0.6 * x[2]); };
  auto filter = Make(grid, grids::boundary(grid, rigid));
  const grids::Run listener(filter);
  const morph::Points x = grids::points(filter->GetOutput());
  for (morph::Index n = 64; n < 68; ++n)
  {
    EXPECT_LT((x.row(n) - rigid(mesh.points.row(n))).norm(), 1e-6) << "node " << n;
  }
  EXPECT_EQ(x.bottomRows(2), mesh.points.bottomRows(2));
  EXPECT_EQ(filter->GetAttachedPoints(), 4);
  listener.ExpectWarning("2 nodes stay");
  listener.ExpectWarning("68, 69");
}

TEST_P(MorphFilters, CollapsedCellsAreMeasuredAsTheCellsThatTheyAre)
{
  // A wedge, a pyramid and two tetrahedra as hexahedra, a wedge that is a pyramid, and a quad.
  morph::Mesh mesh;
  mesh.points.resize(8, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1;
  meshes::add(mesh, VTK_HEXAHEDRON, { 0, 1, 2, 2, 4, 5, 6, 6 });
  meshes::add(mesh, VTK_HEXAHEDRON, { 0, 3, 7, 4, 6, 6, 6, 6 });
  meshes::add(mesh, VTK_HEXAHEDRON, { 0, 2, 3, 3, 6, 6, 6, 6 });
  meshes::add(mesh, VTK_HEXAHEDRON, { 0, 1, 2, 3, 0, 1, 2, 3 });
  auto grid = grids::make(mesh);
  auto filter = Make(grid, grids::boundary(grid, grids::affine));
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty() && listener.Warnings.empty());
  EXPECT_EQ(filter->GetMorphStatus(), std::string("Valid"));
  EXPECT_EQ(filter->GetDegenerateCells() + filter->GetInvertedCells(), 0);
  auto* quality = filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian");
  EXPECT_GT(quality->GetComponent(0, 0), 0.2);
  EXPECT_TRUE(std::isnan(quality->GetComponent(3, 0)));
  const int prepared = filter->GetPrepareCount();
  grid->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), prepared);
}

TEST_P(MorphFilters, PointsOfNoCellMayBeAnything)
{
  auto grid = grids::hexes(3);
  grid->GetPointData()->Initialize();
  grid->GetCellData()->Initialize();
  const double nan = std::nan("");
  const vtkIdType point = grid->GetPoints()->InsertNextPoint(nan, std::log(0.), 1);
  grid->InsertNextCell(VTK_EMPTY_CELL, 1, &point); // as hidden cells are stored
  auto filter = Make(grid, grids::boundary(grid, grids::affine));
  grids::update(filter);
  EXPECT_EQ(filter->GetMorphStatus(), std::string("Valid"));
  const morph::Points rest = grids::points(grid), x = grids::points(filter->GetOutput());
  EXPECT_TRUE(std::isnan(x(point, 0)) && std::isinf(x(point, 1)) && x(point, 2) == 1);
  double by[3];
  filter->GetOutput()->GetPointData()->GetArray("MorphDisplacement")->GetTuple(point, by);
  EXPECT_EQ(grids::Row(by[0], by[1], by[2]), grids::Row(0, 0, 0));
  for (morph::Index n = 0; n < point; ++n)
  {
    EXPECT_LT((x.row(n) - grids::affine(rest.row(n))).norm(), 1e-9) << n;
  }
}

TEST_P(MorphFilters, OfCellsThatAreThereTwiceOneCounts)
{
  morph::Mesh mesh = meshes::hexes(3, 3, 3);
  auto once = grids::make(mesh);
  auto boundary = grids::boundary(once, grids::twist);
  meshes::add(mesh, morph::Hexahedron, { mesh.cell(0), mesh.cell(0) + 8 });
  auto expected = Make(once, boundary), filter = Make(grids::make(mesh), boundary);
  expected->Update();
  grids::expectWarning(filter, "Cells are there twice: cell ids 0, 27");
  EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(expected->GetOutput()));
  EXPECT_EQ(filter->GetMinScaledJacobian(), expected->GetMinScaledJacobian());
}

TEST_P(MorphFilters, OptionsOfTheMethodPrepareAnewWhereTheyHaveTo)
{
  auto grid = grids::hexes(6);
  auto boundary = grids::boundary(grid, grids::twist);
  for (const grids::MorphOption& option : GetParam().options)
  {
    SCOPED_TRACE(option.name);
    auto filter = Make(grid, boundary);
    filter->Update();
    const auto time = filter->GetMTime();
    option.set(filter);
    EXPECT_GT(filter->GetMTime(), time);
    filter->Update();
    EXPECT_EQ(filter->GetPrepareCount(), option.prepares ? 2 : 1);
    // The same as from a filter that has had no other setting.
    auto fresh = Make(grid, boundary);
    option.set(fresh);
    fresh->Update();
    EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(fresh->GetOutput()));
    std::ostringstream text;
    filter->Print(text);
    EXPECT_NE(text.str().find("\n  " + option.name + ": "), std::string::npos) << text.str();
  }
}

TEST_P(MorphFilters, AnotherMotionOfTheSameBoundaryPreparesNothing)
{
  auto grid = grids::hexes(5);
  auto filter = Make(grid, grids::boundary(grid, grids::twist));
  filter->Update();
  const morph::Points first = grids::points(filter->GetOutput());
  filter->SetBoundaryData(grids::boundary(grid, grids::affine));
  filter->Update();
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->SetNumberOfThreads(1);
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_EQ(filter->GetPrepareSeconds(), 0);
  EXPECT_TRUE(grids::points(filter->GetOutput()) == first);
}

TEST_P(MorphFilters, CountsAreZeroBeforeAnExecution)
{
  auto filter = GetParam().make();
  for (const auto& [name, get] : GetParam().counts)
  {
    EXPECT_EQ(get(filter), 0) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, MorphFilters, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });
