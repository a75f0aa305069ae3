// SPDX-License-Identifier: BSD-3-Clause
// Which nodes the boundary's points stand for: every route, and their order.
#include "../Core/BoundaryShapes.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Mesh/Topology.h"
#include "vtkFEMWarpMorph.h"

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

using morph::Index;
using morph::Points;

class MorphMatching : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Mesh = meshes::hexes(4, 4, 4);
    meshes::jitterInterior(this->Mesh, 0.15, meshes::seed());
    this->Grid = grids::make(this->Mesh);
    morph::Monitor serial;
    this->Outer = morph::boundaryFaces(this->Mesh, serial).nodes;
    this->Rest = meshes::rows(this->Mesh.points, this->Outer);
    this->Targets = grids::mapped(this->Rest, grids::twist);
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(grids::boundary(this->Grid, grids::twist));
    this->Filter->Update();
    this->Expected = grids::points(this->Filter->GetOutput());
  }

  /// Runs a new filter, expecting no error; returns its points.
  Points Run(vtkPointSet* boundary)
  {
    this->Filter = vtkSmartPointer<vtkFEMWarpMorph>::New();
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetBoundaryData(boundary);
    return this->RunAgain();
  }
  Points RunAgain()
  {
    const grids::Run listener(this->Filter);
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    this->Warnings = listener.Warnings;
    return grids::points(this->Filter->GetOutput());
  }

  morph::Mesh Mesh;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::vector<Index> Outer;
  Points Rest, Targets, Expected;
  vtkSmartPointer<vtkFEMWarpMorph> Filter = vtkSmartPointer<vtkFEMWarpMorph>::New();
  std::vector<std::string> Warnings;
};

TEST_F(MorphMatching, BoundaryIdArrayComesFirst)
{
  auto boundary = grids::cloud(this->Targets);
  grids::addIds(boundary, "Mine", this->Outer);
  grids::addIds(boundary, "MorphPointId", std::vector<Index>(this->Outer.size(), 0));
  this->Filter->SetBoundaryIdArray("Mine");
  this->Filter->SetBoundaryData(boundary);
  EXPECT_TRUE(this->RunAgain() == this->Expected);
}

TEST_F(MorphMatching, BoundaryIdsMayBeFloatingPoint)
{
  auto boundary = grids::cloud(this->Targets);
  vtkNew<vtkFloatArray> ids;
  ids->SetName("FromTable");
  for (Index id : this->Outer)
  {
    ids->InsertNextValue(static_cast<float>(id));
  }
  boundary->GetPointData()->AddArray(ids);
  this->Filter->SetBoundaryIdArray("FromTable");
  this->Filter->SetBoundaryData(boundary);
  EXPECT_TRUE(this->RunAgain() == this->Expected);
}

TEST_F(MorphMatching, MorphPointIdComesBeforeTheOthers)
{
  auto boundary = grids::cloud(this->Targets);
  const std::vector<Index> wrong(this->Outer.size(), 0);
  grids::addIds(boundary, "vtkOriginalPointIds", wrong);
  grids::addIds(boundary, "PointIds", wrong);
  grids::addIds(boundary, "MorphPointId", this->Outer);
  EXPECT_TRUE(this->Run(boundary) == this->Expected);
  EXPECT_TRUE(this->Warnings.empty());
}

TEST_F(MorphMatching, NoneMeansNone)
{
  this->Filter->SetBoundaryIdArray("None");
  this->Filter->SetDisplacementArray("None");
  EXPECT_TRUE(this->RunAgain() == this->Expected);
  this->Filter->SetBoundaryIdArray("");
  this->Filter->SetDisplacementArray("");
  EXPECT_TRUE(this->RunAgain() == this->Expected);
}

