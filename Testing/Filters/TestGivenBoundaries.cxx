// SPDX-License-Identifier: BSD-3-Clause
// Boundaries as other programs give them: with few digits, with gaps, in another order.
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"

#include <vtkCharArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

namespace
{
using grids::Row;

const double NaN = std::numeric_limits<double>::quiet_NaN();

double asSingle(double x)
{
  return static_cast<float>(x);
}

double withSevenDigits(double x)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.7g", x);
  return std::strtod(text, nullptr);
}

/// A grid where coordinates of single precision have steps of 0.5.
vtkSmartPointer<vtkUnstructuredGrid> farGrid()
{
  morph::Mesh mesh = meshes::hexes(4, 4, 4);
  meshes::transform(mesh, [](const Row& x) { return Row(0.1 * x + Row(5e6, 10, 20)); });
  return grids::make(mesh);
}

/// Its boundary as `rounded` leaves it, without RestPosition, after `map`.
vtkSmartPointer<vtkPolyData> rounded(
  vtkUnstructuredGrid* grid, double (*round)(double), int type, const grids::Map& map)
{
  auto boundary = grids::boundary(grid, map);
  boundary->GetPointData()->RemoveArray("RestPosition");
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    double x[3];
    boundary->GetPoint(i, x);
    points->InsertNextPoint(round(x[0]), round(x[1]), round(x[2]));
  }
  boundary->SetPoints(points);
  return boundary;
}

class GivenBoundaries : public testing::Test
{
protected:
  morph::Points Run(vtkUnstructuredGrid* grid, vtkPointSet* boundary)
  {
    this->Filter->SetInputData(grid);
    this->Filter->SetBoundaryData(boundary);
    const grids::Run listener(this->Filter);
    this->Errors = listener.Errors;
    this->Warnings = listener.Warnings;
    return grids::points(this->Filter->GetOutput());
  }
  vtkNew<vtkFEMWarpMorph> Filter;
  std::vector<std::string> Errors, Warnings;
};

bool names(const std::vector<std::string>& messages, const char* text)
{
  return messages.size() == 1 && messages[0].find(text) != std::string::npos;
}
}

TEST_F(GivenBoundaries, RoundingAloneIsNoMotion)
{
  auto grid = farGrid();
  const morph::Points rest = grids::points(grid);
  EXPECT_EQ(this->Run(grid, rounded(grid, asSingle, VTK_FLOAT, grids::same)), rest);
  EXPECT_TRUE(
    names(this->Warnings, "single precision: its coordinates are rounded to steps of 0.5"));
  EXPECT_EQ(this->Run(grid, rounded(grid, asSingle, VTK_DOUBLE, grids::same)), rest);
  EXPECT_TRUE(names(this->Warnings, "single precision"));
  EXPECT_EQ(this->Run(grid, rounded(grid, withSevenDigits, VTK_DOUBLE, grids::same)), rest);
  EXPECT_TRUE(names(this->Warnings, "6 digits: its coordinates are rounded to steps of 10"));
}

TEST_F(GivenBoundaries, WhatMovesByMoreIsMoved)
{
  auto grid = farGrid();
  const auto lift = [](const Row& x) { return Row(x[0], x[1], x[2] + (x[2] > 20.35 ? 0.125 : 0)); };
  const morph::Points moved = this->Run(grid, rounded(grid, asSingle, VTK_FLOAT, lift));
  const morph::Points rest = grids::points(grid);
  for (morph::Index n = 0; n < moved.rows(); ++n)
  {
    if (rest(n, 2) > 20.35 || rest(n, 2) < 20.05)
    {
      EXPECT_EQ(moved(n, 0), rest(n, 0)); // rounded by up to 0.25 in the file
      EXPECT_NEAR(moved(n, 2), rest(n, 2) + (rest(n, 2) > 20.35 ? 0.125 : 0), 2e-6);
    }
  }
  EXPECT_EQ(this->Filter->GetInvertedCells(), 0);
}

TEST_F(GivenBoundaries, RoundingThatDoesNotShowIsNotToldOf)
{
  auto grid = grids::hexes(4);
  EXPECT_EQ(this->Run(grid, rounded(grid, asSingle, VTK_FLOAT, grids::same)), grids::points(grid));
  EXPECT_TRUE(this->Warnings.empty());
  // Few digits that are exact.
  const auto shift = [](const Row& x) { return Row(x + Row(0.25, 0, 0)); };
  const morph::Points moved = this->Run(grid, rounded(grid, asSingle, VTK_DOUBLE, shift));
  EXPECT_NEAR(moved(0, 0), 0.25, 1e-15);
}

TEST_F(GivenBoundaries, PointsWithoutAValueAreFree)
{
  auto grid = grids::hexes(4);
  auto boundary = grids::boundary(grid, grids::same);
  const vtkIdType count = boundary->GetNumberOfPoints();
  morph::Points by = morph::Points::Constant(count, 3, 0.125);
  vtkNew<vtkCharArray> mask;
  mask->SetName("vtkValidPointMask");
  for (vtkIdType i = 0; i < count; ++i)
  {
    by.row(i) *= i % 7 != 0;
    by(i, 1) = i % 7 == 1 ? NaN : by(i, 1);
    mask->InsertNextValue(i % 7 != 0);
  }
  boundary->GetPointData()->AddArray(mask);
  grids::addVectors(boundary, "By", by);
  this->Filter->SetDisplacementArray("By");
  this->Filter->SetTolerance(1e-12);
  const morph::Points moved = this->Run(grid, boundary);
  EXPECT_TRUE(this->Errors.empty());
  ASSERT_EQ(this->Warnings.size(), 2u); // the other: nothing stays
  EXPECT_NE(this->Warnings[0].find("28 of the boundary's 98 points have no displacement"),
    std::string::npos)
    << this->Warnings[0];
  EXPECT_LT((moved.array() - grids::points(grid).array() - 0.125).abs().maxCoeff(), 1e-9);

  mask->FillValue(0);
  boundary->Modified();
  this->Run(grid, boundary);
  EXPECT_TRUE(names(this->Errors, "No point of the boundary has a displacement"));
}

