// SPDX-License-Identifier: BSD-3-Clause
// Zones, KeepLayers and SlideRounds on random partitions, against the same filter on one rank.
#include "Meshes.h"
#include "Octree.h"
#include "Pieces.h"
#include "PolyhedralMeshes.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkBox.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTransform.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace
{
using grids::Row;
using morph::Index;
using morph::distributed::Ranks;

using Configure = std::function<void(vtkMorphMesh*)>;
using Case = std::pair<std::string, Configure>;

void addArray(
  vtkDataSetAttributes* data, const char* name, const morph::Points& at, bool (*isIn)(const Row&))
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (Index i = 0; i < at.rows(); ++i)
  {
    array->InsertNextValue(isIn(at.row(i)));
  }
  data->AddArray(array);
}

morph::Points centers(const morph::Mesh& mesh)
{
  morph::Points result = morph::Points::Zero(mesh.numberOfCells(), 3);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; k < mesh.cellSize(c); ++k)
    {
      result.row(c) += mesh.points.row(mesh.cell(c)[k]) / static_cast<double>(mesh.cellSize(c));
    }
  }
  return result;
}

constexpr double Height = 6;

/// The box [0, 6]^3 with a wall, z = 0, that gets a bump, and with arrays that mark zones.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(const morph::Mesh& mesh)
{
  auto grid = grids::make(mesh);
  vtkNew<vtkDoubleArray> bump;
  bump->SetName("Bump");
  bump->SetNumberOfComponents(3);
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const Row x = mesh.points.row(n);
    const double s = std::sin(M_PI * x[0] / Height) * std::sin(M_PI * x[1] / Height);
    const bool moves = x[2] == 0;
    bump->InsertNextTuple3(moves ? 0.2 * s * s : 0, 0, moves ? 0.5 * s * s * (1 + 0.1 * x[0]) : 0);
  }
  vtkPointData* points = grid->GetPointData();
  points->AddArray(bump);
  addArray(points, "Wall", mesh.points, [](const Row& x) { return x[2] == 0; });
  addArray(points, "Clamp", mesh.points, [](const Row& x) { return x[0] >= 4.5 && x[2] > 0; });
  addArray(points, "Empty", mesh.points, [](const Row&) { return false; });
  const morph::Points at = centers(mesh);
  addArray(grid->GetCellData(), "Blade", at,
    [](const Row& x)
    { return std::abs(x[0] - 3) < 1 && std::abs(x[1] - 3) < 1 && std::abs(x[2] - 2.5) < 1; });
  addArray(grid->GetCellData(), "Foot", at,
    [](const Row& x) { return std::abs(x[0] - 2) < 1 && std::abs(x[1] - 2) < 1 && x[2] < 2; });
  addArray(grid->GetCellData(), "Left", at, [](const Row& x) { return x[0] < 3; });
  return grid;
}

void bump(vtkMorphMesh* filter)
{
  vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPORT);
  filter->SetMoving(vtkMorphMesh::MOVING_ARRAY);
  filter->SetMovingArray("Wall");
  filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
  filter->SetDisplacementArray("Bump");
}

/// Compares a filter on ranks with one on one process.
void compare(const Ranks& ranks, const std::string& name, const morph::Mesh& mesh,
  const Configure& configure, unsigned seed)
{
  SCOPED_TRACE(name);
  const auto whole = gridOf(mesh);
  vtkNew<vtkMorphMesh> serial, filter;
  bump(serial);
  configure(serial);
  serial->SetInputData(whole);
  grids::Listener serialListener(serial);
  rank_grids::alone([&] { serial->Update(); });
  ASSERT_TRUE(serialListener.Errors.empty()) << serialListener.Errors.front();
  bump(filter);
  configure(filter);
  const auto part = rank_grids::part(ranks, whole, mesh, seed);
  filter->SetInputData(part);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  auto* expected = vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0));
  EXPECT_LT(rank_grids::distance(ranks, output, expected), 1e-8 * Height);
  EXPECT_STREQ(filter->GetMorphStatus(), serial->GetMorphStatus());
  EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
  EXPECT_EQ(filter->GetUnmatchedPoints(), serial->GetUnmatchedPoints());
  EXPECT_EQ(filter->GetInvertedCells(), serial->GetInvertedCells());
  EXPECT_NEAR(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
  EXPECT_EQ(listener.Warnings.size(), ranks.rank() == 0 ? serialListener.Warnings.size() : 0);
  for (const char* array : { "SlideChange", "SlideForce" })
  {
    vtkDataArray* theirs = expected->GetFieldData()->GetArray(array);
    vtkDataArray* mine = output->GetFieldData()->GetArray(array);
    ASSERT_EQ(mine != nullptr, theirs != nullptr);
    ASSERT_EQ(mine ? mine->GetNumberOfTuples() : 0, theirs ? theirs->GetNumberOfTuples() : 0);
    EXPECT_EQ(mine != nullptr, filter->GetSlideRounds() > 0);
    EXPECT_TRUE(!mine || mine->GetNumberOfTuples() > 0);
    for (vtkIdType i = 0; mine && i < mine->GetNumberOfTuples(); ++i)
    {
      EXPECT_NEAR(mine->GetComponent(i, 0), theirs->GetComponent(i, 0), 1e-6);
    }
  }
}