TEST_F(MorphMatching, WarpedCopyOfTheGridGivesItsOuterNodes)
{
  Points all = Points::Constant(this->Mesh.numberOfNodes(), 3, 1e6);
  for (std::size_t i = 0; i < this->Outer.size(); ++i)
  {
    all.row(this->Outer[i]) = this->Targets.row(static_cast<Index>(i));
  }
  auto warped = grids::copy(this->Grid);
  warped->SetPoints(grids::cloud(all)->GetPoints());
  // Comes before PointIds, which a copy of a copy may still have.
  grids::addIds(warped, "PointIds", std::vector<Index>(this->Mesh.numberOfNodes(), 0));
  EXPECT_TRUE(this->Run(warped) == this->Expected);
  EXPECT_EQ(this->Filter->GetPrescribedPoints(), static_cast<vtkIdType>(this->Outer.size()));
}

TEST_F(MorphMatching, PointIdsOfGenerateIds)
{
  auto boundary = grids::cloud(this->Targets);
  grids::addIds(boundary, "vtkOriginalPointIds", std::vector<Index>(this->Outer.size(), 0));
  grids::addIds(boundary, "PointIds", this->Outer);
  EXPECT_TRUE(this->Run(boundary) == this->Expected);
  EXPECT_TRUE(this->Warnings.empty());
}

TEST_F(MorphMatching, IdsThatNumberTheBoundaryItselfDrawAWarning)
{
  auto boundary = grids::cloud(this->Rest.topRows(40));
  std::vector<Index> own(40);
  std::iota(own.begin(), own.end(), Index(0));
  grids::addIds(boundary, "PointIds", own);
  this->Run(boundary);
  // The others: nodes in wrong places invert cells, and faces run into each other.
  ASSERT_EQ(this->Warnings.size(), 3u);
  EXPECT_NE(this->Warnings[0].find("not on the grid's outer boundary"), std::string::npos);
}

TEST_F(MorphMatching, OriginalPointIdsWithAWarning)
{
  auto boundary = grids::cloud(this->Targets);
  grids::addIds(boundary, "vtkOriginalPointIds", this->Outer);
  EXPECT_TRUE(this->Run(boundary) == this->Expected);
  ASSERT_EQ(this->Warnings.size(), 1u);
  EXPECT_NE(this->Warnings[0].find("vtkOriginalPointIds"), std::string::npos);
}

