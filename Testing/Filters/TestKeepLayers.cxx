// SPDX-License-Identifier: BSD-3-Clause
// Layers of cells that vtkMorphMesh keeps on a wall that moves.
#include "TestGrids.h"

#include "../Core/Meshes.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphMesh.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr int Along = 24, Up = 26, Layers = 12;
constexpr double First = 1e-3, Growth = 1.25, Length = 4;

double height(int layer)
{
  return First * (std::pow(Growth, layer) - 1) / (Growth - 1);
}

/// Nodes of the wall, which gets a bump, are marked by `Wall`, and `Bump` is its displacement.
vtkSmartPointer<vtkUnstructuredGrid> channel()
{
  morph::Mesh mesh = meshes::hexes(Along, Up, 3);
  vtkNew<vtkDoubleArray> wall, bump;
  wall->SetName("Wall");
  bump->SetName("Bump");
  bump->SetNumberOfComponents(3);
  for (Index n = 0; n < mesh.points.rows(); ++n)
  {
    Row x = mesh.points.row(n);
    x[0] *= Length / Along;
    x[1] = height(static_cast<int>(std::lround(x[1])));
    x[2] *= 0.2;
    mesh.points.row(n) = x;
    wall->InsertNextValue(x[1] == 0);
    bump->InsertNextTuple3(0, x[1] == 0 ? 0.2 * std::pow(std::sin(M_PI * x[0] / Length), 4) : 0, 0);
  }
  auto grid = grids::make(mesh);
  grid->GetPointData()->AddArray(wall);
  grid->GetPointData()->AddArray(bump);
  return grid;
}
}

TEST(KeepLayers, SurfacesBesideThemFollowThem)
{
  auto grid = channel();
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMoving(vtkMorphMesh::MOVING_ARRAY);
  filter->SetMovingArray("Wall");
  filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
  filter->SetDisplacementArray("Bump");
  filter->SetKeepLayers(Layers);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  grids::update(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_GT(filter->GetMinScaledJacobian(), 0.5);

  // The sides z stay planar, and the layers there keep their heights as those inside do.
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  for (Index n = 0; n < rest.rows(); ++n)
  {
    EXPECT_NEAR(moved(n, 2), rest(n, 2), 1e-9) << n;
    if (rest(n, 1) > 0 && rest(n, 1) <= height(Layers) && rest(n, 0) > 0 && rest(n, 0) < Length)
    {
      const Index below = n - (Along + 1);
      ASSERT_EQ(rest(below, 0), rest(n, 0));
      EXPECT_NEAR(
        (moved.row(n) - moved.row(below)).norm(), (rest.row(n) - rest.row(below)).norm(), 1e-9)
        << n;
    }
  }
}
