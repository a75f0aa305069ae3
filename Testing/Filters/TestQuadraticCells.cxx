// SPDX-License-Identifier: BSD-3-Clause Quadratic cells against VTK's own shape functions, and what
// the filters say of cells that are inverted inside.
#include "../Core/QuadraticCells.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkSmoothingMorph.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace morph;
using quadratic::Cell;
using quadratic::Gradients;
using quadratic::Point;

/// VTK's derivatives, node by node. Its pyramid has InterpolateDerivs() of other functions than
/// InterpolateFunctions(): central differences of the latter, which are exact for polynomials of
/// degree two.
Gradients vtkGradients(std::uint8_t type, vtkGenericCell* cell, const Point& at)
{
  const int nodes = cellShape(type)->numberOfNodes;
  const double xi[3] = { static_cast<double>(at[0]), static_cast<double>(at[1]),
    static_cast<double>(at[2]) };
  Gradients result(nodes, 3);
  if (type != QuadraticPyramid)
  {
    double slopes[3 * CellMap::MostNodes];
    cell->InterpolateDerivs(xi, slopes);
    for (int i = 0; i < nodes; ++i)
    {
      result.row(i) << slopes[i], slopes[nodes + i], slopes[2 * nodes + i];
    }
    return result;
  }
  const auto differences = [&](const double(&x)[3], int j)
  {
    double low[3] = { x[0], x[1], x[2] }, high[3] = { x[0], x[1], x[2] };
    low[j] -= .5;
    high[j] += .5;
    double below[CellMap::MostNodes], above[CellMap::MostNodes];
    cell->InterpolateFunctions(low, below);
    cell->InterpolateFunctions(high, above);
    Eigen::Matrix<long double, Eigen::Dynamic, 1> slope(nodes);
    for (int i = 0; i < nodes; ++i)
    {
      slope[i] = above[i] - below[i];
    }
    return slope;
  };
  result.col(2) = differences(xi, 2);
  for (int j = 0; j < 2; ++j)
  {
    if (xi[2] < 1)
    {
      result.col(j) = differences(xi, j) / (1 - at[2]);
      continue;
    }
    const double low[3] = { xi[0], xi[1], .5 }, high[3] = { xi[0], xi[1], 1.5 };
    result.col(j) = differences(low, j) - differences(high, j);
  }
  return result;
}

/// A brick of 20-node hexahedra with curved edges inside.
vtkSmartPointer<vtkUnstructuredGrid> curvedBrick()
{
  Mesh mesh = meshes::quadraticHexes(4, 4, 4, false);
  meshes::jitterInterior(mesh, .08, meshes::seed());
  Monitor monitor;
  EXPECT_EQ(measureQuality(mesh, mesh.points, {}, {}, monitor).inverted, 0);
  return grids::make(mesh);
}

/// Steep waves along it; FEMWARP turns cells over.
grids::Row waves(const grids::Row& x)
{
  return { x[0], x[1], x[2] + 2.4 * std::sin(M_PI / 2 * x[0]) };
}

/// How many cells have a negative determinant on a dense lattice, by VTK's functions.
vtkIdType sampledInverted(vtkUnstructuredGrid* grid)
{
  const std::uint8_t type = QuadraticHexahedron;
  vtkNew<vtkGenericCell> generic;
  generic->SetCellType(type);
  const quadratic::Sampler sampler(
    type, 10, [&](const Point& at) { return vtkGradients(type, generic, at); });
  vtkIdType count = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    vtkPoints* points = grid->GetCell(c)->GetPoints();
    Cell cell;
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      cell.emplace_back(points->GetPoint(i));
    }
    Point at;
    count += sampler.minimum(cell, at) < 0;
  }
  return count;
}
}

