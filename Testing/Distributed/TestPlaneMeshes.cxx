// SPDX-License-Identifier: BSD-3-Clause
// Plane meshes and shells on random partitions, against the same filters on one rank.
#include "MorphFilters.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkCellType.h>
#include <vtkFEMWarpMorph.h>
#include <vtkMorphMesh.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using grids::Row;
using morph::Index;
using morph::Points;
using morph::distributed::Ranks;

Row flat(const Row& x)
{
  return { 0.6 * x[0] - 0.48 * x[1], 0.8 * x[0] + 0.36 * x[1], 0.8 * x[1] };
}

using rank_grids::dome, rank_grids::sheet;

Row sheared(const Row& x)
{
  return x + 0.1 * std::sin(2 * x[0]) * flat({ 1, 0.5, 0 });
}

Row stretched(const Row& x)
{
  return x + 0.3 * x[0] * flat({ 1, -0.4, 0 }) + flat({ 2, 1, 0 });
}

Row rolled(const Row& x)
{
  return { x[0], x[1] + 0.1 * x[0] * x[0], x[2] + 0.2 * std::sin(2 * x[0] + x[1]) };
}

class RankPlaneMeshes : public testing::TestWithParam<grids::MorphFilter>
{
protected:
  const Ranks Processes = pieces::world();

  /// Natural neighbors among the sites of front and back depend on rounding: on one rank as much,
  /// where its cells come in another order.
  static double tolerance()
  {
    return GetParam().name == "SimplexNaturalNeighbor" ? 1e-3 : GetParam().linear ? 1e-9 : 1e-7;
  }

  void ExpectSame(const grids::Map& place, const grids::Map& motion) const
  {
    const morph::Mesh mesh = sheet(place);
    const auto whole = grids::make(mesh);
    vtkSmartPointer<vtkMorphAlgorithm> serial;
    std::size_t errors = 0;
    rank_grids::alone(
      [&]
      {
        serial = GetParam().of(whole, motion);
        errors = grids::Run(serial).Errors.size();
      });
    const auto part = rank_grids::part(this->Processes, whole, mesh, meshes::seed());
    auto mine = GetParam().of(part, motion);
    const grids::Run run(mine);
    // Of what cannot be morphed on one rank either, one rank says so.
    ASSERT_EQ(this->Processes.sum(static_cast<Index>(run.Errors.size())), Index(errors));
    EXPECT_LT(
      rank_grids::distance(this->Processes, mine->GetOutput(), serial->GetOutput()), tolerance());
    EXPECT_EQ(mine->GetOutput()->GetNumberOfPoints(), part->GetNumberOfPoints());
    EXPECT_EQ(mine->GetPrescribedPoints(), serial->GetPrescribedPoints());
    EXPECT_EQ(mine->GetInvertedCells(), serial->GetInvertedCells());
    EXPECT_NEAR(mine->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 100 * tolerance());
  }
};

TEST_P(RankPlaneMeshes, MoveInTheirPlaneAsOnOneRank)
{
  this->ExpectSame(flat, sheared);
}

TEST_P(RankPlaneMeshes, LeaveTheirPlaneAsOnOneRank)
{
  this->ExpectSame(flat, rolled);
}

TEST_P(RankPlaneMeshes, CurvedShellsMoveAsOnOneRank)
{
  this->ExpectSame(dome, rolled);
}

TEST_P(RankPlaneMeshes, FollowAffineMotionsExactly)
{
  const auto grid = rank_grids::piece(this->Processes, sheet(flat));
  auto filter = GetParam().of(grid, stretched);
  grids::update(filter);
  const Points moved = grids::points(filter->GetOutput());
  const Points expected = grids::mapped(grids::points(grid), stretched);
  EXPECT_LT((moved - expected).cwiseAbs().sum(), GetParam().linear ? 1e-10 : 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Filters, RankPlaneMeshes, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });
}

