// SPDX-License-Identifier: BSD-3-Clause
// Handles and lattices of vtkBoundaryDisplacement and vtkMorphMesh.
#include "DisplacedBoundaries.h"

#include "BoundaryMorphing/LatticeMotion.h"
#include "vtkMorphMesh.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTable.h>
#include <vtkThinPlateSplineTransform.h>

#include <gtest/gtest.h>

using grids::Row;
using morph::Index;
using morph::Points;

namespace
{
/// The displacements of the points of the output, and where these were.
struct Moved
{
  Points Rest, Now;
};

Moved run(vtkBoundaryDisplacement* filter)
{
  grids::update(filter);
  return { displaced::restPositions(filter->GetOutput()), grids::points(filter->GetOutput()) };
}

Row shiftedAffine(const Row& x)
{
  return grids::affine(x);
}

Row corner(int i)
{
  return Row(i & 1, (i >> 1) & 1, (i >> 2) & 1) * 3.7;
}

vtkSmartPointer<vtkTable> table(
  const std::vector<const char*>& names, const std::vector<std::vector<double>>& rows)
{
  auto result = vtkSmartPointer<vtkTable>::New();
  for (std::size_t c = 0; c < names.size(); ++c)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(names[c]);
    for (const auto& row : rows)
    {
      column->InsertNextValue(row[c]);
    }
    result->AddColumn(column);
  }
  return result;
}

double largest(const Points& points)
{
  return points.cwiseAbs().maxCoeff();
}
}

TEST(Handles, OfAnAffineMotionMoveTheBoundaryAffinely)
{
  auto filter = displaced::make(grids::hexes());
  filter->SetDisplacementToHandles();
  for (int i = 0; i < 8; ++i)
  {
    const Row from = corner(i), by = shiftedAffine(from) - from;
    filter->AddHandle(from[0], from[1], from[2], by[0], by[1], by[2], 0);
  }
  EXPECT_EQ(filter->GetNumberOfHandles(), 8);
  Moved moved = run(filter);
  EXPECT_LT(largest(moved.Now - grids::mapped(moved.Rest, shiftedAffine)), 1e-10);

  filter->SetScaleFactor(0.5);
  moved = run(filter);
  const Points half = 0.5 * (moved.Rest + grids::mapped(moved.Rest, shiftedAffine));
  EXPECT_LT(largest(moved.Now - half), 1e-10);
}

TEST(Handles, AreTheThinPlateSplineOfVtk)
{
  auto filter = displaced::make(grids::hexes());
  filter->SetDisplacementToHandles();
  vtkNew<vtkPoints> from, to;
  from->SetDataTypeToDouble();
  to->SetDataTypeToDouble();
  auto cloud = grids::cloud(Points::Random(9, 3) * 3);
  Points vectors(9, 3);
  for (Index i = 0; i < 9; ++i)
  {
    const Row x = grids::points(cloud).row(i), y = grids::twist(x);
    from->InsertNextPoint(x.data());
    to->InsertNextPoint(y.data());
    vectors.row(i) = y - x;
  }
  grids::addVectors(cloud, "Displacement", vectors);
  filter->SetControlPointsData(cloud);
  vtkNew<vtkThinPlateSplineTransform> spline;
  spline->SetSourceLandmarks(from);
  spline->SetTargetLandmarks(to);
  spline->SetBasisToR2LogR();
  const Moved moved = run(filter);
  for (Index i = 0; i < moved.Rest.rows(); ++i)
  {
    Row expected;
    spline->TransformPoint(moved.Rest.row(i).data(), expected.data());
    EXPECT_LT((moved.Now.row(i) - expected).norm(), 1e-9);
  }
}

TEST(Handles, StayWithinTheirRadiusAndTakeTheirNode)
{
  auto grid = grids::hexes();
  auto filter = displaced::make(grid);
  filter->SetDisplacementToHandles();
  const Points rest = grids::points(grid);
  const Row at = rest.row(0), by(0.1, 0.2, -0.3); // a corner
  filter->SetControlPointsData(table({ "x", "y", "z", "dx", "dy", "dz", "radius" },
    { { at[0], at[1], at[2], by[0], by[1], by[2], 1.5 } }));
  const Moved moved = run(filter);
  Index inside = 0;
  for (Index i = 0; i < moved.Rest.rows(); ++i)
  {
    const double distance = (moved.Rest.row(i) - at).norm();
    if (distance == 0)
    {
      EXPECT_LT((moved.Now.row(i) - at - by).norm(), 1e-15);
    }
    if (distance >= 1.5)
    {
      EXPECT_EQ(moved.Now.row(i), moved.Rest.row(i));
    }
    else
    {
      ++inside;
      EXPECT_GT((moved.Now.row(i) - moved.Rest.row(i)).norm(), 0);
    }
  }
  EXPECT_GT(inside, 3);
}

TEST(Handles, AreSelectedPoints)
{
  auto grid = grids::hexes();
  for (const bool inMesh : { false, true })
  {
    vtkNew<vtkMorphMesh> mesh;
    auto boundary = displaced::make(grid);
    vtkDisplacementAlgorithm* filter =
      inMesh ? static_cast<vtkDisplacementAlgorithm*>(mesh) : boundary.Get();
    mesh->SetDisplacementToHandles();
    boundary->SetDisplacementToHandles();
    filter->SetInputData(grid);
    filter->SelectedHandlesOn();
    filter->SetHandleRadius(1.5);
    filter->SetVector(0, 0, 0.25);
    filter->SetSelectionData(displaced::indices(vtkSelectionNode::POINT, { 0 }));
    const Points rest = grids::points(grid);
    grids::update(filter);
    auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    const Points now = grids::points(output);
    // The boundary's points are in the order of the nodes: the corner is the first of either.
    EXPECT_LT((now.row(0) - rest.row(0) - Row(0, 0, 0.25)).norm(), 1e-15);
    EXPECT_EQ(now.row(now.rows() - 1), rest.row(rest.rows() - 1));
  }
}

