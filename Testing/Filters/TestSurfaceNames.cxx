// SPDX-License-Identifier: BSD-3-Clause
// Names that a mesh's file gives parts of its boundary, and how large surfaces are.
#include "BlockGrids.h"
#include "DisplacedBoundaries.h"

#include "vtkMorphMesh.h"

#include <vtkBox.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using grids::Row;

namespace
{
bool onWall(const Row& x)
{
  return x[1] == 0 || x[1] == 3 || x[2] == 0 || x[2] == 3;
}

bool onInlet(const Row& x)
{
  return x[0] == 0 && x[1] <= 2;
}

/// A bar of 6 x 3 x 3 hexahedra. "inlet", a part of one end, is a set of points; "wall", its four
/// sides, one of quadrilaterals.
vtkSmartPointer<vtkUnstructuredGrid> bar()
{
  auto grid = grids::make(meshes::hexes(6, 3, 3));
  auto boundary = grids::boundary(grid, [](const Row& x) { return x; });
  vtkDataArray* ids = boundary->GetPointData()->GetArray("MorphPointId");
  vtkNew<vtkIdList> corners;
  const vtkIdType volumes = grid->GetNumberOfCells();
  for (vtkIdType face = 0; face < boundary->GetNumberOfCells(); ++face)
  {
    boundary->GetCellPoints(face, corners);
    Row center = Row::Zero();
    for (vtkIdType k = 0; k < 4; ++k)
    {
      Row x;
      boundary->GetPoint(corners->GetId(k), x.data());
      center += x / 4;
      corners->SetId(k, static_cast<vtkIdType>(ids->GetComponent(corners->GetId(k), 0)));
    }
    if (onWall(center))
    {
      grid->InsertNextCell(VTK_QUAD, corners);
    }
  }
  grid->GetCellData()->Initialize();
  vtkNew<vtkUnsignedCharArray> wall;
  wall->SetName("wall");
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    wall->InsertNextValue(cell >= volumes);
  }
  grid->GetCellData()->AddArray(wall);
  grids::mark(grid, "inlet", onInlet);
  grids::addTexts(grid, "SurfaceNames", { "inlet", "wall" });
  return grid;
}
}

TEST(SurfaceNames, NamesOfTheFileAreListedWithTheirSizes)
{
  auto filter = grids::of<vtkMorphMesh>(bar());
  filter->UpdateInformation();
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  ASSERT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 2 + 6 + 12);
  ASSERT_EQ(sizes->GetNumberOfValues(), 3 * 20);
  EXPECT_EQ(sizes->GetValue(0), "inlet");
  EXPECT_EQ(sizes->GetValue(1), "6");
  EXPECT_EQ(sizes->GetValue(2), "6");
  EXPECT_EQ(sizes->GetValue(3), "wall");
  EXPECT_EQ(sizes->GetValue(4), "72");
  EXPECT_EQ(sizes->GetValue(5), "72");
  double area = 0, length = 0;
  for (int i = 0; i < 20; ++i)
  {
    EXPECT_EQ(sizes->GetValue(3 * i), filter->GetSurfaceList()->GetArrayName(i));
    (i < 8 ? area : length) += i < 2 ? 0 : std::stod(sizes->GetValue(3 * i + 2));
  }
  EXPECT_DOUBLE_EQ(area, 2 * 9 + 4 * 18);
  EXPECT_DOUBLE_EQ(length, 8 * 3 + 4 * 6);

  vtkStringArray* shapes = filter->GetSurfaceShapes();
  ASSERT_EQ(shapes->GetNumberOfValues(), 2 * 20);
  for (int i = 0; i < 20; ++i)
  {
    EXPECT_EQ(shapes->GetValue(2 * i), filter->GetSurfaceList()->GetArrayName(i));
    // The wall is the box's surface without its inlet.
    EXPECT_EQ(shapes->GetValue(2 * i + 1), i == 1 ? "free form" : i < 8 ? "plane" : "") << i;
  }

  vtkDoubleArray* bounds = filter->GetSurfaceBounds();
  ASSERT_EQ(bounds->GetNumberOfTuples(), 20);
  double whole[6], wall[6];
  vtkDataSet::SafeDownCast(filter->GetInputDataObject(0, 0))->GetBounds(whole);
  bounds->GetTypedTuple(1, wall);
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_EQ(wall[k], whole[k]) << k;
  }
}

TEST(SurfaceNames, ANameThatIsThereTwiceCountsOnce)
{
  auto part = bar();
  grids::addTexts(part, "SurfaceNames", { "wall" });
  auto filter = grids::of<vtkMorphMesh>(part);
  filter->UpdateInformation();
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 2 + 6 + 12);
  EXPECT_EQ(filter->GetSurfaceSizes()->GetNumberOfValues(), 3 * 20);
}