TEST_F(GivenBoundaries, NodesBetweenAFreeCornerAndOneThatStaysDivideTheirEdge)
{
  const morph::Mesh mesh = meshes::quadraticHexes(2, 2, 2, false);
  auto grid = grids::make(mesh);
  std::vector<morph::Index> corners; // of the end at x = 2
  for (morph::Index n = 0; n < 27; ++n)
  {
    if (mesh.points(n, 0) == 2)
    {
      corners.push_back(n);
    }
  }
  auto boundary = grids::cloud(mesh.points(corners, morph::allColumns));
  grids::addIds(boundary, "MorphPointId", corners);
  morph::Points by = morph::Points::Constant(static_cast<morph::Index>(corners.size()), 3, 0.1);
  const morph::Index free = corners.front(); // on the edge at y = z = 0
  by(0, 0) = NaN;
  grids::addVectors(boundary, "By", by);
  this->Filter->SetDisplacementArray("By");
  const morph::Points step = this->Run(grid, boundary) - mesh.points;
  EXPECT_GT(step.row(free).norm(), 1e-3);
  morph::Index middle = 27; // the first one behind the corners
  while (middle < mesh.numberOfNodes() && mesh.points.row(middle) != Row(1.5, 0, 0))
  {
    ++middle;
  }
  ASSERT_LT(middle, mesh.numberOfNodes());
  EXPECT_LT((step.row(middle) - step.row(free) / 2).norm(), 1e-12);
}

TEST_F(GivenBoundaries, NodesWithoutAValueAreFreeInMorphMesh)
{
  auto grid = grids::hexes(4);
  const morph::Points rest = grids::points(grid);
  morph::Points by = morph::Points::Zero(rest.rows(), 3);
  for (morph::Index n = 0; n < rest.rows(); ++n)
  {
    by.row(n) = rest(n, 0) > 3 ? Row(NaN, 0, 0) : Row(0, 0.1 * rest(n, 0), 0);
  }
  grids::addVectors(grid, "By", by);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMovingToEverything();
  filter->SetDisplacementToArray();
  filter->SetDisplacementArray("By");
  const grids::Run listener(filter);
  EXPECT_TRUE(names(listener.Warnings, "25 of the 98 nodes that are to move have no displacement"));
  const morph::Points moved = grids::points(filter->GetOutput());
  for (morph::Index n = 0; n < rest.rows(); ++n)
  {
    if (rest(n, 2) == 0 || rest(n, 0) == 4)
    {
      EXPECT_NEAR(moved(n, 1), rest(n, 1) + 0.1 * rest(n, 0), rest(n, 0) > 3 ? 0.2 : 1e-12);
    }
  }
}

TEST_F(GivenBoundaries, NodesInAnotherOrderAreAnError)
{
  // The whole mesh, as a program writes it whose nodes run along z first.
  const morph::Mesh mesh = meshes::hexes(3, 4, 5);
  std::vector<morph::Index> order;
  for (morph::Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    order.push_back(n / 20 + 6 * (n / 4 % 5 + 5 * (n % 4)));
  }
  auto grid = grids::make(mesh);
  this->Run(grid, grids::make(meshes::renumbered(mesh, order)));
  EXPECT_TRUE(names(this->Errors, "Its nodes come in another order"));
  // The boundary alone, with the ids of the one and the faces of the other.
  auto boundary = grids::boundary(grids::make(meshes::renumbered(mesh, order)), grids::same);
  boundary->GetPointData()->RemoveArray("RestPosition");
  this->Run(grid, boundary);
  EXPECT_TRUE(names(this->Errors, "Its nodes come in another order"));
  // The order of cells does not count.
  morph::Mesh turned = mesh;
  std::reverse_copy(
    mesh.connectivity.begin(), mesh.connectivity.end(), turned.connectivity.begin());
  EXPECT_EQ(this->Run(grid, grids::make(turned)), mesh.points);
  EXPECT_TRUE(this->Errors.empty());
}

TEST_F(GivenBoundaries, AMeshThatNothingHoldsIsToldOf)
{
  auto grid = grids::hexes(4);
  auto boundary = grids::boundary(grid, [](const Row& x) { return Row(x + Row(1, 2, 3)); });
  this->Run(grid, boundary);
  EXPECT_TRUE(this->Warnings.empty()); // all of the boundary moves
  auto filter = grids::of<vtkMorphMesh>(grid);
  grids::moveBy(filter, 0, 0, 0.125);
  filter->AddSurface("Surface 0");
  for (int s = 1; s < 6; ++s)
  {
    filter->AddFreeSurface(("Surface " + std::to_string(s)).c_str());
  }
  const grids::Run listener(filter);
  EXPECT_TRUE(names(listener.Warnings, "Nothing holds the mesh"));
  filter->SetFreeSurfaceStatus("Surface 5", 0);
  filter->AddFixedSurface("Surface 5");
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
}
