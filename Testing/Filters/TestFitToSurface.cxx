// SPDX-License-Identifier: BSD-3-Clause
// vtkMorphMesh with a target surface.
#include "DisplacedBoundaries.h"

#include "vtkMorphMesh.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSphereSource.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

using grids::Row;

namespace
{
/// A ball of radius 1 about the origin, of 6 x 6 x 6 hexahedra.
vtkSmartPointer<vtkUnstructuredGrid> ball()
{
  morph::Mesh mesh = meshes::hexes(6, 6, 6);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const Row y = (x - Row(3, 3, 3)) / 3;
      return y.isZero(0) ? y : Row(y * y.cwiseAbs().maxCoeff() / y.norm());
    });
  return grids::make(mesh);
}

vtkSmartPointer<vtkUnstructuredGrid> brick()
{
  return grids::make(meshes::hexes(6, 4, 3));
}

vtkSmartPointer<vtkPolyData> moved(vtkPolyData* surface, vtkAbstractTransform* transform)
{
  vtkNew<vtkTransformPolyDataFilter> filter;
  filter->SetInputData(surface);
  filter->SetTransform(transform);
  filter->Update();
  return filter->GetOutput();
}

vtkSmartPointer<vtkPolyData> ellipsoid()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->GenerateNormalsOff();
  sphere->SetRadius(1);
  sphere->SetThetaResolution(48);
  sphere->SetPhiResolution(24);
  sphere->Update();
  vtkNew<vtkTransform> scale;
  scale->Scale(1.3, 1.1, 0.9);
  return moved(sphere->GetOutput(), scale);
}

/// The brick's faces, larger by a fifth.
vtkSmartPointer<vtkPolyData> largerBrick()
{
  auto surface = grids::boundary(brick(), [](const Row& x) { return x; });
  vtkNew<vtkTransform> scale;
  scale->Translate(3, 2, 1.5);
  scale->Scale(1.2, 1.2, 1.2);
  scale->Translate(-3, -2, -1.5);
  return moved(surface, scale);
}

/// The ellipsoid with triangles added that are no part of it: twice there, two equal corners, three
/// on a line, and lower than the rounding of single precision.
vtkSmartPointer<vtkPolyData> withFaults(vtkPolyData* surface)
{
  vtkNew<vtkPolyData> result;
  result->DeepCopy(surface);
  const auto corner = [&](vtkIdType cell, int k)
  {
    Row x;
    result->GetPoint(surface->GetCell(cell)->GetPointId(k), x.data());
    return x;
  };
  const auto add = [&](const Row& a, const Row& b, const Row& c)
  {
    vtkIdType ids[3];
    int k = 0;
    for (const Row& x : { a, b, c })
    {
      ids[k++] = result->GetPoints()->InsertNextPoint(x.data());
    }
    result->GetPolys()->InsertNextCell(3, ids);
  };
  add(corner(150, 0), corner(150, 1), corner(150, 2));
  add(corner(40, 0), corner(40, 0), corner(40, 1));
  add(corner(77, 0), (corner(77, 0) + corner(77, 1)) / 2, corner(77, 1));
  const Row low = corner(300, 0) + corner(300, 1) + 1e-8 * corner(300, 2);
  add(corner(300, 0), corner(300, 1), low / (2 + 1e-8));
  result->BuildCells();
  return result.Get();
}

/// The surface with the edge between two triangles divided on one side alone: a triangle without
/// area joins its halves to the whole.
vtkSmartPointer<vtkPolyData> withFlatTriangle(vtkPolyData* surface)
{
  vtkNew<vtkPolyData> result;
  result->DeepCopy(surface);
  const vtkIdType divided = 200;
  vtkNew<vtkIdList> ids;
  surface->GetCellPoints(divided, ids);
  const vtkIdType a = ids->GetId(0), b = ids->GetId(1), c = ids->GetId(2);
  Row x, y;
  surface->GetPoint(a, x.data());
  surface->GetPoint(b, y.data());
  x = (x + y) / 2;
  const vtkIdType m = result->GetPoints()->InsertNextPoint(x.data());
  vtkNew<vtkCellArray> polygons;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    surface->GetCellPoints(cell, ids);
    if (cell != divided)
    {
      polygons->InsertNextCell(ids);
    }
  }
  const vtkIdType parts[][3] = { { a, m, c }, { m, b, c }, { a, b, m } };
  for (const auto& part : parts)
  {
    polygons->InsertNextCell(3, part);
  }
  result->SetPolys(polygons);
  return result.Get();
}

