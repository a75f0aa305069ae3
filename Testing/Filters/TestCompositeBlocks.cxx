// SPDX-License-Identifier: BSD-3-Clause
// What composite data may hold: bodies in contact, cracks, side sets, structured blocks, nothing at
// all, and blocks that cannot be read.
#include "../Core/BoundaryShapes.h"
#include "BlockGrids.h"
#include "DisplacedBoundaries.h"
#include "Support/Lists.h"

#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkScaledJacobian.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkOverlappingAMR.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>
#include <vtkStructuredGrid.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cmath>

using grids::Row;

namespace
{
/// Keeps what VTK's classes say that are no filters.
class Heard : public vtkOutputWindow
{
public:
  static Heard* New();
  vtkTypeMacro(Heard, vtkOutputWindow);
  void DisplayText(const char* text) override { this->Text += text; }
  std::string Text;
};
vtkStandardNewMacro(Heard);

/// Hexahedra of size 1 on [0, nx] x [0, ny] x [0, nz], from `origin` on.
vtkSmartPointer<vtkUnstructuredGrid> box(int nx, int ny, int nz, const Row& origin = Row(0, 0, 0))
{
  morph::Mesh mesh = meshes::hexes(nx, ny, nz);
  mesh.points.rowwise() += origin;
  return grids::make(mesh);
}

/// Two boxes that touch at x = 2.
vtkSmartPointer<vtkMultiBlockDataSet> touching()
{
  return blocks::multiBlock({ box(2, 2, 2), box(2, 2, 2, Row(2, 0, 0)) });
}

vtkSmartPointer<vtkMultiBlockDataSet> withBlocks(
  const std::vector<std::pair<const char*, vtkSmartPointer<vtkDataObject>>>& named)
{
  auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned int i = 0; i < named.size(); ++i)
  {
    result->SetBlock(i, named[i].second);
    result->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), named[i].first);
  }
  return result;
}

/// Points of a leaf, of any type.
morph::Points pointsOf(vtkDataObject* tree, std::size_t leaf)
{
  auto* set = vtkPointSet::SafeDownCast(blocks::leaves(tree).at(leaf));
  EXPECT_NE(set, nullptr);
  return set ? grids::points(set) : morph::Points(0, 3);
}

/// The faces of a box at x = 0, as a side set of its own.
vtkSmartPointer<vtkPolyData> sideOf(vtkUnstructuredGrid* grid)
{
  auto side = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, corners);
    std::vector<vtkIdType> quad;
    for (const int k : { 0, 3, 7, 4 })
    {
      double x[3];
      grid->GetPoint(corners->GetId(k), x);
      if (x[0] == 0)
      {
        quad.push_back(points->InsertNextPoint(x));
      }
    }
    if (quad.size() == 4)
    {
      quads->InsertNextCell(4, quad.data());
    }
  }
  side->SetPoints(points);
  side->SetPolys(quads);
  return side;
}

/// Morph Mesh that lifts the nodes with x = 0 by (0, 0, 0.3).
vtkSmartPointer<vtkMorphMesh> lifting(vtkDataObject* data)
{
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetInputDataObject(data);
  filter->SetMovingToArray();
  filter->SetMovingArray("Left");
  grids::moveBy(filter, 0, 0, 0.3);
  return filter;
}

/// Its blocks with the array that lifting() wants.
template <typename Data>
Data marked(Data data)
{
  for (const auto& leaf : blocks::leaves(data))
  {
    if (auto* set = vtkDataSet::SafeDownCast(leaf))
    {
      grids::mark(set, "Left", [](const Row& x) { return x[0] == 0; });
    }
  }
  return data;
}

void setIds(vtkDataSet* data, vtkIdType first)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Id");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    ids->InsertNextValue(first + i);
  }
  data->GetPointData()->SetGlobalIds(ids);
}

vtkIdType boundaryFaces(vtkDataObject* data, int coincident)
{
  auto extract = grids::of<vtkExtractMorphBoundary>(data);
  extract->SetCoincidentPoints(coincident);
  extract->Update();
  return extract->GetOutput()->GetNumberOfCells();
}

