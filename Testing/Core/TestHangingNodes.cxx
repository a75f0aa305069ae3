// SPDX-License-Identifier: BSD-3-Clause
// Faces that are divided on one side alone: no gap opens there, and all else is as elsewhere.
#include "Boundary/Classification.h"
#include "Boundary/FaceQuality.h"
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/HangingNodes.h"
#include "Meshes.h"
#include "Motions.h"
#include "Octree.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace
{
using namespace morph;
using motions::Row;

/// The octree, and what a session needs with it.
struct Octree : meshes::Octree
{
  meshes::ThreadedMonitor monitor;

  explicit Octree(unsigned seed, int order = 1)
    : meshes::Octree(seed, order)
  {
    if (order == 2) // faces are curved, and their nodes at the shape functions' places
    {
      meshes::transform(mesh,
        [](const Row& x) -> Row
        { return x + 0.05 * Row(x[1] * x[2], x[0] * x[0] - x[2] * x[0], x[1] * x[1]); });
    }
  }

  morph::BoundaryTargets boundary(const motions::Map& map)
  {
    const morph::NodePartition outer = motions::outerPartition(mesh);
    return { outer.prescribed, motions::targets(mesh, outer, map) };
  }
};
constexpr int Width = Octree::Width, Height = Octree::Height;

Row twisted(const Row& x)
{
  return motions::twist(x, Width, Height, 0.5);
}

std::shared_ptr<morph::StepResult> morphed(
  Octree& octree, const motions::Map& map, Session::Options options)
{
  Session session;
  session.setMesh(octree.mesh, octree.monitor);
  return session.morph(octree.boundary(map), options, octree.monitor);
}

class HangingNodesOf : public testing::TestWithParam<meshes::LinearMethod>
{
protected:
  Session::Options options() const
  {
    Session::Options options;
    options.createMorpher = [this] { return this->GetParam().make(); };
    return options;
  }
};
}

TEST(HangingNodes, AreThoseOfTheRefinement)
{
  for (unsigned trial = 0; trial < 20; ++trial)
  {
    const int order = trial % 2 == 0 ? 1 : 2;
    Octree octree(meshes::seed() + trial, order);
    const meshes::Octree straight(meshes::seed() + trial, order);
    HangingNodes found;
    const morph::BoundaryFaces outer = morph::boundaryFaces(octree.mesh, found, octree.monitor);
    std::set<Index> expected;
    for (const Octree::Hanging& own : octree.hanging)
    {
      expected.insert(own.node);
    }
    EXPECT_EQ(std::set<Index>(found.nodes().begin(), found.nodes().end()), expected)
      << "seed " << meshes::seed() << ", trial " << trial;
    const auto isOnBox = [&](Index node)
    {
      const Row x = straight.mesh.points.row(node);
      return (x.array() == 0 || x.array() == Row(Width, Width, Height).array()).any();
    };
    EXPECT_TRUE(std::all_of(outer.nodes.begin(), outer.nodes.end(), isOnBox));
    EXPECT_TRUE(
      morph::UndeformedMesh(octree.mesh, nullptr, octree.monitor).touchingNodes().empty());
    const Mesh conforming = found.conforming(octree.mesh);
    EXPECT_NO_THROW(morph::validate(conforming));
    EXPECT_EQ(morph::boundaryFaces(conforming, octree.monitor).cells.size(), outer.cells.size());
  }
}

// A face of a tetrahedron in four, and a quadrilateral under two triangles.
TEST(HangingNodes, DoNotDivideTheSidesOfTheBox)
{
  for (unsigned trial = 0; trial < 20; ++trial)
  {
    SCOPED_TRACE(meshes::seed() + trial);
    Octree octree(meshes::seed() + trial);
    const morph::BoundaryFaces faces = morph::boundaryFaces(octree.mesh, octree.monitor);

    const morph::Classification geometry =
      morph::classify(octree.mesh, faces, morph::ClassificationOptions(), octree.monitor);

    EXPECT_EQ(geometry.surfaces.size(), 6u);
    EXPECT_EQ(geometry.curves.size(), 12u);
    EXPECT_NEAR(morph::faceAreas(octree.mesh.points, faces).rowwise().norm().sum(),
      2 * Width * Width + 4 * Width * Height, 1e-12 * Width);
  }
}

