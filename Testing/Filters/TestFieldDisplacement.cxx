// SPDX-License-Identifier: BSD-3-Clause
// Displacements of another mesh, of an image or of points: DISPLACEMENT_FIELD.
#include "DisplacedBoundaries.h"

#include "vtkMorphMesh.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <limits>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

Row affineField(const Row& x)
{
  return grids::affine(x) - x;
}

/// Not affine, and a function that hexahedra along the axes have.
Row trilinearField(const Row& x)
{
  return Row(x[0] * x[1] * x[2], x[1] * x[2], 1 + x[0]) * 0.01;
}

vtkSmartPointer<vtkDoubleArray> valuesOf(vtkDataSet* data, const grids::Map& field)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName("U");
  array->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    Row x;
    data->GetPoint(i, x.data());
    array->InsertNextTuple(field(x).data());
  }
  return array;
}

/// A mesh that covers the box of grids::hexes() and a rim of `rim` around it.
vtkSmartPointer<vtkUnstructuredGrid> around(morph::Mesh mesh, double cells, double rim)
{
  meshes::transform(
    mesh, [=](const Row& x) { return Row((x * (4 + 2 * rim) / cells).array() - rim); });
  return grids::make(mesh);
}

vtkSmartPointer<vtkImageData> image(double high = 5)
{
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetOrigin(-1, -1, -1);
  result->SetSpacing((high + 1) / 3, 1.5, 1.2);
  result->SetDimensions(4, 5, 6);
  return result;
}

vtkSmartPointer<vtkRectilinearGrid> rectilinear()
{
  auto result = vtkSmartPointer<vtkRectilinearGrid>::New();
  vtkNew<vtkDoubleArray> along;
  for (const double x : { -1., 0.3, 2., 5. })
  {
    along->InsertNextValue(x);
  }
  result->SetDimensions(4, 4, 4);
  result->SetXCoordinates(along);
  result->SetYCoordinates(along);
  result->SetZCoordinates(along);
  return result;
}

vtkSmartPointer<vtkBoundaryDisplacement> moves(vtkDataObject* field, const char* array = "U")
{
  auto filter = displaced::make(grids::hexes());
  filter->SetDisplacementToField();
  filter->SetFieldData(field);
  filter->SetFieldArray(array);
  return filter;
}

/// How far the boundary is from where the field takes it.
double deviation(vtkBoundaryDisplacement* filter, const grids::Map& field)
{
  grids::updateQuietly(filter);
  const Points rest = displaced::restPositions(filter->GetOutput());
  EXPECT_EQ(rest.rows(), 98);
  return (grids::points(filter->GetOutput()) - rest - grids::mapped(rest, field))
    .cwiseAbs()
    .maxCoeff();
}

}

TEST(FieldDisplacement, OfAnAffineFieldIsAffine)
{
  const auto jittered = grids::hexes(5);
  const std::vector<vtkSmartPointer<vtkDataSet>> fields = { around(meshes::hexes(3, 3, 3), 3, 0.1),
    around(meshes::tets(3, 3, 3), 3, 0), around(meshes::quadraticTets(2, 2, 2), 2, 0.2), jittered,
    image(), rectilinear() };
  for (const auto& field : fields)
  {
    SCOPED_TRACE(field->GetClassName());
    field->GetPointData()->AddArray(valuesOf(field, affineField));
    EXPECT_LT(deviation(moves(field), affineField), 1e-10);
  }
}

TEST(FieldDisplacement, IsThatOfTheShapeFunctions)
{
  const std::vector<vtkSmartPointer<vtkDataSet>> fields = { around(meshes::hexes(3, 3, 3), 3, 0.1),
    image(), rectilinear() };
  for (const auto& field : fields)
  {
    SCOPED_TRACE(field->GetClassName());
    field->GetPointData()->AddArray(valuesOf(field, trilinearField));
    EXPECT_LT(deviation(moves(field), trilinearField), 1e-10);
  }
}

TEST(FieldDisplacement, OfATurnedImageFollowsItsAxes)
{
  auto turned = image();
  turned->SetOrigin(5, -1, -1);
  turned->SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1);
  turned->GetPointData()->AddArray(valuesOf(turned, affineField));
  EXPECT_LT(deviation(moves(turned), affineField), 1e-10);
}

TEST(FieldDisplacement, OfASurfaceIsThatOfTheNearestFace)
{
  auto shell = around(meshes::hexes(3, 3, 3), 3, 0.02);
  const auto faces = grids::boundary(shell, [](const Row& x) { return x; });
  faces->GetPointData()->AddArray(valuesOf(faces, affineField));
  const auto filter = moves(faces);
  // The value of a face is that 0.02 in front of each node.
  EXPECT_LT(deviation(filter, affineField), 0.02);
  EXPECT_GT(deviation(filter, affineField), 1e-4);
  filter->SetFieldDistance(1e-4);
  grids::expectError(filter, "`FieldDistance`");
}

TEST(FieldDisplacement, OfPointsIsAffineForAnAffineField)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  const Points at = 2 * (Points::Random(300, 3).array() + 1);
  const Points by = grids::mapped(at, affineField);
  const char* names[] = { "x", "y", "z", "dx", "dy", "dz" };
  for (int c = 0; c < 6; ++c)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(names[c]);
    for (Index i = 0; i < at.rows(); ++i)
    {
      column->InsertNextValue(c < 3 ? at(i, c) : by(i, c - 3));
    }
    table->AddColumn(column);
  }
  const auto filter = moves(table, "");
  filter->SetFieldDistance(1);
  EXPECT_LT(deviation(filter, affineField), 1e-10);

  auto cloud = grids::cloud(at);
  cloud->GetPointData()->AddArray(valuesOf(cloud, affineField));
  const auto other = moves(cloud);
  other->SetFieldDistance(1);
  EXPECT_LT(deviation(other, affineField), 1e-10);

  table->RemoveColumnByName("dy");
  grids::expectError(moves(table), "The field's array 'dy' is missing.");
}

