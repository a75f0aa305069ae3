// SPDX-License-Identifier: BSD-3-Clause
// Zones of vtkBoundaryDisplacement and vtkMorphMesh: frozen, rigid and soft.
#include "BlockGrids.h"
#include "DisplacedBoundaries.h"

#include "Geometry/RotationFit.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkBox.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr int N = 6; // cells a side

/// Nodes of the middle, none on the boundary: a cube of two cells a side.
bool isMiddle(const Row& x)
{
  return ((x.array() - N / 2.).abs() < 1.5).all();
}

/// Whether a cell with this center is between them.
bool isMiddleCell(const Row& x)
{
  return ((x.array() - N / 2.).abs() < 1).all();
}

/// A jittered cube whose nodes and cells of the middle are marked by the arrays `Nodes` and
/// `Cells`.
vtkSmartPointer<vtkUnstructuredGrid> marked()
{
  auto grid = grids::hexes(N);
  grids::mark(grid, "Nodes", isMiddle);
  grids::markCells(grid, "Cells", isMiddleCell);
  return grid;
}

/// Turns and stretches the top, the rest of the boundary follows.
vtkSmartPointer<vtkBoundaryDisplacement> twisted(vtkDataObject* grid)
{
  auto filter = displaced::make(grid);
  filter->SetMovingToRegion();
  vtkNew<vtkBox> top;
  top->SetBounds(-1, N + 1, -1, N + 1, N - 1e-6, N + 1);
  filter->SetRegion(top);
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetRotation(0, 0, 25);
  filter->SetTranslation(0.3, 0, 0.8);
  return filter;
}

Points morphed(
  vtkMorphAlgorithm* method, vtkUnstructuredGrid* grid, vtkBoundaryDisplacement* displacement)
{
  method->SetInputData(grid);
  method->SetBoundaryConnection(displacement->GetOutputPort());
  method->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  grids::update(method);
  return grids::points(method->GetOutput());
}

std::vector<Index> middleNodes(vtkUnstructuredGrid* grid)
{
  return displaced::nodesWhere(grid, isMiddle);
}

/// The largest distance of the rows `ids` from the rigid motion that fits them best.
double offRigid(const Points& rest, const Points& moved, const std::vector<Index>& ids)
{
  const Points from = rest(ids, morph::allColumns), to = moved(ids, morph::allColumns);
  const morph::RigidMotion motion = morph::fitRigidMotion(from, to);
  double off = 0;
  for (Index i = 0; i < from.rows(); ++i)
  {
    off = std::max(off, (motion(from.row(i)) - to.row(i)).norm());
  }
  return off;
}
}

TEST(Zones, FrozenAndRigidOnesKeepTheirShapeUnderEveryMethod)
{
  auto grid = marked();
  const Points rest = grids::points(grid);
  const std::vector<Index> middle = middleNodes(grid);
  ASSERT_EQ(middle.size(), 27u);
  const vtkSmartPointer<vtkMorphAlgorithm> methods[] = { vtkSmartPointer<vtkFEMWarpMorph>::New(),
    vtkSmartPointer<vtkLBWarpMorph>::New(), vtkSmartPointer<vtkWeightedResidualMorph>::New(),
    vtkSmartPointer<vtkSimplexLinearMorph>::New(),
    vtkSmartPointer<vtkSimplexNaturalNeighborMorph>::New(),
    vtkSmartPointer<vtkSmoothingMorph>::New(), vtkSmartPointer<vtkInversionFreeMorph>::New() };
  for (const auto& method : methods)
  {
    SCOPED_TRACE(method->GetClassName());
    auto displacement = twisted(grid);
    const Points without = morphed(method, grid, displacement);
    EXPECT_GT(offRigid(rest, without, middle), 0.01);
    displacement->AddFixedZone("Nodes");
    const Points frozen = morphed(method, grid, displacement);
    EXPECT_EQ(frozen(middle, morph::allColumns), rest(middle, morph::allColumns));
    displacement->RemoveAllFixedZones();
    displacement->AddRigidZone("Cells");
    const Points rigid = morphed(method, grid, displacement);
    EXPECT_LT(offRigid(rest, rigid, middle), 1e-12);
    EXPECT_GT((rigid(middle, morph::allColumns) - rest(middle, morph::allColumns)).norm(), 0.5);
    // The boundary moves as before.
    const std::vector<Index> top =
      displaced::nodesWhere(grid, [](const Row& x) { return x[2] > N - 1e-6; });
    EXPECT_EQ(rigid(top, morph::allColumns), without(top, morph::allColumns));
  }
}

