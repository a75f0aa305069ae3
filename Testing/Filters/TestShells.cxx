// SPDX-License-Identifier: BSD-3-Clause
// Curved shells that go to a target, slide along their edges, or run into themselves.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkCylinderSource.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
/// [0, 1]^2 in quadrilaterals, linear or quadratic, moved by `map`.
vtkSmartPointer<vtkUnstructuredGrid> sheet(int n, const grids::Map& map, bool quadratic = false)
{
  const int steps = quadratic ? 2 : 1; // half a cell
  const Index row = steps * n + 1;
  morph::Mesh mesh;
  mesh.points.resize(row * row, 3);
  for (Index i = 0; i < mesh.points.rows(); ++i)
  {
    const double x = static_cast<double>(i / row), y = static_cast<double>(i % row);
    mesh.points.row(i) = map(Row(x, y, 0) / (steps * n));
  }
  for (Index cell = 0; cell < n * n; ++cell)
  {
    const auto at = [&](Index i, Index j)
    { return (cell / n * steps + i) * row + cell % n * steps + j; };
    std::vector<Index> nodes = { at(0, 0), at(steps, 0), at(steps, steps), at(0, steps) };
    if (quadratic)
    {
      nodes.insert(nodes.end(), { at(1, 0), at(2, 1), at(1, 2), at(0, 1) });
    }
    meshes::add(mesh, quadratic ? morph::QuadraticQuad : morph::Quad, nodes);
  }
  return grids::make(mesh);
}

constexpr int Cells = 12, Nodes = Cells + 1; ///< along a side

Row dome(const Row& x)
{
  return { x[0], x[1], x[0] * (1 - x[0]) + 0.5 * x[1] * (1 - x[1]) };
}

/// Names nodes, those of an edge or of a zone.
void name(vtkUnstructuredGrid* grid, const char* edge, const std::function<bool(Index)>& isOn)
{
  vtkNew<vtkDoubleArray> marks;
  marks->SetName(edge);
  for (Index n = 0; n < grid->GetNumberOfPoints(); ++n)
  {
    marks->InsertNextValue(isOn(n));
  }
  grid->GetPointData()->AddArray(marks);
  grids::addTexts(grid, "SurfaceNames", { edge });
}

constexpr double Radius = 2;

vtkSmartPointer<vtkPolyData> cylinder()
{
  vtkNew<vtkCylinderSource> source;
  source->SetRadius(Radius);
  source->SetHeight(9);
  source->SetResolution(96);
  source->CappingOff();
  source->Update();
  return source->GetOutput();
}

/// A wide strip that bends onto the cylinder about the y axis.
Row wide(const Row& x)
{
  return { 2 * x[0] - 1, 4 * x[1] - 2, 2.1 };
}

vtkSmartPointer<vtkMorphMesh> onto(vtkUnstructuredGrid* grid, vtkPolyData* target)
{
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetInputData(grid);
  filter->SetTargetData(target);
  filter->SetDisplacementToTarget();
  return filter;
}

/// The distance from the y axis, from the least to the most.
std::pair<double, double> radii(const Points& points)
{
  Points x = points;
  x.col(1).setZero();
  return { x.rowwise().norm().minCoeff(), x.rowwise().norm().maxCoeff() };
}

/// The distance from an edge with these nodes.
double distanceFrom(const Points& edge, const Row& x)
{
  double nearest = 1;
  for (Index k = 0; k + 1 < edge.rows(); ++k)
  {
    const Row along = edge.row(k + 1) - edge.row(k), from = x - edge.row(k);
    const double part = std::clamp(from.dot(along) / along.squaredNorm(), 0., 1.);
    nearest = std::min(nearest, (from - part * along).norm());
  }
  return nearest;
}
}

TEST(Shells, AWideStripGoesToACylinder)
{
  for (const bool quadratic : { false, true })
  {
    auto grid = sheet(Cells, wide, quadratic);
    auto filter = onto(grid, cylinder());
    grids::updateQuietly(filter);
    EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
    EXPECT_GT(filter->GetMaxTargetDistanceBefore(), 0.3);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_GT(filter->GetMinScaledJacobian(), 0.9);
    EXPECT_EQ(filter->GetPrescribedPoints(), grid->GetNumberOfPoints());
    const auto [least, most] = radii(grids::points(filter->GetOutput()).topRows(Nodes));
    EXPECT_GT(least, Radius * std::cos(M_PI / 96) - 1e-6); // points of the target are single
    EXPECT_LT(most, Radius + 1e-6);
  }
}

