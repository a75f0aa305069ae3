// SPDX-License-Identifier: BSD-3-Clause
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "vtkClassifyBoundary.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphBoundary.h"

#include <vtkBox.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTransform.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace displaced;
using grids::Row;

namespace
{
const Row Up(0.1, -0.2, 0.7);

/// A box of 4 x 4 x 4 hexahedra, [0, 4] in each direction: 98 nodes on its boundary, 25 on each
/// side.
bool onTop(const Row& x)
{
  return x[2] == 4;
}

/// Checks that exactly the nodes whose undeformed positions satisfy `moves` have moved by `Up`, and
/// that the others have stayed.
void expectMoved(vtkBoundaryDisplacement* filter, const std::function<bool(const Row&)>& moves)
{
  vtkPolyData* output = filter->GetOutput();
  ASSERT_EQ(output->GetNumberOfPoints(), 98);
  const morph::Points x = grids::points(output), rest = restPositions(output);
  vtkIdType count = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const bool has = moves(rest.row(i));
    count += has;
    EXPECT_EQ(x.row(i), has ? Row(rest.row(i) + Up) : Row(rest.row(i))) << i;
    EXPECT_EQ(role(output, i), has ? 1 : 0) << i;
  }
  EXPECT_EQ(filter->GetMovingPoints(), count);
  EXPECT_GT(count, 0);
}

vtkSmartPointer<vtkBoundaryDisplacement> movesUp(vtkDataObject* input)
{
  auto filter = displaced::make(input);
  grids::moveBy(filter, Up[0], Up[1], Up[2]);
  filter->SetSurroundingsToStay();
  return filter;
}
}

TEST(BoundaryDisplacement, NothingMovesBitForBit)
{
  for (const int type : { VTK_DOUBLE, VTK_FLOAT })
  {
    morph::Mesh mesh = meshes::quadraticTets(2, 2, 2);
    meshes::transform(mesh, [](const Row& x) { return Row(0.1 * x); });
    auto grid = grids::make(mesh, type);
    for (int surroundings = 0; surroundings < 3; ++surroundings)
    {
      for (int motion = 0; motion < 3; ++motion)
      {
        auto filter = displaced::make(grid);
        filter->SetMovingToSurfaces();
        filter->AddSurface("Surface 2");
        filter->SetDisplacement(motion);
        filter->SetSurroundings(surroundings);
        filter->Update();
        vtkPolyData* output = filter->GetOutput();
        ASSERT_GT(output->GetNumberOfPoints(), 0);
        EXPECT_EQ(output->GetPoints()->GetDataType(), type);
        EXPECT_EQ(grids::points(output), restPositions(output));
        EXPECT_EQ(vectors(output, "BoundaryDisplacement").cwiseAbs().maxCoeff(), 0);
      }
    }
  }
}

TEST(BoundaryDisplacement, EverythingByATransformAndTheVolumeFollows)
{
  for (auto& [name, mesh] : meshes::all(2, 3, 2))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    auto grid = grids::make(mesh);
    auto filter = displaced::make(grid);
    vtkNew<vtkTransform> transform;
    transform->Translate(1, 2, 3);
    transform->RotateWXYZ(50, 1, -2, 0.5);
    transform->Scale(1.5, 0.5, 1);
    filter->SetTransform(transform);
    filter->Update();
    const auto map = [&](const Row& x)
    {
      Row y;
      transform->TransformPoint(x.data(), y.data());
      return y;
    };
    vtkPolyData* output = filter->GetOutput();
    EXPECT_EQ(grids::points(output), grids::mapped(restPositions(output), map));

    auto volume = grids::of<vtkFEMWarpMorph>(grid);
    volume->SetBoundaryConnection(filter->GetOutputPort());
    volume->SetTolerance(1e-12);
    volume->Update();
    const morph::Points expected = grids::mapped(mesh.points, map);
    EXPECT_LE((grids::points(volume->GetOutput()) - expected).cwiseAbs().maxCoeff(),
      1e-10 * meshes::size(mesh.points));
  }
}

