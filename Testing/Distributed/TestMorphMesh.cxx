// SPDX-License-Identifier: BSD-3-Clause
// vtkMorphMesh on random partitions, against the same filter on the whole mesh.
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkTransform.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using morph::Index;
using morph::distributed::Ranks;

using Configure = std::function<void(vtkMorphMesh*)>;

void withFemWarp(vtkMorphMesh* filter)
{
  vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPORT);
}

void turnAndShift(vtkMorphMesh* filter)
{
  filter->AddSurface("Surface 1");
  filter->AddFixedSurface("Surface 3");
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetTranslation(0.1, 0.2, -0.1);
  filter->SetRotation(5, 0, 10);
}

/// The largest distance between the nodes of both outputs, in the size of the mesh.
double difference(vtkUnstructuredGrid* mine, vtkUnstructuredGrid* whole)
{
  double most = 0;
  vtkDataArray* ids = mine->GetPointData()->GetGlobalIds();
  EXPECT_TRUE(ids || mine->GetNumberOfPoints() == 0);
  const morph::Points a = grids::points(mine), b = grids::points(whole);
  for (Index i = 0; i < a.rows(); ++i)
  {
    const auto id = static_cast<Index>(ids->GetComponent(static_cast<vtkIdType>(i), 0));
    most = std::max(most, (a.row(i) - b.row(id)).norm());
  }
  return most / meshes::size(b);
}
}

TEST(RankMorphMesh, MovesSurfacesAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(2, 1.5, 1.5);
  ball->SetRadius(2.4);
  ball->SetThetaResolution(40);
  ball->SetPhiResolution(40);
  ball->Update();
  vtkNew<vtkTransform> turn;
  turn->Translate(0.1, 0.2, -0.1);
  turn->RotateZ(10);
  turn->RotateX(5);
  const std::vector<std::pair<std::string, Configure>> cases = { { "placement", turnAndShift },
    // No rank has all of what moves, and its center.
    { "transform about the center",
      [&](vtkMorphMesh* filter)
      {
        turnAndShift(filter);
        filter->SetDisplacementToTransform();
        filter->SetTransform(turn);
        filter->TransformAboutCenterOn();
      } },
    { "sliding",
      [](vtkMorphMesh* filter)
      {
        filter->AddSurface("Surface 1");
        filter->AddSlidingSurface("Surface 0");
        grids::moveBy(filter, 0.1, 0, 0.2);
      } },
    { "target", [&](vtkMorphMesh* filter)
      {
        filter->AddSurface("Surface 0");
        filter->SetDisplacementToTarget();
        filter->SetTargetData(ball->GetOutput());
        filter->SetTargetReach(1);
        filter->SetTargetAngle(180);
      } } };
  for (auto& [name, mesh] :
    { std::pair("hexes", meshes::hexes(5, 4, 3)), std::pair("tets", meshes::tets(4, 3, 3)),
      std::pair("quadratic", meshes::quadraticTets(3, 2, 2)) })
  {
    for (const auto& [what, configure] : cases)
    {
      SCOPED_TRACE(std::string(name) + ", " + what);
      const auto whole = grids::make(mesh);
      vtkNew<vtkMorphMesh> serial, filter;
      withFemWarp(serial);
      configure(serial);
      serial->SetInputData(whole);
      grids::Listener serialListener(serial);
      rank_grids::alone([&] { serial->Update(); });
      EXPECT_TRUE(serialListener.Errors.empty());
      withFemWarp(filter);
      configure(filter);
      filter->SetInputData(rank_grids::part(ranks, whole, mesh, ++seed));
      grids::update(filter);
      EXPECT_LT(difference(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)),
                  vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0))),
        1e-8);
      EXPECT_STREQ(filter->GetMorphStatus(), serial->GetMorphStatus());
      EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
      EXPECT_EQ(filter->GetInvertedCells(), serial->GetInvertedCells());
      EXPECT_EQ(filter->GetWorstCellId(), serial->GetWorstCellId());
      EXPECT_NEAR(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
      EXPECT_NEAR(filter->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-8);
      if (what == "target")
      {
        EXPECT_GT(serial->GetMaxTargetDistanceBefore(), 0);
        EXPECT_NEAR(
          filter->GetMaxTargetDistanceBefore(), serial->GetMaxTargetDistanceBefore(), 1e-8);
        EXPECT_NEAR(
          filter->GetMeanTargetDistanceBefore(), serial->GetMeanTargetDistanceBefore(), 1e-8);
        EXPECT_NEAR(filter->GetMaxTargetDistance(), serial->GetMaxTargetDistance(), 1e-8);
        EXPECT_NEAR(filter->GetMeanTargetDistance(), serial->GetMeanTargetDistance(), 1e-8);
      }
    }
  }
}

TEST(RankMorphMesh, ReproducesAffineMotions)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::tets(4, 3, 3);
  auto filter = grids::of<vtkMorphMesh>(rank_grids::piece(ranks, mesh));
  filter->SetMovingToEverything();
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetTranslation(1, 2, 3);
  filter->SetRotation(20, 30, 40);
  filter->SetScale(1.2, 0.8, 1.1);
  filter->Update();
  auto serial = grids::of<vtkMorphMesh>(grids::make(mesh));
  serial->SetMovingToEverything();
  serial->SetDisplacementToTranslateRotateScale();
  serial->SetTranslation(1, 2, 3);
  serial->SetRotation(20, 30, 40);
  serial->SetScale(1.2, 0.8, 1.1);
  rank_grids::alone([&] { serial->Update(); });
  EXPECT_LT(difference(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)),
              vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0))),
    1e-10);
}

