// SPDX-License-Identifier: BSD-3-Clause
// What surfaces do that touch what moves: they keep their shape where they can. The others stay.
#include "DisplacedBoundaries.h"
#include "MorphFilters.h"

#include "../Core/BoundaryShapes.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphMesh.h"

#include <vtkCylindricalTransform.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTransform.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cmath>

using grids::Row;

namespace
{
double radius(const Row& x)
{
  return std::hypot(x[0], x[1]);
}

bool isAt(double value, double wanted)
{
  return std::abs(value - wanted) < 1e-9;
}

/// A block with a hole of radius 1 about the z axis, outer radius 2 and length 1: a sector of
/// `angle` degrees, turned and shifted so that no plane is an axis plane if `turned`.
vtkSmartPointer<vtkUnstructuredGrid> sector(double angle, int cellsAround)
{
  morph::Mesh mesh = meshes::hexes(3, cellsAround, 3);
  meshes::transform(mesh,
    [&](const Row& x)
    {
      const double r = 1 + x[0] / 3, phi = angle * M_PI / 180 * x[1] / cellsAround;
      return Row(r * std::cos(phi), r * std::sin(phi), x[2] / 3);
    });
  return grids::make(mesh);
}

std::string surface(vtkDataObject* grid, const std::function<bool(const Row&)>& is)
{
  auto filter = displaced::make(grid);
  return displaced::surfaceName(filter, is);
}

bool onHole(const Row& x)
{
  return isAt(radius(x), 1);
}

bool onOuterWall(const Row& x)
{
  return isAt(radius(x), 2);
}

double angleOf(const Row& x)
{
  return std::atan2(x[1], x[0]) * 180 / M_PI;
}
}

TEST(BoundarySliding, PlanesOfSymmetryStayPlanarWhileAHoleGrows)
{
  for (const bool turned : { false, true })
  {
    auto grid = sector(90, 5);
    vtkNew<vtkTransform> place;
    if (turned)
    {
      place->Translate(3, -2, 7);
      place->RotateWXYZ(40, 1, 2, 3);
    }
    const std::string hole = surface(grid, onHole);
    const std::string first = surface(grid, [](const Row& x) { return isAt(x[1], 0); });
    const std::string second = surface(grid, [](const Row& x) { return isAt(x[0], 0); });
    const morph::Points unturned = grids::points(grid);
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      grid->GetPoints()->SetPoint(i, place->TransformPoint(grid->GetPoint(i)));
    }
    auto filter = grids::of<vtkMorphMesh>(grid);
    filter->AddSurface(hole.c_str());
    filter->SetDisplacementToAlongNormals();
    filter->SetDistance(-0.3); // against the normal that points out of the mesh
    filter->AddSlidingSurface(first.c_str());
    filter->AddSlidingSurface(second.c_str());
    const grids::Run listener(filter);
    ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
    vtkLinearTransform* back = place->GetLinearInverse();
    double moved = 0;
    for (morph::Index i = 0; i < unturned.rows(); ++i)
    {
      const Row x = unturned.row(i);
      Row y;
      back->TransformPoint(filter->GetOutput()->GetPoint(i), y.data());
      // The size is about 3, and its place 8 from the origin.
      EXPECT_TRUE(!isAt(x[1], 0) || std::abs(y[1]) < (turned ? 1e-14 * 20 : 1e-15)) << y[1];
      EXPECT_TRUE(!isAt(x[0], 0) || std::abs(y[0]) < 1e-14 * 20) << y[0];
      EXPECT_TRUE(!isAt(x[2], 0) || std::abs(y[2]) < 1e-12 * 3) << y[2];
      EXPECT_TRUE(!isAt(x[2], 1) || std::abs(y[2] - 1) < 1e-12 * 3) << y[2];
      EXPECT_TRUE(!isAt(radius(x), 2) || (y - x).norm() < 1e-14) << y;
      if (onHole(x))
      {
        EXPECT_NEAR(radius(y), 1.3, 1e-9);
        moved = std::max(moved, (y - x).norm());
      }
    }
    EXPECT_GT(moved, 0.29);

    // Without them the rim leaves the planes, since the hole's normals at its end do.
    filter->RemoveAllSlidingSurfaces();
    filter->Update();
    double off = 0;
    for (morph::Index i = 0; i < unturned.rows(); ++i)
    {
      Row y;
      back->TransformPoint(filter->GetOutput()->GetPoint(i), y.data());
      off = std::max(off, isAt(unturned(i, 1), 0) ? std::abs(y[1]) : 0);
    }
    EXPECT_GT(off, 0.02);
    ASSERT_FALSE(listener.Warnings.empty());
    EXPECT_NE(listener.Warnings[0].find("leave their own shape"), std::string::npos);
  }
}