TEST(BoundaryDisplacement, WaysToChoose)
{
  auto grid = grids::hexes(4);
  const std::vector<morph::Index> top = nodesWhere(grid, onTop);
  {
    SCOPED_TRACE("everything");
    auto filter = movesUp(grid);
    filter->Update();
    expectMoved(filter, [](const Row&) { return true; });
  }
  {
    SCOPED_TRACE("surfaces and curves");
    auto filter = movesUp(grid);
    filter->SetMovingToSurfaces();
    filter->AddSurface(surfaceName(filter, onTop).c_str());
    filter->Update();
    expectMoved(filter, onTop);
    filter->AddSurface(surfaceName(filter, [](const Row& x) { return x[0] == 0; }).c_str());
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[2] == 4 || x[0] == 0; });
    filter->SetSurfaceStatus(surfaceName(filter, onTop).c_str(), 0);
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[0] == 0; });
    filter->RemoveAllSurfaces();
    filter->AddSurface("Curve 0"); // by lowest node: along x from the origin
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[1] == 0 && x[2] == 0; });
  }
  {
    SCOPED_TRACE("region");
    auto filter = movesUp(grid);
    filter->SetMovingToRegion();
    vtkNew<vtkBox> box;
    box->SetBounds(-1, 2, -1, 5, 4, 5);
    filter->SetRegion(box);
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[2] == 4 && x[0] <= 2; });
    box->SetBounds(-1, 0, -1, 5, -1, 5);
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[0] == 0; });
    EXPECT_EQ(filter->GetChooseCount(), 2);
  }
  {
    SCOPED_TRACE("points by id");
    auto filter = movesUp(grid);
    filter->SetMovingToSelection();
    std::vector<morph::Index> ids = top;
    ids.push_back(62); // inside
    filter->SetSelectionData(indices(vtkSelectionNode::POINT, ids));
    filter->Update();
    expectMoved(filter, onTop);
    filter->SetSelectionData(indices(vtkSelectionNode::POINT, { 0, 4 }));
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x == Row(0, 0, 0) || x == Row(4, 0, 0); });
  }
  {
    SCOPED_TRACE("cells by id");
    auto filter = movesUp(grid);
    filter->SetMovingToSelection();
    filter->SetSelectionData(indices(vtkSelectionNode::CELL, { 0, 1 }));
    filter->Update();
    expectMoved(filter, [](const Row& x)
      { return x[0] <= 2 && x[1] <= 1 && x[2] <= 1 && (x[1] == 0 || x[2] == 0 || x[0] == 0); });
  }
  {
    SCOPED_TRACE("frustum and location");
    auto filter = movesUp(grid);
    filter->SetMovingToSelection();
    filter->SetSelectionData(frustum(vtkSelectionNode::POINT, { -1, 5, -1, 1.5, 3.5, 5 }));
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[2] == 4 && x[1] <= 1; });
    filter->SetSelectionData(frustum(vtkSelectionNode::CELL, { -1, 5, -1, 5, 3.9, 5 }));
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x[2] >= 3; });
    vtkNew<vtkDoubleArray> places;
    places->SetNumberOfComponents(3);
    places->InsertNextTuple3(4, 4, 4);
    vtkNew<vtkSelectionNode> node;
    node->SetContentType(vtkSelectionNode::LOCATIONS);
    node->SetFieldType(vtkSelectionNode::POINT);
    node->SetSelectionList(places);
    node->GetProperties()->Set(vtkSelectionNode::EPSILON(), 0.01);
    vtkNew<vtkSelection> location;
    location->AddNode(node);
    filter->SetSelectionData(location);
    filter->Update();
    expectMoved(filter, [](const Row& x) { return x == Row(4, 4, 4); });
  }
  {
    SCOPED_TRACE("cells and points of the boundary");
    auto extract = grids::of<vtkExtractMorphBoundary>(grid);
    extract->Update();
    std::vector<morph::Index> cells, points;
    for (vtkIdType c = 0; c < extract->GetOutput()->GetNumberOfCells(); ++c)
    {
      double bounds[6];
      extract->GetOutput()->GetCellBounds(c, bounds);
      if (bounds[4] == 4)
      {
        cells.push_back(c);
      }
    }
    auto filter = movesUp(extract->GetOutput());
    filter->SetMovingToSelection();
    filter->SetSelectionData(indices(vtkSelectionNode::CELL, cells));
    filter->Update();
    expectMoved(filter, onTop);
    filter->SetSelectionData(
      indices(vtkSelectionNode::POINT, nodesWhere(extract->GetOutput(), onTop)));
    filter->Update();
    expectMoved(filter, onTop);
  }
}