TEST_F(MorphMatching, RestPositionWithADisplacementArray)
{
  // Rounded to float, in another order, with a point that belongs to no node.
  const Index count = static_cast<Index>(this->Outer.size());
  Points positions(count + 1, 3), vectors(count + 1, 3);
  for (Index i = 0; i < count; ++i)
  {
    const Index from = count - 1 - i;
    positions.row(i) = this->Rest.row(from).cast<float>().cast<double>();
    vectors.row(i) = this->Targets.row(from) - this->Rest.row(from);
  }
  positions.row(count) << 0.5, 0.5, 0;
  vectors.row(count) << 0, 0, 9;
  auto boundary = grids::cloud(positions);
  grids::addVectors(boundary, "Shift", vectors);
  this->Filter->SetBoundaryData(boundary);
  this->Filter->SetDisplacementArray("Shift");
  EXPECT_LT((this->RunAgain() - this->Expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(this->Filter->GetUnmatchedPoints(), 1);
  ASSERT_EQ(this->Warnings.size(), 1u);
  EXPECT_NE(this->Warnings[0].find("1 of the boundary's 99 points"), std::string::npos);
}

/// Two bodies that touch, `gap` apart, with a node each on the interface: those of the second, in
/// the same order, come after those of the first.
class MorphTouching : public MorphMatching
{
protected:
  /// The filter's input. Returns the outer nodes of both.
  std::vector<Index> MakeBodies(double gap)
  {
    const morph::Mesh one = meshes::hexes(3, 3, 3);
    this->Nodes = one.numberOfNodes();
    morph::Mesh& two = this->Mesh =
      shapes::together(one, meshes::shifted(one, grids::Row(3 + gap, 0, 0)));
    this->Grid = grids::make(two);
    this->Filter->SetInputData(this->Grid);
    morph::Monitor serial;
    return morph::boundaryFaces(two, serial).nodes;
  }
  Points Move(const Points& positions, const Points& vectors)
  {
    auto boundary = grids::cloud(positions);
    grids::addVectors(boundary, "Shift", vectors);
    this->Filter->SetBoundaryData(boundary);
    this->Filter->SetDisplacementArray("Shift");
    return this->RunAgain();
  }
  Index Nodes = 0; ///< of one body
};

TEST_F(MorphTouching, PositionRouteTakesAllNodesInOnePlace)
{
  for (const double gap : { 0.0, 1e-15, 1e-9 })
  {
    SCOPED_TRACE(gap);
    const std::vector<Index> outer = this->MakeBodies(gap);
    // Only the first body's points are given.
    const std::vector<Index> first(
      outer.begin(), outer.begin() + static_cast<Index>(outer.size()) / 2);
    const Points rest = meshes::rows(this->Mesh.points, first);
    const Points moved = this->Move(rest, Points::Constant(rest.rows(), 3, 0.125));
    int interface = 0;
    for (Index n = 0; n < this->Nodes; ++n)
    {
      const bool touches = this->Mesh.points(n, 0) == 0;
      const Index other = this->Nodes + n;
      interface += touches;
      if (touches || this->Mesh.points(n, 0) == 3) // the far side is held
      {
        const double shift = touches ? 0.125 : 0;
        EXPECT_TRUE(moved.row(other) == this->Mesh.points.row(other) + grids::Row::Constant(shift));
      }
    }
    EXPECT_EQ(interface, 16);
  }
}

TEST_F(MorphTouching, PositionRouteLetsEachNodeFollowItsOwnPoint)
{
  const std::vector<Index> outer = this->MakeBodies(1e-9);
  const Points rest = meshes::rows(this->Mesh.points, outer);
  // Rounded to float the two points are in one place, and their displacements differ a little.
  const Points rounded = rest.cast<float>().cast<double>();
  for (const Points& positions : { rest, rounded })
  {
    const Points moved = this->Move(positions, 0.1 * rest);
    EXPECT_TRUE(this->Warnings.empty());
    ASSERT_EQ(moved.rows(), 2 * this->Nodes);
    for (std::size_t i = 0; i < outer.size(); ++i)
    {
      EXPECT_LT((moved.row(outer[i]) - 1.1 * rest.row(static_cast<Index>(i))).norm(), 1e-8);
    }
  }
  const Points moved = this->Move(rest, 0.1 * rest);
  for (std::size_t i = 0; i < outer.size(); ++i)
  {
    const Index k = static_cast<Index>(i);
    EXPECT_TRUE(moved.row(outer[i]) == rest.row(k) + (0.1 * rest).row(k));
  }
}

TEST_F(MorphMatching, PositionRouteLeavesInteriorNodesNearbyAlone)
{
  // With a tolerance of several cells, a point still stands for one node.
  auto boundary = grids::cloud(this->Rest);
  grids::addVectors(boundary, "Shift", this->Targets - this->Rest);
  this->Filter->SetBoundaryData(boundary);
  this->Filter->SetDisplacementArray("Shift");
  this->Filter->SetMatchTolerance(0.5);
  EXPECT_LT((this->RunAgain() - this->Expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(this->Filter->GetPrescribedPoints(), static_cast<vtkIdType>(this->Outer.size()));
}

TEST_F(MorphMatching, PositionRouteLeavesOuterNodesOfTheSameCellAlone)
{
  // Only the top face is given, and the tolerance reaches several cells.
  std::vector<Index> top;
  std::copy_if(this->Outer.begin(), this->Outer.end(), std::back_inserter(top),
    [this](Index id) { return this->Mesh.points(id, 2) == 4; });
  auto boundary = grids::cloud(meshes::rows(this->Mesh.points, top));
  grids::addVectors(boundary, "Shift", Points::Constant(25, 3, 0.125));
  this->Filter->SetBoundaryData(boundary);
  this->Filter->SetDisplacementArray("Shift");
  this->Filter->SetMatchTolerance(0.5);
  const Points moved = this->RunAgain();
  for (const Index id : this->Outer)
  {
    const double shift = this->Mesh.points(id, 2) == 4 ? 0.125 : 0;
    EXPECT_EQ(moved.row(id), this->Mesh.points.row(id) + grids::Row::Constant(shift)) << id;
  }
}

TEST_F(MorphMatching, DisplacementArrayWithIds)
{
  // With ids the points themselves do not matter.
  auto boundary = grids::cloud(Points::Constant(this->Rest.rows(), 3, 77));
  grids::addIds(boundary, "MorphPointId", this->Outer);
  grids::addVectors(boundary, "Shift", this->Targets - this->Rest);
  this->Filter->SetBoundaryData(boundary);
  this->Filter->SetDisplacementArray("Shift");
  EXPECT_LT((this->RunAgain() - this->Expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(MorphMatching, VectorsAloneAreNoDisplacement)
{
  auto boundary = grids::boundary(this->Grid, grids::twist);
  grids::addVectors(boundary, "Normals", Points::Constant(this->Rest.rows(), 3, 1));
  boundary->GetPointData()->SetActiveVectors("Normals");
  EXPECT_TRUE(this->Run(boundary) == this->Expected);
}

TEST_F(MorphMatching, UnnamedBoundaryIsHeldOrSolved)
{
  // Only the top face is named.
  std::vector<Index> top;
  for (Index id : this->Outer)
  {
    if (this->Mesh.points(id, 2) == 4)
    {
      top.push_back(id);
    }
  }
  const grids::Row up(0, 0, 1);
  Points targets = meshes::rows(this->Mesh.points, top);
  targets.rowwise() += up;
  auto boundary = grids::cloud(targets);
  grids::addIds(boundary, "MorphPointId", top);
  Points moved = this->Run(boundary);
  EXPECT_EQ(this->Filter->GetPrescribedPoints(), static_cast<vtkIdType>(this->Outer.size()));
  for (Index id : this->Outer)
  {
    const grids::Row expected =
      this->Mesh.points.row(id) +
      (this->Mesh.points(id, 2) == 4 ? up : grids::Row(grids::Row::Zero()));
    EXPECT_TRUE(moved.row(id) == expected);
  }
  this->Filter->FixUnnamedBoundaryOff();
  this->Filter->SetTolerance(1e-12);
  moved = this->RunAgain();
  EXPECT_EQ(this->Filter->GetPrescribedPoints(), 25);
  // Nothing else is fixed: the body follows its top face.
  EXPECT_LT((moved.rowwise() - up - this->Mesh.points).cwiseAbs().maxCoeff(), 1e-9);
}

class MorphMiddles : public testing::TestWithParam<const char*>
{
protected:
  static morph::Mesh Mesh()
  {
    for (const auto& [name, mesh] : meshes::all(3, 3, 3))
    {
      if (name == GetParam())
      {
        return mesh;
      }
    }
    return {};
  }
  /// Those outer corners that `wanted` says, moved by `map`.
  static vtkSmartPointer<vtkPolyData> Corners(const morph::Mesh& mesh,
    const std::function<bool(const grids::Row&)>& wanted, const grids::Map& map)
  {
    morph::Monitor serial;
    const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, serial);
    const std::set<Index> corners(faces.connectivity.begin(), faces.connectivity.end());
    std::vector<Index> ids;
    for (const Index id : corners)
    {
      if (wanted(mesh.points.row(id)))
      {
        ids.push_back(id);
      }
    }
    auto boundary = grids::cloud(grids::mapped(meshes::rows(mesh.points, ids), map));
    grids::addIds(boundary, "MorphPointId", ids);
    return boundary;
  }
  static Points Run(const morph::Mesh& mesh, vtkPolyData* boundary)
  {
    auto filter = grids::morphed<vtkFEMWarpMorph>(grids::make(mesh), boundary);
    filter->SetTolerance(1e-13);
    grids::update(filter);
    return grids::points(filter->GetOutput());
  }
};

TEST_P(MorphMiddles, FollowWhereCornersAloneAreNamed)
{
  const morph::Mesh mesh = Mesh();
  const auto boundary = Corners(
    mesh, [](const grids::Row&) { return true; },
    [](const grids::Row& x) { return grids::Row(2 * x); });
  const Points moved = Run(mesh, boundary);
  ASSERT_EQ(moved.rows(), mesh.numberOfNodes());
  EXPECT_LT((moved - 2 * mesh.points).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_P(MorphMiddles, AreHeldWhereCornersMoveByRounding)
{
  const morph::Mesh mesh = Mesh();
  const auto boundary = Corners(
    mesh, [](const grids::Row&) { return true; }, [](const grids::Row& x) { return x; });
  grids::addVectors(boundary, "Shift", Points::Constant(boundary->GetNumberOfPoints(), 3, 1e-16));
  auto filter = grids::morphed<vtkFEMWarpMorph>(grids::make(mesh), boundary);
  filter->SetDisplacementArray("Shift");
  filter->Update();
  morph::Monitor serial;
  const auto outer = static_cast<vtkIdType>(morph::boundaryFaces(mesh, serial).nodes.size());
  EXPECT_EQ(filter->GetPrescribedPoints(), outer);
}

TEST_P(MorphMiddles, StayBetweenCornersThatStay)
{
  morph::Mesh mesh = Mesh();
  // Curved edges, whose middles depend on the corners inside.
  meshes::transform(mesh, [](const grids::Row& x)
    { return grids::Row(x[0] + 0.05 * x[1] * x[1], x[1] + 0.05 * x[2] * x[2], x[2]); });
  const grids::Map up = [](const grids::Row& x) { return grids::Row(x[0], x[1], x[2] + 0.4); };
  const auto atTop = [](const grids::Row& x) { return x[2] == 3; };
  const auto expectHeld = [&](const Points& moved)
  {
    ASSERT_EQ(moved.rows(), mesh.numberOfNodes());
    morph::Monitor serial;
    int held = 0, followed = 0;
    for (const Index id : morph::boundaryFaces(mesh, serial).nodes)
    {
      const double z = mesh.points(id, 2);
      if (z <= 2)
      {
        ++held;
        EXPECT_TRUE(moved.row(id) == mesh.points.row(id)) << id;
      }
      else if (z < 3)
      {
        ++followed;
        EXPECT_NEAR(moved(id, 2), z + 0.2, 0.02) << id;
      }
      else
      {
        EXPECT_NEAR(moved(id, 2), 3.4, 0.01) << id;
      }
    }
    EXPECT_GT(held, 50);
    EXPECT_GT(followed, 10);
  };
  // The others unnamed, and named where they are.
  expectHeld(Run(mesh, Corners(mesh, atTop, up)));
  expectHeld(Run(mesh, Corners(
                         mesh, [](const grids::Row&) { return true; },
                         [&](const grids::Row& x) { return atTop(x) ? up(x) : x; })));
}

INSTANTIATE_TEST_SUITE_P(Quadratic, MorphMiddles, testing::Values("tet10", "hex20", "hex27"),
  [](const auto& info) { return std::string(info.param); });

TEST_F(MorphMatching, InteriorNodesMayBePrescribed)
{
  auto boundary = grids::cloud(grids::Row(2.25, 2, 2));
  grids::addIds(boundary, "MorphPointId", { 62 });
  const Points moved = this->Run(boundary);
  EXPECT_TRUE(moved.row(62) == grids::Row(2.25, 2, 2));
  EXPECT_EQ(this->Filter->GetPrescribedPoints(), static_cast<vtkIdType>(this->Outer.size()) + 1);
}

TEST_F(MorphMatching, DuplicatesThatAgreeAreAccepted)
{
  const Index count = static_cast<Index>(this->Outer.size());
  Points twice(2 * count, 3);
  twice << this->Targets, this->Targets;
  std::vector<Index> ids = this->Outer;
  ids.insert(ids.end(), this->Outer.begin(), this->Outer.end());
  auto boundary = grids::cloud(twice);
  grids::addIds(boundary, "MorphPointId", ids);
  EXPECT_TRUE(this->Run(boundary) == this->Expected);
}

TEST_F(MorphMatching, RestPositionWithThreeComponentsIsReadToo)
{
  auto boundary = grids::cloud(this->Targets);
  grids::addIds(boundary, "MorphPointId", this->Outer);
  grids::addVectors(boundary, "RestPosition", this->Rest);
  EXPECT_TRUE(this->Run(boundary) == this->Expected);

  grids::addVectors(boundary, "RestPosition", this->Rest.array() + 0.01);
  grids::expectError(this->Filter, "stale");
}