TEST(BoundarySliding, TheOuterWallStaysWhereAHoleGrows)
{
  // Two halves of a pipe, whose ends meet: no vertex, and closed curves.
  auto grid = sector(180, 8);
  auto filter = displaced::moving(grid, onHole);
  filter->SetDisplacementToTransform();
  vtkNew<vtkTransform> grow;
  grow->Scale(1.2, 1.2, 1);
  filter->SetTransform(grow);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
  vtkPolyData* output = filter->GetOutput();
  const morph::Points x = displaced::restPositions(output), y = grids::points(output);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (onOuterWall(x.row(i)))
    {
      EXPECT_EQ(y.row(i), x.row(i));
      EXPECT_EQ(displaced::role(output, i), 0);
    }
    EXPECT_NEAR(y(i, 2), x(i, 2), 1e-15);
    if (!onHole(x.row(i)) && !onOuterWall(x.row(i)) && (isAt(x(i, 2), 0) || isAt(x(i, 1), 0)))
    {
      EXPECT_EQ(displaced::role(output, i), 3) << x.row(i);
      EXPECT_GT(radius(y.row(i)), radius(x.row(i)));
    }
  }
}

TEST(BoundarySliding, ACylinderStaysACylinderWhereItsEndMoves)
{
  auto grid = sector(90, 5);
  auto filter = displaced::moving(grid, [](const Row& x) { return isAt(x[2], 1); });
  vtkNew<vtkTransform> turn;
  turn->Translate(0, 0, 0.5);
  turn->RotateZ(10);
  filter->SetTransform(turn);
  filter->AddSlidingSurface(surface(grid, onHole).c_str());
  filter->AddSlidingSurface(surface(grid, onOuterWall).c_str());
  const grids::Run listener(filter);
  const morph::Points x = displaced::restPositions(filter->GetOutput());
  const morph::Points y = grids::points(filter->GetOutput());
  vtkIdType along = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (onHole(x.row(i)) || onOuterWall(x.row(i)))
    {
      EXPECT_NEAR(radius(y.row(i)), radius(x.row(i)), 1e-12);
      along += x(i, 2) < 1 && y(i, 2) > x(i, 2) && angleOf(y.row(i)) > angleOf(x.row(i)) + 1;
    }
  }
  EXPECT_GT(along, 8);
  // The two planes of the sector cannot follow in themselves.
  listener.ExpectWarning(" % of the largest displacement");
  // Those that stay follow nothing, though their edges move.
  filter->AddFixedSurface(surface(grid, [](const Row& x) { return isAt(x[0], 0); }).c_str());
  filter->AddFixedSurface(surface(grid, [](const Row& x) { return isAt(x[1], 0); }).c_str());
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
}

TEST(BoundarySliding, NodesOfABumpySurfaceStayWhereNothingMoves)
{
  for (const double height : { 0.05, 1e-3, 1e-4, 1e-6, 1e-8 })
  {
    // What is bumpy and nearly flat fits large cylinders, too.
    morph::Mesh mesh = meshes::hexes(6, 3, 4);
    meshes::transform(mesh,
      [&](const Row& x)
      {
        const double up = x[2] == 4 ? height * std::sin(2 * (x[0] + 0.3) * (x[1] + 1)) : 0;
        return Row(x + Row(0, 0, up));
      });
    auto grid = grids::make(mesh);
    auto filter = displaced::moving(grid, [](const Row& x) { return x[0] == 6; });
    filter->AddSlidingSurface(surface(grid, [](const Row& x) { return x[2] > 3.5; }).c_str());
    grids::moveBy(filter, 0, 1e-9, 0);
    filter->Update();
    const morph::Points x = displaced::restPositions(filter->GetOutput());
    const morph::Points y = grids::points(filter->GetOutput());
    EXPECT_LT((y - x).rowwise().norm().maxCoeff(), 2e-9) << height;
    // The same with a motion that can be seen: the top keeps its height.
    filter->SetVector(0, 0.1, 0);
    filter->Update();
    const morph::Points z = grids::points(filter->GetOutput());
    EXPECT_LT((z - x).rowwise().norm().maxCoeff(), 0.13) << height;
  }
}