TEST(HangingNodes, OfTrianglesAndOfFacesThatAreCut)
{
  morph::Monitor monitor;
  Mesh tets;
  tets.points.resize(8, 3);
  tets.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .5, 0, 0, .5, .5, 0, 0, .5, 0, 0, 0, -1;
  meshes::add(tets, morph::Tetra, { 0, 1, 2, 3 });
  for (const auto& base :
    { std::array<Index, 3>{ 0, 4, 6 }, { 4, 1, 5 }, { 6, 5, 2 }, { 4, 5, 6 } })
  {
    meshes::add(tets, morph::Tetra, { base[0], base[2], base[1], 7 });
  }
  HangingNodes hanging;
  EXPECT_EQ(morph::boundaryFaces(tets, hanging, monitor).cells.size(), 3u + 6u);
  EXPECT_EQ(hanging.nodes(), (std::vector<Index>{ 4, 5, 6 }));

  Mesh cut = meshes::hexes(1, 1, 1);
  cut.points.conservativeResize(9, 3);
  cut.points.row(8) << .5, .5, 2;
  meshes::add(cut, morph::Tetra, { 4, 5, 7, 8 });
  meshes::add(cut, morph::Tetra, { 5, 7, 6, 8 });
  const morph::BoundaryFaces outer = morph::boundaryFaces(cut, hanging, monitor);
  EXPECT_TRUE(hanging.nodes().empty());
  EXPECT_FALSE(hanging.empty());
  EXPECT_EQ(outer.cells.size(), 5u + 4u);
}

// The parts at a corner that is pulled in lie in the face the other way around.
TEST(HangingNodes, OfAFaceThatIsFolded)
{
  const double corners[4][2] = { { 0, 0 }, { 1, 0 }, { .2, .2 }, { 0, 1 } };
  Mesh mesh = meshes::hexes(2, 2, 1); // below z = 1, nodes by rows
  for (Index n = 0; n < 18; ++n)
  {
    const double u = mesh.points(n, 0) / 2, v = mesh.points(n, 1) / 2;
    const double N[4] = { (1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v };
    mesh.points.row(n).head<2>().setZero();
    for (int a = 0; a < 4; ++a)
    {
      mesh.points.row(n).head<2>() += N[a] * Eigen::RowVector2d(corners[a][0], corners[a][1]);
    }
  }
  mesh.points.conservativeResize(22, 3);
  for (Index a = 0; a < 4; ++a)
  {
    mesh.points.row(18 + a) << corners[a][0], corners[a][1], 2;
  }
  meshes::add(mesh, morph::Hexahedron, { 9, 11, 17, 15, 18, 19, 20, 21 });
  morph::Monitor monitor;
  HangingNodes found;
  morph::boundaryFaces(mesh, found, monitor);
  EXPECT_EQ(found.nodes(), (std::vector<Index>{ 10, 12, 13, 14, 16 }));
}

// The middle of the large edge follows its corners, and what hangs follows it.
TEST(HangingNodes, AreTiedToNodesThatFollow)
{
  const Mesh mesh = meshes::dividedInThree();
  morph::Monitor monitor;
  const auto corners = [&](const std::vector<Index>& all)
  {
    std::vector<Index> ids;
    std::copy_if(
      all.begin(), all.end(), std::back_inserter(ids), [](Index node) { return node < 36; });
    return ids;
  };
  const morph::NodePartition outer = motions::outerPartition(mesh);
  morph::BoundaryTargets boundary;
  boundary.ids = corners(outer.prescribed);
  boundary.targets = motions::mapped(mesh.points, twisted)(boundary.ids, morph::allColumns);
  Session session;
  session.setMesh(mesh, monitor);
  Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };

  const Points moved = session.morph(boundary, options, monitor)->moved;

  // Of the large edge from (0, 0, 1) to (3, 0, 1) at a third.
  const Index* large = mesh.cell(9);
  const Row expected =
    2. / 9 * moved.row(large[0]) + 8. / 9 * moved.row(large[8]) - 1. / 9 * moved.row(large[1]);
  ASSERT_EQ(mesh.points.row(17), Row(1, 0, 1));
  EXPECT_LT((moved.row(17) - expected).norm(), 1e-12 * meshes::size(mesh.points));
  EXPECT_GT((moved.row(large[8]) - mesh.points.row(large[8])).norm(), 0.01);
}