TEST(BoundaryDisplacement, AlongNormals)
{
  // One layer: the sides' faces have all of their nodes on what moves, but are not of the patches
  // that do.
  auto flat = grids::make(meshes::hexes(3, 3, 1));
  auto filter = displaced::moving(flat, [](const Row& x) { return x[2] == 0; });
  filter->AddSurface(surfaceName(filter, [](const Row& x) { return x[2] == 1; }).c_str());
  filter->SetDisplacementToAlongNormals();
  filter->SetDistance(0.25);
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 32);
  morph::Points x = grids::points(filter->GetOutput());
  morph::Points rest = restPositions(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_LE((x.row(i) - rest.row(i) - Row(0, 0, rest(i, 2) == 1 ? 0.25 : -0.25)).norm(), 1e-15);
  }

  // All of a box: corners move along their diagonals. Inside out it is the same.
  morph::Mesh box = meshes::hexes(2, 2, 2);
  for (const bool mirrored : { false, true })
  {
    if (mirrored)
    {
      meshes::transform(box, [](const Row& p) { return Row(2 - p[0], p[1], p[2]); });
    }
    filter = displaced::make(grids::make(box));
    filter->SetDisplacementToAlongNormals();
    filter->SetDistance(0.5);
    filter->SetScaleFactor(-2);
    filter->Update();
    x = grids::points(filter->GetOutput());
    rest = restPositions(filter->GetOutput());
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      const Row outwards = (rest.row(i) - Row(1, 1, 1)).normalized();
      EXPECT_LE((x.row(i) - rest.row(i) + outwards).norm(), 1e-14);
    }
  }

  // Nodes without a moving face take all faces around them.
  filter->SetMovingToSelection();
  filter->SetSelectionData(indices(vtkSelectionNode::POINT, { 4 })); // in the middle of the bottom
  filter->SetScaleFactor(1);
  filter->SetSurroundingsToStay();
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 1);
  x = grids::points(filter->GetOutput());
  EXPECT_LE((x.row(4) - Row(1, 1, -0.5)).norm(), 1e-15);
}