TEST(BoundarySliding, SaysHowFarASurfaceLeavesItsShape)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  auto filter = displaced::moving(grid, [](const Row& x) { return x[2] == 4; });
  grids::moveBy(filter, 0.3, 0, 0.4);
  const grids::Run listener(filter);
  // Two sides keep their planes, and two are pulled 0.3 out of theirs by 0.5.
  listener.ExpectWarning(" by 0.3 (60 % of the largest displacement), Surface ");
  filter->SetVector(0.003, 0, 0.4); // within 1 %: they slide, but for the edge that moves
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
  filter->SetVector(0.3, 0, 0.4);
  filter->SetSurroundingsToFollowEverywhere();
  filter->Update();
  EXPECT_EQ(listener.Warnings.size(), 1u);
}

TEST(BoundarySliding, AVertexIsNoTouchUnlessItMovesAlone)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  auto filter = displaced::moving(grid, [](const Row& x) { return x[2] == 4; });
  grids::moveBy(filter, 0, 0, 0.4);
  filter->Update();
  const auto followers = [&](const std::function<bool(const Row&)>& is)
  {
    int count = 0;
    const morph::Points x = displaced::restPositions(filter->GetOutput());
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      count += is(x.row(i)) && displaced::role(filter->GetOutput(), i) == 3;
    }
    return count;
  };
  const auto isInBottom = [](const Row& x) { return x[2] == 0; };
  const auto isInSide = [](const Row& x) { return x[0] == 0 && x[2] > 0; };
  EXPECT_EQ(followers(isInBottom), 0);
  EXPECT_EQ(followers(isInSide), 15);
  // One corner that moves alone: its three faces follow.
  filter->SetMovingToSelection();
  filter->SetSelectionData(displaced::indices(vtkSelectionNode::POINT,
    displaced::nodesWhere(grid, [](const Row& x) { return x.norm() == 0; })));
  filter->SetVector(-0.4, -0.4, -0.4);
  const grids::Run silence(filter);
  EXPECT_GT(followers(isInBottom), 10);
}

TEST(BoundarySliding, TheRadiusOfAHoleIsOneNumber)
{
  auto grid = sector(90, 5);
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface(surface(grid, onHole).c_str());
  filter->SetDisplacementToRadius();
  filter->SetRadiusChange(0.3);
  const grids::Run listener(filter);
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_TRUE(!onHole(x.row(i)) || std::abs(radius(y.row(i)) - 1.3) < 1e-12);
    EXPECT_TRUE(!onHole(x.row(i)) || std::abs(angleOf(y.row(i)) - angleOf(x.row(i))) < 1e-9);
    EXPECT_TRUE(!onOuterWall(x.row(i)) || y.row(i) == x.row(i));
  }
  filter->SetRadiusChange(-1.5);
  filter->Update();
  listener.ExpectError("no radius");
  filter->SetMovingToEverything();
  filter->Update();
  ASSERT_EQ(listener.Errors.size(), 2u);
  EXPECT_NE(listener.Errors[1].find("is neither"), std::string::npos) << listener.Errors[1];
}

TEST(BoundarySliding, TheRadiusOfASphereIsOneNumber)
{
  auto grid = grids::make(shapes::hollowBall(8));
  auto filter = grids::of<vtkMorphMesh>(grid);
  const double hole = 0.5;
  const auto isHole = [&](const Row& x) { return isAt(x.norm(), hole); };
  filter->AddSurface(surface(grid, isHole).c_str());
  filter->SetDisplacementToRadius();
  filter->SetRadiusChange(0.1);
  grids::update(filter);
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  int moved = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (isHole(x.row(i)))
    {
      ++moved;
      EXPECT_LT((y.row(i) - (hole + 0.1) / hole * x.row(i)).norm(), 1e-9);
    }
    EXPECT_TRUE(!isAt(x.row(i).norm(), 1) || y.row(i) == x.row(i));
  }
  EXPECT_GT(moved, 50);
}

