// SPDX-License-Identifier: BSD-3-Clause
// Meshes of triangles and quadrilaterals in a plane, through all filters.
#include "AllFilters.h"
#include "BlockGrids.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkFEMWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphMesh.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
constexpr int Rounds = 6, Around = 24;
const Eigen::Matrix3d Turn = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, -3).normalized()).matrix();

/// A map of the plane z = 0, as one of the turned plane.
grids::Map inPlane(const grids::Map& map)
{
  return [map](const Row& x) -> Row { return map(x * Turn) * Turn.transpose(); };
}

Row turnedBy(const Row& x, double angle)
{
  return { std::cos(angle) * x[0] - std::sin(angle) * x[1],
    std::sin(angle) * x[0] + std::cos(angle) * x[1], x[2] };
}

/// A plate with a round hole in a turned plane: quadrilaterals inside, triangles outside, all
/// linear or all quadratic. The nodes of the hole come first.
vtkSmartPointer<vtkUnstructuredGrid> plate(bool quadratic = false)
{
  morph::Mesh mesh;
  const int steps = quadratic ? 2 : 1; // half a cell
  const auto node = [&](int round, int k)
  { return round * steps * Around + (k + steps * Around) % (steps * Around); };
  mesh.points.resize((steps * Rounds + 1) * steps * Around, 3);
  for (int round = 0; round <= steps * Rounds; ++round)
  {
    for (int k = 0; k < steps * Around; ++k)
    {
      const double angle = 2 * M_PI * k / (steps * Around),
                   r = 0.5 + 1.5 * round / (steps * Rounds);
      mesh.points.row(node(round, k)) = Row(r * std::cos(angle), r * std::sin(angle), 0);
    }
  }
  mesh.points = (mesh.points * Turn.transpose()).eval();
  for (int round = 0; round < Rounds; ++round)
  {
    for (int cell = 0; cell < Around; ++cell)
    {
      const auto at = [&](int r, int k) { return node(steps * round + r, steps * cell + k); };
      const Index a = at(0, 0), b = at(steps, 0), c = at(steps, steps), d = at(0, steps);
      if (quadratic && round >= Rounds / 2)
      {
        meshes::add(mesh, morph::QuadraticTriangle, { a, b, c, at(1, 0), at(2, 1), at(1, 1) });
        meshes::add(mesh, morph::QuadraticTriangle, { a, c, d, at(1, 1), at(1, 2), at(0, 1) });
      }
      else if (quadratic)
      {
        meshes::add(
          mesh, morph::QuadraticQuad, { a, b, c, d, at(1, 0), at(2, 1), at(1, 2), at(0, 1) });
      }
      else if (round >= Rounds / 2)
      {
        meshes::add(mesh, morph::Triangle, { a, b, c });
        meshes::add(mesh, morph::Triangle, { a, c, d });
      }
      else
      {
        meshes::add(mesh, morph::Quad, { a, b, c, d });
      }
    }
  }
  return grids::make(mesh);
}

/// The edge of the hole as a line, moved by `map`.
vtkSmartPointer<vtkPolyData> hole(
  vtkUnstructuredGrid* grid, const grids::Map& map, vtkIdType count = Around)
{
  const Points rest = grids::points(grid).topRows(count);
  auto line = vtkSmartPointer<vtkPolyData>::New();
  line->ShallowCopy(grids::cloud(rest));
  grids::addVectors(line, "Motion", grids::mapped(rest, map) - rest);
  vtkNew<vtkCellArray> cells;
  for (vtkIdType k = 0; k < count; ++k)
  {
    const vtkIdType ends[2] = { k, (k + 1) % count };
    cells->InsertNextCell(2, ends);
  }
  line->SetLines(cells);
  return line;
}

/// The points of cells; others are zero.
Points used(vtkUnstructuredGrid* grid)
{
  const Points all = grids::points(grid);
  Points result = Points::Zero(all.rows(), 3);
  const vtkIdType* nodes = nullptr;
  vtkIdType size = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    grid->GetCellPoints(c, size, nodes);
    for (vtkIdType k = 0; k < size; ++k)
    {
      result.row(nodes[k]) = all.row(nodes[k]);
    }
  }
  return result;
}

double outOfPlane(const Points& points)
{
  return (points * Turn).col(2).cwiseAbs().maxCoeff();
}

class PlaneMeshes : public testing::TestWithParam<grids::MorphFilter>
{
};
INSTANTIATE_TEST_SUITE_P(Methods, PlaneMeshes, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });
}