TEST(BoundaryDisplacement, ByAnArrayAndScaled)
{
  for (const bool asBoundary : { false, true })
  {
    auto grid = grids::hexes(3);
    const morph::Points shift = grids::mapped(
      grids::points(grid), [](const Row& x) { return Row(x[1], -x[2], x[0] * x[0]); });
    grids::addVectors(grid, "Shift", shift);
    auto classify = grids::of<vtkClassifyBoundary>(grid);
    classify->Update();
    auto filter =
      displaced::make(asBoundary ? vtkDataObject::SafeDownCast(classify->GetSurfaces()) : grid);
    filter->SetDisplacementToArray();
    filter->SetDisplacementArray("Shift");
    for (const double scale : { 1., 0.25, 0., -3. })
    {
      filter->SetScaleFactor(scale);
      filter->Update();
      vtkPolyData* output = filter->GetOutput();
      const morph::Points x = grids::points(output), rest = restPositions(output);
      const morph::Points own = vectors(output, "Shift");
      ASSERT_EQ(x.rows(), 56);
      EXPECT_LE((x - rest - scale * own).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_LE((vectors(output, "BoundaryDisplacement") - x + rest).cwiseAbs().maxCoeff(), 0);
      EXPECT_TRUE(scale != 0 || x == rest);
    }
  }
}

TEST(BoundaryDisplacement, FollowsAsMorphBoundaryDoes)
{
  for (const morph::Mesh& mesh :
    { meshes::hexes(4, 4, 4), meshes::quadraticTets(3, 2, 2), shapes::boxWithHole(16, 3, 3) })
  {
    auto grid = grids::make(mesh);
    for (int method = 0; method < 3; ++method)
    {
      auto filter = displaced::make(grid);
      filter->SetMovingToSurfaces();
      filter->AddSurface("Surface 1");
      filter->AddSurface("Curve 3");
      filter->SetSurroundingsToFollowEverywhere();
      filter->SetSurfaceMethod(method);
      vtkNew<vtkTransform> transform;
      transform->RotateWXYZ(20, 1, 2, 3);
      transform->Translate(0.3, 0.1, 0.2);
      filter->SetTransform(transform);
      filter->Update();
      vtkPolyData* output = filter->GetOutput();
      EXPECT_EQ(filter->GetMovingPoints() + filter->GetFixedPoints() + filter->GetFollowingPoints(),
        output->GetNumberOfPoints());

      // The same nodes given to the other filter.
      std::vector<morph::Index> ids;
      std::vector<Row> places;
      for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
      {
        if (role(output, i) == 1)
        {
          ids.push_back(static_cast<morph::Index>(
            output->GetPointData()->GetArray("MorphPointId")->GetTuple1(i)));
          places.push_back(grids::points(output).row(i));
        }
      }
      morph::Points targets(static_cast<morph::Index>(places.size()), 3);
      for (std::size_t i = 0; i < places.size(); ++i)
      {
        targets.row(static_cast<morph::Index>(i)) = places[i];
      }
      auto given = grids::cloud(targets);
      grids::addIds(given, "MorphPointId", ids);
      auto reference = grids::of<vtkMorphBoundary>(grid);
      reference->SetBoundaryData(given);
      reference->SetPrescribedDimension(2);
      reference->SetSurfaceMethod(method);
      const grids::Run silence(reference);
      EXPECT_EQ(grids::points(output), grids::points(reference->GetOutput()));
      EXPECT_EQ(filter->GetFixedPoints(), reference->GetFixedVertices());
    }
  }
}

TEST(BoundaryDisplacement, HeldPatchesStayButForSharedNodes)
{
  auto grid = grids::hexes(4);
  auto filter = movesUp(grid);
  filter->SetMovingToSurfaces();
  filter->AddSurface(surfaceName(filter, onTop).c_str());
  filter->AddFixedSurface(surfaceName(filter, [](const Row& x) { return x[0] == 0; }).c_str());
  for (int surroundings = 0; surroundings < 3; ++surroundings)
  {
    filter->SetSurroundings(surroundings);
    filter->SetFalloffRadius(1);
    filter->Update();
    vtkPolyData* output = filter->GetOutput();
    const morph::Points x = grids::points(output), rest = restPositions(output);
    int followed = 0;
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      if (rest(i, 2) == 4)
      {
        EXPECT_EQ(x.row(i), rest.row(i) + Up);
        EXPECT_EQ(role(output, i), 1);
      }
      else if (rest(i, 0) == 0)
      {
        EXPECT_EQ(x.row(i), rest.row(i));
        EXPECT_EQ(role(output, i), 2);
      }
      else
      {
        followed += x.row(i) != rest.row(i);
      }
    }
    EXPECT_EQ(followed > 0, surroundings != vtkBoundaryDisplacement::SURROUNDINGS_STAY);
    EXPECT_GE(filter->GetFixedPoints(), 20);
  }
}

TEST(BoundaryDisplacement, FadesWithTheDistance)
{
  auto grid = grids::hexes(4);
  auto filter = movesUp(grid);
  filter->SetMovingToSurfaces();
  filter->AddSurface(surfaceName(filter, onTop).c_str());
  filter->SetSurroundingsToFade();
  const double radius = 2.5;
  filter->SetFalloffRadius(radius / std::sqrt(48.));
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  const morph::Points x = grids::points(output), rest = restPositions(output);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const double t = (4 - rest(i, 2)) / radius;
    const double part = t < 1 ? std::pow(1 - t, 4) * (4 * t + 1) : 0;
    EXPECT_LE((x.row(i) - rest.row(i) - part * Up).norm(), 1e-14);
    EXPECT_EQ(role(output, i), rest(i, 2) == 4 ? 1 : t < 1 ? 3 : 0);
    EXPECT_TRUE(t < 1 || x.row(i) == rest.row(i));
  }
  filter->SetFalloffRadius(0);
  filter->Update();
  expectMoved(filter, onTop);
}