// The large cell is a hexahedron of seven nodes, and so a polyhedron.
TEST(HangingNodes, HangOnCollapsedCells)
{
  Mesh mesh = meshes::hexes(1, 1, 1); // of the nodes 1, 3, 5 and 7 at x = 1
  mesh.connectivity[3] = 0;           // 0 and 2 are one node
  const Mesh fine = meshes::hexes(2, 2, 2);
  std::vector<Index> to;
  for (Index n = 0; n < fine.numberOfNodes(); ++n)
  {
    const Row x = fine.points.row(n) / 2 + Row(1, 0, 0);
    Index found = 0;
    while (found < mesh.numberOfNodes() && mesh.points.row(found) != x)
    {
      ++found;
    }
    if (found == mesh.numberOfNodes())
    {
      mesh.points.conservativeResize(found + 1, 3);
      mesh.points.row(found) = x;
    }
    to.push_back(found);
  }
  for (Index c = 0; c < fine.numberOfCells(); ++c)
  {
    std::vector<Index> nodes;
    std::transform(fine.cell(c), fine.cell(c) + 8, std::back_inserter(nodes),
      [&](Index node) { return to[node]; });
    meshes::add(mesh, morph::Hexahedron, nodes);
  }
  morph::Monitor monitor;
  morph::recognizeCells(mesh, monitor);
  ASSERT_EQ(int(mesh.types[0]), int(morph::Polyhedron));
  HangingNodes hanging;

  const morph::BoundaryFaces outer = morph::boundaryFaces(mesh, hanging, monitor);

  EXPECT_EQ(hanging.nodes().size(), 5u);
  EXPECT_EQ(outer.cells.size(), 5u + 5 * 4);
  const Mesh conforming = hanging.conforming(mesh);
  EXPECT_NO_THROW(morph::validate(conforming));
  EXPECT_EQ(morph::boundaryFaces(conforming, monitor).cells.size(), outer.cells.size());
  Session session;
  session.setMesh(mesh, monitor);
  Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  const morph::NodePartition partition = motions::outerPartition(mesh);
  const auto step = session.morph(
    { partition.prescribed, motions::targets(mesh, partition, motions::affine) }, options, monitor);
  for (const Index node : to)
  {
    const Row x = mesh.points.row(node);
    EXPECT_LT((step->moved.row(node) - motions::affine(x)).norm(), 1e-10) << node;
  }
}

// Where all cells around an edge are on one side of it, its nodes are on the boundary.
TEST(HangingNodes, OnAnEdgeOfTheBoundaryAreItsNodes)
{
  for (const int order : { 1, 2 })
  {
    SCOPED_TRACE(order);
    Octree octree(meshes::seed(), order);
    Mesh part; // some cells at random, so that faces of all kinds are outer ones
    part.points = octree.mesh.points;
    std::mt19937 random(meshes::seed());
    for (Index c = 0; c < octree.mesh.numberOfCells(); ++c)
    {
      if (random() % 3 > 0)
      {
        meshes::add(part, octree.mesh.types[c],
          std::vector<Index>(octree.mesh.cell(c), octree.mesh.cell(c) + octree.mesh.cellSize(c)));
      }
    }

    const morph::BoundaryFaces faces = morph::boundaryFaces(part, octree.monitor);

    for (const Index corner : faces.connectivity)
    {
      const auto at = std::lower_bound(faces.nodes.begin(), faces.nodes.end(), corner);
      ASSERT_TRUE(at != faces.nodes.end() && *at == corner) << corner;
      const Index k = at - faces.nodes.begin();
      EXPECT_EQ(faces.between.begin(k), faces.between.end(k)) << corner;
    }
  }
}

// Two boxes that touch, and share no node.
TEST(HangingNodes, AreNotNodesOfAnotherBody)
{
  Mesh mesh = meshes::hexes(2, 2, 1);
  const Index nodes = mesh.numberOfNodes();
  mesh.points.conservativeResize(nodes + 8, 3);
  mesh.points.bottomRows(8) = 2 * meshes::hexes(1, 1, 1).points;
  mesh.points.bottomRows(8).col(2).array() += 1;
  std::vector<Index> box = { 0, 1, 3, 2, 4, 5, 7, 6 };
  std::for_each(box.begin(), box.end(), [&](Index& node) { node += nodes; });
  meshes::add(mesh, morph::Hexahedron, box);
  morph::Monitor monitor;
  HangingNodes hanging;
  EXPECT_EQ(morph::boundaryFaces(mesh, hanging, monitor).cells.size(), 16u + 6u);
  EXPECT_TRUE(hanging.empty());
}

