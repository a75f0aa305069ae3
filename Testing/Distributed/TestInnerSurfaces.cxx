// SPDX-License-Identifier: BSD-3-Clause
// Surfaces inside of a mesh, and those that depend on each other, on random partitions against the
// same filter on the whole mesh.
#include "BoundaryShapes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkCellType.h>
#include <vtkFEMWarpMorph.h>
#include <vtkMorphMesh.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace
{
using grids::Row;
using morph::Index;
using morph::distributed::Ranks;

/// A box of 6 x 4 x 4 cells. `plate`: a baffle, each of its faces twice.
morph::Mesh box()
{
  morph::Mesh mesh = meshes::hexes(6, 4, 4);
  const auto node = [](Index y, Index z) { return 2 + 7 * (y + 5 * z); };
  for (Index k = 0; k < 8; ++k)
  {
    const Index y = k / 2 % 2, z = k / 4;
    meshes::add(mesh, VTK_QUAD, { node(y, z), node(y + 1, z), node(y + 1, z + 1), node(y, z + 1) });
  }
  return mesh;
}

vtkSmartPointer<vtkUnstructuredGrid> named(const morph::Mesh& mesh)
{
  const auto grid = grids::make(mesh);
  grids::markCells(grid, "plate", [](const Row& x) { return x[0] == 2; });
  grids::markCells(grid, "left", [](const Row& x) { return x[0] < 4; });
  grids::markCells(grid, "right", [](const Row& x) { return x[0] > 4; });
  grids::mark(grid, "middle", [](const Row& x) { return x[0] == 4; });
  grids::mark(
    grid, "line", [](const Row& x) { return x[0] == 3 && x[1] == 2 && x[2] > 0 && x[2] < 4; });
  grids::mark(grid, "outlet", [](const Row& x) { return x[0] == 6; });
  grids::mark(grid, "low", [](const Row& x) { return x[1] == 0; });
  grids::mark(grid, "high", [](const Row& x) { return x[1] == 4; });
  grids::mark(grid, "block", [](const Row& x) { return x[0] <= 2 && x[2] >= 3; });
  grids::addTexts(grid, "SurfaceNames", { "plate", "middle", "line", "outlet", "low", "high" });
  return grid;
}

using Configure = std::function<void(vtkMorphMesh*)>;

Configure moves(const char* surface)
{
  return [surface](vtkMorphMesh* filter) { filter->AddSurface(surface); };
}

/// Of a list of names, counts and sizes, or counts of cells and nodes, by threes: those that have
/// no number, which depends on the order of the nodes.
std::vector<std::string> namesAndCounts(vtkStringArray* list)
{
  std::vector<std::string> texts;
  for (vtkIdType i = 0; i + 1 < list->GetNumberOfValues(); i += 3)
  {
    const std::string name = list->GetValue(i);
    if (name.find("Surface ") != 0 && name.find("Curve ") != 0)
    {
      texts.push_back(name + ": " + list->GetValue(i + 1));
    }
  }
  return texts;
}

vtkSmartPointer<vtkMorphMesh> configured(vtkUnstructuredGrid* grid, const Configure& configure)
{
  auto filter = grids::of<vtkMorphMesh>(grid);
  vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  configure(filter);
  grids::moveBy(filter, 0.2, 0.05, 0);
  return filter;
}
}

TEST(RankInnerSurfaces, MoveStayAndAreListedAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = box();
  const auto whole = named(mesh);
  unsigned seed = meshes::seed();
  for (const auto& [name, configure] :
    { std::pair("interface", moves("left | right")), std::pair("nodes", moves("middle")),
      std::pair("baffle", moves("plate")), std::pair("baffle that stays", moves("outlet")),
      std::pair("baffle in a zone", Configure(
                                      [](vtkMorphMesh* filter)
                                      {
                                        filter->AddSurface("plate");
                                        filter->AddFixedZone("block");
                                      })),
      std::pair("baffle that keeps layers", Configure(
                                              [](vtkMorphMesh* filter)
                                              {
                                                filter->AddSurface("plate");
                                                filter->SetKeepLayers(1);
                                              })),
      std::pair("layers up to an interface", Configure(
                                               [](vtkMorphMesh* filter)
                                               {
                                                 filter->AddSurface("outlet");
                                                 filter->AddFixedSurface("left | right");
                                                 filter->SetKeepLayers(3);
                                               })),
      std::pair("periodic sides", Configure(
                                    [](vtkMorphMesh* filter)
                                    {
                                      filter->AddSurface("outlet");
                                      filter->SetPeriodicSurfaces("low = high");
                                    })) })
  {
    SCOPED_TRACE(name);
    auto serial = configured(whole, configure);
    rank_grids::alone([&] { grids::update(serial); });
    auto mine = configured(rank_grids::part(ranks, whole, mesh, ++seed), configure);
    grids::update(mine);
    EXPECT_LT(rank_grids::distance(ranks, vtkUnstructuredGrid::SafeDownCast(mine->GetOutput()),
                vtkUnstructuredGrid::SafeDownCast(serial->GetOutput())),
      1e-9);
    EXPECT_EQ(mine->GetPrescribedPoints(), serial->GetPrescribedPoints());
    EXPECT_EQ(mine->GetZonePoints(), serial->GetZonePoints());
    EXPECT_EQ(namesAndCounts(mine->GetSurfaceSizes()), namesAndCounts(serial->GetSurfaceSizes()));
    EXPECT_EQ(namesAndCounts(mine->GetZoneSizes()), namesAndCounts(serial->GetZoneSizes()));
  }
}

TEST(RankInnerSurfaces, BodiesKeepContactAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh body = meshes::hexes(3, 2, 2);
  const morph::Mesh mesh = shapes::together(body, meshes::shifted(body, { 0, 0, 2.01 }));
  const auto whole = grids::make(mesh);
  grids::mark(whole, "seat", [](const Row& x) { return x[2] == 2; });
  grids::mark(whole, "roof", [](const Row& x) { return x[2] > 4; });
  grids::addTexts(whole, "SurfaceNames", { "seat", "roof" });
  const Configure configure = [](vtkMorphMesh* filter)
  {
    filter->AddSurface("seat");
    filter->AddFixedSurface("roof");
    filter->SetContactDistance(0.02);
  };
  auto serial = configured(whole, configure);
  rank_grids::alone([&] { serial->Update(); });
  auto mine = configured(rank_grids::part(ranks, whole, mesh, meshes::seed()), configure);
  mine->Update();
  EXPECT_LT(rank_grids::distance(ranks, vtkUnstructuredGrid::SafeDownCast(mine->GetOutput()),
              vtkUnstructuredGrid::SafeDownCast(serial->GetOutput())),
    1e-9);
  EXPECT_STREQ(mine->GetContactReport(), serial->GetContactReport());
  EXPECT_STRNE(serial->GetContactReport(), "None");
}

TEST(RankInnerSurfaces, WhatCannotMoveIsOneError)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = box();
  const auto whole = named(mesh);
  const auto filter =
    configured(rank_grids::part(ranks, whole, mesh, meshes::seed()), moves("line"));
  rank_grids::expectOneError(ranks, filter, "a zone holds or moves the nodes of 'line'");
}