std::vector<Case> zones()
{
  const auto named = [](const char* what, const char* array)
  {
    return [what = std::string(what), array](vtkMorphMesh* filter)
    {
      what == "frozen"  ? filter->AddFixedZone(array)
      : what == "rigid" ? filter->AddRigidZone(array)
                        : filter->AddSoftZone(array);
    };
  };
  const auto region = [](int type)
  {
    return [type](vtkMorphMesh* filter)
    {
      vtkNew<vtkBox> box;
      box->SetBounds(1.5, 3.5, 1.5, 4.5, 1.5, 7);
      filter->SetZoneRegion(box);
      filter->SetZoneRegionType(type);
    };
  };
  return { { "frozen cells inside", named("frozen", "Blade") },
    { "frozen cells on the wall", named("frozen", "Foot") },
    { "frozen nodes at a side", named("frozen", "Clamp") },
    { "a frozen region", region(vtkMorphMesh::ZONE_FIXED) },
    { "rigid cells inside", named("rigid", "Blade") },
    { "rigid cells on the wall", named("rigid", "Foot") },
    { "rigid nodes at a side", named("rigid", "Clamp") },
    { "a rigid region", region(vtkMorphMesh::ZONE_RIGID) },
    { "a rigid zone with a transform",
      [](vtkMorphMesh* filter)
      {
        vtkNew<vtkTransform> turn;
        turn->Translate(0.1, 0, 0.2);
        turn->RotateY(3);
        filter->SetRigidTransform(turn);
        filter->AddRigidZone("Blade");
        filter->AddRigidZone("Foot");
      } },
    { "soft cells", named("soft", "Blade") }, { "soft nodes", named("soft", "Clamp") },
    { "a soft region", region(vtkMorphMesh::ZONE_SOFT) },
    { "one of each", [](vtkMorphMesh* filter)
      {
        filter->AddFixedZone("Clamp");
        filter->AddRigidZone("Foot");
        filter->AddRigidZone("Blade");
        filter->AddSoftZone("Left");
      } } };
}

std::vector<std::pair<std::string, morph::Mesh>> meshesOfBox()
{
  std::vector<std::pair<std::string, morph::Mesh>> all = { { "hexes", meshes::hexes(6, 6, 6) },
    { "wedges", meshes::wedges(6, 6, 6) }, { "tets", meshes::tets(6, 6, 6) } };
  for (auto& [name, mesh] : all)
  {
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
  }
  morph::Mesh quadratic = meshes::quadraticHexes(3, 3, 3, false);
  quadratic.points *= 2;
  all.emplace_back("quadratic", quadratic);
  return all;
}

/// The box with polyhedra above hexahedra.
morph::Mesh polyhedraAbove()
{
  morph::Mesh mesh = meshes::hexes(6, 6, 6);
  const morph::Points at = centers(mesh);
  mesh = meshes::asPolyhedra(mesh, [&](Index cell) { return at(cell, 2) > 2; });
  meshes::jitterInterior(mesh, 0.1, meshes::seed());
  return mesh;
}
}

TEST(RankZones, AgreeWithTheSerialOnes)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (const auto& [name, mesh] : meshesOfBox())
  {
    for (const auto& [what, configure] : zones())
    {
      compare(ranks, name + ", " + what, mesh, configure, ++seed);
    }
  }
}

TEST(RankZones, AndLayersOfPolyhedraAgreeWithTheSerialOnes)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = polyhedraAbove();
  unsigned seed = meshes::seed();
  for (const auto& [what, configure] : zones())
  {
    compare(ranks, what, mesh, configure, ++seed);
  }
  compare(
    ranks, "two layers", mesh, [](vtkMorphMesh* filter) { filter->SetKeepLayers(2); }, ++seed);
}