/// A cell of the points in their order.
vtkSmartPointer<vtkUnstructuredGrid> oneCell(std::uint8_t type, const morph::Points& points)
{
  morph::Mesh mesh;
  mesh.points = points;
  const std::vector<morph::Index> nodes = morph::consecutive(points.rows());
  mesh.add(type, nodes.begin(), nodes.end());
  return grids::make(mesh);
}

/// The one error of a filter with this input, and none of the executive's.
std::string errorOf(vtkDataObject* data)
{
  auto extract = grids::of<vtkExtractMorphBoundary>(data);
  const std::string error = grids::errorOf(extract);
  EXPECT_EQ(extract->GetOutput()->GetNumberOfPoints(), 0);
  return error;
}
}

TEST(CompositeBlocks, BodiesInContactAreKeptApart)
{
  auto data = marked(touching());
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 40);
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_KEEP_APART), 48);

  auto filter = lifting(data);
  filter->Update();
  const morph::Points left = grids::points(box(2, 2, 2)), right = left.rowwise() + Row(2, 0, 0);
  vtkDataObject* output = filter->GetOutputDataObject(0);
  morph::Points a = pointsOf(output, 0), b = pointsOf(output, 1);
  for (morph::Index i = 0; i < left.rows(); ++i)
  {
    EXPECT_EQ(a(i, 2) - left(i, 2) > 0.29, left(i, 0) == 0) << i;
    for (morph::Index j = 0; j < right.rows(); ++j)
    {
      if (left.row(i) == right.row(j))
      {
        EXPECT_EQ(a.row(i), b.row(j)) << "the interface is torn";
      }
    }
  }
  EXPECT_GT((b - right).norm(), 0.05) << "the other block follows";

  filter->SetCoincidentPoints(vtkMorphAlgorithm::COINCIDENT_POINTS_KEEP_APART);
  filter->Update();
  output = filter->GetOutputDataObject(0);
  EXPECT_GT((pointsOf(output, 0) - left).norm(), 0.05);
  EXPECT_EQ(pointsOf(output, 1), right) << "another body does not";

  // Ids of their own keep bodies apart without an option, and one can ask for the positions.
  for (const vtkIdType first : { vtkIdType(0), vtkIdType(1) << 60 })
  {
    setIds(blocks::grid(data, 0), first);
    setIds(blocks::grid(data, 1), first + 100);
    EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 48);
    EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE_BY_POSITION), 40);
  }
}

TEST(CompositeBlocks, PartitionsOfOneBlockAreNeverKeptApart)
{
  // A block of a decomposed file has a partition for each part.
  auto data = blocks::collection({ box(2, 2, 2), box(2, 2, 2, Row(2, 0, 0)) });
  EXPECT_EQ(data->GetNumberOfPartitionedDataSets(), 1u);
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_KEEP_APART), 40);
  // The third piece is another block.
  data =
    blocks::collection({ box(2, 2, 2), box(2, 2, 2, Row(2, 0, 0)), box(2, 2, 2, Row(4, 0, 0)) });
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_KEEP_APART), 64);
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 56);
}

TEST(CompositeBlocks, ContradictoryIdsAreToldAndPositionsCount)
{
  auto data = touching();
  setIds(blocks::grid(data, 0), 0);
  setIds(blocks::grid(data, 1), 0); // as two files that were grouped have them
  vtkNew<vtkExtractMorphBoundary> extract;
  grids::Listener listener(extract);
  extract->SetInputDataObject(data);
  extract->Update();
  EXPECT_EQ(extract->GetOutput()->GetNumberOfCells(), 40);
  listener.ExpectWarning("global ids do not number one mesh");
}

