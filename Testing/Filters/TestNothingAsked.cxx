// SPDX-License-Identifier: BSD-3-Clause
// Where nothing is asked, nothing moves: no node by a motion of zero, and none by more than 1e-7 of
// the size by one of 1e-9.
#include "TestGrids.h"

#include "vtkMorphAlgorithm.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace
{
/// Meshes far from the origin, so that sums round.
std::vector<std::pair<std::string, morph::Mesh>> bodies()
{
  auto all = meshes::all(3, 3, 3);
  for (auto& [name, mesh] : all)
  {
    meshes::jitterInterior(mesh, 0.1, meshes::seed());
    meshes::transform(mesh, [](const grids::Row& x)
      { return grids::Row(x[0] / 3 + 12.3, x[1] / 7 - 45.6, x[2] / 9 + 78.9); });
  }
  return all;
}

double largestMove(vtkUnstructuredGrid* rest, vtkPointSet* moved)
{
  return (grids::points(moved) - grids::points(rest)).cwiseAbs().maxCoeff() /
         meshes::size(grids::points(rest));
}

/// The kinds of displacement of Morph Mesh that a number can make.
const std::vector<std::pair<std::string, void (*)(vtkMorphMesh*, double)>> Motions = {
  { "Vector", [](vtkMorphMesh* f, double by) { grids::moveBy(f, 0, by, 0); } },
  { "AlongNormals",
    [](vtkMorphMesh* f, double by)
    {
      f->SetDisplacementToAlongNormals();
      f->SetDistance(by);
    } },
  { "Placement",
    [](vtkMorphMesh* f, double by)
    {
      f->SetDisplacementToTranslateRotateScale();
      f->SetRotation(by, 0, by);
      f->SetScale(1, 1, 1 + by);
    } },
  { "Handles",
    [](vtkMorphMesh* f, double by)
    {
      f->SetDisplacementToHandles();
      f->RemoveAllHandles();
      f->AddHandle(12.3, -45.6, 78.9, by, 0, 0, 0);
      f->AddHandle(13.3, -45.2, 79.2, 0, 0, 0, 0);
    } },
  { "Lattice",
    [](vtkMorphMesh* f, double by)
    {
      f->SetDisplacementToLattice();
      f->RemoveAllLatticeDisplacements();
      f->AddLatticeDisplacement(1, 1, 2, 0, by, 0);
    } },
};

class NothingAsked : public testing::TestWithParam<int>
{
};
}

TEST_P(NothingAsked, EveryMethodAndDisplacement)
{
  for (const auto& [body, mesh] : bodies())
  {
    auto grid = grids::make(mesh);
    for (const auto& [motion, ask] : Motions)
    {
      SCOPED_TRACE(body + ", " + motion);
      auto filter = grids::of<vtkMorphMesh>(grid);
      filter->SetMethod(GetParam());
      filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPORT);
      filter->AddSurface("Surface 1");
      for (const double by : { 0., 1e-9 })
      {
        ask(filter, by);
        grids::update(filter);
        // Smoothing improves any mesh, and the inversion-free morph one whose boundary moves.
        const bool improves = GetParam() == vtkMorphMesh::METHOD_SMOOTHING ||
                              (GetParam() == vtkMorphMesh::METHOD_INVERSION_FREE && by > 0);
        if (!improves)
        {
          EXPECT_LE(largestMove(grid, filter->GetOutput()), by == 0 ? 0 : 1e-7) << by;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, NothingAsked,
  testing::Range(int(vtkMorphMesh::METHOD_FEMWARP), int(vtkMorphMesh::METHOD_RADIAL_BASIS) + 1));

TEST(NothingAskedOf, WeightsOfShapes)
{
  for (const auto& [body, mesh] : bodies())
  {
    auto grid = grids::make(mesh);
    auto filter = grids::of<vtkMorphShapes>(grid);
    filter->AddShapeData(grids::boundary(grid, grids::affine));
    filter->AddShapeData(grids::boundary(grid,
      [](const grids::Row& x) { return grids::Row(x[0] + 0.01 * std::sin(x[1]), x[1], x[2]); }));
    for (const double weight : { 0., 1e-9 })
    {
      SCOPED_TRACE(body);
      filter->SetWeight(1, weight);
      grids::update(filter);
      EXPECT_LE(largestMove(grid, filter->GetOutput()), weight == 0 ? 0 : 1e-7);
    }
  }
}

TEST(NothingAskedOf, RepairOfAValidResult)
{
  for (const auto& [body, mesh] : bodies())
  {
    SCOPED_TRACE(body);
    auto grid = grids::make(mesh);
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPAIR);
    filter->AddSurface("Surface 1");
    grids::moveBy(filter, 1e-9, 0, 0);
    filter->Update();
    EXPECT_LE(largestMove(grid, filter->GetOutput()), 1e-7);
  }
}