/// A target over the brick's outline and more.
vtkSmartPointer<vtkPolyData> overBrick(
  double margin, int along, int across, const std::function<double(const Row&)>& height)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  plane->SetOrigin(-margin, -margin, 0);
  plane->SetPoint1(6 + margin, -margin, 0);
  plane->SetPoint2(-margin, 4 + margin, 0);
  plane->SetResolution(along, across);
  plane->Update();
  vtkPolyData* surface = plane->GetOutput();
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    Row x;
    surface->GetPoint(i, x.data());
    x[2] = height(x);
    surface->GetPoints()->SetPoint(i, x.data());
  }
  return surface;
}

/// Hills about a height.
vtkSmartPointer<vtkPolyData> hills(double height, double margin)
{
  return overBrick(margin, 40, 40,
    [=](const Row& x)
    { return height + 0.5 * std::sin(1.3 * x[0] + 0.4) * std::cos(1.1 * x[1] - 0.3); });
}

/// A floor at 0.5, and walls of 66 degrees.
vtkSmartPointer<vtkPolyData> canyon()
{
  return overBrick(
    0.5, 28, 20, [](const Row& x) { return 0.5 + 2.25 * std::max(0., std::abs(x[0] - 3) - 0.75); });
}

vtkSmartPointer<vtkMorphMesh> make(vtkUnstructuredGrid* grid, vtkPolyData* target)
{
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetInputData(grid);
  filter->SetTargetData(target);
  filter->SetDisplacementToTarget();
  return filter;
}

/// The brick's top goes to the target, and its four sides slide.
vtkSmartPointer<vtkMorphMesh> onto(vtkUnstructuredGrid* grid, vtkPolyData* target)
{
  auto filter = make(grid, target);
  auto displace = displaced::make(grid);
  const auto name = [&](const std::function<bool(const Row&)>& is)
  { return displaced::surfaceName(displace, is); };
  filter->AddSurface(name([](const Row& x) { return x[2] == 3; }).c_str());
  filter->AddSlidingSurface(name([](const Row& x) { return x[0] == 0; }).c_str());
  filter->AddSlidingSurface(name([](const Row& x) { return x[0] == 6; }).c_str());
  filter->AddSlidingSurface(name([](const Row& x) { return x[1] == 0; }).c_str());
  filter->AddSlidingSurface(name([](const Row& x) { return x[1] == 4; }).c_str());
  return filter;
}

/// A brick of `n` hexahedra along x whose top rises by half of `profile` of the distance from x =
/// 3.
vtkSmartPointer<vtkUnstructuredGrid> ridge(int n, const std::function<double(double)>& profile)
{
  morph::Mesh mesh = meshes::hexes(n, 4, 3);
  meshes::transform(mesh, [&](const Row& x) { return Row(x[0] * 6 / n, x[1], x[2]); });
  meshes::transform(mesh,
    [&](const Row& x) { return Row(x[0], x[1], x[2] * (1 + profile(std::abs(x[0] - 3)) / 6)); });
  return grids::make(mesh);
}

/// A rectangle of the brick's outline at a height, larger by `margin` on each side.
vtkSmartPointer<vtkPolyData> lid(double height, double margin)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(-margin, -margin, height);
  plane->SetPoint1(6 + margin, -margin, height);
  plane->SetPoint2(-margin, 4 + margin, height);
  plane->SetResolution(5, 7);
  plane->Update();
  return plane->GetOutput();
}

