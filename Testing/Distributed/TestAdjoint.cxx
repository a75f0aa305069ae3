// SPDX-License-Identifier: BSD-3-Clause
// Morph Adjoint on MPI ranks, against one process and finite differences.
#include "MeshKinds.h"
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "TestGrids.h"

#include <vtkDoubleArray.h>
#include <vtkFEMWarpMorph.h>
#include <vtkLBWarpMorph.h>
#include <vtkMorphAdjoint.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRadialBasisMorph.h>
#include <vtkSmoothingMorph.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace
{
using morph::Index;
using morph::Points;
using morph::distributed::Ranks;

/// Derivatives of an objective at a node, by its global id.
grids::Row slope(Index id)
{
  const auto t = static_cast<double>(id);
  return { std::sin(t), std::cos(2 * t), std::sin(3 * t + 1) };
}

void addGradient(vtkUnstructuredGrid* grid, const std::vector<Index>& ids)
{
  Points rows(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    rows.row(static_cast<Index>(i)) = slope(ids[i]);
  }
  grids::addVectors(grid, "Gradient", rows);
}

Points gradientOf(vtkMorphAlgorithm* filter, vtkUnstructuredGrid* grid, vtkPolyData* boundary)
{
  vtkNew<vtkMorphAdjoint> adjoint;
  adjoint->SetMorph(filter);
  adjoint->SetInputData(grid);
  adjoint->SetBoundaryData(boundary);
  adjoint->SetGradientArray("Gradient");
  grids::update(adjoint);
  vtkDataArray* array = adjoint->GetOutput()->GetPointData()->GetArray("MorphGradient");
  Points result = Points::Zero(boundary->GetNumberOfPoints(), 3);
  for (Index i = 0; array && i < result.rows(); ++i)
  {
    array->GetTuple(i, result.row(i).data());
  }
  return result;
}

void setTolerance(vtkMorphAlgorithm* filter)
{
  if (auto* fem = vtkFEMWarpMorph::SafeDownCast(filter))
  {
    fem->SetTolerance(1e-12);
  }
  if (auto* barrier = vtkLBWarpMorph::SafeDownCast(filter))
  {
    barrier->SetTolerance(1e-12);
  }
}

morph::Mesh block()
{
  morph::Mesh mesh = meshes::quadraticTets(3, 3, 2);
  return mesh;
}

template <typename Filter>
void compare(const Ranks& ranks, const morph::Mesh& whole)
{
  std::map<Index, grids::Row> expected;
  rank_grids::alone(
    [&]
    {
      const auto grid = grids::make(whole);
      std::vector<Index> ids(whole.numberOfNodes());
      for (std::size_t n = 0; n < ids.size(); ++n)
      {
        ids[n] = static_cast<Index>(n);
      }
      addGradient(grid, ids);
      vtkNew<Filter> filter;
      setTolerance(filter);
      filter->SetScaleFactor(0.7);
      const auto boundary = grids::boundary(grid, grids::twist);
      const Points gradient = gradientOf(filter, grid, boundary);
      const std::vector<Index> named = rank_grids::globalIds(boundary, "MorphPointId");
      for (std::size_t i = 0; i < named.size(); ++i)
      {
        expected[named[i]] = gradient.row(static_cast<Index>(i));
      }
    });
  const auto grid = rank_grids::piece(ranks, whole);
  addGradient(grid, rank_grids::globalIds(grid, "GlobalIds"));
  vtkNew<Filter> filter;
  setTolerance(filter);
  filter->SetScaleFactor(0.7);
  const auto boundary = grids::boundary(grid, grids::twist);
  const Points gradient = gradientOf(filter, grid, boundary);
  const std::vector<Index> named = rank_grids::globalIds(boundary, "MorphPointId");
  double largest = 0;
  for (std::size_t i = 0; i < named.size(); ++i)
  {
    // Copies of a point on several ranks all have the node's derivatives.
    largest = std::max(
      largest, (gradient.row(static_cast<Index>(i)) - expected.at(named[i])).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(ranks.maximum(largest), 1e-8) << filter->GetClassName();
  EXPECT_EQ(
    ranks.sum(static_cast<Index>(named.size())) >= static_cast<Index>(expected.size()), true);
}

/// The sum of slope . position over the nodes, each counted once.
double objective(const Ranks& ranks, vtkMorphAlgorithm* filter)
{
  filter->Update();
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  const std::vector<Index> mine = rank_grids::globalIds(output, "GlobalIds");
  std::map<Index, double> copies;
  for (const Index id : ranks.gather(mine))
  {
    ++copies[id];
  }
  double sum = 0;
  for (std::size_t i = 0; i < mine.size(); ++i)
  {
    double x[3];
    output->GetPoint(static_cast<vtkIdType>(i), x);
    sum += slope(mine[i]).dot(grids::Row(x[0], x[1], x[2])) / copies[mine[i]];
  }
  return ranks.sum(sum);
}
}

TEST(RankAdjoint, AgreesWithTheSerialOne)
{
  const Ranks ranks = pieces::world();
  for (const morph::Mesh& mesh : { block(), rank_grids::sheet(rank_grids::dome) })
  {
    compare<vtkFEMWarpMorph>(ranks, mesh);
    compare<vtkLBWarpMorph>(ranks, mesh);
    compare<vtkRadialBasisMorph>(ranks, mesh);
  }
  for (const meshes::Kind& kind : meshes::kinds())
  {
    SCOPED_TRACE(kind.name);
    compare<vtkFEMWarpMorph>(ranks, kind.mesh);
  }
}

TEST(RankAdjoint, AgreesWithFiniteDifferences)
{
  const Ranks ranks = pieces::world();
  const auto grid = rank_grids::piece(ranks, block());
  addGradient(grid, rank_grids::globalIds(grid, "GlobalIds"));
  const auto boundary = grids::boundary(grid, grids::twist);
  const std::vector<Index> named = rank_grids::globalIds(boundary, "MorphPointId");
  vtkNew<vtkLBWarpMorph> filter;
  filter->SetTolerance(1e-12);
  filter->SetInputData(grid);
  const Points gradient = gradientOf(filter, grid, boundary);
  const Points places = grids::points(boundary);
  for (const Index id : { 0, 5, 17 })
  {
    const int axis = static_cast<int>(id % 3);
    const double h = 0.1;
    double values[2], adjoint = 0;
    for (const int side : { 0, 1 })
    {
      Points moved = places;
      for (std::size_t i = 0; i < named.size(); ++i)
      {
        if (named[i] == id)
        {
          moved(static_cast<Index>(i), axis) += side == 0 ? -h : h;
          adjoint = gradient(static_cast<Index>(i), axis);
        }
      }
      vtkNew<vtkPolyData> displaced;
      displaced->ShallowCopy(boundary);
      displaced->SetPoints(grids::cloud(moved)->GetPoints());
      filter->SetBoundaryData(displaced);
      values[side] = objective(ranks, filter);
    }
    const double sign = ranks.minimum(adjoint) < 0 ? -1 : 1; // zero where the rank has no copy
    EXPECT_NEAR(sign * ranks.maximum(sign * adjoint), (values[1] - values[0]) / (2 * h), 1e-7)
      << "node " << id;
  }
}

TEST(RankAdjoint, NamesAMethodThatIsNotLinear)
{
  const Ranks ranks = pieces::world();
  const auto grid = rank_grids::piece(ranks, block());
  addGradient(grid, rank_grids::globalIds(grid, "GlobalIds"));
  vtkNew<vtkSmoothingMorph> smoothing;
  vtkNew<vtkMorphAdjoint> adjoint;
  adjoint->SetMorph(smoothing);
  adjoint->SetInputData(grid);
  adjoint->SetBoundaryData(grids::boundary(grid, grids::twist));
  adjoint->SetGradientArray("Gradient");
  const grids::Run listener(adjoint);
  ASSERT_EQ(listener.Errors.size(), ranks.rank() == 0 ? 1u : 0u);
  if (ranks.rank() == 0)
  {
    EXPECT_NE(listener.Errors[0].find("linear"), std::string::npos) << listener.Errors[0];
  }
}
