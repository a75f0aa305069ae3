// SPDX-License-Identifier: BSD-3-Clause
// From a selection in a view to surfaces, and what a view shows of them.
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "../Core/Meshes.h"
#include "vtkListedSurfaces.h"
#include "vtkMorphMesh.h"

#include <vtkDataArraySelection.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTrivialProducer.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using grids::Row;
using Names = std::vector<std::string>;

namespace
{
Names enabled(vtkDataArraySelection* names)
{
  Names found;
  for (int i = 0; i < names->GetNumberOfArrays(); ++i)
  {
    if (names->GetArraySetting(i))
    {
      found.push_back(names->GetArrayName(i));
    }
  }
  return found;
}

/// The surfaces of the selection, on `shown`.
Names pick(vtkBoundaryDisplacement* filter, vtkDataObject* shown, vtkSelection* selection)
{
  vtkNew<vtkDataArraySelection> names;
  filter->FindSurfaces(shown, selection, names);
  EXPECT_EQ(names->GetNumberOfArrays(), filter->GetSurfaceList()->GetNumberOfArrays());
  return enabled(names);
}

/// Points or cells whose points satisfy `is`, all of them or, with `any`, one at least.
vtkSmartPointer<vtkSelection> where(
  int type, vtkPointSet* data, const std::function<bool(const Row&)>& is, bool any = false)
{
  std::vector<morph::Index> ids = displaced::nodesWhere(data, is);
  if (type == vtkSelectionNode::CELL)
  {
    const std::set<morph::Index> inside(ids.begin(), ids.end());
    ids.clear();
    vtkNew<vtkIdList> points;
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
    {
      data->GetCellPoints(cell, points);
      vtkIdType count = 0;
      for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      {
        count += inside.count(static_cast<morph::Index>(points->GetId(k))) > 0;
      }
      if (any ? count > 0 : count == points->GetNumberOfIds())
      {
        ids.push_back(static_cast<morph::Index>(cell));
      }
    }
  }
  return displaced::indices(type, ids);
}

bool onTop(const Row& x)
{
  return x[2] > 2.999;
}
bool onSide(const Row& x)
{
  return x[0] > 2.999;
}
}

