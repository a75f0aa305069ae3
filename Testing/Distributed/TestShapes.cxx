// SPDX-License-Identifier: BSD-3-Clause
// vtkMorphShapes on random partitions, against the same filter on the whole mesh.
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFEMWarpMorph.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMorphAdjoint.h>
#include <vtkMorphShapes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
using grids::Row;
using morph::Index;
using morph::distributed::Ranks;

/// Turns the top of a block of height 3 about an axis above it.
Row turned(const Row& x)
{
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Row center(2, 0, 3.5);
  return x[2] > 3 - 1e-9 ? Row((x - center) * R.transpose() + center) : x;
}

Row bulged(const Row& x)
{
  return x[2] < 1e-9 ? Row(x[0], x[1], -0.02 * x[0] * x[1]) : x;
}

vtkSmartPointer<vtkMorphShapes> shapesOf(vtkUnstructuredGrid* grid)
{
  auto filter = vtkSmartPointer<vtkMorphShapes>::New();
  filter->SetInputDataObject(grid);
  for (const auto& map : { grids::Map(turned), grids::Map(bulged), grids::Map(grids::twist) })
  {
    filter->AddShapeData(grids::boundary(grid, map));
  }
  filter->SetMotion(0, vtkMorphShapes::MOTION_AS_ROTATION);
  filter->SetShapeName(0, "turned");
  filter->SetShapeName(1, "bulged");
  filter->SetTolerance(1e-12);
  filter->SetWeight(0, 0.6);
  filter->SetWeight(1, -0.5);
  filter->SetWeight(2, 0.2);
  return filter;
}

vtkUnstructuredGrid* outputOf(vtkMorphShapes* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

/// Near in parts of the value; both may be infinite, or NaN.
void expectNear(double mine, double whole)
{
  if (!std::isfinite(whole))
  {
    EXPECT_EQ(std::isnan(mine), std::isnan(whole));
    EXPECT_EQ(mine > 0, whole > 0);
  }
  else
  {
    EXPECT_NEAR(mine, whole, 1e-6 * std::max(1., std::abs(whole)));
  }
}

void compare(const Ranks& ranks, vtkMorphShapes* filter, vtkMorphShapes* serial)
{
  EXPECT_LT(rank_grids::distance(ranks, outputOf(filter), outputOf(serial)),
    1e-8 * meshes::size(grids::points(outputOf(serial))));
  EXPECT_STREQ(filter->GetMorphStatus(), serial->GetMorphStatus());
  EXPECT_EQ(filter->GetInvertedCells(), serial->GetInvertedCells());
  EXPECT_EQ(filter->GetWorstCellId(), serial->GetWorstCellId());
  EXPECT_EQ(filter->GetPrescribedPoints(), serial->GetPrescribedPoints());
  EXPECT_EQ(filter->GetSurfaceInvertedCells(), serial->GetSurfaceInvertedCells());
  EXPECT_NEAR(filter->GetMinScaledJacobian(), serial->GetMinScaledJacobian(), 1e-8);
  EXPECT_NEAR(filter->GetMeanScaledJacobian(), serial->GetMeanScaledJacobian(), 1e-8);
  expectNear(filter->GetLargestFactor(), serial->GetLargestFactor());
  for (int i = 0; i < serial->GetNumberOfShapes(); ++i)
  {
    expectNear(filter->GetLowestWeight(i), serial->GetLowestWeight(i));
    expectNear(filter->GetHighestWeight(i), serial->GetHighestWeight(i));
    if (!std::isnan(serial->GetHighestWeight(i)))
    {
      EXPECT_EQ(ranks.minimum(filter->GetHighestWeight(i)), filter->GetHighestWeight(i));
      EXPECT_EQ(ranks.maximum(filter->GetHighestWeight(i)), filter->GetHighestWeight(i));
    }
  }
}

morph::Mesh block()
{
  return meshes::hexes(4, 4, 3);
}

vtkSmartPointer<vtkTable> designs()
{
  auto table = vtkSmartPointer<vtkTable>::New();
  const std::pair<const char*, std::vector<double>> columns[] = { { "turned", { 0.1, 9, -0.4 } },
    { "bulged", { 0.3, 0.2, -0.1 } } };
  for (const auto& [name, values] : columns)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    for (const double value : values)
    {
      column->InsertNextValue(value);
    }
    table->AddColumn(column);
  }
  return table;
}

/// The lines of a surface on all ranks, by the global ids of their nodes, ascending.
std::vector<Index> linesOf(const Ranks& ranks, vtkDataObject* data)
{
  auto* surface = vtkPolyData::SafeDownCast(data);
  const std::vector<Index> ids = rank_grids::globalIds(surface, "MorphPointId");
  std::vector<Index> lines;
  vtkNew<vtkIdList> line;
  for (vtkIdType c = 0; c < surface->GetNumberOfLines(); ++c)
  {
    surface->GetCellPoints(c, line);
    const Index a = ids.at(line->GetId(0)), b = ids.at(line->GetId(1));
    lines.push_back(100000 * std::min(a, b) + std::max(a, b));
  }
  lines = ranks.gather(lines);
  std::sort(lines.begin(), lines.end());
  return lines;
}