TEST(CompositeBlocks, ACrackInsideABlockStaysOpen)
{
  // One block of two bodies that touch, and a third one that touches both from above.
  const morph::Mesh body = meshes::hexes(1, 1, 1);
  auto both = grids::make(shapes::together(body, meshes::shifted(body, Row(1, 0, 0))));
  auto data = blocks::multiBlock({ both, box(2, 1, 1, Row(0, 0, 1)) });
  // Of 24 quads the two pairs between the blocks are inside; the two sides of the crack are not.
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 6 + 6 + 10 - 4);
  auto mirrored = blocks::multiBlock({ box(2, 1, 1, Row(0, 0, 1)), both });
  EXPECT_EQ(boundaryFaces(mirrored, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 6 + 6 + 10 - 4);
}

TEST(CompositeBlocks, ACrackThroughTwoBlocksStaysOpen)
{
  // Four cubes around the line x = y = 1: the crack x = 1 goes through both blocks, y < 1 and
  // y > 1.
  const auto pair = [](double y, bool mirrored)
  {
    const Row left(0, y, 0), right(1, y, 0);
    const morph::Mesh body = meshes::hexes(1, 1, 1);
    return grids::make(shapes::together(meshes::shifted(body, mirrored ? right : left),
      meshes::shifted(body, mirrored ? left : right)));
  };
  for (const bool mirrored : { false, true })
  {
    auto data = marked(blocks::multiBlock({ pair(0, false), pair(1, mirrored) }));
    EXPECT_EQ(boundaryFaces(data, 0), 24 - 4);
    auto filter = lifting(data);
    filter->Update();
    vtkDataObject* output = filter->GetOutputDataObject(0);
    for (std::size_t leaf = 0; leaf < 2; ++leaf)
    {
      const morph::Points rest = pointsOf(data, leaf), moved = pointsOf(output, leaf);
      const morph::Index far = leaf == 1 && mirrored ? 0 : 8; // the cube x > 1
      EXPECT_EQ(rest.middleRows(far, 8), moved.middleRows(far, 8));
      EXPECT_NE(rest.middleRows(8 - far, 8), moved.middleRows(8 - far, 8));
    }
  }
}

TEST(CompositeBlocks, SetsMoveWithTheirNodes)
{
  auto data = marked(touching());
  // A patch at x = 0, a node set with one point off the mesh, a sensor elsewhere, a table.
  vtkNew<vtkPolyData> patch;
  vtkNew<vtkPoints> corners;
  for (const Row& x : { Row(0, 0, 0), Row(0, 1, 0), Row(0, 1, 1), Row(0, 0, 1) })
  {
    corners->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> quads;
  const vtkIdType ids[] = { 0, 1, 2, 3 };
  quads->InsertNextCell(4, ids);
  patch->SetPoints(corners);
  patch->SetPolys(quads);
  auto set = grids::cloud((morph::Points(2, 3) << 0, 1, 1, 0.5, 0.5, 0.5).finished());
  auto sensor = grids::cloud((morph::Points(1, 3) << 9, 9, 9).finished());
  vtkNew<vtkTable> table;
  data->SetBlock(1, patch);
  data->SetBlock(2, set);
  data->SetBlock(3, sensor);
  data->SetBlock(4, table);
  data->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "inlet");
  data->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "nodes");
  data->GetMetaData(3u)->Set(vtkCompositeDataSet::NAME(), "sensor");

  auto filter = lifting(data);
  grids::Run listener(filter);
  vtkDataObject* output = filter->GetOutputDataObject(0);
  EXPECT_EQ(pointsOf(output, 2), (grids::points(patch).rowwise() + Row(0, 0, 0.3)).eval());
  EXPECT_EQ(pointsOf(output, 3).row(0), Row(0, 1, 1.3));
  EXPECT_EQ(pointsOf(output, 3).row(1), Row(0.5, 0.5, 0.5));
  EXPECT_EQ(pointsOf(output, 4), grids::points(sensor));
  EXPECT_TRUE(vtkTable::SafeDownCast(blocks::leaves(output)[5]));
  auto* moved = vtkPolyData::SafeDownCast(blocks::leaves(output)[2]);
  EXPECT_EQ(moved->GetNumberOfPolys(), 1);
  EXPECT_EQ(moved->GetPointData()->GetArray("MorphDisplacement")->GetComponent(0, 2), 0.3);
  auto* moving = vtkPolyData::SafeDownCast(blocks::leaves(output)[3]);
  EXPECT_EQ(moving->GetPointData()->GetArray("MorphDisplacement")->GetComponent(1, 2), 0);
  EXPECT_EQ(moving->GetPointData()->GetArray("MorphPointId")->GetComponent(1, 0), -1);
  EXPECT_EQ(grids::points(patch)(0, 2), 0) << "the input is not touched";
  ASSERT_GE(listener.Warnings.size(), 2u);
  EXPECT_NE(listener.Warnings[0].find("Block 'nodes': 1 of its 2 points"), std::string::npos);
  EXPECT_NE(listener.Warnings[1].find("2 blocks have no point on a node"), std::string::npos);
  EXPECT_NE(listener.Warnings[1].find("Block 'sensor'"), std::string::npos);
  listener.Warnings.clear();
  filter->LiveOn();
  filter->Update();
  EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
}