TEST(Zones, AnInnerOneFollowsFemWarpsMeanMotion)
{
  auto grid = marked();
  const Points rest = grids::points(grid);
  vtkNew<vtkFEMWarpMorph> method;
  auto displacement = twisted(grid);
  const Points without = morphed(method, grid, displacement);
  displacement->AddRigidZone("Cells");
  const Points with = morphed(method, grid, displacement);
  // All but the node in the middle are on the zone's edge.
  std::vector<Index> edge = middleNodes(grid);
  edge.erase(std::remove_if(edge.begin(), edge.end(),
               [&](Index n) { return ((rest.row(n).array() - N / 2.).abs() < 0.5).all(); }),
    edge.end());
  ASSERT_EQ(edge.size(), 26u);
  const morph::RigidMotion expected =
    morph::fitRigidMotion(rest(edge, morph::allColumns), without(edge, morph::allColumns));
  for (const Index n : edge)
  {
    EXPECT_LT((expected(rest.row(n)) - with.row(n)).norm(), 1e-8);
  }
}

TEST(Zones, OneOnTheBoundaryTakesTheMotionOfItsNodesThere)
{
  auto grid = grids::hexes(N);
  const Points rest = grids::points(grid);
  auto displacement = twisted(grid);
  vtkNew<vtkBox> box; // two layers of cells below the top
  box->SetBounds(-1, N + 1, -1, N + 1, N - 2.4, N + 1);
  displacement->SetZoneRegion(box);
  displacement->SetZoneRegionType(vtkBoundaryDisplacement::ZONE_RIGID);
  displacement->SetSurroundings(vtkBoundaryDisplacement::SURROUNDINGS_STAY);
  displacement->SetMovingToEverything(); // so all its outer nodes tell the motion
  vtkNew<vtkFEMWarpMorph> method;
  const Points moved = morphed(method, grid, displacement);
  const std::vector<Index> zone =
    displaced::nodesWhere(grid, [](const Row& x) { return x[2] > N - 2.4; });
  EXPECT_LT(offRigid(rest, moved, zone), 1e-12);
  EXPECT_EQ(displacement->GetZonePoints(), static_cast<vtkIdType>(zone.size()));
  // The placement itself is rigid, so that nothing changes against a morph without the zone.
  displacement->SetZoneRegionType(vtkBoundaryDisplacement::ZONE_NONE);
  EXPECT_LT((morphed(method, grid, displacement) - moved).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Zones, ATransformMovesRigidOnes)
{
  auto grid = marked();
  const Points rest = grids::points(grid);
  auto displacement = twisted(grid);
  displacement->AddRigidZone("Nodes");
  vtkNew<vtkTransform> shift;
  shift->Translate(0.2, -0.1, 0.3);
  displacement->SetRigidTransform(shift);
  displacement->SetScaleFactor(0.5);
  vtkNew<vtkFEMWarpMorph> method;
  const Points moved = morphed(method, grid, displacement);
  for (const Index n : middleNodes(grid))
  {
    EXPECT_LT((moved.row(n) - rest.row(n) - Row(0.1, -0.05, 0.15)).norm(), 1e-14);
  }
  shift->Translate(1, 0, 0); // a change inside is one of the filter
  EXPECT_GT((morphed(method, grid, displacement) - moved).norm(), 0.1);
}

TEST(Zones, SelectionsAndBlocksAreZonesToo)
{
  auto grid = marked();
  const Points rest = grids::points(grid);
  const std::vector<Index> middle = middleNodes(grid);
  vtkNew<vtkFEMWarpMorph> method;
  auto byArray = twisted(grid);
  byArray->AddFixedZone("Nodes");
  const Points expected = morphed(method, grid, byArray);
  auto bySelection = twisted(grid);
  bySelection->SetZoneSelectionData(displaced::indices(vtkSelectionNode::POINT, middle));
  bySelection->SetZoneSelectionType(vtkBoundaryDisplacement::ZONE_FIXED);
  EXPECT_EQ(morphed(method, grid, bySelection), expected);

  // Two blocks: the middle's cells, and the others.
  const blocks::Pieces pieces = blocks::cut(
    grid, 2, [](const Row& x) { return isMiddleCell(x) ? 1 : 0; }, true);
  auto multi = blocks::multiBlock(pieces);
  auto mesh = grids::of<vtkMorphMesh>(multi);
  mesh->SetMoving(vtkMorphMesh::MOVING_REGION);
  mesh->SetRegion(byArray->GetRegion());
  mesh->SetDisplacement(vtkMorphMesh::DISPLACEMENT_TRANSLATE_ROTATE_SCALE);
  mesh->SetRotation(0, 0, 25);
  mesh->SetTranslation(0.3, 0, 0.8);
  mesh->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  mesh->AddFixedZone("B");
  grids::update(mesh);
  EXPECT_EQ(mesh->GetZonePoints(), 27);
  // The array `Number` counts from 1000 on.
  for (const auto& [node, x] : blocks::pointsByNumber(mesh->GetOutputDataObject(0)))
  {
    EXPECT_LT((x - expected.row(node - 1000)).norm(), 1e-8) << node;
  }
}

TEST(Zones, AreListedByTheirNamesWithTheirSizes)
{
  auto grid = marked();
  vtkNew<vtkUnsignedCharArray> ghosts; // no zone
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(grid->GetNumberOfCells());
  ghosts->FillValue(0);
  grid->GetCellData()->AddArray(ghosts);
  grids::addTexts(grid, "SurfaceNames", { "Cells", "Nowhere" });
  auto mesh = grids::of<vtkMorphMesh>(grid);
  mesh->UpdateInformation();
  ASSERT_EQ(mesh->GetZoneList()->GetNumberOfArrays(), 2);
  vtkStringArray* sizes = mesh->GetZoneSizes();
  ASSERT_EQ(sizes->GetNumberOfValues(), 6);
  EXPECT_EQ(sizes->GetValue(0) + ":" + sizes->GetValue(1) + ":" + sizes->GetValue(2), "Cells:8:");
  EXPECT_EQ(sizes->GetValue(3) + ":" + sizes->GetValue(4) + ":" + sizes->GetValue(5), "Nodes::27");

  // Of blocks, the last parts of their paths.
  const blocks::Pieces pieces = blocks::cut(
    grid, 2, [](const Row& x) { return isMiddleCell(x) ? 1 : 0; }, false);
  mesh->SetInputDataObject(blocks::multiBlock(pieces));
  mesh->UpdateInformation();
  EXPECT_TRUE(mesh->GetZoneList()->ArrayExists("A"));
  EXPECT_TRUE(mesh->GetZoneList()->ArrayExists("B"));
}

namespace
{
/// A cube whose cells with x above 4 are the zone `Rotor`, and whose top turns by 30 degrees.
vtkSmartPointer<vtkBoundaryDisplacement> withRotor(double scale)
{
  auto grid = grids::make(meshes::hexes(N, N, N));
  grids::markCells(grid, "Rotor", [](const Row& center) { return center[0] > 4; });
  auto filter = twisted(grid);
  filter->SetRotation(0, 0, 30);
  filter->SetTranslation(0, 0, 0);
  filter->SetScale(scale, 1, 1);
  filter->AddRigidZone("Rotor");
  return filter;
}
}

TEST(Zones, ARigidOneTakesItsMotionFromTheNodesThatMove)
{
  auto filter = withRotor(1);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
  for (const std::string& warning : listener.Warnings) // the sides leave their planes
  {
    EXPECT_EQ(warning.find("miss their places"), std::string::npos) << warning;
  }
  const Points rest = displaced::restPositions(filter->GetOutput());
  const Points moved = grids::points(filter->GetOutput());
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (Index i = 0; i < rest.rows(); ++i)
  {
    if (rest(i, 0) >= 4 || rest(i, 2) == N)
    {
      const double x = rest(i, 0) - N / 2., y = rest(i, 1) - N / 2.;
      EXPECT_LT(
        (moved.row(i) - Row(N / 2. + c * x - s * y, N / 2. + s * x + c * y, rest(i, 2))).norm(),
        1e-9)
        << i;
    }
  }
}

TEST(Zones, AWarningSaysHowFarAskedPlacesAreMissed)
{
  auto filter = withRotor(1.5);
  const grids::Run listener(filter);
  ASSERT_FALSE(listener.Warnings.empty());
  // Of the zone's nodes at the top, those at 5 go to 6 on average, as is asked of them.
  const std::string& warning = listener.Warnings.back();
  EXPECT_NE(warning.find("14 nodes that move miss their places by up to 0.5"), std::string::npos)
    << warning;
}

TEST(Zones, SoftOnesGiveWay)
{
  auto grid = marked();
  const Points rest = grids::points(grid);
  auto mesh = grids::of<vtkMorphMesh>(grid);
  mesh->SetMoving(vtkMorphMesh::MOVING_EVERYTHING);
  // A motion without an affine part, which all cells would share.
  const auto bulge = [](const Row& p)
  {
    const Row x = p / N - Row::Constant(0.5);
    return Row(0, 0, 0.5 * std::cos(6 * x[0]) * std::cos(6 * x[1]) * (x[2] > 0));
  };
  grids::addVectors(grid, "Bulge", grids::mapped(rest, bulge));
  mesh->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
  mesh->SetDisplacementArray("Bulge");
  mesh->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  const auto strain = [&]
  {
    mesh->Update();
    const Points moved = grids::points(mesh->GetOutput());
    return offRigid(rest, moved, middleNodes(grid));
  };
  const double before = strain();
  mesh->AddSoftZone("Cells");
  mesh->SetSoftStiffness(1e-3);
  EXPECT_GT(strain(), 1.1 * before);
  mesh->SetSoftStiffness(1);
  EXPECT_NEAR(strain(), before, 1e-7);

  mesh->SetMethod(vtkMorphMesh::METHOD_SIMPLEX_LINEAR);
  grids::expectError(mesh, "no soft zones");
}

TEST(Zones, ErrorsNameWhatIsWrong)
{
  auto grid = marked();
  const auto errorOf = [&](vtkBoundaryDisplacement* filter)
  {
    grids::Listener listener(filter);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    return listener.Errors.size() == 1 ? listener.Errors[0] : std::string();
  };
  auto unknown = twisted(grid);
  unknown->AddFixedZone("Bolt");
  EXPECT_NE(errorOf(unknown).find("The zone 'Bolt' is neither"), std::string::npos);
  grids::addTexts(grid, "SurfaceNames", { "Cells", "Nodes" });
  EXPECT_NE(errorOf(unknown).find("it has Cells, Nodes."), std::string::npos);
  auto empty = twisted(grid);
  vtkNew<vtkBox> far;
  far->SetBounds(100, 101, 0, 1, 0, 1);
  empty->SetZoneRegion(far);
  empty->SetZoneRegionType(vtkBoundaryDisplacement::ZONE_FIXED);
  EXPECT_NE(errorOf(empty).find("has no node"), std::string::npos);
  auto none = twisted(grid);
  none->SetZoneRegionType(vtkBoundaryDisplacement::ZONE_RIGID);
  EXPECT_NE(errorOf(none).find("set `ZoneRegion`"), std::string::npos);
  auto surface = twisted(grids::boundary(grid, [](const Row& x) { return x; }));
  surface->AddFixedZone("Nodes");
  EXPECT_NE(errorOf(surface).find("the input is a surface"), std::string::npos);
}

TEST(Zones, OneThatIsFrozenAndRigidStays)
{
  auto grid = marked();
  for (const char* name : { "All", "Nodes" })
  {
    grids::addNumbers(grid->GetPointData(), "All", grid->GetNumberOfPoints(), 1);
    auto filter = displaced::make(grid);
    grids::moveBy(filter, 0.1, 0, 0);
    filter->AddFixedZone(name);
    filter->AddRigidZone(name);
    grids::update(filter);
    const Points rest = displaced::restPositions(filter->GetOutput());
    const Points moved = grids::points(filter->GetOutput());
    for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); ++i)
    {
      const bool isFrozen = displaced::role(filter->GetOutput(), i) == 5;
      EXPECT_NEAR((moved.row(i) - rest.row(i)).norm(), isFrozen ? 0 : 0.1, 1e-12);
    }
    EXPECT_GT(filter->GetZonePoints(), 0);
  }
}