TEST(RankPlaneMorphMesh, NamedEdgesZonesAndLayersAreAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  for (const grids::Map& place : { grids::Map(flat), grids::Map(dome) })
  {
    const morph::Mesh mesh = sheet(place);
    const auto whole = grids::make(mesh);
    grids::mark(whole, "Left", [](const Row& x) { return x[0] == 0; });
    const auto configured = [&](vtkUnstructuredGrid* grid)
    {
      auto filter = grids::of<vtkMorphMesh>(grid);
      vtkFEMWarpMorph::SafeDownCast(filter->GetMethodFilter())->SetTolerance(1e-12);
      filter->AddSurface("Surface 0");
      grids::moveBy(filter, 0.05, 0.02, 0);
      filter->SetKeepLayers(1);
      filter->SetNumberOfSteps(2);
      return filter;
    };
    auto serial = configured(whole);
    rank_grids::alone([&] { grids::update(serial); });
    auto mine = configured(rank_grids::part(ranks, whole, mesh, meshes::seed()));
    grids::update(mine);
    EXPECT_LT(rank_grids::distance(ranks, vtkUnstructuredGrid::SafeDownCast(mine->GetOutput()),
                vtkUnstructuredGrid::SafeDownCast(serial->GetOutput())),
      1e-9);
    EXPECT_EQ(mine->GetLayerPoints(), serial->GetLayerPoints());
  }
}

TEST(RankPlaneMorphMesh, PiecesWithoutIdsAreJoinedByTheirPlaces)
{
  // Each rank has a square beside that of the rank before, wound the other way.
  const Ranks ranks = pieces::world();
  morph::Mesh square;
  square.points.resize(4, 3);
  square.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  square.points.col(0).array() += ranks.rank();
  ranks.rank() % 2 == 0 ? meshes::add(square, VTK_QUAD, { 0, 1, 2, 3 })
                        : meshes::add(square, VTK_QUAD, { 3, 2, 1, 0 });
  const auto grid = grids::make(square);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::cloud(grids::mapped(square.points, grids::affine)));
  grids::update(filter);
  EXPECT_EQ(filter->GetPrescribedPoints(), 2 * ranks.count() + 2);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

TEST(RankPlaneMorphMesh, AMoebiusStripAcrossRanksIsOneError)
{
  const Ranks ranks = pieces::world();
  constexpr int Around = 24;
  morph::Mesh strip;
  strip.points.resize(2 * Around, 3);
  for (int k = 0; k < Around; ++k)
  {
    const double angle = 2 * M_PI * k / Around;
    for (int side = 0; side < 2; ++side)
    {
      const double r = 2 + (side - 0.5) * std::cos(angle / 2),
                   h = (side - 0.5) * std::sin(angle / 2);
      strip.points.row(2 * k + side) << r * std::cos(angle), r * std::sin(angle), h;
    }
    const Index a = 2 * k, b = a + 1, c = 2 * ((k + 1) % Around), d = c + 1;
    k + 1 < Around ? meshes::add(strip, VTK_QUAD, { a, c, d, b })
                   : meshes::add(strip, VTK_QUAD, { a, d, c, b });
  }
  const auto grid = rank_grids::piece(ranks, strip);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::cloud(grids::points(grid)));
  rank_grids::expectOneError(ranks, filter, "one side alone");
}

TEST(RankPlaneMorphMesh, APolygonOnOneRankIsOneError)
{
  const Ranks ranks = pieces::world();
  morph::Mesh piece;
  piece.points.resize(5, 3);
  piece.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0.5, 2, 0, 0, 1, 0;
  piece.points.col(0).array() += ranks.rank();
  ranks.rank() == 0 ? meshes::add(piece, VTK_POLYGON, { 0, 1, 2, 3, 4 })
                    : meshes::add(piece, VTK_QUAD, { 0, 1, 2, 4 });
  const auto grid = grids::make(piece);
  auto filter = grids::of<vtkFEMWarpMorph>(grid);
  filter->SetBoundaryData(grids::cloud(piece.points));
  rank_grids::expectOneError(ranks, filter, "has a polygon, cell 0");
}

TEST(RankPlaneMorphMesh, AllNodesOfAShellGoToATarget)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = sheet(dome);
  const auto whole = grids::make(mesh);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(0.5, 0.5, -1.5);
  ball->SetRadius(1.9);
  ball->SetThetaResolution(60);
  ball->SetPhiResolution(60);
  ball->Update();
  const auto configured = [&](vtkUnstructuredGrid* grid)
  {
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->SetDisplacementToTarget();
    filter->SetTargetData(ball->GetOutput());
    filter->SetTargetReach(1);
    return filter;
  };
  auto serial = configured(whole);
  rank_grids::alone([&] { serial->Update(); });
  auto mine = configured(rank_grids::part(ranks, whole, mesh, meshes::seed()));
  mine->Update();
  EXPECT_LT(rank_grids::distance(ranks, vtkUnstructuredGrid::SafeDownCast(mine->GetOutput()),
              vtkUnstructuredGrid::SafeDownCast(serial->GetOutput())),
    1e-9);
}