TEST(RankMorphMesh, ShowsItsSurfacesAndKeepsWhatADragNeeds)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(5, 4, 3);
  const auto piece = rank_grids::piece(ranks, mesh);
  auto filter = grids::of<vtkMorphMesh>(piece);
  const grids::Run listener(filter);
  // Nothing is chosen: the output is the boundary, to look at.
  auto* shown = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(shown->GetNumberOfPoints(), piece->GetNumberOfPoints());
  EXPECT_EQ(ranks.sum(static_cast<Index>(shown->GetNumberOfCells())), 2 * (5 * 4 + 4 * 3 + 3 * 5));
  vtkDataArray* behind = shown->GetCellData()->GetArray("MorphCellId");
  for (vtkIdType c = 0; c < shown->GetNumberOfCells(); ++c)
  {
    EXPECT_LT(behind->GetComponent(c, 0), piece->GetNumberOfCells());
  }
  EXPECT_EQ(filter->GetSurfaceList()->GetNumberOfArrays(), 6 + 12);
  // Nor without a handle, with what is selected on no rank, nor listed, nor connected.
  filter->SetMovingToEverything();
  filter->SetDisplacementToHandles();
  filter->SelectedHandlesOn();
  filter->Update();
  EXPECT_NE(std::string(filter->GetAdvice()).find("Give a handle"), std::string::npos);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors.front();
  filter->SetMovingToSurfaces();

  filter->LiveOn();
  turnAndShift(filter);
  filter->Update();
  const int prepared = filter->GetPrepareCount();
  filter->SetTranslation(0.2, 0.1, 0);
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), prepared);
  EXPECT_TRUE(listener.Errors.empty());
}

TEST(RankMorphMesh, RepairsByDefault)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(5, 4, 3);
  const auto run = [](vtkMorphMesh* filter, vtkUnstructuredGrid* grid)
  {
    filter->SetInputData(grid);
    filter->AddSurface("Surface 1");
    filter->SetSurroundings(vtkBoundaryDisplacement::SURROUNDINGS_STAY);
    grids::moveBy(filter, 0.1, 0, 0.1);
    grids::update(filter);
  };
  vtkNew<vtkMorphMesh> serial, filter;
  rank_grids::alone([&] { run(serial, grids::make(mesh)); });
  run(filter, rank_grids::piece(ranks, mesh));
  EXPECT_EQ(filter->GetValidity(), vtkMorphAlgorithm::VALIDITY_REPAIR);
  EXPECT_STREQ(filter->GetMorphStatus(), serial->GetMorphStatus());
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

TEST(RankMorphMesh, OneErrorEndsAllRanks)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(5, 4, 3);
  const auto piece = rank_grids::piece(ranks, mesh);
  const std::vector<std::pair<std::string, Configure>> cases = {
    { "Surface 77", [](vtkMorphMesh* filter) { filter->AddSurface("Surface 77"); } },
    { "`FixedSurfaces` names",
      [](vtkMorphMesh* filter)
      {
        filter->AddSurface("Surface 1");
        filter->AddFixedSurface("Surface 77");
      } },
    { "names 'a | b'", [](vtkMorphMesh* filter) { filter->AddSurface("a | b"); } },
  };
  for (const auto& [message, configure] : cases)
  {
    SCOPED_TRACE(message);
    vtkNew<vtkMorphMesh> filter;
    configure(filter);
    filter->SetInputData(piece);
    const grids::Run listener(filter);
    EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
    if (!listener.Errors.empty())
    {
      EXPECT_NE(listener.Errors.front().find(message), std::string::npos)
        << listener.Errors.front();
    }
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(grids::points(vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))),
      grids::points(piece));
  }
}

TEST(RankMorphMesh, AnAbortOnOneRankEndsAllWithoutAMessage)
{
  const Ranks ranks = pieces::world();
  const auto piece = rank_grids::piece(ranks, meshes::hexes(5, 4, 3));
  vtkNew<vtkMorphMesh> filter;
  turnAndShift(filter);
  filter->SetInputData(piece);
  rank_grids::abortOnLastRank(ranks, filter);
  grids::update(filter);
  EXPECT_STREQ(filter->GetMorphStatus(), "Cancelled");
}

TEST(RankMorphMesh, MovesAMeshThatOneRankHas)
{
  const Ranks ranks = pieces::world();
  const auto whole = grids::make(meshes::hexes(5, 4, 3));
  vtkNew<vtkMorphMesh> serial, filter;
  turnAndShift(serial);
  serial->SetInputData(whole);
  rank_grids::alone([&] { serial->Update(); });
  turnAndShift(filter);
  vtkNew<vtkUnstructuredGrid> none;
  filter->SetInputData(ranks.rank() == 0 ? whole.Get() : none.Get());
  grids::update(filter);
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  if (ranks.rank() == 0)
  {
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
    EXPECT_EQ(grids::points(output),
      grids::points(vtkUnstructuredGrid::SafeDownCast(serial->GetOutputDataObject(0))));
  }
  else
  {
    EXPECT_EQ(output->GetNumberOfPoints(), 0);
  }
}