TEST(QuadraticCells, TheMapsAreVTKs)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> uniform(0, 1);
  vtkNew<vtkGenericCell> generic;
  for (const quadratic::Type& type : quadratic::Types)
  {
    SCOPED_TRACE(cellShape(type.type)->name);
    generic->SetCellType(type.type);
    const Cell nodes = quadratic::parametric(type.type);
    ASSERT_EQ(generic->GetNumberOfPoints(), static_cast<vtkIdType>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      EXPECT_EQ(nodes[i], Eigen::Vector3d(generic->GetParametricCoords() + 3 * i)) << i;
    }
    const CellMap& map = *CellMap::find(type.type);
    for (int trial = 0; trial < 200; ++trial)
    {
      const double r = uniform(random), s = uniform(random) * (1 - r);
      const double t = uniform(random) * (type.type == QuadraticTetra ? 1 - r - s : 1);
      const double at[3] = { r, s, trial % 10 == 0 && type.type != QuadraticTetra ? 1 : t };
      const Point point(at[0], at[1], at[2]);
      double weights[CellMap::MostNodes];
      generic->InterpolateFunctions(at, weights);
      const auto expected = quadratic::functions(type.type, point);
      for (Eigen::Index i = 0; i < expected.size(); ++i)
      {
        EXPECT_NEAR(weights[i], static_cast<double>(expected[i]), 1e-14) << "node " << i;
      }
      const Gradients slopes = vtkGradients(type.type, generic, point);
      EXPECT_LT((slopes - quadratic::gradients(type.type, point)).cwiseAbs().maxCoeff(), 1e-13);
      const Cell cell = quadratic::random(type.type, type.amount, random);
      const Eigen::Matrix3d found = map.jacobian(map.derivatives(cell.data()), at);
      EXPECT_LT(
        (found - quadratic::jacobian(cell, slopes).cast<double>()).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

TEST(QuadraticCells, TenThousandOfEachTypeAgainstVTKsFunctions)
{
  vtkNew<vtkGenericCell> generic;
  for (const quadratic::Type& type : quadratic::Types)
  {
    SCOPED_TRACE(cellShape(type.type)->name);
    generic->SetCellType(type.type);
    const int count = 10000;
    std::mt19937 random(meshes::seed() + type.type);
    const quadratic::Sampler sampler(
      type.type, 7, [&](const Point& at) { return vtkGradients(type.type, generic, at); });
    int inverted = 0, undecided = 0;
    for (int i = 0; i < count; ++i)
    {
      const Cell cell = quadratic::random(type.type, type.amount, random);
      const JacobianProof found = proveJacobian(type.type, cell.data());
      if (found.certificate == Certificate::Inverted)
      {
        ++inverted;
        const Point at(found.at[0], found.at[1], found.at[2]);
        ASSERT_LT(quadratic::jacobian(cell, vtkGradients(type.type, generic, at)).determinant(), 0)
          << "cell " << i;
        continue;
      }
      undecided += found.certificate == Certificate::Undecided;
      Point least;
      ASSERT_GT(sampler.minimum(cell, least), 0) << "cell " << i;
      if (i % 100 == 0)
      {
        ASSERT_GT(quadratic::searchedMinimum(type.type, cell, least), 0) << "cell " << i;
      }
    }
    EXPECT_GE(inverted, .3 * count);
    EXPECT_LE(inverted, .7 * count);
    EXPECT_LE(undecided, .01 * count);
    std::printf("%s: %d inverted, %d undecided of %d\n", cellShape(type.type)->name, inverted,
      undecided, count);
  }
}

TEST(QuadraticCells, MorphsThatInvertCellsInsideSaySo)
{
  auto grid = curvedBrick();
  {
    auto filter = grids::morphed<vtkSmoothingMorph>(grid, waves);
    filter->SetValidityToNone();
    filter->CertifyOn();
    filter->Update();
    const vtkIdType inverted = filter->GetInvertedCells();
    EXPECT_GT(inverted, 0);
    EXPECT_EQ(inverted, sampledInverted(filter->GetOutput()));
    EXPECT_EQ(filter->GetUncertifiedCells(), inverted);
    EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
    EXPECT_LT(filter->GetMinScaledJacobian(), 0);
    auto* bad = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
    EXPECT_EQ(bad->GetNumberOfCells(), inverted);

    auto measure = grids::of<vtkScaledJacobian>(filter->GetOutput());
    measure->CertifyOn();
    measure->Update();
    EXPECT_EQ(measure->GetInvertedCells(), inverted);
    EXPECT_EQ(measure->GetUncertifiedCells(), inverted);
    EXPECT_EQ(measure->GetUndecidedCells(), 0);

    filter->SetValidityToRefuse();
    const grids::Run listener(filter);
    EXPECT_EQ(listener.Errors.size(), 1u);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
  }
}

TEST(QuadraticCells, InversionFreeMovesMiddleNodesUntilNoneIsInvertedInside)
{
  auto grid = curvedBrick();
  auto filter = grids::morphed<vtkInversionFreeMorph>(grid, waves);
  filter->CertifyOn();
  filter->Update();
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_EQ(sampledInverted(filter->GetOutput()), 0);
  EXPECT_EQ(filter->GetUncertifiedCells(), 0);
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  EXPECT_GT(filter->GetMinScaledJacobian(), 0);
}

TEST(QuadraticCells, SubStepsAndRepairLeaveNoneInvertedInside)
{
  auto grid = curvedBrick();
  for (const int mode :
    { vtkMorphAlgorithm::VALIDITY_SUB_STEP, vtkMorphAlgorithm::VALIDITY_REPAIR })
  {
    SCOPED_TRACE(mode);
    auto filter = grids::morphed<vtkFEMWarpMorph>(grid, waves);
    filter->SetValidity(mode);
    const grids::Run listener(filter);
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetInvertedCells(), 0);
    EXPECT_EQ(sampledInverted(filter->GetOutput()), 0);
    if (mode == vtkMorphAlgorithm::VALIDITY_REPAIR)
    {
      // Middle nodes move where no moved corner helps.
      EXPECT_STREQ(filter->GetMorphStatus(), "Repaired");
      EXPECT_EQ(filter->GetLargestValidStep(), 1);
      continue;
    }
    EXPECT_STREQ(filter->GetMorphStatus(), "Partial");
    EXPECT_GT(filter->GetLargestValidStep(), 0);
    EXPECT_LT(filter->GetLargestValidStep(), 1);
  }
}