TEST_P(HangingNodesOf, FollowAnAffineMotion)
{
  for (const int order : { 1, 2 })
  {
    Octree octree(meshes::seed(), order);
    const auto step = morphed(octree, motions::affine, this->options());
    const Points expected = motions::mapped(octree.mesh.points, motions::affine);
    EXPECT_LT(motions::difference(step->moved, expected), 1e-10 * meshes::size(octree.mesh.points))
      << "order " << order;
  }
}

TEST_P(HangingNodesOf, LeaveNoGapUnderATwist)
{
  for (const int order : { 1, 2 })
  {
    Octree octree(meshes::seed(), order);
    ASSERT_GT(octree.hanging.size(), 5u);
    ASSERT_GT(octree.gap(motions::mapped(octree.mesh.points, twisted)), 1e-4);
    const auto step = morphed(octree, twisted, this->options());
    EXPECT_LT(octree.gap(step->moved), 1e-12 * meshes::size(octree.mesh.points));
    EXPECT_EQ(step->valid.status, "Valid") << "order " << order;
  }
}

TEST_P(HangingNodesOf, HaveTheAdjointOfTheMotion)
{
  for (const int order : { 1, 2 })
  {
    Octree octree(meshes::seed(), order);
    const morph::BoundaryTargets still = octree.boundary([](const Row& x) { return x; });
    const morph::BoundaryTargets moved = octree.boundary(twisted);
    const Points gradient = Points::Random(octree.mesh.numberOfNodes(), 3);
    Session session;
    session.setMesh(octree.mesh, octree.monitor);

    const Points derivative =
      session.transpose(still.ids, gradient, this->options(), octree.monitor);

    const auto step = session.morph(moved, this->options(), octree.monitor);
    const double change = gradient.cwiseProduct(step->moved - octree.mesh.points).sum();
    EXPECT_NEAR(derivative.cwiseProduct(moved.targets - still.targets).sum(), change, 1e-6)
      << "order " << order;
  }
}

INSTANTIATE_TEST_SUITE_P(Linear, HangingNodesOf, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& info) { return info.param.name; });

TEST(HangingNodes, LeaveNoGapWhereCellsAreRepairedOrSmoothed)
{
  Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::InversionFree>(); };
  for (const int order : { 1, 2 })
  {
    Octree octree(meshes::seed(), order);
    for (const bool smooths : { false, true })
    {
      options.postSmooth = smooths;
      const auto step = morphed(octree, twisted, options);
      EXPECT_LT(octree.gap(step->moved), 1e-12 * meshes::size(octree.mesh.points));
      EXPECT_EQ(step->valid.status, "Valid") << "order " << order;
      EXPECT_TRUE(morph::invertedCells(octree.mesh, step->moved, {}, octree.monitor).empty());
    }
  }
}

TEST(HangingNodes, OfTheBoundaryAreNamedWhereTheyAreNotAtTheirTargets)
{
  Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::FemWarp>(); };
  Octree octree(meshes::seed());
  const auto step = morphed(octree, twisted, options);
  const morph::BoundaryTargets boundary = octree.boundary(twisted);
  std::vector<Index> dropped;
  for (std::size_t k = 0; k < boundary.ids.size(); ++k)
  {
    const Row off = step->moved.row(boundary.ids[k]) - boundary.targets.row(Index(k));
    if (off.norm() > 1e-6 * meshes::size(octree.mesh.points))
    {
      dropped.push_back(boundary.ids[k]);
    }
  }
  ASSERT_FALSE(dropped.empty());
  ASSERT_EQ(octree.monitor.warnings.size(), 1u);
  EXPECT_EQ(octree.monitor.warnings[0], morph::noteOfDropped(dropped));
  EXPECT_EQ(octree.monitor.warnings[0].find(std::to_string(dropped.size()) + " nodes"), 0u);

  Octree straight(meshes::seed());
  morphed(straight, motions::affine, options);
  EXPECT_TRUE(straight.monitor.warnings.empty());
}