TEST(BoundaryDisplacement, MidSideNodesKeepTheirPlaceBetweenCorners)
{
  const morph::Mesh mesh = meshes::quadraticHexes(2, 2, 2, true);
  auto grid = grids::make(mesh);
  // The corners on top alone are selected: the nodes between them move along.
  std::vector<morph::Index> corners;
  for (const morph::Index node : nodesWhere(grid, [](const Row& x) { return x[2] == 2; }))
  {
    const Row x = mesh.points.row(node);
    if (x[0] == std::floor(x[0]) && x[1] == std::floor(x[1]))
    {
      corners.push_back(node);
    }
  }
  ASSERT_EQ(corners.size(), 9u);
  for (const int surroundings :
    { vtkBoundaryDisplacement::SURROUNDINGS_STAY, vtkBoundaryDisplacement::SURROUNDINGS_FADE })
  {
    auto filter = movesUp(grid);
    filter->SetMovingToSelection();
    filter->SetSelectionData(indices(vtkSelectionNode::POINT, corners));
    filter->SetSurroundings(surroundings);
    filter->SetFalloffRadius(0.9 / std::sqrt(12.));
    filter->Update();
    EXPECT_EQ(filter->GetMovingPoints(), 25);
    const morph::Points x = grids::points(filter->GetOutput());
    const morph::Points rest = restPositions(filter->GetOutput());
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      const double part = rest(i, 2) == 2 ? 1 : rest(i, 2) == 1.5 ? 0.5 : 0;
      EXPECT_LE((x.row(i) - rest.row(i) - part * Up).norm(), 1e-14) << rest.row(i);
    }
  }
}

TEST(BoundaryDisplacement, NodesBetweenAMovedAndAFixedCornerKeepTheirPart)
{
  // The edge y = z = 0 moves, and mid-side nodes next to it are at a quarter of their edges.
  morph::Mesh mesh = meshes::quadraticHexes(3, 3, 3, false);
  const auto isBeside = [](const Row& x)
  { return x[1] + x[2] == 0.5 && (x[1] == 0.5 || x[2] == 0.5) && x[0] == std::floor(x[0]); };
  meshes::transform(
    mesh, [&](const Row& x) { return isBeside(x) ? Row(x[0], x[1] / 2, x[2] / 2) : x; });
  auto grid = grids::make(mesh);
  auto filter = movesUp(grid);
  filter->SetMovingToSelection();
  filter->SetSelectionData(indices(vtkSelectionNode::POINT,
    nodesWhere(grid, [](const Row& x) { return x[1] == 0 && x[2] == 0; })));
  for (int surroundings = 0; surroundings < 3; ++surroundings)
  {
    filter->SetSurroundings(surroundings);
    filter->SetFalloffRadius(0.1);
    filter->Update();
    const morph::Points x = grids::points(filter->GetOutput());
    const morph::Points rest = restPositions(filter->GetOutput());
    int between = 0;
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      if ((rest(i, 0) == 0 || rest(i, 0) == 3) && rest(i, 1) + rest(i, 2) == 0.25)
      {
        EXPECT_LE((x.row(i) - rest.row(i) - 0.75 * Up).norm(), 1e-14) << rest.row(i);
        ++between;
      }
    }
    EXPECT_EQ(between, 4);
  }
}