TEST(SurfaceNames, WhatHasANameMovesAndSlides)
{
  auto grid = bar();
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("inlet");
  filter->AddSlidingSurface("wall");
  grids::moveBy(filter, -0.25, 0.1, 0);
  grids::update(filter);
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_EQ(y(i, 0) == x(i, 0) - 0.25, onInlet(x.row(i))) << i;
    for (const int j : { 1, 2 })
    {
      // The wall's four planes stay planes.
      EXPECT_TRUE((x(i, j) != 0 && x(i, j) != 3) || std::abs(y(i, j) - x(i, j)) < 1e-14) << i;
    }
  }
}

TEST(SurfaceNames, APartOfASurfaceCannotSlide)
{
  auto filter = grids::of<vtkMorphMesh>(bar());
  filter->AddSurface("wall");
  filter->AddFreeSurface("inlet");
  grids::Run listener(filter);
  listener.ExpectError("`FreeSurfaces` names 'inlet', which has a part alone of Surface");
  listener.Errors.clear();
  filter->RemoveAllFreeSurfaces();
  filter->AddSurface("walls");
  filter->Update();
  listener.ExpectError("which the boundary does not have; it has inlet, wall, Surface 0");
}

namespace
{
bool onPlate(const grids::Row& x)
{
  return x[0] == 2 && x[1] <= 2;
}

/// A cube of 4 x 4 x 4 cells with a baffle: two patches of 8 faces each, on the same points. The
/// set `sheet` has the 16 faces at x = 3 once, and `core` a cell.
vtkSmartPointer<vtkUnstructuredGrid> withBaffle()
{
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  const morph::Index volumes = mesh.numberOfCells();
  const auto node = [](morph::Index x, morph::Index y, morph::Index z)
  { return x + 5 * (y + 5 * z); };
  std::vector<std::string> patch(static_cast<std::size_t>(volumes));
  const auto add = [&](const char* name, morph::Index x, morph::Index y, morph::Index z)
  {
    meshes::add(
      mesh, 9, { node(x, y, z), node(x, y + 1, z), node(x, y + 1, z + 1), node(x, y, z + 1) });
    patch.emplace_back(name);
  };
  for (const char* name : { "plateLeft", "plateRight" })
  {
    for (morph::Index k = 0; k < 8; ++k)
    {
      add(name, 2, k % 2, k / 2);
    }
  }
  for (morph::Index k = 0; k < 16; ++k)
  {
    add("sheet", 3, k % 4, k / 4);
  }
  patch[21] = "core";
  auto grid = grids::make(mesh);
  for (const char* name : { "plateLeft", "plateRight", "sheet", "core" })
  {
    vtkNew<vtkUnsignedCharArray> marks;
    marks->SetName(name);
    for (const std::string& of : patch)
    {
      marks->InsertNextValue(of == name);
    }
    grid->GetCellData()->AddArray(marks);
    grids::addTexts(grid, "SurfaceNames", { name });
  }
  return grid;
}
}

TEST(SurfaceNames, BafflesAndSheetsAreListedAsInner)
{
  auto filter = grids::of<vtkMorphMesh>(withBaffle());
  filter->UpdateInformation();
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  ASSERT_GT(sizes->GetNumberOfValues(), 6);
  EXPECT_EQ(sizes->GetValue(0), "plateLeft");
  EXPECT_EQ(sizes->GetValue(1), "8 inner");
  EXPECT_EQ(sizes->GetValue(2), "8");
  EXPECT_EQ(sizes->GetValue(3), "plateRight");
  EXPECT_EQ(sizes->GetValue(4), "8 inner");
  EXPECT_EQ(sizes->GetValue(6), "sheet");
  EXPECT_EQ(sizes->GetValue(7), "16 inner");
  EXPECT_EQ(sizes->LookupValue("core"), -1);
  EXPECT_TRUE(filter->GetZoneList()->ArrayExists("core"));
}

TEST(SurfaceNames, ABaffleMovesByItsName)
{
  auto grid = withBaffle();
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("plateLeft");
  grids::moveBy(filter, 0.3, 0, 0);
  grids::update(filter);
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  bool anyFollows = false;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (onPlate(x.row(i)))
    {
      EXPECT_EQ(y(i, 0), 2.3) << i;
    }
    anyFollows = anyFollows || (!onPlate(x.row(i)) && y(i, 0) != x(i, 0));
  }
  EXPECT_TRUE(anyFollows);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