TEST(CompositeBlocks, AShellAndABeamOfOtherBlocksComeAlong)
{
  for (const bool withIds : { false, true })
  {
    // The shell stands on two nodes of the solid, the beam on the shell. All of the solid moves.
    auto data = touching();
    auto shell =
      oneCell(morph::Quad, (morph::Points(4, 3) << 0, 0, 2, 0, 1, 2, 0, 1, 3, 0, 0, 3).finished());
    auto beam = oneCell(morph::Line, (morph::Points(2, 3) << 0, 1, 3, 0, 1, 5).finished());
    for (std::size_t solid : { 0, 1 })
    {
      grids::mark(blocks::grid(data, solid), "Left", [](const Row&) { return true; });
    }
    if (withIds) // other ones at the same places
    {
      setIds(shell, 1000);
      setIds(blocks::grid(data, 0), 0);
    }
    data->SetBlock(1, beam);
    data->SetBlock(2, shell);

    auto filter = lifting(data);
    grids::Run listener(filter);
    vtkDataObject* output = filter->GetOutputDataObject(0);
    const auto lifted = [](vtkPointSet* set)
    { return (grids::points(set).rowwise() + Row(0, 0, 0.3)).eval(); };
    EXPECT_LT((pointsOf(output, 2) - lifted(beam)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((pointsOf(output, 3) - lifted(shell)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(filter->GetAttachedPoints(), 3);
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
  }
}

TEST(CompositeBlocks, ASetWithARoundedPointIsNoShell)
{
  auto data = marked(touching());
  auto set =
    oneCell(morph::Quad, (morph::Points(4, 3) << 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 1e-8, 1).finished());
  data->SetBlock(1, set);
  auto filter = lifting(data);
  grids::Run listener(filter);
  EXPECT_EQ(filter->GetAttachedPoints(), 0);
  ASSERT_FALSE(listener.Warnings.empty());
  EXPECT_NE(listener.Warnings[0].find("1 of its 4 points"), std::string::npos);
}

TEST(CompositeBlocks, SetsAreNamesOfSurfaces)
{
  auto data = marked(touching());
  auto patch = sideOf(box(2, 2, 2));
  data->SetBlock(1, patch);
  data->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "inlet");
  auto filter = grids::of<vtkMorphMesh>(data);
  filter->AddSurface("inlet");
  grids::moveBy(filter, -0.3, 0.1, 0);
  filter->SetSurroundings(0);
  const grids::Run listener(filter);
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(0), "inlet");
  EXPECT_EQ(filter->GetSurfaceSizes()->GetValue(1), "4");
  vtkDataObject* output = filter->GetOutputDataObject(0);
  EXPECT_EQ(pointsOf(output, 2), (grids::points(patch).rowwise() + Row(-0.3, 0.1, 0)).eval());
  // The faces of a set are colored as the cells behind them.
  auto* faces = vtkPolyData::SafeDownCast(blocks::leaves(output)[2]);
  vtkDataArray* quality = faces->GetCellData()->GetScalars();
  ASSERT_NE(quality, nullptr);
  EXPECT_STREQ(quality->GetName(), "ScaledJacobian");
  auto* cells = blocks::grid(output, 0)->GetCellData()->GetArray("ScaledJacobian");
  for (vtkIdType i = 0; i < 4; ++i)
  {
    EXPECT_EQ(quality->GetComponent(i, 0), cells->GetComponent(2 * i, 0)) << i;
    EXPECT_LT(quality->GetComponent(i, 0), 0.9999);
  }
  EXPECT_FALSE(blocks::grid(output, 0)->GetPointData()->HasArray("inlet"));

  // Another name of the same arrays.
  data->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "mouth");
  data->Modified();
  filter->RemoveAllSurfaces();
  filter->AddSurface("mouth");
  filter->Update();
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(0), "mouth");
}