/// Where the brick's eight corners are now: those of an upright box of these half sizes?
double cornerError(vtkUnstructuredGrid* before, vtkUnstructuredGrid* after, const Row& half)
{
  const morph::Points x = grids::points(before), y = grids::points(after);
  const Row middle(3, 2, 1.5);
  double largest = 0;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const Row from = x.row(i) - middle;
    if (std::abs(from[0]) == 3 && std::abs(from[1]) == 2 && std::abs(from[2]) == 1.5)
    {
      const Row to = y.row(i) - middle;
      largest = std::max(largest, (to.cwiseAbs() - half).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}
}

TEST(FitToSurface, ASphereBecomesAnEllipsoid)
{
  auto grid = ball();
  auto filter = make(grid, ellipsoid());
  grids::updateQuietly(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_NEAR(filter->GetMaxTargetDistanceBefore(), 0.3, 0.01);
  EXPECT_GT(filter->GetMeanTargetDistanceBefore(), 0.05);
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
  EXPECT_LE(filter->GetMeanTargetDistance(), filter->GetMaxTargetDistance());
  vtkPointData* arrays = filter->GetOutput()->GetPointData();
  vtkDataArray* before = arrays->GetArray("TargetDistanceBefore");
  vtkDataArray* after = arrays->GetArray("TargetDistance");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->GetNumberOfTuples(), grid->GetNumberOfPoints());
  const morph::Points x = grids::points(grid);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    const bool isOutside = x.row(i).norm() > 0.99;
    EXPECT_EQ(std::isnan(after->GetComponent(i, 0)), !isOutside) << i;
    EXPECT_EQ(std::isnan(before->GetComponent(i, 0)), !isOutside) << i;
  }
  // Half of the way, and back.
  filter->SetScaleFactor(0.5);
  filter->Update();
  EXPECT_NEAR(filter->GetMaxTargetDistance(), 0.15, 0.02);
  filter->SetDisplacementToVector();
  filter->SetMovingToEverything();
  filter->Update();
  EXPECT_EQ(filter->GetMaxTargetDistance(), -1);
  EXPECT_FALSE(filter->GetOutput()->GetPointData()->GetArray("TargetDistance"));
}

TEST(FitToSurface, ATargetWithItsOwnAxesIsAlignedFirst)
{
  vtkNew<vtkTransform> away;
  away->Translate(50, -20, 7);
  away->RotateWXYZ(130, 1, 2, 3);
  auto grid = brick();
  auto filter = make(grid, moved(largerBrick(), away));
  filter->AlignTargetOn();
  grids::updateQuietly(filter);
  // The brick has another length along each axis, so that it has one place but for half turns.
  EXPECT_LT(cornerError(grid, filter->GetOutput(), Row(3.6, 2.4, 1.8)), 1e-3);
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-10);
  EXPECT_GT(filter->GetMeanTargetDistanceBefore(), 0.2);
  EXPECT_EQ(filter->GetInvertedCells(), 0);

  auto sphere = make(ball(), moved(ellipsoid(), away));
  sphere->AlignTargetOn();
  sphere->Update();
  EXPECT_LT(sphere->GetMaxTargetDistance(), 1e-10);
  EXPECT_LT(sphere->GetMaxTargetDistanceBefore(), 0.4);
}

TEST(FitToSurface, ATargetWhoseCornerIsNearestToAllIsAligned)
{
  vtkNew<vtkTransform> away;
  away->Translate(1000, 1000, 1000);
  auto grid = brick();
  auto filter = make(grid, moved(largerBrick(), away));
  filter->AlignTargetOn();
  grids::update(filter);
  EXPECT_LT(cornerError(grid, filter->GetOutput(), Row(3.6, 2.4, 1.8)), 1e-3);
}

TEST(FitToSurface, AlignmentTellsItsProgress)
{
  auto filter = make(brick(), largerBrick());
  filter->AlignTargetOn();
  std::vector<double> told;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&told);
  observer->SetCallback([](vtkObject*, unsigned long, void* list, void* value)
    { static_cast<std::vector<double>*>(list)->push_back(*static_cast<double*>(value)); });
  filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  // Of vtkMorphMesh's share for the boundary, 0 to 0.3, the alignment has 0.15 to 0.18.
  EXPECT_GT(
    std::count_if(told.begin(), told.end(), [](double x) { return x > 0.15 && x < 0.18; }), 3);
}

TEST(FitToSurface, CornersGoToCornersAndEdgesToEdges)
{
  auto grid = brick();
  auto filter = make(grid, largerBrick());
  filter->Update();
  EXPECT_LT(cornerError(grid, filter->GetOutput(), Row(3.6, 2.4, 1.8)), 1e-6);
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-6); // the target's points are in single precision
  EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
}

TEST(FitToSurface, ACurveThatTheTargetDoesNotHaveGoesToItsSurface)
{
  // The mesh's ridge is sharp, the target's round: its only edges are those of the brick.
  auto grid = ridge(6, [](double x) { return std::max(0., 1 - x); });
  auto target = grids::boundary(
    ridge(24, [](double x) { return x < 1.5 ? std::pow(std::cos(x * std::acos(-1.) / 3), 2) : 0; }),
    [](const Row& x) { return x; });
  auto filter = make(grid, target);
  grids::update(filter);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-6);
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  EXPECT_LT((y - x).cwiseAbs().maxCoeff(), 0.3); // rounds are at most 0.18 off
}