TEST(BoundarySliding, ScalesAndTurnsAboutTheCenterOfWhatMoves)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  auto filter = displaced::moving(grid, [](const Row& x) { return x[2] == 4; });
  filter->SetSurroundingsToStay();
  filter->SetDisplacementToTranslateRotateScale();
  filter->SetRotation(0, 0, 90);
  filter->SetScale(0.5, 1, 1);
  filter->SetTranslation(0, 0, 1);
  const auto check = [&](const Row& center)
  {
    filter->Update();
    const morph::Points x = displaced::restPositions(filter->GetOutput());
    const morph::Points y = grids::points(filter->GetOutput());
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      const Row d = x.row(i) - center;
      const Row wanted = x(i, 2) == 4 ? Row(center + Row(-d[1], 0.5 * d[0], d[2] + 1)) : x.row(i);
      EXPECT_LE((y.row(i) - wanted).norm(), 1e-14) << x.row(i);
    }
  };
  check(Row(2, 2, 4));
  filter->AutoCenterOff();
  check(Row(0, 0, 0));
  filter->SetCenter(1, 2, 3);
  check(Row(1, 2, 3));
  // A transform does the same if it is asked to; else it is about the origin.
  vtkNew<vtkTransform> transform;
  transform->Translate(0, 0, 1);
  transform->RotateZ(90);
  transform->Scale(0.5, 1, 1);
  filter->SetDisplacementToTransform();
  filter->SetTransform(transform);
  check(Row(0, 0, 0));
  filter->TransformAboutCenterOn();
  check(Row(1, 2, 3));
  filter->AutoCenterOn();
  check(Row(2, 2, 4));
  filter->SetScaleFactor(0.5); // half of the stretch, then half of the turn
  filter->Update();
  const morph::Points x = displaced::restPositions(filter->GetOutput());
  const morph::Points y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const Row center(2, 2, 4), d = (x.row(i) - center).cwiseProduct(Row(0.75, 1, 1));
    const Row turned = std::sqrt(0.5) * Row(d[0] - d[1], d[0] + d[1], 0);
    const Row wanted = x(i, 2) == 4 ? Row(center + turned + Row(0, 0, 0.5)) : x.row(i);
    EXPECT_LE((y.row(i) - wanted).norm(), 1e-14) << x.row(i);
  }
}

TEST(BoundarySliding, ANonlinearTransformAboutTheCenterOfWhatMoves)
{
  auto grid = grids::make(meshes::hexes(4, 4, 4));
  vtkNew<vtkCylindricalTransform> polar; // (r, phi, z) to (r cos(phi), r sin(phi), z)
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->SetMovingToEverything();
  filter->SetTransform(polar);
  filter->SetScaleFactor(0.05);
  filter->TransformAboutCenterOn();
  filter->Update();
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const Row d = x.row(i) - Row(2, 2, 2);
    if (d.cwiseAbs().maxCoeff() == 2) // on the boundary
    {
      const Row wanted(d[0] * std::cos(d[1]), d[0] * std::sin(d[1]), d[2]);
      EXPECT_LE((y.row(i) - x.row(i) - 0.05 * (wanted - d)).norm(), 1e-14) << x.row(i);
    }
  }
}