TEST(CompositeBlocks, SurfacesArePickedInBlocks)
{
  auto data = touching();
  auto filter = grids::of<vtkMorphMesh>(data);
  filter->Update(); // shows the boundary
  const auto picked = [&](vtkDataObject* shown, int type, const std::vector<morph::Index>& ids)
  {
    auto selection = displaced::indices(type, ids);
    selection->GetNode(0)->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), 2);
    vtkNew<vtkDataArraySelection> names;
    filter->FindSurfaces(shown, selection, names);
    std::vector<std::string> found;
    for (int i = 0; i < names->GetNumberOfArrays(); ++i)
    {
      if (names->GetArraySetting(i))
      {
        found.emplace_back(names->GetArrayName(i));
      }
    }
    return found;
  };
  grids::Listener listener(filter);
  // The cells and points of the first block at x = 0.
  const auto left = picked(data, vtkSelectionNode::CELL, { 0, 2, 4, 6 });
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(picked(data, vtkSelectionNode::POINT, { 0, 3, 6, 9, 12, 15, 18, 21, 24 }), left);
  // The faces that the output shows.
  vtkDataObject* output = filter->GetOutputDataObject(0);
  auto* faces = blocks::grid(output, 0);
  std::vector<morph::Index> atLeft;
  for (vtkIdType i = 0; i < faces->GetNumberOfCells(); ++i)
  {
    double bounds[6];
    faces->GetCellBounds(i, bounds);
    if (bounds[1] == 0)
    {
      atLeft.push_back(static_cast<morph::Index>(i));
    }
  }
  EXPECT_EQ(picked(output, vtkSelectionNode::CELL, atLeft), left);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  // Other data, and a mesh that was never read.
  picked(box(1, 1, 1), vtkSelectionNode::CELL, { 0 });
  picked(blocks::multiBlock({ box(1, 1, 1), box(1, 1, 1), box(1, 1, 1) }), vtkSelectionNode::CELL,
    { 0 });
  ASSERT_FALSE(listener.Errors.empty());
  EXPECT_NE(listener.Errors.back().find("other blocks than the mesh"), std::string::npos);
}