TEST(FieldDisplacement, OfBlocksIsThatOfTheNearest)
{
  const auto left = image(2), right = image(); // of which the left half has no values
  left->GetPointData()->AddArray(valuesOf(left, affineField));
  right->GetPointData()->AddArray(
    valuesOf(right, [](const Row& x) { return x[0] < 0 ? Row(NaN, NaN, NaN) : affineField(x); }));
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, left);
  blocks->SetBlock(1, right);
  blocks->SetBlock(2, vtkNew<vtkPolyData>());
  EXPECT_LT(deviation(moves(blocks), affineField), 1e-10);
}

TEST(FieldDisplacement, LeavesNodesWithoutAValueFreeOrWhereTheyAre)
{
  const auto part = image(2.5); // x from -1
  part->GetPointData()->AddArray(valuesOf(part, affineField));
  const auto filter = moves(part);
  filter->SetSurroundingsToStay();
  for (const bool stay : { false, true })
  {
    filter->SetMissingValues(stay ? vtkBoundaryDisplacement::MISSING_VALUES_STAY
                                  : vtkBoundaryDisplacement::MISSING_VALUES_FREE);
    const grids::Run listener(filter);
    ASSERT_EQ(listener.Warnings.size(), 1u) << listener.Warnings.back();
    const auto rest = displaced::restPositions(filter->GetOutput());
    const auto missing = (rest.col(0).array() > 2).count();
    EXPECT_NE(listener.Warnings[0].find(std::to_string(missing) + " of the 98 nodes that are to "),
      std::string::npos);
    EXPECT_NE(listener.Warnings[0].find(stay ? "and stay" : "are free"), std::string::npos);
    EXPECT_EQ(filter->GetFreePoints(), stay ? 0 : missing);
    EXPECT_EQ(filter->GetMovingPoints(), 98 - missing);
    const Points now = grids::points(filter->GetOutput());
    for (Index i = 0; i < rest.rows(); ++i)
    {
      const Row by = rest(i, 0) > 2 ? Row(0, 0, 0) : affineField(rest.row(i));
      EXPECT_LT((now.row(i) - rest.row(i) - by).norm(), 1e-10);
    }
  }
}

TEST(FieldDisplacement, SaysWhatIsMissing)
{
  const auto field = image();
  field->GetPointData()->AddArray(valuesOf(field, affineField));
  grids::expectError(moves(nullptr), "(`Field`)");
  grids::expectError(moves(vtkNew<vtkTable>()), "(`Field`)");
  grids::expectError(moves(field, "V"), "'V'");
  grids::expectError(moves(field, "V"), "vectors at points are U");
  grids::expectError(moves(field, ""), "set `FieldArray`");

  auto broken = around(meshes::hexes(2, 2, 2), 2, 0);
  broken->GetPointData()->AddArray(valuesOf(broken, affineField));
  grids::expectError(moves(broken, "Number"), "'Number'");
  broken->GetPoints()->SetPoint(3, NaN, 0, 0);
  grids::expectError(moves(broken), "point ids 3");
}

TEST(FieldDisplacement, RefusesCellsThatVtkCannotEvaluate)
{
  const auto grid = around(meshes::hexes(2, 2, 2), 2, 0);
  grid->GetCellData()->Initialize();
  grid->GetPointData()->AddArray(valuesOf(grid, affineField));
  const vtkIdType corners[] = { 0, 1, 2 };
  grid->InsertNextCell(VTK_HEXAHEDRON, 3, corners);
  grids::expectError(moves(grid), "cell ids 8");
  const auto unknown = around(meshes::hexes(2, 2, 2), 2, 0);
  unknown->GetCellData()->Initialize();
  unknown->GetPointData()->AddArray(valuesOf(unknown, affineField));
  unknown->InsertNextCell(200, 3, corners);
  grids::expectError(moves(unknown), "type 200");
  const auto strips = around(meshes::hexes(2, 2, 2), 2, 0);
  strips->GetCellData()->Initialize();
  strips->GetPointData()->AddArray(valuesOf(strips, affineField));
  strips->InsertNextCell(VTK_TRIANGLE_STRIP, 2, corners); // without a triangle
  grids::expectError(moves(strips), "Triangulate");
}

TEST(FieldDisplacement, MovesAMeshByMorphMesh)
{
  const auto field = around(meshes::tets(3, 3, 3), 3, 0.1);
  field->GetPointData()->AddArray(valuesOf(field, affineField));
  vtkNew<vtkMorphMesh> filter;
  const auto grid = grids::hexes();
  filter->SetInputData(grid);
  filter->SetMovingToEverything();
  filter->SetDisplacementToField();
  filter->SetFieldData(field);
  filter->SetFieldArray("U");
  grids::update(filter);
  const auto moved = grids::points(vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0)));
  EXPECT_LT(
    (moved - grids::mapped(grids::points(grid), grids::affine)).cwiseAbs().maxCoeff(), 1e-9);

  // Another field is another result.
  field->GetPointData()->GetArray("U")->Fill(0);
  field->Modified();
  grids::update(filter);
  EXPECT_EQ(
    grids::points(vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))), grids::points(grid));
}