TEST(BoundarySliding, NodesOfFreeSurfacesAreSolvedWithTheInterior)
{
  // A quarter of a block with a hole: the ends are free, and the hole grows more at one of them.
  auto grid = sector(90, 5);
  const auto isAtEnd = [](const Row& x) { return isAt(x[2], 0) || isAt(x[2], 1); };
  const auto isInside = [](const Row& x)
  { return radius(x) > 1.01 && radius(x) < 1.99 && x[0] > 0.01 && x[1] > 0.01; };
  auto filter = grids::of<vtkMorphMesh>(grid);
  filter->AddSurface(surface(grid, onHole).c_str());
  filter->SetDisplacementToRadius();
  filter->SetRadiusChange(0.3);
  const grids::Run listener(filter);
  const morph::Points x = grids::points(grid), followed = grids::points(filter->GetOutput());
  const vtkIdType prescribed = filter->GetPrescribedPoints();
  for (const double end : { 0., 1. })
  {
    filter->AddFreeSurface(surface(grid, [&](const Row& at) { return isAt(at[2], end); }).c_str());
  }
  filter->Update();
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  const morph::Points y = grids::points(filter->GetOutput());
  vtkIdType freed = 0;
  double otherwise = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (isAtEnd(x.row(i)) && isInside(x.row(i)))
    {
      // Laplace's equation with natural boundary values: nothing pulls along z.
      EXPECT_NEAR(y(i, 2), x(i, 2), 1e-6);
      EXPECT_GT(radius(y.row(i)), radius(x.row(i)) + 1e-3);
      otherwise = std::max(otherwise, (y.row(i) - followed.row(i)).norm());
      ++freed;
    }
    else if (onHole(x.row(i)))
    {
      EXPECT_NEAR(radius(y.row(i)), 1.3, 1e-12); // the rim of the free ends moves
    }
    else if (onOuterWall(x.row(i)))
    {
      EXPECT_EQ(y.row(i), x.row(i));
    }
  }
  EXPECT_EQ(freed, 2 * 2 * 4);
  EXPECT_EQ(filter->GetPrescribedPoints(), prescribed - freed);
  EXPECT_GT(otherwise, 1e-3);
  EXPECT_LT(otherwise, 0.1);

  // The same answer by the two filters, whose boundary tells which points are free.
  auto displace = displaced::moving(grid, onHole);
  grids::moveBy(displace, 0, 0, 0.1);
  displace->AddFreeSurface(surface(grid, [](const Row& at) { return isAt(at[2], 1); }).c_str());
  displace->Update();
  EXPECT_EQ(displace->GetFreePoints(), freed / 2);
  for (vtkIdType i = 0; i < displace->GetOutput()->GetNumberOfPoints(); ++i)
  {
    vtkDataArray* marks = displace->GetOutput()->GetPointData()->GetArray("MorphFree");
    ASSERT_TRUE(marks);
    EXPECT_EQ(marks->GetComponent(i, 0) != 0, displaced::role(displace->GetOutput(), i) == 4);
  }
  // A fixed or sliding surface beside it keeps its nodes, and so does a second filter its freedom.
  vtkNew<vtkBoundaryDisplacement> second;
  second->SetInputConnection(displace->GetOutputPort());
  second->SetMovingToSurfaces();
  second->AddSurface(surface(grid, onOuterWall).c_str());
  second->SetSurroundingsToStay();
  second->Update();
  EXPECT_TRUE(second->GetOutput()->GetPointData()->GetArray("MorphFree"));
  second->SetMovingToEverything();
  second->Update();
  EXPECT_FALSE(second->GetOutput()->GetPointData()->GetArray("MorphFree"));
}

TEST(BoundarySliding, ABoundaryThatIsAllFreeIsAnError)
{
  auto grid = grids::make(meshes::hexes(3, 3, 3));
  auto boundary = grids::boundary(grid, [](const Row& x) { return x; });
  vtkNew<vtkUnsignedCharArray> free;
  free->SetName("MorphFree");
  free->SetNumberOfValues(boundary->GetNumberOfPoints());
  free->FillValue(1);
  boundary->GetPointData()->AddArray(free);
  auto morph = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
  grids::expectError(morph, "All points of the boundary are free");
}

TEST(BoundarySliding, NamesWhatDoesNotExist)
{
  auto filter = grids::of<vtkMorphMesh>(grids::make(meshes::hexes(2, 2, 2)));
  filter->SetMovingToEverything();
  filter->AddSlidingSurface("Curve 1");
  grids::expectError(filter, "`SlidingSurfaces` names 'Curve 1'");
}

TEST(BoundarySliding, SurfacesThatFoldAsTheyFollowSlideUntilTheyDoNot)
{
  auto grid = grids::make(shapes::boxWithHole(24, 5, 2));
  auto filter = displaced::moving(grid, onHole);
  grids::moveBy(filter, 0.85, 0, 0);
  const grids::Run listener(filter);

  ASSERT_EQ(listener.Warnings.size(), 1);
  EXPECT_NE(listener.Warnings[0].find("folded as they followed"), std::string::npos)
    << listener.Warnings[0];
  const morph::Points x = displaced::restPositions(filter->GetOutput());
  const morph::Points y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    EXPECT_EQ(y(i, 2), x(i, 2)) << "the ends stay in their planes";
    EXPECT_TRUE(!onHole(x.row(i)) || y.row(i) == x.row(i) + Row(0.85, 0, 0));
  }
  vtkNew<vtkInversionFreeMorph> morph;
  morph->SetInputData(0, grid);
  morph->SetInputConnection(1, filter->GetOutputPort());
  morph->Update();
  EXPECT_EQ(morph->GetInvertedCells(), 0);
  EXPECT_GT(morph->GetMinScaledJacobian(), 0.1);
}