TEST(CompositeBlocks, StructuredBlocksMove)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  image->SetOrigin(2, 0, 0);
  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetDimensions(3, 3, 3);
  for (int axis = 0; axis < 3; ++axis)
  {
    vtkNew<vtkDoubleArray> places;
    for (int i = 0; i < 3; ++i)
    {
      places->InsertNextValue(i + (axis == 0 ? 4 : 0));
    }
    axis == 0   ? rectilinear->SetXCoordinates(places)
    : axis == 1 ? rectilinear->SetYCoordinates(places)
                : rectilinear->SetZCoordinates(places);
  }
  vtkNew<vtkStructuredGrid> curvilinear;
  curvilinear->SetDimensions(3, 3, 3);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int n = 0; n < 27; ++n)
  {
    points->InsertNextPoint(6 + n % 3, n / 3 % 3, n / 9);
  }
  curvilinear->SetPoints(points);
  auto data = marked(withBlocks({ { "cells", box(2, 2, 2) }, { "image", image.Get() },
    { "rectilinear", rectilinear.Get() }, { "curvilinear", curvilinear.Get() } }));
  EXPECT_EQ(boundaryFaces(data, 0), 2 * 4 + 4 * 16);

  auto whole = box(8, 2, 2);
  grids::mark(whole, "Left", [](const Row& x) { return x[0] == 0; });
  auto expected = lifting(whole);
  auto filter = lifting(data);
  expected->Update();
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  const auto leaves = blocks::leaves(filter->GetOutputDataObject(0));
  EXPECT_STREQ(leaves[0]->GetClassName(), "vtkUnstructuredGrid");
  const morph::Points rest = grids::points(whole);
  const morph::Points moved = grids::points(expected->GetOutput());
  for (int i = 0; i < 4; ++i)
  {
    auto* set = vtkPointSet::SafeDownCast(leaves[i]);
    ASSERT_NE(set, nullptr);
    EXPECT_EQ(set->GetNumberOfCells(), 8);
    EXPECT_TRUE(set->GetPointData()->HasArray("Left"));
    EXPECT_TRUE(set->GetCellData()->HasArray("ScaledJacobian"));
    const morph::Points x = grids::points(set);
    for (int n = 0; n < 27; ++n)
    {
      const Row at(2 * i + n % 3, n / 3 % 3, n / 9);
      for (morph::Index k = 0; k < rest.rows(); ++k)
      {
        if (rest.row(k) == at)
        {
          EXPECT_LE((x.row(n) - moved.row(k)).norm(), 1e-9);
        }
      }
    }
    if (i > 0)
    {
      EXPECT_STREQ(set->GetClassName(), "vtkStructuredGrid");
    }
  }
  // A measure moves nothing, and the types stay.
  auto measure = grids::of<vtkScaledJacobian>(data);
  measure->Update();
  EXPECT_EQ(measure->GetMinScaledJacobian(), 1);
  EXPECT_EQ(measure->GetMeasuredCells(), 32);
  EXPECT_STREQ(blocks::leaves(measure->GetOutputDataObject(0))[1]->GetClassName(), "vtkImageData");
}

TEST(CompositeBlocks, ASeamOfAStructuredBlockIsClosed)
{
  vtkNew<vtkStructuredGrid> ring;
  ring->SetDimensions(2, 7, 2);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int n = 0; n < 28; ++n)
  {
    const double angle = 2 * M_PI * (n / 2 % 7 % 6) / 6, radius = 1 + n % 2;
    points->InsertNextPoint(radius * std::cos(angle), radius * std::sin(angle), n / 14);
  }
  ring->SetPoints(points);
  auto data = withBlocks({ { "ring", ring.Get() } });
  EXPECT_EQ(boundaryFaces(data, 0), 4 * 6);
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_KEEP_APART), 4 * 6 + 2);
  setIds(ring, 0); // both sides of the seam have ids
  EXPECT_EQ(boundaryFaces(data, 0), 4 * 6);
}

TEST(CompositeBlocks, StructuredBodiesInContactAreKeptApart)
{
  vtkNew<vtkImageData> left, right;
  left->SetDimensions(3, 3, 3);
  right->SetDimensions(3, 3, 3);
  right->SetOrigin(2, 0, 0);
  setIds(left, 0);
  setIds(right, 27);
  auto data = withBlocks({ { "left", left.Get() }, { "right", right.Get() } });
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE), 48);
  EXPECT_EQ(boundaryFaces(data, vtkMorphAlgorithm::COINCIDENT_POINTS_MERGE_BY_POSITION), 40);
}