TEST_P(PlaneMeshes, AffineMotionsAreExact)
{
  const auto affine =
    inPlane([](const Row& x) { return Row(1.2 * x[0] + 0.3 * x[1] + 1, 0.9 * x[1] - 2, x[2]); });
  for (const bool quadratic : { false, true })
  {
    auto grid = plate(quadratic);
    auto filter = GetParam().of(grid, affine);
    grids::update(filter);
    const Points moved = used(filter->GetOutput()), rest = used(grid);
    for (Index n = 0; n < rest.rows(); ++n)
    {
      EXPECT_TRUE(rest.row(n).isZero(0) || (moved.row(n) - affine(rest.row(n))).norm() < 1e-12)
        << n;
    }
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), grid->GetCellType(0));
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), grid->GetNumberOfCells());
  }
}

TEST_P(PlaneMeshes, AHoleThatTurnsLeavesAValidMeshInThePlane)
{
  const auto turn = inPlane([](const Row& x) { return turnedBy(x, 0.3); });
  for (const bool quadratic : { false, true })
  {
    auto grid = plate(quadratic);
    auto filter = GetParam().make();
    filter->SetInputData(grid);
    const vtkIdType count = quadratic ? 2 * Around : Around;
    auto line = hole(grid, turn, count);
    filter->SetBoundaryData(line);
    filter->SetDisplacementArray("Motion");
    grids::update(filter);
    const Points moved = grids::points(filter->GetOutput());
    const Points given = grids::mapped(grids::points(line), turn);
    EXPECT_LT((moved.topRows(count) - given).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT(outOfPlane(moved), 1e-14);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_EQ(filter->GetPrescribedPoints(), 2 * count);
  }
}

TEST(PlaneMeshes, AGrowingHoleMovesThePlateHarmonically)
{
  // Each coordinate of the displacement is harmonic: 0.1 (a r + b / r) times the direction.
  constexpr double b = 1 / (1 / 0.5 - 0.5 / 4), a = -b / 4;
  auto grid = plate();
  auto line = hole(grid, [](const Row& x) -> Row { return 1.2 * x; });
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, line);
  filter->SetDisplacementArray("Motion");
  filter->Update();
  const Points rest = grids::points(grid), moved = grids::points(filter->GetOutput());
  for (Index n = 0; n < rest.rows(); ++n)
  {
    const double r = rest.row(n).norm();
    const Row expected = 0.1 * (a + b / (r * r)) * rest.row(n);
    EXPECT_LT((moved.row(n) - rest.row(n) - expected).norm(), 0.003) << n;
  }
}

TEST(PlaneMeshes, AWarpedCopyOfThemIsABoundary)
{
  const auto turn = inPlane([](const Row& x) { return turnedBy(x, 0.3); });
  auto grid = plate();
  const Points turned = grids::mapped(grids::points(grid), turn);
  auto filter = grids::morphed<vtkFEMWarpMorph>(
    grid, grids::cloud(turned)); // without ids: points have the nodes' numbers
  grids::update(filter);
  EXPECT_EQ(filter->GetPrescribedPoints(), 2 * Around);
  EXPECT_LT((grids::points(filter->GetOutput()) - turned).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PlaneMeshes, SolidsMayComeBeforeAndAfterThem)
{
  vtkNew<vtkMorphMesh> filter;
  filter->SetMovingToEverything();
  for (const auto& grid : { grids::hexes(2), plate(), plate(true), grids::hexes(3), plate() })
  {
    filter->SetInputData(grid);
    grids::update(filter);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), grid->GetNumberOfPoints());
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), grid->GetCellType(0));
  }
}

TEST(PlaneMeshes, EveryFilterTakesThem)
{
  const auto turn = inPlane([](const Row& x) { return turnedBy(x, 0.02); });
  auto grid = plate();
  grids::addVectors(grid, "Gradient", Points::Ones(grid->GetNumberOfPoints(), 3));
  for (const grids::AnyFilter& filter : grids::allFilters())
  {
    auto made = filter.connected(grid, grids::boundary(grid, turn));
    SCOPED_TRACE(filter.name);
    grids::update(made);
    if (auto* output = vtkUnstructuredGrid::SafeDownCast(made->GetOutputDataObject(0)))
    {
      EXPECT_EQ(output->GetNumberOfPoints(), grid->GetNumberOfPoints()) << filter.name;
      EXPECT_EQ(output->GetCellType(0), VTK_QUAD) << filter.name;
      EXPECT_LT(outOfPlane(grids::points(output)), 1e-14) << filter.name;
    }
  }
}

