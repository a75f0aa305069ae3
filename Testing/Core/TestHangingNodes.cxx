// SPDX-License-Identifier: BSD-3-Clause
// Faces that are divided on one side alone: no gap opens there, and all else is as elsewhere.
#include "Boundary/Classification.h"
#include "Boundary/FaceAreas.h"
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/HangingNodes.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace
{
using morph::HangingNodes;
using morph::Index;
using morph::Mesh;
using morph::Points;
using morph::Session;
using motions::Row;

constexpr int Width = 3, Height = 2; // cells of the box before refinement

/// A box of cubes, some of them in eight, some of these in eight again, and the nodes that hang.
struct Octree
{
  using Place = std::array<int, 3>; ///< in quarters of a cube
  struct Hanging
  {
    Index node;
    std::vector<Index> corners; ///< of the face or edge that it lies on
    std::vector<double> weights;
  };

  Mesh mesh;
  std::map<Place, Index> nodeAt;
  std::vector<Hanging> hanging;
  morph::Monitor monitor;

  explicit Octree(unsigned seed)
  {
    std::mt19937 random(seed);
    mesh.offsets = { 0 };
    mesh.points.resize(0, 3);
    std::vector<std::pair<Place, int>> boxes, open; // corners and sizes
    for (int c = 0; c < Width * Width * Height; ++c)
    {
      open.push_back({ { 4 * (c % Width), 4 * (c / Width % Width), 4 * (c / Width / Width) }, 4 });
    }
    for (std::size_t i = 0; i < open.size(); ++i)
    {
      const auto [low, size] = open[i];
      if (size == 1 || (i != 0 && (i == 1 || random() % 3 > 0))) // the second stays whole
      {
        boxes.emplace_back(low, size);
        continue;
      }
      for (int k = 0; k < 8; ++k)
      {
        open.emplace_back(at(low, { k % 2, k / 2 % 2, k / 4 }, size / 2), size / 2);
      }
    }
    for (const auto& [low, size] : boxes)
    {
      std::vector<Index> nodes;
      for (const Place& corner : Corner)
      {
        nodes.push_back(node(at(low, corner, size)));
      }
      meshes::add(mesh, morph::Hexahedron, nodes);
    }
    for (const auto& [low, size] : boxes)
    {
      findHanging(low, size);
    }
  }

  static constexpr Place Corner[8] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
    { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

  static Place at(const Place& low, const Place& step, int size)
  {
    return { low[0] + size * step[0], low[1] + size * step[1], low[2] + size * step[2] };
  }
  Index node(const Place& place)
  {
    const auto [found, isNew] = nodeAt.emplace(place, mesh.numberOfNodes());
    if (isNew)
    {
      mesh.points.conservativeResize(found->second + 1, 3);
      mesh.points.row(found->second) << place[0] / 4., place[1] / 4., place[2] / 4.;
    }
    return found->second;
  }
  /// Nodes on a box that are no corners of it.
  void findHanging(const Place& low, int size)
  {
    for (int k = 0; k < (size + 1) * (size + 1) * (size + 1); ++k)
    {
      const Place step = { k % (size + 1), k / (size + 1) % (size + 1),
        k / (size + 1) / (size + 1) };
      const auto found = nodeAt.find(at(low, step, 1));
      if (found == nodeAt.end())
      {
        continue;
      }
      Hanging own = { found->second, {}, {} };
      for (const Place& corner : Corner)
      {
        double weight = 1;
        for (int j = 0; j < 3; ++j)
        {
          const double part = static_cast<double>(step[j]) / size;
          weight *= corner[j] == 1 ? part : 1 - part;
        }
        if (weight > 0)
        {
          own.corners.push_back(nodeAt.at(at(low, corner, size)));
          own.weights.push_back(weight);
        }
      }
      if (own.corners.size() > 1)
      {
        hanging.push_back(own);
      }
    }
  }

  /// The largest distance of a node that hangs from its place on its face or edge.
  double gap(const Points& points) const
  {
    double most = 0;
    for (const Hanging& own : hanging)
    {
      Row off = points.row(own.node);
      for (std::size_t k = 0; k < own.corners.size(); ++k)
      {
        off -= own.weights[k] * points.row(own.corners[k]);
      }
      most = std::max(most, off.norm());
    }
    return most;
  }

  morph::BoundaryTargets boundary(const motions::Map& map)
  {
    const morph::NodePartition outer = motions::outerPartition(mesh);
    return { outer.prescribed, motions::targets(mesh, outer, map) };
  }
};

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
    Octree octree(meshes::seed() + trial);
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
      const Row x = octree.mesh.points.row(node);
      return (x.array() == 0 || x.array() == Row(Width, Width, Height).array()).any();
    };
    EXPECT_TRUE(std::all_of(outer.nodes.begin(), outer.nodes.end(), isOnBox));
    EXPECT_TRUE(
      morph::UndeformedMesh(octree.mesh, nullptr, octree.monitor).touchingNodes().empty());
    const Mesh conforming = found.conforming(octree.mesh);
    EXPECT_NO_THROW(morph::validate(conforming));
    EXPECT_EQ(morph::boundaryFaces(conforming, octree.monitor).nodes, outer.nodes);
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
  tets.offsets = { 0 };
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
  Octree octree(meshes::seed());
  const auto step = morphed(octree, motions::affine, this->options());
  const Points expected = motions::mapped(octree.mesh.points, motions::affine);
  EXPECT_LT(motions::difference(step->moved, expected), 1e-10 * meshes::size(octree.mesh.points));
}

TEST_P(HangingNodesOf, LeaveNoGapUnderATwist)
{
  Octree octree(meshes::seed());
  ASSERT_GT(octree.hanging.size(), 5u);
  ASSERT_GT(octree.gap(motions::mapped(octree.mesh.points, twisted)), 0.01);
  const auto step = morphed(octree, twisted, this->options());
  EXPECT_LT(octree.gap(step->moved), 1e-12 * meshes::size(octree.mesh.points));
  EXPECT_EQ(step->valid.status, "Valid");
}

TEST_P(HangingNodesOf, HaveTheAdjointOfTheMotion)
{
  Octree octree(meshes::seed());
  const morph::BoundaryTargets still = octree.boundary([](const Row& x) { return x; });
  const morph::BoundaryTargets moved = octree.boundary(twisted);
  const Points gradient = Points::Random(octree.mesh.numberOfNodes(), 3);
  Session session;
  session.setMesh(octree.mesh, octree.monitor);

  const Points derivative = session.transpose(still.ids, gradient, this->options(), octree.monitor);

  const auto step = session.morph(moved, this->options(), octree.monitor);
  const double change = gradient.cwiseProduct(step->moved - octree.mesh.points).sum();
  EXPECT_NEAR(derivative.cwiseProduct(moved.targets - still.targets).sum(), change, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Linear, HangingNodesOf, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& info) { return info.param.name; });

TEST(HangingNodes, LeaveNoGapWhereCellsAreRepairedOrSmoothed)
{
  Octree octree(meshes::seed());
  Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::InversionFree>(); };
  for (const bool smooths : { false, true })
  {
    options.postSmooth = smooths;
    const auto step = morphed(octree, twisted, options);
    EXPECT_LT(octree.gap(step->moved), 1e-12 * meshes::size(octree.mesh.points));
    EXPECT_EQ(step->valid.status, "Valid");
    EXPECT_TRUE(morph::invertedCells(octree.mesh, step->moved, {}, octree.monitor).empty());
  }
}