TEST(CompositeBlocks, CellsOfTwoBlocksAreOne)
{
  auto a = box(3, 2, 2);
  auto zone = blocks::cut(
    a, 2, [](const Row& x) { return x[0] > 1 ? 0 : 1; }, false)[0];
  auto ghost = blocks::cut(
    a, 2, [](const Row& x) { return x[0] > 2 ? 0 : 1; }, false)[0];
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->SetNumberOfValues(ghost->GetNumberOfCells());
  flags->FillValue(vtkDataSetAttributes::DUPLICATECELL);
  ghost->GetCellData()->AddArray(flags);
  auto data = withBlocks({ { "ghosts", ghost }, { "mesh", a }, { "zone", zone } });
  EXPECT_EQ(boundaryFaces(data, 0), 32);
  auto measure = grids::of<vtkScaledJacobian>(data);
  measure->Update();
  EXPECT_EQ(measure->GetMeasuredCells(), 12);
  auto filter = lifting(marked(data));
  filter->Update();
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  const auto moved = blocks::pointsByNumber(filter->GetOutputDataObject(0));
  EXPECT_EQ(moved.size(), 36u);
}

TEST(CompositeBlocks, FlagsOfThreeComponentsAreNoGhosts)
{
  auto whole = box(2, 2, 2);
  grids::mark(whole, "Left", [](const Row& x) { return x[0] == 0; });
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->SetNumberOfComponents(3);
  flags->SetNumberOfTuples(whole->GetNumberOfPoints());
  flags->FillValue(vtkDataSetAttributes::DUPLICATEPOINT);
  whole->GetPointData()->AddArray(flags);
  auto filter = lifting(withBlocks({ { "only", whole } }));
  const grids::Listener listener(filter); // its own warnings do not count
  vtkNew<Heard> heard;
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  vtkOutputWindow::SetInstance(heard);
  filter->Update();
  vtkOutputWindow::SetInstance(before);
  EXPECT_EQ(heard->Text, "");
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
}

TEST(CompositeBlocks, EmptyBlocksAndOneBlock)
{
  auto whole = box(2, 2, 2);
  grids::mark(whole, "Left", [](const Row& x) { return x[0] == 0; });
  auto expected = lifting(whole);
  expected->Update();
  for (const auto& data : { withBlocks({ { "only", whole } }),
         withBlocks({ { "empty", vtkSmartPointer<vtkUnstructuredGrid>::New() }, { "mesh", whole },
           { "null", nullptr }, { "surface", vtkSmartPointer<vtkPolyData>::New() },
           { "inner", vtkSmartPointer<vtkMultiBlockDataSet>::New() } }) })
  {
    auto filter = lifting(data);
    const grids::Run listener(filter);
    for (const std::string& warning : listener.Warnings)
    {
      EXPECT_EQ(warning.find("lock"), std::string::npos) << warning;
    }
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    ASSERT_EQ(output->GetNumberOfBlocks(), data->GetNumberOfBlocks());
    const auto leaves = blocks::leaves(output);
    EXPECT_EQ(grids::points(vtkPointSet::SafeDownCast(leaves[leaves.size() == 1 ? 0 : 1])),
      grids::points(expected->GetOutput()));
  }
  vtkNew<vtkMultiBlockDataSet> nothing;
  EXPECT_NE(errorOf(nothing).find("no cells"), std::string::npos);
  EXPECT_NE(
    errorOf(withBlocks({ { "cloud", grids::cloud(grids::points(whole)) } })).find("no cells"),
    std::string::npos);
}