TEST(PlaneMeshes, AdjointsAreTheTransposeForALine)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  auto grid = plate();
  const Points rest = grids::points(grid);
  const Points gradient = Points::NullaryExpr(rest.rows(), 3, [&] { return value(random); });
  grids::addVectors(grid, "Gradient", gradient);
  const auto motion = inPlane(
    [](const Row& x) { return Row(x[0] + 0.1 * x[1] * x[1], x[1] + 0.2 * x[0] * x[1], x[2]); });
  auto line = hole(grid, motion);
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, line);
  morph->SetDisplacementArray("Motion");
  morph->SetTolerance(1e-13);
  morph->Update();
  vtkNew<vtkMorphAdjoint> adjoint;
  adjoint->SetMorph(morph);
  adjoint->SetInputData(0, grid);
  adjoint->SetInputData(1, line);
  adjoint->SetGradientArray("Gradient");
  adjoint->Update();
  vtkDataArray* found = vtkPointSet::SafeDownCast(adjoint->GetOutputDataObject(0))
                          ->GetPointData()
                          ->GetArray("MorphGradient");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->GetNumberOfTuples(), Around);
  double sum = 0;
  for (vtkIdType k = 0; k < Around; ++k)
  {
    for (int j = 0; j < 3; ++j)
    {
      sum +=
        found->GetComponent(k, j) * line->GetPointData()->GetArray("Motion")->GetComponent(k, j);
    }
  }
  EXPECT_NEAR(sum, (grids::points(morph->GetOutput()) - rest).cwiseProduct(gradient).sum(), 1e-9);
}

TEST(PlaneMeshes, PolygonalDataAndBlocksAreMorphedAlike)
{
  auto grid = plate();
  const auto moved = [](vtkDataObject* input)
  {
    vtkNew<vtkMorphMesh> filter;
    filter->SetInputDataObject(0, input);
    filter->SetMovingToEverything();
    filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
    filter->SetDisplacementArray("Motion");
    filter->Update();
    return vtkSmartPointer<vtkDataObject>(filter->GetOutputDataObject(0));
  };
  const auto bend = inPlane([](const Row& x) { return Row(x[0] + 0.1 * x[1] * x[1], x[1], x[2]); });
  const Points rest = grids::points(grid);
  grids::addVectors(grid, "Motion", grids::mapped(rest, bend) - rest);
  const Points expected = grids::points(vtkUnstructuredGrid::SafeDownCast(moved(grid)));
  EXPECT_GT((expected - rest).cwiseAbs().maxCoeff(), 0.1);

  vtkNew<vtkPolyData> polygons;
  polygons->SetPoints(grid->GetPoints());
  polygons->SetPolys(grid->GetCells());
  polygons->GetPointData()->ShallowCopy(grid->GetPointData());
  EXPECT_EQ(grids::points(vtkUnstructuredGrid::SafeDownCast(moved(polygons))), expected);

  auto blocks = blocks::multiBlock(blocks::quarters(grid, true));
  for (const auto& [number, x] : blocks::pointsByNumber(moved(blocks)))
  {
    EXPECT_LT((x - expected.row(number - 1000)).norm(), 1e-12)
      << number; // as grids::make() numbers
  }
}

TEST(PlaneMeshes, BlocksShowTheirEdgesWhereNothingMovesYet)
{
  auto blocks = blocks::multiBlock(blocks::quarters(plate(), true));
  auto filter = grids::of<vtkMorphMesh>(blocks);
  filter->Update();
  vtkIdType edges = 0;
  for (const auto& leaf : blocks::leaves(filter->GetOutputDataObject(0)))
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    edges += grid->GetNumberOfCells();
    EXPECT_EQ(grid->GetCellType(0), VTK_LINE);
  }
  EXPECT_EQ(edges, 2 * Around);
}

TEST(PlaneMeshes, StepsZonesAndLayersAreAsForSolids)
{
  auto grid = plate();
  grids::mark(grid, "Ring", [](const Row& x) { return x.norm() < 0.8; });
  grids::mark(grid, "Hole", [](const Row& x) { return x.norm() < 0.55; });
  const Points rest = grids::points(grid);
  const auto turn = inPlane([](const Row& x) { return turnedBy(x, 1.2); });
  grids::addVectors(grid, "Motion", grids::mapped(rest, turn) - rest);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMoving(vtkMorphMesh::MOVING_ARRAY);
  filter->SetMovingArray("Hole");
  filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
  filter->SetDisplacementArray("Motion");
  filter->SetKeepLayers(1);
  filter->SetNumberOfSteps(6);
  filter->SetStepping(vtkMorphAlgorithm::STEPPING_RELATIVE);
  filter->AddRigidZone("Ring");
  grids::update(filter);
  const Points moved = grids::points(filter->GetOutput());
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_LT(outOfPlane(moved), 1e-13);
  // The zone is as it was, turned.
  for (Index n = 0; n < Around; ++n)
  {
    EXPECT_NEAR((moved.row(n) - moved.row(n + Around)).norm(),
      (rest.row(n) - rest.row(n + Around)).norm(), 1e-9);
  }
}

