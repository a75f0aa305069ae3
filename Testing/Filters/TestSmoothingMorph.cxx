// SPDX-License-Identifier: BSD-3-Clause
// Smoothing is neither linear nor, with its default target, the identity where nothing moves:
// TestMorphFilters.cxx is not for it.
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkSmoothingMorph.h"

#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> jittered(int n)
{
  morph::Mesh mesh = meshes::hexes(n, n, n);
  meshes::jitterInterior(mesh, .15, meshes::seed());
  return grids::make(mesh);
}

double farthest(const morph::Points& a, const morph::Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

/// A deep dent in the top of a box of 6 x 6 x 6.
grids::Row dent(const grids::Row& x)
{
  const double r2 = (x[0] - 3) * (x[0] - 3) + (x[1] - 3) * (x[1] - 3);
  return grids::Row(x[0], x[1], x[2] * (1 - .5 * std::exp(-r2 / 1.5)));
}
}

TEST(SmoothingMorph, PrescribedNodesArriveExactlyAndCellsStayValid)
{
  for (auto& [name, mesh] : meshes::all(4, 4, 4))
  {
    SCOPED_TRACE(name);
    // Middle nodes far from the middle would invert curved cells before they move.
    meshes::jitterInterior(mesh, .04, meshes::seed());
    auto grid = grids::make(mesh);
    auto boundary = grids::boundary(grid, grids::twist);
    auto filter = grids::morphed<vtkSmoothingMorph>(grid, boundary);
    filter->SetScaleFactor(.5);
    filter->Update();
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_GT(filter->GetNewtonSteps(), 0);
    const morph::Points moved = grids::points(filter->GetOutput()), rest = grids::points(grid);
    auto* ids = boundary->GetPointData()->GetArray("MorphPointId");
    for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
    {
      const auto id = static_cast<vtkIdType>(ids->GetComponent(i, 0));
      const Eigen::RowVector3d target(boundary->GetPoint(i));
      EXPECT_LT(
        (moved.row(id) - (rest.row(id) + .5 * (target - rest.row(id)))).cwiseAbs().maxCoeff(),
        1e-14);
    }
  }
}

TEST(SmoothingMorph, NoMotionSmoothsTheIdealAndKeepsTheInitialShapes)
{
  auto grid = jittered(4);
  auto filter = grids::morphed<vtkSmoothingMorph>(grid, grids::boundary(grid, grids::same));
  EXPECT_EQ(filter->GetTargetShape(), vtkSmoothingMorph::TARGET_SHAPE_IDEAL);
  filter->Update();
  // Back to the lattice
  EXPECT_LT(farthest(grids::points(filter->GetOutput()), meshes::hexes(4, 4, 4).points), 1e-3);
  EXPECT_GT(filter->GetMinScaledJacobian(), .999);
  filter->SetTargetShapeToInitial();
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == grids::points(grid));
  EXPECT_EQ(filter->GetPrepareCount(), 1);
}

TEST(SmoothingMorph, OptionsAndCountsAreReported)
{
  auto grid = jittered(5);
  auto filter = grids::morphed<vtkSmoothingMorph>(grid, grids::boundary(grid, grids::twist));
  EXPECT_EQ(filter->GetNewtonSteps(), 0);
  filter->SetIterationLimit(1);
  filter->Update();
  EXPECT_EQ(filter->GetNewtonSteps(), 1);
  EXPECT_EQ(filter->GetSolverIterations(), filter->GetNewtonSteps() + filter->GetUntangleSteps());
  filter->SetIterationLimit(50);
  filter->SetStopMove(1e-6);
  filter->Update();
  EXPECT_GT(filter->GetNewtonSteps(), 1);
  EXPECT_EQ(grids::field(filter->GetOutput(), "NewtonSteps"), filter->GetNewtonSteps());
  EXPECT_EQ(grids::field(filter->GetOutput(), "UntangleSteps"), filter->GetUntangleSteps());
  EXPECT_EQ(grids::field(filter->GetOutput(), "SmoothingPatches"), filter->GetSmoothingPatches());
  EXPECT_EQ(grids::field(filter->GetOutput(), "LinearIterations"), filter->GetLinearIterations());
  EXPECT_EQ(grids::field(filter->GetOutput(), "EnergyEvaluations"), filter->GetEnergyEvaluations());
  EXPECT_EQ(grids::field(filter->GetOutput(), "BoundaryDeterminedCells"),
    filter->GetBoundaryDeterminedCells());
  std::ostringstream text;
  filter->Print(text);
  for (const char* name :
    { "TargetShape: 1", "Objective: 2", "IterationLimit: 50", "StopMove: 1e-06" })
  {
    EXPECT_NE(text.str().find(name), std::string::npos) << name;
  }
}