TEST(FitToSurface, TheSurfacesThatTheTargetBelongsToMove)
{
  // A target with open edges: they serve the rim.
  auto grid = brick();
  auto filter = make(grid, lid(3.4, 0.2));
  filter->SetSurroundings(1);
  grids::update(filter);
  const morph::Points x = grids::points(grid), y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x(i, 2) == 3)
    {
      EXPECT_NEAR(y(i, 2), 3.4, 1e-6) << i;
    }
    if (x(i, 2) == 0)
    {
      EXPECT_EQ(Row(y.row(i)), Row(x.row(i))) << i;
    }
    if (x(i, 2) == 3 && x(i, 0) == 0 && x(i, 1) == 0)
    {
      EXPECT_LT((y.row(i) - Row(-0.2, -0.2, 3.4)).norm(), 1e-6);
    }
  }
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-6);

  // The same where the surface is chosen.
  auto chosen = grids::of<vtkMorphMesh>(grid);
  chosen->SetTargetData(lid(3.4, 0.2));
  chosen->SetDisplacementToTarget();
  auto displace = displaced::make(grid);
  chosen->AddSurface(
    displaced::surfaceName(displace, [](const Row& at) { return at[2] == 3; }).c_str());
  chosen->Update();
  EXPECT_EQ(grids::points(chosen->GetOutput()), y);
}

TEST(FitToSurface, ATargetThatCannotServeIsAnErrorAndKeepsTheMesh)
{
  auto grid = brick();
  vtkNew<vtkTransform> away, farAway;
  away->Translate(0, 0, 100);
  farAway->Translate(0, 0, 1e20);
  auto notFinite = lid(3.4, 0);
  notFinite->GetPoints()->SetPoint(3, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  const std::pair<vtkSmartPointer<vtkPolyData>, const char*> cases[] = {
    { vtkSmartPointer<vtkPolyData>::New(), "no polygons" }, { notFinite, "not finite" },
    { moved(largerBrick(), away), "" }, { moved(lid(3.4, 0), away), "No node that moves reaches" },
    { moved(lid(3.4, 0), farAway), "farther from the mesh than 100,000 times its size" }
  };
  for (const auto& [target, message] : cases)
  {
    SCOPED_TRACE(message);
    auto filter = make(grid, target);
    grids::expectError(filter, message);
    EXPECT_STREQ(filter->GetMorphStatus(), "Failed");
    EXPECT_EQ(filter->GetInvertedCells(), -1);
    EXPECT_EQ(filter->GetMaxTargetDistance(), -1);
    EXPECT_EQ(grids::points(filter->GetOutput()), grids::points(grid));
    // And a good one after it.
    filter->SetTargetData(largerBrick());
    filter->Update();
    EXPECT_STREQ(filter->GetMorphStatus(), "Valid");
  }
}

TEST(FitToSurface, TrianglesThatAreNoPartOfTheTargetChangeNothing)
{
  auto grid = ball();
  // Turned, as a symmetric node would have two nearest places, and might take either.
  vtkNew<vtkTransform> turn;
  turn->RotateWXYZ(20, 1, 2, 3);
  const auto target = moved(ellipsoid(), turn);
  for (const bool align : { false, true })
  {
    SCOPED_TRACE(align);
    const auto fitted = [&](vtkPolyData* surface)
    {
      auto filter = make(grid, surface);
      filter->SetAlignTarget(align);
      grids::updateQuietly(filter);
      return grids::points(filter->GetOutput());
    };
    const morph::Points clean = fitted(target);
    EXPECT_LT((fitted(withFaults(target)) - clean).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((fitted(withFlatTriangle(target)) - clean).cwiseAbs().maxCoeff(),
      align ? 2e-3 : 1e-6); // its points are in single precision
  }
}

TEST(FitToSurface, TheRimGoesToTargetAndSlidingSidesTogether)
{
  auto grid = grids::make(meshes::hexes(24, 16, 12));
  {
    morph::Points x = grids::points(grid) / 4;
    for (morph::Index i = 0; i < x.rows(); ++i)
    {
      grid->GetPoints()->SetPoint(i, x.row(i).data());
    }
  }
  const morph::Points x = grids::points(grid);
  auto filter = onto(grid, hills(3.2, 0.7));
  grids::updateQuietly(filter);
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-9);
  EXPECT_EQ(filter->GetInvertedCells(), 0);
  const morph::Points y = grids::points(filter->GetOutput());
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    for (const auto& [axis, side] :
      { std::pair(0, 0.), std::pair(0, 6.), std::pair(1, 0.), std::pair(1, 4.) })
    {
      if (x(i, axis) == side)
      {
        EXPECT_NEAR(y(i, axis), side, 1e-12) << i;
      }
    }
  }
}