TEST(BoundaryDisplacement, ABoundaryIsAsGoodAsTheMesh)
{
  auto grid = grids::make(shapes::boxWithHole(16, 3, 3));
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  extract->Update();
  auto classify = grids::of<vtkClassifyBoundary>(grid);
  classify->Update();
  for (int surroundings = 0; surroundings < 3; ++surroundings)
  {
    std::vector<morph::Points> results;
    for (vtkDataObject* input :
      { vtkDataObject::SafeDownCast(grid), vtkDataObject::SafeDownCast(extract->GetOutput()),
        vtkDataObject::SafeDownCast(classify->GetSurfaces()) })
    {
      auto filter = movesUp(input);
      filter->SetMovingToSurfaces();
      filter->AddSurface("Surface 2");
      filter->SetSurroundings(surroundings);
      filter->SetFalloffRadius(0.3);
      filter->Update();
      ASSERT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
      results.push_back(grids::points(filter->GetOutput()));
      EXPECT_NE(filter->GetOutput()->GetCellData()->GetArray("GeometryId"), nullptr);
    }
    EXPECT_LE((results[1] - results[0]).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LE((results[2] - results[0]).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(BoundaryDisplacement, OneAfterTheOtherMoveTwoParts)
{
  auto grid = grids::hexes(4);
  auto first = movesUp(grid);
  first->SetMovingToSurfaces();
  first->AddSurface(surfaceName(first, onTop).c_str());
  auto second = displaced::make(nullptr);
  second->SetInputConnection(first->GetOutputPort());
  second->SetMovingToSurfaces();
  second->AddSurface(surfaceName(first, [](const Row& x) { return x[0] == 0; }).c_str());
  grids::moveBy(second, -1, 0, 0);
  second->SetSurroundingsToStay();
  for (const double height : { 0.7, 1.5, 2.5 })
  {
    first->SetVector(Up[0], Up[1], height);
    second->Update();
    vtkPolyData* output = second->GetOutput();
    const morph::Points x = grids::points(output), rest = restPositions(output);
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      Row expected = rest.row(i);
      expected += rest(i, 2) == 4 ? Row(Up[0], Up[1], height) : Row(0, 0, 0);
      expected += rest(i, 0) == 0 ? Row(-1, 0, 0) : Row(0, 0, 0);
      EXPECT_EQ(x.row(i), expected);
      EXPECT_EQ(Row(vectors(output, "BoundaryDisplacement").row(i)), expected - Row(rest.row(i)));
    }
  }
  EXPECT_EQ(first->GetClassifyCount(), 1);
  EXPECT_EQ(second->GetClassifyCount(), 1);

  auto volume = grids::of<vtkFEMWarpMorph>(grid);
  volume->SetBoundaryConnection(second->GetOutputPort());
  volume->Update();
  EXPECT_EQ(volume->GetPrescribedPoints(), 98);
  EXPECT_EQ(volume->GetUnmatchedPoints(), 0);
}

TEST(BoundaryDisplacement, FloatsAreWrittenAsTheyAre)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3), VTK_FLOAT);
  auto filter = movesUp(grid);
  filter->SetVector(0.1, 0, 0);
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  const morph::Points x = grids::points(output), rest = restPositions(output);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_FLOAT);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_EQ(x(i, 0), static_cast<double>(static_cast<float>(rest(i, 0) + 0.1)));
  }
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  EXPECT_EQ(grids::points(filter->GetOutput())(0, 0), 0.1);
  EXPECT_EQ(output->GetCellData()->GetScalars()->GetName(), std::string("Role"));
  EXPECT_NE(output->GetPointData()->GetArray("Number"), nullptr);
}

TEST(BoundaryDisplacement, ThreadsDoNotShow)
{
  auto grid = grids::make(shapes::boxWithHole(32, 8, 8));
  for (int surroundings = 0; surroundings < 3; ++surroundings)
  {
    auto filter = movesUp(grid);
    filter->SetMovingToSurfaces();
    filter->AddSurface("Surface 0");
    filter->SetDisplacementToAlongNormals();
    filter->SetDistance(0.3);
    filter->SetSurroundings(surroundings);
    filter->SetFalloffRadius(0.5);
    filter->SetNumberOfThreads(1);
    filter->Update();
    const morph::Points one = grids::points(filter->GetOutput());
    auto other = movesUp(grid);
    other->SetMovingToSurfaces();
    other->AddSurface("Surface 0");
    other->SetDisplacementToAlongNormals();
    other->SetDistance(0.3);
    other->SetSurroundings(surroundings);
    other->SetFalloffRadius(0.5);
    other->SetNumberOfThreads(3);
    other->Update();
    EXPECT_EQ(grids::points(other->GetOutput()), one);
  }
}

TEST(BoundaryDisplacement, NamesOfPatchesAreKnownBeforeAnExecution)
{
  auto grid = grids::hexes(3);
  auto filter = displaced::make(grid);
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 0);
  filter->UpdateInformation();
  ASSERT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 6 + 12);
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(0), "Surface 0");
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(5), "Surface 5");
  EXPECT_STREQ(filter->GetSurfaceList()->GetArrayName(17), "Curve 11");
  filter->Update();
  EXPECT_EQ(filter->GetClassifyCount(), 1);
  filter->SetFeatureAngle(180);
  filter->UpdateInformation();
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 1);

  // Data that an update would replace say nothing.
  auto extract = grids::of<vtkExtractMorphBoundary>(grid);
  auto second = displaced::make(nullptr);
  second->SetInputConnection(extract->GetOutputPort());
  second->UpdateInformation();
  EXPECT_EQ(second->GetSurfaceList()->GetNumberOfArrays(), 0);
  extract->Update();
  second->Modified(); // or the executive sees nothing to do
  second->UpdateInformation();
  EXPECT_EQ(second->GetSurfaceList()->GetNumberOfArrays(), 18);
}