class Pick : public testing::TestWithParam<bool>
{
protected:
  void SetUp() override
  {
    this->Grid =
      grids::make(GetParam() ? meshes::quadraticHexes(3, 3, 3, true) : meshes::hexes(3, 3, 3));
    this->Filter = displaced::make(this->Grid);
    this->Filter->SetMovingToNothing();
    this->Filter->Update();
    this->Top = displaced::surfaceName(this->Filter, onTop);
    this->Side = displaced::surfaceName(this->Filter, onSide);
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkSmartPointer<vtkBoundaryDisplacement> Filter;
  std::string Top, Side;
};

TEST_P(Pick, CellsPointsAndFacesOfASurface)
{
  // All cells at the top: those at its edges lie on four other surfaces, which are not meant.
  const auto cells = where(vtkSelectionNode::CELL, this->Grid, onTop, true);
  EXPECT_EQ(pick(this->Filter, this->Grid, cells), Names{ this->Top });
  const auto points = where(vtkSelectionNode::POINT, this->Grid, onTop);
  EXPECT_EQ(pick(this->Filter, this->Grid, points), Names{ this->Top });
  vtkPolyData* boundary = this->Filter->GetOutput();
  for (const auto type : { vtkSelectionNode::CELL, vtkSelectionNode::POINT })
  {
    EXPECT_EQ(pick(this->Filter, boundary, where(type, boundary, onTop)), Names{ this->Top });
  }
}

TEST_P(Pick, TwoSurfacesAndNone)
{
  const auto both = where(
    vtkSelectionNode::CELL, this->Grid, [](const Row& x) { return onTop(x) || onSide(x); }, true);
  Names expected{ this->Top, this->Side };
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(pick(this->Filter, this->Grid, both), expected);
  // The cell in the middle of 27, and a node in the interior.
  EXPECT_EQ(
    pick(this->Filter, this->Grid, displaced::indices(vtkSelectionNode::CELL, { 13 })), Names());
  const auto inside = where(vtkSelectionNode::POINT, this->Grid,
    [](const Row& x) { return (x.array() > 0.5).all() && (x.array() < 2.5).all(); });
  EXPECT_EQ(pick(this->Filter, this->Grid, inside), Names());
}

TEST_P(Pick, ASingleCornerCellLiesOnOneSurface)
{
  const Names found =
    pick(this->Filter, this->Grid, displaced::indices(vtkSelectionNode::CELL, { 26 }));
  EXPECT_EQ(found.size(), 1u);
}

TEST_P(Pick, ASurfaceAsInput)
{
  auto next = displaced::make(this->Filter->GetOutput());
  next->SetMovingToNothing();
  next->Update();
  vtkPolyData* boundary = next->GetOutput();
  for (const auto type : { vtkSelectionNode::CELL, vtkSelectionNode::POINT })
  {
    EXPECT_EQ(
      pick(next, next->GetInputDataObject(0, 0), where(type, boundary, onTop)), Names{ this->Top });
  }
  // The mesh whose boundary it is has the points' ids, too.
  EXPECT_EQ(
    pick(next, this->Grid, where(vtkSelectionNode::POINT, this->Grid, onTop)), Names{ this->Top });
}

TEST_P(Pick, NoExecutionAndNoChange)
{
  vtkNew<vtkTrivialProducer> selection;
  selection->SetOutput(where(vtkSelectionNode::CELL, this->Grid, onTop, true));
  const vtkMTimeType before = this->Filter->GetMTime();
  this->Filter->SetPick(selection);
  this->Filter->SetPickPort(-1);
  EXPECT_EQ(enabled(this->Filter->GetPickedSurfaces()), Names{ this->Top });
  selection->SetOutput(where(vtkSelectionNode::POINT, this->Filter->GetOutput(), onSide));
  this->Filter->SetPickPort(0);
  EXPECT_EQ(enabled(this->Filter->GetPickedSurfaces()), Names{ this->Side });
  this->Filter->SetPick(nullptr);
  EXPECT_EQ(enabled(this->Filter->GetPickedSurfaces()), Names());
  EXPECT_EQ(this->Filter->GetMTime(), before);
}

TEST_P(Pick, ErrorsAreOneMessage)
{
  const grids::Listener listener(this->Filter);
  const auto cells = where(vtkSelectionNode::CELL, this->Grid, onTop, true);
  EXPECT_EQ(pick(this->Filter, nullptr, cells), Names());
  EXPECT_EQ(listener.Errors.size(), 1u);
  vtkNew<vtkSelectionNode> broken; // without a list
  broken->SetContentType(vtkSelectionNode::INDICES);
  broken->SetFieldType(vtkSelectionNode::CELL);
  vtkNew<vtkSelection> selection;
  selection->AddNode(broken);
  EXPECT_EQ(pick(this->Filter, this->Grid, selection), Names());
  EXPECT_EQ(listener.Errors.size(), 2u);
  // Ids that the mesh does not have select nothing.
  EXPECT_EQ(pick(this->Filter, this->Grid, displaced::indices(vtkSelectionNode::CELL, { 1000000 })),
    Names());
}

INSTANTIATE_TEST_SUITE_P(LinearAndQuadratic, Pick, testing::Bool());

TEST(ListedSurfaces, SurfacesAndCurvesWhereTheResultHasThem)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 2));
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetInputData(grid);
  filter->Update();
  Names surfaces, curves;
  vtkDataArraySelection* list = filter->GetSurfaceList();
  for (int i = 0; i < list->GetNumberOfArrays(); ++i)
  {
    const std::string name = list->GetArrayName(i);
    (name[0] == 'S' ? surfaces : curves).push_back(name);
  }
  vtkNew<vtkListedSurfaces> shown;
  shown->SetFilter(filter);
  vtkIdType faces = 0;
  for (const std::string& name : surfaces)
  {
    shown->RemoveAllSurfaces();
    shown->AddSurface(name.c_str());
    shown->Update();
    EXPECT_GT(shown->GetOutput()->GetNumberOfPolys(), 0);
    EXPECT_EQ(shown->GetOutput()->GetNumberOfLines(), 0);
    faces += shown->GetOutput()->GetNumberOfPolys();
  }
  EXPECT_EQ(faces, filter->GetOutput()->GetNumberOfCells());
  ASSERT_FALSE(curves.empty());
  shown->RemoveAllSurfaces();
  shown->AddSurface(curves[0].c_str());
  shown->AddSurface("Surface 1000");
  shown->Update();
  EXPECT_EQ(shown->GetOutput()->GetNumberOfPolys(), 0);
  EXPECT_EQ(shown->GetOutput()->GetNumberOfLines(), 1);

  shown->RemoveAllSurfaces();
  shown->AddSurface(surfaces[0].c_str());
  shown->Update();
  const double before = shown->GetOutput()->GetPoint(0)[2];
  filter->SetMovingToEverything();
  filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_VECTOR);
  filter->SetVector(0, 0, 0.25);
  filter->Update();
  shown->Update();
  EXPECT_NEAR(shown->GetOutput()->GetPoint(0)[2], before + 0.25, 1e-12);

  shown->SetFilter(nullptr);
  shown->Update();
  EXPECT_EQ(shown->GetOutput()->GetNumberOfCells(), 0);
}

TEST(ListedSurfaces, AMotionIsShownBeforeItIsMade)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->UpdateInformation();
  vtkNew<vtkBoundaryDisplacement> motion; // which has no input
  grids::moveBy(motion, 0, 0, 0.5);
  vtkNew<vtkListedSurfaces> shown;
  shown->SetFilter(filter);
  shown->SetMotion(motion);
  const std::string top =
    displaced::surfaceName(displaced::make(grid), [](const Row& x) { return x[2] == 3; });
  shown->AddSurface(top.c_str());
  shown->Update();
  // Nine faces, and twelve arrows with four sides each, from z = 3 to 3.5.
  EXPECT_EQ(shown->GetOutput()->GetNumberOfPolys(), 9 + 12 * 4);
  EXPECT_EQ(shown->GetOutput()->GetNumberOfLines(), 12);
  double bounds[6];
  shown->GetOutput()->GetCellsBounds(bounds);
  EXPECT_EQ(bounds[4], 3);
  EXPECT_EQ(bounds[5], 3.5);
  EXPECT_EQ(filter->GetPrepareCount(), 0);

  motion->SetVector(0, 0, 0);
  shown->Update();
  EXPECT_EQ(shown->GetOutput()->GetNumberOfCells(), 0);
  motion->SetDisplacementToRadius(); // of a plane: the execution says that it has none
  motion->SetRadiusChange(0.1);
  const grids::Run listener(shown);
  EXPECT_EQ(shown->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_TRUE(listener.Errors.empty());
}