TEST(RankZones, SelectionsAreOfEachRanksPiece)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(6, 6, 6);
  const auto whole = gridOf(mesh);
  const auto select = [](vtkUnstructuredGrid* grid, bool byCells)
  {
    vtkDataArray* marks =
      byCells ? grid->GetCellData()->GetArray("Foot") : grid->GetPointData()->GetArray("Clamp");
    vtkNew<vtkIdTypeArray> ids;
    for (vtkIdType i = 0; marks && i < marks->GetNumberOfTuples(); ++i)
    {
      if (marks->GetComponent(i, 0) != 0)
      {
        ids->InsertNextValue(i);
      }
    }
    vtkNew<vtkSelectionNode> node;
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetFieldType(byCells ? vtkSelectionNode::CELL : vtkSelectionNode::POINT);
    node->SetSelectionList(ids);
    vtkNew<vtkSelection> selection;
    if (ids->GetNumberOfValues() > 0)
    {
      selection->AddNode(node);
    }
    return vtkSmartPointer<vtkSelection>(selection);
  };
  for (const int type : { vtkMorphMesh::ZONE_FIXED, vtkMorphMesh::ZONE_SOFT })
  {
    for (const bool byCells : { false, true })
    {
      const auto configure = [&](vtkMorphMesh* filter, vtkUnstructuredGrid* grid)
      {
        bump(filter);
        filter->SetZoneSelectionType(type);
        filter->SetZoneSelectionData(select(grid, byCells));
        filter->SetInputData(grid);
      };
      vtkNew<vtkMorphMesh> serial, filter;
      configure(serial, whole);
      rank_grids::alone([&] { serial->Update(); });
      configure(filter, rank_grids::part(ranks, whole, mesh, meshes::seed()));
      grids::update(filter);
      EXPECT_LT(rank_grids::distance(ranks,
                  vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)),
                  vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0))),
        1e-8 * Height);
      EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
    }
  }
}

TEST(RankKeepLayers, AgreeWithTheSerialOnes)
{
  const Ranks ranks = pieces::world();
  const std::vector<Case> cases = { { "one layer",
                                      [](vtkMorphMesh* filter) { filter->SetKeepLayers(1); } },
    { "three layers", [](vtkMorphMesh* filter) { filter->SetKeepLayers(3); } },
    { "all layers", [](vtkMorphMesh* filter) { filter->SetKeepLayers(100); } },
    { "layers of some cells",
      [](vtkMorphMesh* filter)
      {
        filter->SetKeepLayers(3);
        filter->SetLayersArray("Left");
      } },
    { "layers and zones", [](vtkMorphMesh* filter)
      {
        filter->SetKeepLayers(2);
        filter->AddRigidZone("Blade");
        filter->AddFixedZone("Clamp");
      } } };
  unsigned seed = meshes::seed();
  for (const auto& [name, mesh] : meshesOfBox())
  {
    for (const auto& [what, configure] : cases)
    {
      if (name == "hexes" || name == "wedges")
      {
        compare(ranks, name + ", " + what, mesh, configure, ++seed);
      }
    }
  }
}

TEST(RankSlideRounds, AgreeWithTheSerialOnes)
{
  const Ranks ranks = pieces::world();
  const auto slide = [](vtkMorphMesh* filter)
  {
    filter->SetSurroundings(vtkMorphMesh::SURROUNDINGS_STAY);
    for (const char* name : { "Surface 1", "Surface 2", "Surface 3" })
    {
      filter->AddSlidingSurface(name);
    }
    filter->SetSlideRounds(3);
  };
  const std::vector<Case> cases = { { "sliding", slide },
    { "sliding with zones and layers", [&](vtkMorphMesh* filter)
      {
        slide(filter);
        filter->AddFixedZone("Clamp");
        filter->AddRigidZone("Blade");
      } } };
  unsigned seed = meshes::seed();
  std::vector<std::pair<std::string, morph::Mesh>> boxes = meshesOfBox();
  boxes.emplace_back("polyhedra", polyhedraAbove());
  boxes.emplace_back("octree", meshes::Octree(seed, 1, { 3, 3, 3 }).mesh);
  boxes.back().second.points *= 2;
  for (const auto& [name, mesh] : boxes)
  {
    for (const auto& [what, configure] : cases)
    {
      compare(ranks, name + ", " + what, mesh, configure, ++seed);
    }
  }
}