/// The derivatives of an objective, at each node by its global id.
void addGradient(vtkUnstructuredGrid* grid, const std::vector<Index>& ids)
{
  morph::Points rows(static_cast<Index>(ids.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i)
  {
    const auto t = static_cast<double>(ids[i]);
    rows.row(i) << std::sin(t), std::cos(2 * t), std::sin(3 * t + 1);
  }
  grids::addVectors(grid, "Gradient", rows);
}
}

TEST(RankShapes, AgreeWithOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (auto& [name, mesh] : { std::pair("hexes", block()), std::pair("tets", meshes::tets(4, 4, 3)),
         std::pair("quadratic", meshes::quadraticTets(4, 4, 3)) })
  {
    const auto whole = grids::make(mesh);
    for (const int method : { vtkMorphShapes::METHOD_FEMWARP, vtkMorphShapes::METHOD_LBWARP,
           vtkMorphShapes::METHOD_WEIGHTED_RESIDUAL, vtkMorphShapes::METHOD_RADIAL_BASIS })
    {
      SCOPED_TRACE(std::string(name) + ", method " + std::to_string(method));
      vtkSmartPointer<vtkMorphShapes> serial;
      rank_grids::alone(
        [&]
        {
          serial = shapesOf(whole);
          serial->SetMethod(method);
          serial->Update();
        });
      const auto filter = shapesOf(rank_grids::part(ranks, whole, mesh, ++seed));
      filter->SetMethod(method);
      grids::update(filter);
      compare(ranks, filter, serial);
      EXPECT_TRUE(std::isfinite(serial->GetHighestWeight(0)));
      EXPECT_EQ(filter->GetSolveCount(), 4); // one a shape, and two for the rotation
    }
  }
}

TEST(RankShapes, DragAWeightWithoutASolve)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = block();
  const auto whole = grids::make(mesh);
  const auto filter = shapesOf(rank_grids::part(ranks, whole, mesh, meshes::seed()));
  filter->Update();
  for (const double weight : { 0.1, 0.9, -1.5 })
  {
    filter->SetWeight(0, weight);
    filter->Update();
    vtkSmartPointer<vtkMorphShapes> serial;
    rank_grids::alone(
      [&]
      {
        serial = shapesOf(whole);
        serial->SetWeight(0, weight);
        serial->Update();
      });
    compare(ranks, filter, serial);
  }
  EXPECT_EQ(filter->GetPrepareCount(), 1);
  EXPECT_EQ(filter->GetSolveCount(), 4);
  EXPECT_EQ(filter->GetSolverIterations(), 0);
  // A boundary that is new on one rank is new.
  const auto again = filter->GetInputDataObject(1, 1);
  if (ranks.rank() == 0)
  {
    again->Modified();
  }
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetSolveCount(), 4); // its content is the same
}

TEST(RankShapes, TheirSurfaceIsThatOfTheWholeMesh)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = block();
  const auto filter = shapesOf(rank_grids::part(ranks, grids::make(mesh), mesh, meshes::seed()));
  filter->Update();
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_EQ(ranks.sum(static_cast<Index>(surface->GetNumberOfCells())), 2 * (4 * 4 + 2 * 4 * 3));
  // After an error it is that of the undeformed mesh.
  filter->SetMethod(vtkMorphShapes::METHOD_FEMWARP);
  filter->SetMotion(2, vtkMorphShapes::MOTION_AS_ROTATION);
  const grids::Run listener(filter);
  EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
  EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
  surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_EQ(ranks.sum(static_cast<Index>(surface->GetNumberOfCells())), 2 * (4 * 4 + 2 * 4 * 3));
}

TEST(RankShapes, AndTheMethodsDrawTheFeatureLinesOfOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (auto& [name, mesh] : { std::pair("hexes", block()), std::pair("tets", meshes::tets(4, 4, 3)),
         std::pair("quadratic", meshes::quadraticTets(3, 3, 2)) })
  {
    SCOPED_TRACE(name);
    const auto whole = grids::make(mesh);
    std::vector<Index> expected;
    rank_grids::alone(
      [&]
      {
        const auto serial = shapesOf(whole);
        serial->FeatureLinesOn();
        serial->Update();
        expected = linesOf(Ranks(MPI_COMM_SELF), serial->GetOutputDataObject(2));
      });
    EXPECT_GT(expected.size(), 0u);
    const auto piece = rank_grids::part(ranks, whole, mesh, ++seed);
    const auto filter = shapesOf(piece);
    filter->FeatureLinesOn();
    filter->Update();
    EXPECT_EQ(linesOf(ranks, filter->GetOutputDataObject(2)), expected);
    filter->FeatureLinesOff();
    filter->Update();
    EXPECT_TRUE(linesOf(ranks, filter->GetOutputDataObject(2)).empty());
    auto method = grids::of<vtkFEMWarpMorph>(piece);
    method->SetBoundaryData(grids::boundary(piece, grids::affine));
    method->FeatureLinesOn();
    method->Update();
    EXPECT_EQ(linesOf(ranks, method->GetOutputDataObject(2)), expected);
  }
}