TEST(Handles, ThatAreNoneOrWrongAreErrors)
{
  auto filter = displaced::make(grids::hexes());
  filter->SetDisplacementToHandles();
  grids::expectError(filter, "no handle");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  filter->SetControlPointsData(grids::cloud(Points::Random(3, 3)));
  grids::expectError(filter, "'Displacement' is missing");
  filter->SetControlPointsData(table({ "x", "y", "z", "dx", "dy" }, {}));
  grids::expectError(filter, "'dz' is missing");
  vtkNew<vtkSelection> selection;
  filter->SetControlPointsData(selection);
  grids::expectError(filter, "vtkPointSet or a vtkTable");
  filter->SetControlPointsData(nullptr);
  filter->AddHandle(0, 0, 0, 1, 0, 0, 0);
  filter->AddHandle(0, 0, 0, 0, 1, 0, 0);
  grids::expectError(filter, "same place");
  filter->RemoveAllHandles();
  filter->AddHandle(0, 0, 0, 1, 0, 0, 0);
  grids::update(filter);
}

TEST(Lattice, OfAnAffineMotionMovesTheBoundaryAffinely)
{
  auto grid = grids::hexes();
  double bounds[6];
  grid->GetBounds(bounds);
  for (const int basis : { vtkBoundaryDisplacement::LATTICE_BASIS_BERNSTEIN,
         vtkBoundaryDisplacement::LATTICE_BASIS_B_SPLINE })
  {
    morph::LatticeMotion lattice;
    lattice.basis = static_cast<morph::LatticeMotion::Basis>(basis);
    lattice.size = { 3, 5, 4 };
    lattice.low << bounds[0], bounds[2], bounds[4];
    lattice.high << bounds[1], bounds[3], bounds[5];
    const Points points = lattice.controlPoints();
    auto control = grids::cloud(points);
    grids::addVectors(control, "Displacement", grids::mapped(points, shiftedAffine) - points);
    auto filter = displaced::make(grid);
    filter->SetDisplacementToLattice();
    filter->SetLatticeBasis(basis);
    filter->SetLatticeSize(3, 5, 4);
    filter->SetControlPointsData(control);
    const Moved moved = run(filter);
    EXPECT_LT(largest(moved.Now - grids::mapped(moved.Rest, shiftedAffine)), 1e-10);
    filter->SetLatticeSize(3, 3, 3);
    grids::expectError(filter, "27 control points");
  }
}

TEST(Lattice, TakesTablesAndListsAndLeavesWhatIsOutside)
{
  auto grid = grids::hexes();
  auto filter = displaced::make(grid);
  filter->SetDisplacementToLattice();
  filter->SetLatticeBoxToOwn();
  filter->SetLatticePosition(-1, -1, -1);
  filter->SetLatticeLength(3, 3, 3);
  filter->SetLatticeSize(3, 3, 3);
  filter->AddLatticeDisplacement(1, 1, 1, 0.5, 0, 0);
  const Moved listed = run(filter);
  for (Index i = 0; i < listed.Rest.rows(); ++i)
  {
    const Row t = (listed.Rest.row(i).array() + 1) / 3;
    const Row basis = 2 * t.array() * (1 - t.array()); // Bernstein's of degree 2
    const bool isInside = (t.array() >= 0).all() && (t.array() <= 1).all();
    const Row by = isInside ? Row(0.5 * basis.prod(), 0, 0) : Row(0, 0, 0);
    EXPECT_LT((listed.Now.row(i) - listed.Rest.row(i) - by).norm(), isInside ? 1e-14 : 1e-300);
  }
  filter->RemoveAllLatticeDisplacements();
  filter->SetControlPointsData(table(
    { "i", "j", "k", "dx", "dy", "dz" }, { { 1, 1, 1, 0.25, 0, 0 }, { 1, 1, 1, 0.25, 0, 0 } }));
  EXPECT_LT(largest(run(filter).Now - listed.Now), 1e-15);
  filter->AddLatticeDisplacement(3, 0, 0, 1, 0, 0);
  grids::expectError(filter, "no control point 3");
}

TEST(Lattice, OfMorphMeshMovesEverythingInTheBox)
{
  auto grid = grids::hexes();
  auto mesh = grids::of<vtkMorphMesh>(grid);
  mesh->SetDisplacementToLattice();
  mesh->SetLatticeSize(2, 2, 2);
  for (int corner = 0; corner < 8; ++corner)
  {
    mesh->AddLatticeDisplacement(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1, 0.5, 1, 2);
  }
  mesh->SetValidity(0);
  grids::update(mesh);
  const Points rest = grids::points(grid), now = grids::points(mesh->GetOutput());
  EXPECT_LT(largest((now - rest).rowwise() - Row(0.5, 1, 2)), 1e-9);
  const int before = mesh->GetPrepareCount();
  mesh->RemoveAllLatticeDisplacements();
  mesh->AddLatticeDisplacement(0, 0, 0, 0.1, 0.1, 0.1);
  grids::update(mesh);
  EXPECT_EQ(mesh->GetPrepareCount(), before);
}