TEST(RankZones, CountsAndOutputsAreThoseOfTheWholeMesh)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(6, 6, 6);
  const auto whole = gridOf(mesh);
  const auto run = [](vtkBoundaryDisplacement* filter, vtkUnstructuredGrid* grid)
  {
    filter->SetInputData(grid);
    filter->SetMoving(vtkBoundaryDisplacement::MOVING_ARRAY);
    filter->SetMovingArray("Wall");
    filter->SetDisplacement(vtkBoundaryDisplacement::DISPLACEMENT_ARRAY);
    filter->SetDisplacementArray("Bump");
    filter->SetKeepLayers(2);
    filter->AddRigidZone("Blade");
    filter->AddFixedZone("Clamp");
    filter->Update();
  };
  vtkNew<vtkBoundaryDisplacement> serial, filter;
  rank_grids::alone([&] { run(serial, whole); });
  run(filter, rank_grids::part(ranks, whole, mesh, meshes::seed()));
  EXPECT_GT(serial->GetZonePoints(), 0);
  EXPECT_GT(serial->GetLayerPoints(), 0);
  EXPECT_EQ(filter->GetMovingPoints(), serial->GetMovingPoints());
  EXPECT_EQ(filter->GetFixedPoints(), serial->GetFixedPoints());
  EXPECT_EQ(filter->GetFollowingPoints(), serial->GetFollowingPoints());
  EXPECT_EQ(filter->GetZonePoints(), serial->GetZonePoints());
  EXPECT_EQ(filter->GetLayerPoints(), serial->GetLayerPoints());

  // Inner nodes are on one rank each, by their global ids, with the values of the serial output.
  const auto rows = [](vtkPolyData* data)
  {
    std::vector<std::array<double, 8>> result;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      const auto value = [&](const char* name, int j)
      { return data->GetPointData()->GetArray(name)->GetComponent(i, j); };
      const double* x = data->GetPoint(i);
      if (value("GeometryDimension", 0) == 3)
      {
        result.push_back({ value("MorphPointId", 0), x[0], x[1], x[2], value("RestPosition", 0),
          value("Role", 0), value("Number", 0), value("BoundaryDisplacement", 2) });
      }
    }
    return result;
  };
  std::vector<std::array<double, 8>> mine = ranks.gather(rows(filter->GetOutput())),
                                     expected = rows(serial->GetOutput());
  std::sort(mine.begin(), mine.end());
  std::sort(expected.begin(), expected.end());
  ASSERT_EQ(mine.size(), expected.size());
  for (std::size_t i = 0; i < mine.size(); ++i)
  {
    for (std::size_t j = 0; j < mine[i].size(); ++j)
    {
      EXPECT_NEAR(mine[i][j], expected[i][j], 1e-8 * Height) << i << ' ' << j;
    }
  }
}

TEST(RankZones, OneErrorEndsAllRanks)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh hexes = meshes::hexes(6, 6, 6), tets = meshes::tets(6, 6, 6);
  const std::vector<std::tuple<std::string, const morph::Mesh*, Configure>> cases = {
    { "The zone 'Nowhere' is neither", &hexes,
      [](vtkMorphMesh* filter) { filter->AddFixedZone("Nowhere"); } },
    { "The zone 'Empty' has no node", &hexes,
      [](vtkMorphMesh* filter) { filter->AddRigidZone("Empty"); } },
    { "The zone 'Empty' has no node", &hexes,
      [](vtkMorphMesh* filter) { filter->AddSoftZone("Empty"); } },
    { "No region is given", &hexes,
      [](vtkMorphMesh* filter) { filter->SetZoneRegionType(vtkMorphMesh::ZONE_FIXED); } },
    { "There are no layers to keep", &tets,
      [](vtkMorphMesh* filter) { filter->SetKeepLayers(2); } },
    { "`LayersArray` names 'Nowhere'", &hexes,
      [](vtkMorphMesh* filter)
      {
        filter->SetKeepLayers(2);
        filter->SetLayersArray("Nowhere");
      } },
  };
  for (const auto& [message, mesh, configure] : cases)
  {
    SCOPED_TRACE(message);
    vtkNew<vtkMorphMesh> filter;
    bump(filter);
    configure(filter);
    filter->SetInputData(rank_grids::part(ranks, gridOf(*mesh), *mesh, meshes::seed()));
    const grids::Run listener(filter);
    EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
    if (!listener.Errors.empty())
    {
      EXPECT_NE(listener.Errors.front().find(message), std::string::npos)
        << listener.Errors.front();
    }
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  }
}