TEST(Shells, AClosedOneGoesToItsTarget)
{
  const auto sphere = [](double radius, int resolution)
  {
    vtkNew<vtkSphereSource> source;
    source->SetRadius(radius);
    source->SetThetaResolution(resolution);
    source->SetPhiResolution(resolution);
    source->Update();
    return vtkSmartPointer<vtkPolyData>(source->GetOutput());
  };
  auto shell = sphere(1, 12), target = sphere(1.2, 24);
  auto filter = grids::of<vtkMorphMesh>(shell);
  filter->SetTargetData(target);
  filter->SetDisplacementToTarget();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  grids::update(filter);
  EXPECT_EQ(filter->GetPrescribedPoints(), shell->GetNumberOfPoints());
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

TEST(Shells, EverythingOfAClosedOneAreItsNodes)
{
  vtkNew<vtkSphereSource> source;
  source->Update();
  auto filter = grids::of<vtkMorphMesh>(source->GetOutput());
  filter->SetMovingToEverything();
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetAutoCenter(false);
  filter->SetScale(1, 2, 3);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  grids::update(filter);
  const Points rest = grids::points(source->GetOutput()), x = grids::points(filter->GetOutput());
  for (Index n = 0; n < rest.rows(); ++n)
  {
    EXPECT_EQ(Row(x.row(n)), Row(rest(n, 0), 2 * rest(n, 1), 3 * rest(n, 2)));
  }
}

TEST(Shells, WhatIsWrongWithATargetIsNamedByThePointsOfTheShell)
{
  // The last edge, whose ids come after those of points of no cell, is out of reach.
  auto grid = sheet(
    Cells, [](const Row& x) -> Row { return wide(x) + Row(0.1, 0, 0); }, true);
  auto filter = onto(grid, cylinder());
  filter->SetTargetReach(0.0805);
  filter->SetValidity(vtkMorphAlgorithm::VALIDITY_REPORT); // what stays behind is inverted
  const grids::Run listener(filter);
  ASSERT_GT(listener.Warnings.size(), 0u);
  EXPECT_NE(listener.Warnings[0].find("point ids 600, 601, 602"), std::string::npos)
    << listener.Warnings[0];
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  filter->SetKeepLayers(1);
  filter->Update();
  listener.ExpectError("tick the edges that move");
}

TEST(Shells, OnlyTheEdgesThatAreTickedGoToTheTarget)
{
  auto grid = sheet(Cells, wide);
  name(grid, "Ends", [](Index n) { return n < Nodes || n >= Cells * Nodes; });
  auto filter = onto(grid, cylinder());
  filter->AddSurface("Ends");
  filter->SetSurroundingsToFollow();
  grids::update(filter);
  const Points moved = grids::points(filter->GetOutput());
  EXPECT_GT(radii(moved.topRows(Nodes)).first, Radius * std::cos(M_PI / 96) - 1e-6);
  EXPECT_LT(radii(moved.bottomRows(Nodes)).second, Radius + 1e-6);
  EXPECT_GT(std::abs(radii(moved.middleRows(Nodes, 11 * Nodes)).first - Radius), 0.05);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
}

TEST(Shells, AnEdgeSlidesAlongItsOwnCurve)
{
  // A saddle, whose normals along the lower edge turn, so that this lies in no plane of symmetry.
  auto grid = sheet(12, [](const Row& x)
    { return Row(x[0], x[1], 0.4 * x[0] * x[0] - 0.3 * x[0] * x[1] + x[1] / 10); });
  const auto isLower = [](Index n) { return n % Nodes == 0; };
  name(grid, "Lower", isLower);
  name(grid, "Left", [](Index n) { return n < Nodes; });
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("Left");
  filter->AddSlidingSurface("Lower");
  grids::moveBy(filter, 0.1, 0, 0);
  const grids::Run listener(filter);
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  const Points lower = rest(Eigen::seqN(0, Nodes, Nodes), morph::allColumns);
  for (Index n = 0; n < Nodes * Nodes; n += Nodes)
  {
    EXPECT_LT(distanceFrom(lower, moved.row(n)), 1e-9) << n;
  }
  EXPECT_GT((moved.row(0) - rest.row(0)).norm(), 0.09);
  EXPECT_GT((moved.row(6 * Nodes) - rest.row(6 * Nodes)).norm(), 0.01);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  for (const std::string& warning : listener.Warnings) // which names no images of nodes
  {
    EXPECT_EQ(warning.find("169"), std::string::npos) << warning;
  }
}

TEST(Shells, OneThatRunsIntoItselfIsFound)
{
  // A hairpin: its upper leg goes down towards its end, through the lower one.
  constexpr int Fine = 40;
  auto grid = sheet(Fine,
    [](const Row& x)
    {
      const double Leg = 3, Half = M_PI / 2, s = x[0] * (2 * Leg + Half); // radius 1/2
      const double angle = M_PI * std::clamp((s - Leg) / Half, 0., 1.);
      const double along = std::max({ 0., Leg - s, s - Leg - Half });
      return Row(along - std::sin(angle) / 2, x[1], std::cos(angle) / 2);
    });
  Points motion = Points::Zero(grid->GetNumberOfPoints(), 3);
  for (Index n = 0; n < motion.rows(); ++n)
  {
    motion(n, 2) = static_cast<double>(n / (Fine + 1)) / Fine - 1;
  }
  grids::addVectors(grid, "Motion", motion);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMovingToEverything();
  filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
  filter->SetDisplacementArray("Motion");
  const auto crossing = [&](double scale)
  {
    filter->SetScaleFactor(scale);
    const grids::Run listener(filter);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    const bool isTold = std::any_of(listener.Warnings.begin(), listener.Warnings.end(),
      [](const std::string& text) { return text.find("crosses itself") != std::string::npos; });
    EXPECT_EQ(isTold, filter->GetCrossingFaces() > 0);
    return filter->GetCrossingFaces();
  };
  EXPECT_EQ(crossing(0.3), 0);
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_GT(crossing(1.6), Fine);
  EXPECT_STREQ(filter->GetMorphStatus(), "CrossesItself");
}

TEST(Shells, StepsZonesAndLayersAreAsForSolids)
{
  auto grid = sheet(Cells, dome);
  name(grid, "Left", [](Index n) { return n < Nodes; });
  name(grid, "Plate",
    [](Index n) { return n / Nodes >= 5 && n / Nodes <= 8 && n % Nodes >= 4 && n % Nodes <= 7; });
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface("Left");
  filter->AddRigidZone("Plate");
  filter->SetKeepLayers(2);
  grids::moveBy(filter, -0.1, 0, 0.4);
  filter->SetNumberOfSteps(3);
  filter->SetStepping(vtkMorphAlgorithm::STEPPING_RELATIVE);
  grids::update(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  for (Index n = 0; n < 3 * Nodes; ++n) // the edge and its two layers, but for the other edges
  {
    const bool isInside = n % Nodes > 2 && n % Nodes < Nodes - 3;
    EXPECT_TRUE(!isInside || (moved.row(n) - rest.row(n) - Row(-0.1, 0, 0.4)).norm() < 1e-9) << n;
  }
  const Index corner = 5 * Nodes + 4;
  EXPECT_GT((moved.row(corner) - rest.row(corner)).norm(), 0.05);
  for (const Index n : { corner + 3, corner + 3 * Nodes, corner + 3 * Nodes + 3 })
  {
    EXPECT_NEAR(
      (moved.row(n) - moved.row(corner)).norm(), (rest.row(n) - rest.row(corner)).norm(), 1e-9);
  }
}

TEST(Shells, ComparedMethodsHaveTheQualityOfTheFiltersThemselves)
{
  auto grid = sheet(Cells, dome);
  auto boundary =
    grids::boundary(grid, [](const Row& x) { return Row(x[0], x[1], x[2] + 0.3 * x[0] * x[1]); });
  auto compare = grids::of<vtkCompareMorphMethods>(grid);
  compare->SetBoundaryData(boundary);
  compare->SetNumberOfSteps(1);
  compare->SetSimplexLinear(false);
  compare->SetSimplexNaturalNeighbor(false);
  grids::update(compare);
  const vtkNew<vtkFEMWarpMorph> femwarp;
  const vtkNew<vtkWeightedResidualMorph> residual;
  vtkTable* rows = compare->GetOutput(0);
  int found = 0;
  for (vtkMorphAlgorithm* filter : std::initializer_list<vtkMorphAlgorithm*>{ femwarp, residual })
  {
    filter->SetInputData(grid);
    filter->SetBoundaryData(boundary);
    filter->Update();
    const std::string method = filter == femwarp ? "FEMWARP" : "Weighted residual";
    for (vtkIdType row = 0; row < rows->GetNumberOfRows(); ++row)
    {
      if (rows->GetValueByName(row, "Method").ToString() == method &&
          rows->GetValueByName(row, "Step").ToInt() == 1)
      {
        EXPECT_EQ(rows->GetValueByName(row, "MinScaledJacobian").ToDouble(),
          filter->GetMinScaledJacobian());
        EXPECT_EQ(rows->GetValueByName(row, "InvertedCells").ToInt(), 0);
        ++found;
      }
    }
  }
  EXPECT_EQ(found, 2);
}

TEST(Shells, AShapeIsTheMorphAndGrowsWithItsWeight)
{
  auto grid = sheet(Cells, dome);
  auto boundary =
    grids::boundary(grid, [](const Row& x) { return Row(x[0], x[1], x[2] + 0.3 * x[0] * x[1]); });
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
  morph->Update();
  auto shapes = grids::of<vtkMorphShapes>(grid);
  shapes->AddShapeData(boundary);
  shapes->SetFindValidRanges(false);
  const Points rest = grids::points(grid), whole = grids::points(morph->GetOutput()) - rest;
  EXPECT_GT(whole.col(2).maxCoeff(), 0.29);
  for (const double weight : { 1., 0.5, -0.25 })
  {
    shapes->SetWeight(0, weight);
    shapes->Update();
    const Points moved =
      grids::points(vtkUnstructuredGrid::SafeDownCast(shapes->GetOutputDataObject(0))) - rest;
    EXPECT_LT((moved - weight * whole).cwiseAbs().maxCoeff(), 1e-9) << weight;
  }
}
