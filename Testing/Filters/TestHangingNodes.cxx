// SPDX-License-Identifier: BSD-3-Clause
// Filters on meshes with hanging nodes: shapes, derivatives, steps and Compare leave no gap,
// either.
#include "DisplacedBoundaries.h"
#include "Geometry/RotationFit.h"
#include "MorphFilters.h"
#include "Octree.h"
#include "TestGrids.h"

#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"

#include <vtkNew.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using grids::Row;
using morph::Index;
using morph::Points;

class HangingNodesOfFilters : public testing::TestWithParam<int>
{
protected:
  const meshes::Octree Octree{ meshes::seed(), this->GetParam() };
  const vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::make(this->Octree.mesh);
  const double Size = meshes::size(this->Octree.mesh.points);
};

/// Not affine, so that nodes that hang are asked to leave their edges.
Row bulged(const Row& x)
{
  return x + Row(0.02 * x[1], 0.1 * x[2], 0.03 * x[2] * std::sin(2 * x[0]));
}

/// Where FEMWARP takes the mesh.
Points morphedBy(vtkUnstructuredGrid* grid, const grids::Map& map)
{
  vtkNew<vtkFEMWarpMorph> morph;
  morph->SetTolerance(1e-12);
  morph->SetInputData(grid);
  morph->SetBoundaryData(grids::boundary(grid, map));
  morph->Update();
  return grids::points(morph->GetOutput());
}
}

TEST_P(HangingNodesOfFilters, FollowShapesAsAMorph)
{
  auto shapes = grids::of<vtkMorphShapes>(this->Grid);
  shapes->AddShapeData(grids::boundary(this->Grid, bulged));
  shapes->AddShapeData(grids::boundary(this->Grid, grids::affine));
  shapes->SetTolerance(1e-12);
  shapes->SetWeight(0, 0.5);
  shapes->SetWeight(1, 0.2);
  grids::expectWarning(shapes, "they hang on faces");
  const Points moved = grids::points(shapes->GetOutput());
  const Points expected = morphedBy(this->Grid,
    [](const Row& x) -> Row { return x + .5 * (bulged(x) - x) + .2 * (grids::affine(x) - x); });
  EXPECT_LT((moved - expected).cwiseAbs().maxCoeff(), 1e-9 * this->Size);
  EXPECT_LT(this->Octree.gap(moved), 1e-12 * this->Size);
  EXPECT_STREQ(shapes->GetMorphStatus(), "Valid");
}

TEST_P(HangingNodesOfFilters, TakeARigidZoneAlongAsFemWarpDoes)
{
  const auto isZone = [](const Row& x) {
    return x[2] == 1 && (x.array() >= 1 && x.array() <= 2 && x.array() == x.array().round()).all();
  };
  grids::mark(this->Grid, "Zone", isZone);
  const Points rest = grids::points(this->Grid);
  grids::addVectors(this->Grid, "Bulge", grids::mapped(rest, bulged) - rest);
  auto filter = grids::of<vtkMorphMesh>(this->Grid);
  filter->SetMovingToEverything();
  filter->SetDisplacementToArray();
  filter->SetDisplacementArray("Bulge");
  filter->AddRigidZone("Zone");

  grids::expectWarning(filter, "they hang on faces");

  const std::vector<Index> zone = displaced::nodesWhere(this->Grid, isZone);
  const Points moved = grids::points(filter->GetOutput()), method = morphedBy(this->Grid, bulged);
  const morph::RigidMotion expected =
    morph::fitRigidMotion(rest(zone, morph::allColumns), method(zone, morph::allColumns));
  for (const Index node : zone)
  {
    EXPECT_LT((expected(rest.row(node)) - moved.row(node)).norm(), 1e-6 * this->Size);
  }
}

TEST_P(HangingNodesOfFilters, LeaveNoGapInSteps)
{
  for (const bool isRelative : { false, true })
  {
    auto morph = grids::morphed<vtkFEMWarpMorph>(this->Grid, grids::boundary(this->Grid, bulged));
    morph->SetNumberOfSteps(3);
    morph->SetStepping(isRelative);
    const grids::Listener listener(morph);

    morph->UpdateTimeStep(3);

    EXPECT_TRUE(listener.Errors.empty());
    const Points moved = grids::points(morph->GetOutput());
    EXPECT_LT(this->Octree.gap(moved), 1e-12 * this->Size) << isRelative;
    EXPECT_GT((moved - this->Octree.mesh.points).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_STREQ(morph->GetMorphStatus(), "Valid");
  }
}

TEST_P(HangingNodesOfFilters, AreComparedAsTheMethodsMoveThem)
{
  auto compare = grids::of<vtkCompareMorphMethods>(this->Grid);
  compare->SetBoundaryData(grids::boundary(this->Grid, bulged));
  compare->SetNumberOfSteps(1);
  compare->SetInversionFree(false);
  grids::update(compare);

  auto morph = grids::morphed<vtkFEMWarpMorph>(this->Grid, grids::boundary(this->Grid, bulged));
  morph->Update();
  vtkTable* table = compare->GetOutput(0);
  int found = 0;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    if (table->GetValueByName(row, "Method").ToString() == "FEMWARP" &&
        table->GetValueByName(row, "Step").ToInt() == 1)
    {
      ++found;
      EXPECT_EQ(
        table->GetValueByName(row, "MinScaledJacobian").ToDouble(), morph->GetMinScaledJacobian());
    }
  }
  EXPECT_GT(found, 0);
}

INSTANTIATE_TEST_SUITE_P(Orders, HangingNodesOfFilters, testing::Values(1, 2));