TEST(Zones, InnerPointsHaveAllArrays)
{
  auto grid = marked();
  auto filter = twisted(grid);
  filter->AddFixedZone("Nodes");
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  const vtkIdType outer = (N + 1) * (N + 1) * (N + 1) - (N - 1) * (N - 1) * (N - 1);
  ASSERT_EQ(output->GetNumberOfPoints(), outer + 27);
  const Points rest = displaced::restPositions(output), moved = grids::points(output);
  for (int a = 0; a < output->GetPointData()->GetNumberOfArrays(); ++a)
  {
    EXPECT_EQ(
      output->GetPointData()->GetAbstractArray(a)->GetNumberOfTuples(), output->GetNumberOfPoints())
      << output->GetPointData()->GetArrayName(a);
  }
  vtkDataArray* ids = output->GetPointData()->GetArray("MorphPointId");
  vtkDataArray* numbers = output->GetPointData()->GetArray("Number");
  vtkDataArray* ofGrid = grid->GetPointData()->GetArray("Number");
  for (vtkIdType i = outer; i < output->GetNumberOfPoints(); ++i)
  {
    EXPECT_EQ(displaced::role(output, i), 5);
    const auto node = static_cast<vtkIdType>(ids->GetComponent(i, 0));
    EXPECT_EQ(numbers->GetComponent(i, 0), ofGrid->GetComponent(node, 0));
    const morph::Points all = grids::points(grid);
    EXPECT_EQ(rest.row(i), all.row(node));
    EXPECT_EQ(rest.row(i), moved.row(i));
  }
  // A second filter behind it keeps them.
  auto second = twisted(output);
  vtkNew<vtkFEMWarpMorph> method;
  const Points twice = morphed(method, grid, second);
  const std::vector<Index> middle = middleNodes(grid);
  EXPECT_EQ(twice(middle, morph::allColumns), grids::points(grid)(middle, morph::allColumns));
}