TEST(FitToSurface, NodesGoToTheTargetAlongADirection)
{
  auto grid = brick();
  const morph::Points x = grids::points(grid);
  auto filter = onto(grid, hills(3.2, 0.7));
  grids::Listener listener(filter);
  filter->SetProjectAlongToZ();
  filter->Update();
  ASSERT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
  const morph::Points along = grids::points(filter->GetOutput());
  EXPECT_GT((along - x).col(2).cwiseAbs().maxCoeff(), 0.5);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x(i, 2) == 3)
    {
      EXPECT_LT((along.row(i) - x.row(i)).head(2).norm(), 1e-12) << i;
    }
  }
  // The same by a vector, and by the normals of the flat top.
  filter->SetProjectAlongToVector();
  filter->SetProjectVector(0, 0, -5);
  filter->Update();
  EXPECT_LT((grids::points(filter->GetOutput()) - along).cwiseAbs().maxCoeff(), 1e-12);
  filter->SetProjectAlongToNormal();
  filter->Update();
  EXPECT_LT((grids::points(filter->GetOutput()) - along).cwiseAbs().maxCoeff(), 1e-12);
  // Askew, sliding sides keep their nodes, and others go askew.
  filter->SetProjectAlongToVector();
  filter->SetProjectVector(0.3, 0, 1);
  filter->Update();
  const morph::Points askew = grids::points(filter->GetOutput());
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (x(i, 2) == 3)
    {
      const double dx = askew(i, 0) - x(i, 0), dz = askew(i, 2) - 3;
      const bool isOnSide = x(i, 0) == 0 || x(i, 0) == 6;
      EXPECT_NEAR(dx, isOnSide ? 0 : 0.3 * dz, 1e-12) << i;
    }
  }
  filter->SetProjectVector(0, 0, 0);
  filter->Update();
  listener.ExpectError("`ProjectVector` has no length");
}

TEST(FitToSurface, ATargetIsOrientedByWhatMovesAlone)
{
  // The canyon's walls are steep, and its floor is near the bottom, whose normals are opposite.
  auto filter = onto(brick(), canyon());
  filter->SetProjectAlongToZ();
  filter->SetTargetAngle(80);
  filter->SetTargetReach(2);
  filter->SetValidityToReport();
  filter->Update();
  EXPECT_LT(filter->GetMaxTargetDistance(), 1e-12);
}

TEST(FitToSurface, NodesThatMissTheTargetAlongADirectionFollowTheOthers)
{
  // The target ends before the brick does.
  auto grid = brick();
  const morph::Points x = grids::points(grid);
  auto filter = make(grid, lid(3.4, -0.5));
  filter->SetProjectAlongToZ();
  grids::expectWarning(filter, "within `TargetReach` along the direction");
  EXPECT_NEAR(filter->GetMinScaledJacobian(), 1, 0.2);
  // To its very rim, in single precision, nodes are on it.
  auto exact = make(grid, lid(3.4, 0));
  exact->SetProjectAlongToZ();
  const grids::Run other(exact);
  EXPECT_TRUE(other.Warnings.empty()) << other.Warnings[0];
  EXPECT_LT(exact->GetMaxTargetDistance(), 1e-6);
}

TEST(FitToSurface, WithoutATargetTheBoundaryIsShown)
{
  auto grid = brick();
  auto filter = make(grid, nullptr);
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_STREQ(filter->GetMorphStatus(), "None");
  filter->SetMovingToEverything();
  filter->Update();
  listener.ExpectError("There is no target");
}

TEST(FitToSurface, NodesOutOfReachAreNamedAndTheResultIsKeptUntilTheTargetChanges)
{
  auto grid = brick();
  auto target = lid(3.4, 0);
  auto filter = make(grid, target);
  grids::Listener listener(filter);
  filter->SetMovingToEverything();
  filter->SetTargetReach(0.1);
  filter->Update();
  ASSERT_FALSE(listener.Warnings.empty());
  EXPECT_NE(listener.Warnings[0].find("do not reach the target"), std::string::npos);
  const double first = filter->GetMeanTargetDistance();
  EXPECT_GT(first, 0.1);
  filter->SetTargetData(lid(3.2, 0));
  filter->Update();
  EXPECT_LT(filter->GetMeanTargetDistance(), first);
}