TEST(SurfaceNames, ABaffleStaysWhileAnotherSurfaceMoves)
{
  auto grid = withBaffle();
  grids::addTexts(grid, "SurfaceNames", { "outlet" });
  grids::mark(grid, "outlet", [](const Row& x) { return x[0] == 4; });
  const morph::Points x = grids::points(grid);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("outlet");
  grids::moveBy(filter, 1, 0, 0);
  filter->Update();
  const morph::Points y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_TRUE(!onPlate(x.row(i)) || y.row(i) == x.row(i)) << i;
    EXPECT_TRUE(x(i, 0) != 4 || y(i, 0) == 5) << i;
  }
}

TEST(SurfaceNames, ASheetMovesByItsNameAndElseGoesAlong)
{
  auto grid = withBaffle();
  const morph::Points x = grids::points(grid);
  vtkNew<vtkBox> side;
  side->SetBounds(3.9, 5, -1, 5, -1, 5);
  const auto moved = [&](int moving, const char* fixed)
  {
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->SetMoving(moving);
    filter->SetRegion(side);
    filter->AddSurface("sheet");
    filter->AddFixedSurface(fixed);
    grids::moveBy(filter, 0.25, 0, 0);
    filter->SetSurroundingsToStay();
    grids::update(filter);
    return morph::Points(grids::points(filter->GetOutput()) - x);
  };
  const morph::Points bySheet = moved(vtkMorphMesh::MOVING_SURFACES, "plateLeft");
  const morph::Points along = moved(vtkMorphMesh::MOVING_REGION, "plateLeft");
  const morph::Points held = moved(vtkMorphMesh::MOVING_REGION, "sheet");
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const bool isRim = x(i, 1) == 0 || x(i, 1) == 4 || x(i, 2) == 0 || x(i, 2) == 4;
    EXPECT_TRUE(x(i, 0) != 3 || bySheet(i, 0) == 0.25) << i;
    EXPECT_TRUE(x(i, 0) != 3 || isRim || along(i, 0) > 0.01) << i;
    EXPECT_TRUE(x(i, 0) != 3 || held(i, 0) == 0) << i;
  }
}

TEST(SurfaceNames, ASetOfNodesInsideMovesWithItsRim)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  const morph::Points x = grids::points(grid);
  grids::mark(grid, "MIDDLE", [](const Row& p) { return p[0] == 2; });
  grids::mark(
    grid, "LINE", [](const Row& p) { return p[0] == 2 && p[1] == 2 && p[2] > 0 && p[2] < 4; });
  grids::addTexts(grid, "SurfaceNames", { "MIDDLE", "LINE" });
  auto filter = grids::of<vtkMorphMesh>(grid);
  grids::moveBy(filter, 0.25, 0, 0);
  filter->UpdateInformation();
  EXPECT_EQ(filter->GetSurfaceSizes()->GetValue(0), "MIDDLE");
  EXPECT_EQ(filter->GetSurfaceSizes()->GetValue(1), "16 inner");
  EXPECT_EQ(filter->GetSurfaceSizes()->LookupValue("LINE"), -1);
  filter->AddSurface("MIDDLE");
  const grids::Run listener(filter);
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  const morph::Points y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_TRUE(x(i, 0) != 2 || y(i, 0) == 2.25) << i;
  }
  filter->AddSurface("LINE");
  filter->Update();
  listener.ExpectError("a zone holds or moves the nodes of 'LINE'");
}

TEST(SurfaceNames, ASetInsideThatCannotMoveSaysSo)
{
  auto filter = grids::of<vtkMorphMesh>(withBaffle());
  filter->AddSurface("core");
  grids::expectError(filter, "'core', which lies inside of the mesh");
}

namespace
{
/// A cube of 4 x 4 x 4 cells in two blocks that meet at x = 2.
vtkSmartPointer<vtkMultiBlockDataSet> twoBlocks()
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  const auto side = [](const grids::Row& center) { return center[0] < 2 ? 0 : 1; };
  const auto pieces = blocks::cut(grid, 2, side, false);
  for (unsigned int i = 0; i < 2; ++i)
  {
    result->SetBlock(i, pieces[i]);
    result->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), i == 0 ? "steel" : "glue");
  }
  return result;
}

/// Before and after, of all blocks.
std::pair<morph::Points, morph::Points> movedBlocks(
  vtkMultiBlockDataSet* data, vtkMorphMesh* filter)
{
  filter->SetInputData(data);
  grids::update(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  const auto all = [](vtkDataObject* tree)
  {
    const morph::Points a = grids::points(blocks::grid(tree, 0)),
                        b = grids::points(blocks::grid(tree, 1));
    morph::Points both(a.rows() + b.rows(), 3);
    both << a, b;
    return both;
  };
  return { all(data), all(filter->GetOutputDataObject(0)) };
}
}