TEST(RankShapes, TakeDesignsThatOneRankHas)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = block();
  const auto whole = grids::make(mesh);
  vtkSmartPointer<vtkMorphShapes> serial;
  const auto filter = shapesOf(rank_grids::part(ranks, whole, mesh, meshes::seed()));
  rank_grids::alone(
    [&]
    {
      serial = shapesOf(whole);
      serial->SetTableData(designs());
    });
  vtkNew<vtkTable> none;
  filter->SetTableData(ranks.rank() == ranks.count() - 1 ? designs().Get() : none.Get());
  for (const double time : { 2., 0., 1. })
  {
    SCOPED_TRACE(time);
    rank_grids::alone([&] { serial->UpdateTimeStep(time); });
    filter->UpdateTimeStep(time);
    compare(ranks, filter, serial);
    EXPECT_STREQ(filter->GetInvertingDesigns(), serial->GetInvertingDesigns());
  }
  EXPECT_STREQ(filter->GetInvertingDesigns(), "1");
  vtkInformation* information = filter->GetOutputInformation(0);
  EXPECT_EQ(information->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 3);
  filter->SetTableData(none);
  filter->Modified(); // on the other ranks
  const grids::Run listener(filter);
  EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
}

TEST(RankShapes, HaveTheDerivativesOfOneRank)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::tets(4, 4, 3);
  const auto whole = grids::make(mesh);
  const auto piece = rank_grids::part(ranks, whole, mesh, meshes::seed());
  std::vector<Index> all(mesh.numberOfNodes());
  for (std::size_t n = 0; n < all.size(); ++n)
  {
    all[n] = static_cast<Index>(n);
  }
  addGradient(whole, all);
  addGradient(piece, rank_grids::globalIds(piece, "GlobalIds"));
  const auto derivatives = [](vtkMorphShapes* shapes, vtkUnstructuredGrid* grid)
  {
    shapes->Update();
    vtkNew<vtkMorphAdjoint> adjoint;
    adjoint->SetMorphShapes(shapes);
    adjoint->SetInputData(grid);
    adjoint->SetGradientArray("Gradient");
    grids::update(adjoint);
    std::vector<double> result(3, 0.);
    vtkDataArray* values = adjoint->GetOutput()->GetFieldData()->GetArray("ShapeGradient");
    for (int i = 0; values && i < 3; ++i)
    {
      result[i] = values->GetComponent(i, 0);
    }
    return result;
  };
  std::vector<double> expected;
  rank_grids::alone([&] { expected = derivatives(shapesOf(whole), whole); });
  const std::vector<double> mine = derivatives(shapesOf(piece), piece);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_GT(std::abs(expected[i]), 1e-3);
    EXPECT_NEAR(mine[i], expected[i], 1e-8);
  }
}

TEST(RankShapes, OneErrorEndsAllRanks)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = block();
  const auto piece = rank_grids::part(ranks, grids::make(mesh), mesh, meshes::seed());
  const auto expectOne = [&](vtkMorphShapes* filter, const std::string& message)
  {
    const grids::Run listener(filter);
    EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), 1);
    if (!listener.Errors.empty())
    {
      EXPECT_NE(listener.Errors[0].find(message), std::string::npos) << listener.Errors[0];
    }
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(grids::points(outputOf(filter)), grids::points(piece));
    vtkNew<vtkDoubleArray> derivatives;
    grids::Listener derived(filter);
    EXPECT_FALSE(filter->ComputeDerivatives(derivatives, derivatives));
  };
  const auto broken = shapesOf(piece);
  if (ranks.rank() == ranks.count() - 1)
  {
    auto* boundary = vtkPolyData::SafeDownCast(broken->GetInputDataObject(1, 1));
    boundary->GetPoints()->SetPoint(0, NAN, 0, 0);
    boundary->Modified();
  }
  expectOne(broken, "Shape 'bulged': ");

  const auto stopped = shapesOf(piece);
  rank_grids::abortOnLastRank(ranks, stopped);
  grids::update(stopped);
  EXPECT_STREQ(stopped->GetMorphStatus(), "Cancelled");
}

TEST(RankShapes, TakeAMeshThatOneRankHas)
{
  const Ranks ranks = pieces::world();
  const auto whole = grids::make(block());
  vtkSmartPointer<vtkMorphShapes> serial;
  rank_grids::alone(
    [&]
    {
      serial = shapesOf(whole);
      serial->Update();
    });
  vtkNew<vtkUnstructuredGrid> none;
  const auto filter = shapesOf(ranks.rank() == 0 ? whole.Get() : none.Get());
  grids::update(filter);
  if (ranks.rank() == 0)
  {
    EXPECT_EQ(grids::points(outputOf(filter)), grids::points(outputOf(serial)));
  }
}