TEST(SmoothingMorph, TheObjectiveChoosesTheMeasure)
{
  auto grid = jittered(5);
  auto filter = grids::morphed<vtkSmoothingMorph>(grid, grids::boundary(grid, grids::twist));
  EXPECT_EQ(filter->GetObjective(), vtkSmoothingMorph::OBJECTIVE_ADAPTIVE);
  filter->Update();
  const morph::Points adaptive = grids::points(filter->GetOutput());
  ASSERT_GT(filter->GetMinScaledJacobian(), .2); // so no cell is bad
  EXPECT_EQ(filter->GetConditionSteps(), 0);
  filter->SetObjectiveToMeanRatio();
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == adaptive);
  filter->SetObjectiveToConditionNumber();
  filter->Update();
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_GT(filter->GetConditionSteps(), 0);
  EXPECT_EQ(filter->GetConditionSteps(), filter->GetNewtonSteps());
  EXPECT_EQ(grids::field(filter->GetOutput(), "ConditionSteps"), filter->GetConditionSteps());
  EXPECT_GT(farthest(grids::points(filter->GetOutput()), adaptive), 1e-4);
  filter->SetObjective(7);
  EXPECT_EQ(filter->GetObjective(), vtkSmoothingMorph::OBJECTIVE_ADAPTIVE);
}

TEST(SmoothingMorph, ThreadsDoNotShow)
{
  auto grid = jittered(6);
  auto filter = grids::morphed<vtkSmoothingMorph>(grid, grids::boundary(grid, grids::twist));
  filter->SetNumberOfThreads(1);
  filter->Update();
  const morph::Points one = grids::points(filter->GetOutput());
  filter->SetNumberOfThreads(3);
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == one);
}

TEST(PostSmooth, UntanglesWhatTheMethodLeft)
{
  // FEMWARP turns cells inside out here.
  auto grid = grids::hexes(6);
  auto boundary = grids::boundary(grid, dent);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_NONE);
  EXPECT_FALSE(filter->GetPostSmooth());
  filter->Update();
  ASSERT_GT(filter->GetInvertedCells(), 0);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("PostSmoothSteps"), nullptr);
  const morph::Points plain = grids::points(filter->GetOutput());
  filter->PostSmoothOn();
  filter->Update();
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_GT(grids::field(filter->GetOutput(), "PostSmoothSteps"), 0);
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  const morph::Points smoothed = grids::points(filter->GetOutput());
  auto* ids = boundary->GetPointData()->GetArray("MorphPointId");
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    const auto id = static_cast<vtkIdType>(ids->GetComponent(i, 0));
    EXPECT_TRUE(smoothed.row(id) == plain.row(id));
  }
  filter->SetPostSmoothIterations(1);
  filter->Update();
  EXPECT_LE(grids::field(filter->GetOutput(), "PostSmoothSteps"), 21);
  filter->PostSmoothOff();
  filter->Update();
  EXPECT_TRUE(grids::points(filter->GetOutput()) == plain);
}

TEST(PostSmooth, NeverMakesAMeshWorse)
{
  for (auto& [name, mesh] : meshes::all(4, 4, 4))
  {
    SCOPED_TRACE(name);
    meshes::jitterInterior(mesh, .1, meshes::seed());
    auto grid = grids::make(mesh);
    auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::boundary(grid, grids::twist));
    filter->Update();
    const double least = filter->GetMinScaledJacobian();
    const vtkIdType inverted = filter->GetInvertedCells();
    filter->PostSmoothOn();
    filter->Update();
    EXPECT_LE(filter->GetInvertedCells(), inverted);
    if (filter->GetInvertedCells() == inverted)
    {
      EXPECT_GE(filter->GetMinScaledJacobian(), least);
    }
  }
}

TEST(PostSmooth, MidSideNodesFollow)
{
  morph::Mesh mesh = meshes::quadraticTets(3, 3, 3);
  auto grid = grids::make(mesh);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::boundary(grid, grids::twist));
  filter->PostSmoothOn();
  filter->Update();
  ASSERT_GT(grids::field(filter->GetOutput(), "PostSmoothSteps"), 0);
  // Free edges stay straight: their middles are the means of the corners.
  const morph::Points moved = grids::points(filter->GetOutput());
  morph::Monitor monitor;
  const morph::NodePartition partition =
    morph::partitionNodes(mesh, morph::boundaryFaces(mesh, monitor).nodes);
  constexpr int Edges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  morph::Index checked = 0;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::Index* cell = mesh.cell(c);
    for (int e = 0; e < 6; ++e)
    {
      if (std::binary_search(
            partition.higherOrderNodes.begin(), partition.higherOrderNodes.end(), cell[4 + e]))
      {
        const Eigen::RowVector3d middle =
          (moved.row(cell[Edges[e][0]]) + moved.row(cell[Edges[e][1]])) / 2;
        EXPECT_LT((moved.row(cell[4 + e]) - middle).norm(), 1e-12);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 0);
}