TEST(SurfaceNames, AnInterfaceOfTwoBlocksIsListedAfterTheOuterSets)
{
  auto filter = grids::of<vtkMorphMesh>(twoBlocks());
  filter->UpdateInformation();
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  const std::string before = filter->GetSurfaceList()->GetArrayName(1);
  ASSERT_EQ(sizes->GetValue(0), "steel | glue");
  EXPECT_EQ(sizes->GetValue(1), "16 inner");
  EXPECT_EQ(sizes->GetValue(2), "16");
  filter->AddFixedSurface("steel | glue");
  filter->UpdateInformation();
  EXPECT_EQ(filter->GetSurfaceSizes()->GetValue(0), "steel | glue");
  EXPECT_EQ(filter->GetSurfaceList()->GetArrayName(1), before);
}

TEST(SurfaceNames, AnInterfaceMovesAndSidesFollowItsRim)
{
  vtkNew<vtkMorphMesh> filter;
  filter->AddSurface("steel | glue");
  grids::moveBy(filter, 0.5, 0, 0);
  const auto [x, y] = movedBlocks(twoBlocks(), filter);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_TRUE(x(i, 0) != 2 || y(i, 0) == 2.5) << i;
    EXPECT_TRUE((x(i, 0) != 0 && x(i, 0) != 4) || y(i, 0) == x(i, 0)) << i;
    for (const int j : { 1, 2 })
    {
      EXPECT_TRUE((x(i, j) != 0 && x(i, j) != 4) || std::abs(y(i, j) - x(i, j)) < 1e-12) << i;
    }
  }
}

TEST(SurfaceNames, AnInterfaceIsHeldOrSlidesOrGoesAlong)
{
  vtkNew<vtkBox> side;
  side->SetBounds(3.9, 5, -1, 5, -1, 5);
  const auto at = [&](bool isHeld, bool isSliding)
  {
    vtkNew<vtkMorphMesh> filter;
    filter->SetMoving(vtkMorphMesh::MOVING_REGION);
    filter->SetRegion(side);
    grids::moveBy(filter, 0.25, 0.25, 0);
    if (isHeld)
    {
      filter->AddFixedSurface("steel | glue");
    }
    if (isSliding)
    {
      filter->AddSlidingSurface("steel | glue");
      filter->SetSurroundingsToFollowEverywhere();
    }
    return movedBlocks(twoBlocks(), filter);
  };
  const auto along = at(false, false), held = at(true, false), slid = at(false, true);
  bool anyAlong = false, anySlid = false;
  const morph::Points& x = along.first;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x(i, 0) == 2)
    {
      anyAlong = anyAlong || along.second(i, 0) > 2.01;
      EXPECT_EQ(held.second.row(i), x.row(i)) << i;
      EXPECT_NEAR(slid.second(i, 0), 2, 1e-12) << i;
      anySlid = anySlid || slid.second(i, 1) > x(i, 1) + 0.01;
    }
  }
  EXPECT_TRUE(anyAlong);
  EXPECT_TRUE(anySlid);
}

TEST(SurfaceNames, PlanesOfSymmetryOfTheFileSlide)
{
  const auto grid = bar();
  grids::addTexts(grid, "SymmetrySurfaces", { "wall" });
  auto filter = displaced::make(grid);
  filter->SetMovingToSelection();
  filter->SetSelectionData(displaced::indices(
    vtkSelectionNode::POINT, displaced::nodesWhere(grid, [](const Row& x) { return x[0] == 6; })));
  grids::moveBy(filter, 0.5, 0.2, 0);
  filter->Update();

  const morph::Points rest = displaced::restPositions(filter->GetOutput());
  const morph::Points step = grids::points(filter->GetOutput()) - rest;
  double along = 0, off = 0;
  for (morph::Index i = 0; i < rest.rows(); ++i)
  {
    if (rest(i, 1) == 0 || rest(i, 1) == 3)
    {
      off = std::max(off, std::abs(step(i, 1)));
      along = std::max(along, std::abs(step(i, 0)));
    }
  }
  EXPECT_LT(off, 1e-12);
  EXPECT_GT(along, 0.05);
}

TEST(SurfaceNames, APatchOfSymmetryThatIsAPartOfAPlaneIsNamed)
{
  const auto grid = bar();
  grids::addTexts(grid, "SymmetrySurfaces", { "inlet" });
  auto filter = displaced::make(grid);
  filter->AddSurface("wall");
  grids::moveBy(filter, 0.5, 0, 0);
  const grids::Run listener(filter);
  listener.ExpectWarning("'inlet' is one of symmetry");
  filter->AddFixedSurface("inlet");
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
}