TEST(CompositeBlocks, ErrorsNameTheBlock)
{
  const auto bad = [](const std::function<void(vtkUnstructuredGrid*)>& spoil)
  {
    auto piece = box(2, 2, 2, Row(2, 0, 0));
    spoil(piece);
    return errorOf(blocks::multiBlock({ box(2, 2, 2), piece }));
  };
  const auto expect = [](const std::string& error, const std::vector<std::string>& parts)
  {
    for (const std::string& part : parts)
    {
      EXPECT_NE(error.find(part), std::string::npos) << error;
    }
  };
  expect(bad([](vtkUnstructuredGrid* piece) { piece->GetPoints()->SetPoint(5, NAN, 0, 0); }),
    { "Block 'Solid/B'", "not finite", "5" });
  expect(bad(
           [](vtkUnstructuredGrid* piece)
           {
             vtkNew<vtkDoubleArray> few;
             few->SetName("Few");
             few->InsertNextValue(1);
             piece->GetPointData()->AddArray(few);
           }),
    { "Block 'Solid/B'", "'Few'", "1 tuples for 27 points" });
  expect(bad(
           [](vtkUnstructuredGrid* piece)
           {
             const vtkIdType ids[] = { 0, 1, 2, 99 };
             piece->InsertNextCell(VTK_TETRA, 4, ids);
             piece->GetCellData()->Initialize();
           }),
    { "Block 'Solid/B'", "outside 0 to 26", "8" });
  expect(bad(
           [](vtkUnstructuredGrid* piece)
           {
             const vtkIdType ids[] = { 0, 1, 2, 9 };
             piece->InsertNextCell(VTK_LAGRANGE_PYRAMID, 4, ids);
             piece->GetCellData()->Initialize();
           }),
    { "Block 'Solid/B'", "cannot be morphed" });
  vtkNew<vtkOverlappingAMR> levels;
  expect(errorOf(levels), { "vtkOverlappingAMR", "an unstructured grid" });

  // Morphing filters keep the picture where there is one.
  auto data = marked(touching());
  auto filter = lifting(data);
  filter->SetMovingArray("No such array");
  const grids::Run listener(filter);
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  vtkDataObject* output = filter->GetOutputDataObject(0);
  EXPECT_EQ(pointsOf(output, 0), pointsOf(data, 0));
  EXPECT_EQ(pointsOf(output, 1), pointsOf(data, 1));
  EXPECT_EQ(vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("MorphStatus"))
              ->GetValue(0),
    "Failed");
}

TEST(CompositeBlocks, NothingTickedShowsTheFacesOfEachBlock)
{
  auto filter = grids::of<vtkMorphMesh>(touching());
  filter->Update();
  vtkDataObject* output = filter->GetOutputDataObject(0);
  for (std::size_t leaf = 0; leaf < 2; ++leaf)
  {
    auto* faces = blocks::grid(output, leaf);
    ASSERT_NE(faces, nullptr);
    EXPECT_EQ(faces->GetNumberOfCells(), 20); // of 24, without those between the blocks
    EXPECT_EQ(faces->GetCellType(0), VTK_QUAD);
    EXPECT_STREQ(faces->GetCellData()->GetScalars()->GetName(), "SurfaceId");
    double bounds[6];
    faces->GetCellBounds(0, bounds);
    EXPECT_GE(bounds[0], 2. * static_cast<double>(leaf));
  }
}

TEST(CompositeBlocks, SelectionsOfBlocksMove)
{
  auto data = touching();
  for (const int fieldType : { vtkSelectionNode::CELL, vtkSelectionNode::POINT })
  {
    // Cell 0 of the second leaf, the corner (2, 0, 0) to (3, 1, 1), or its first point.
    auto selection = displaced::indices(fieldType, { 0 });
    selection->GetNode(0)->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), 4);
    auto filter = grids::of<vtkMorphMesh>(data);
    filter->SetSelectionData(selection);
    grids::moveBy(filter, 0, -0.2, 0);
    filter->SetSurroundings(0);
    grids::update(filter);
    vtkDataObject* output = filter->GetOutputDataObject(0);
    const morph::Points a = pointsOf(output, 0), b = pointsOf(output, 1);
    EXPECT_EQ(b.row(0), Row(2, -0.2, 0));
    EXPECT_EQ(a.row(2), Row(2, -0.2, 0));
    EXPECT_EQ(b.row(1)[1] < -0.1, fieldType == vtkSelectionNode::CELL);
    EXPECT_EQ(a.row(0), Row(0, 0, 0));
    EXPECT_EQ(b.row(2), Row(4, 0, 0));
  }
}