TEST(PlaneMeshes, ABoundaryThatLeavesThePlaneTakesTheMeshAlong)
{
  const auto roll = [](const Row& x) -> Row
  {
    const Row flat = x * Turn;
    return Row(3 * std::sin(flat[0] / 3), flat[1], 3 - 3 * std::cos(flat[0] / 3)) *
           Turn.transpose();
  };
  auto grid = plate();
  const Points rest = grids::points(grid);
  grids::addVectors(grid, "Motion", grids::mapped(rest, roll) - rest);
  for (const int steps : { 1, 3 })
  {
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->SetMovingToEverything();
    filter->SetDisplacement(vtkMorphMesh::DISPLACEMENT_ARRAY);
    filter->SetDisplacementArray("Motion");
    filter->SetSteppingToRelative();
    filter->SetNumberOfSteps(steps);
    filter->UpdateTimeStep(steps);
    const Points moved = grids::points(filter->GetOutput());
    EXPECT_LT((moved - grids::mapped(rest, roll)).cwiseAbs().maxCoeff(), 0.1);
    EXPECT_LT((moved - grids::mapped(rest, roll)).topRows(Around).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
  }
}

namespace
{
/// The plate as a bowl: z = 0.2 r^2 in the turned frame.
vtkSmartPointer<vtkUnstructuredGrid> bowl(bool quadratic = false)
{
  auto grid = plate(quadratic);
  for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n)
  {
    Row x;
    grid->GetPoint(n, x.data());
    x += 0.2 * x.squaredNorm() * Row(0, 0, 1) * Turn.transpose();
    grid->GetPoints()->SetPoint(n, x.data());
  }
  return grid;
}

class CurvedShells : public testing::TestWithParam<grids::MorphFilter>
{
};
INSTANTIATE_TEST_SUITE_P(Methods, CurvedShells, testing::ValuesIn(grids::morphFilters()),
  [](const auto& info) { return info.param.name; });
}

TEST_P(CurvedShells, AffineMotionsAreExactOrTheMethodIsRefused)
{
  const grids::Map affine = [](const Row& x)
  { return Row(1.2 * x[0] + 0.3 * x[1] + 1, 0.9 * x[1] - 2 + 0.1 * x[2], x[2] - 0.2 * x[0]); };
  for (const bool quadratic : { false, true })
  {
    auto grid = bowl(quadratic);
    auto filter = GetParam().of(grid, affine);
    if (GetParam().name.find("Simplex") != std::string::npos)
    {
      grids::expectError(filter, "curved shell encloses none");
      continue;
    }
    grids::update(filter);
    const Points moved = used(filter->GetOutput()), rest = used(grid);
    for (Index n = 0; n < rest.rows(); ++n)
    {
      EXPECT_TRUE(rest.row(n).isZero(0) || (moved.row(n) - affine(rest.row(n))).norm() < 1e-12)
        << n;
    }
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), grid->GetCellType(0));
  }
}

TEST(CurvedShells, EveryFilterTakesThem)
{
  const grids::Map turn = [](const Row& x) { return turnedBy(x, 0.02); };
  auto grid = bowl();
  grids::addVectors(grid, "Gradient", Points::Ones(grid->GetNumberOfPoints(), 3));
  for (const grids::AnyFilter& filter : grids::allFilters())
  {
    if (filter.name.find("Simplex") != std::string::npos)
    {
      continue;
    }
    auto made = filter.connected(grid, grids::boundary(grid, turn));
    SCOPED_TRACE(filter.name);
    grids::update(made);
    if (auto* output = vtkUnstructuredGrid::SafeDownCast(made->GetOutputDataObject(0)))
    {
      EXPECT_EQ(output->GetNumberOfPoints(), grid->GetNumberOfPoints()) << filter.name;
      EXPECT_EQ(output->GetCellType(0), VTK_QUAD) << filter.name;
    }
  }
}
