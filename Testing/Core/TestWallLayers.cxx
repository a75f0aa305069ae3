// SPDX-License-Identifier: BSD-3-Clause
// Layers of cells on a wall, and how they move with it.
#include "Boundary/WallLayers.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Geometry/RotationFit.h"
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/InversionFree.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace morph;
using motions::Row;

namespace
{
/// The faces whose nodes all satisfy `is`.
std::vector<std::uint8_t> facesWhere(
  const Mesh& mesh, const BoundaryFaces& faces, const std::function<bool(const Row&)>& is)
{
  std::vector<std::uint8_t> result;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    result.push_back(std::all_of(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1],
      [&](Index node) { return is(mesh.points.row(node)); }));
  }
  return result;
}

bool isBottom(const Row& x)
{
  return std::abs(x[2]) < 1e-12;
}

Index longest(const WallLayers& layers)
{
  Index most = 0;
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    most = std::max(most, layers.columns.offsets[i + 1] - layers.columns.offsets[i]);
  }
  return most;
}

Index shortest(const WallLayers& layers)
{
  Index least = std::numeric_limits<Index>::max();
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    least = std::min(least, layers.columns.offsets[i + 1] - layers.columns.offsets[i]);
  }
  return least;
}

/// An O-grid around a wing-like section: a symmetric section of 12 % and chord 1, `span` cells in
/// span, with layers from `first` on that grow by 1.2, up to a radius of about 10.
Mesh oGrid(int around, int span, double first)
{
  std::vector<double> heights = { 0 };
  for (double step = first; heights.back() < 10; step *= 1.2)
  {
    heights.push_back(heights.back() + step);
  }
  const int layers = static_cast<int>(heights.size()) - 1;
  const Mesh open = meshes::hexes(layers, around, span);
  return meshes::closedAlongY(open, around,
    [&](const Row& x) -> Row
    {
      // The section is the image of a circle under a rounded Joukowski-like map: an ellipse-like
      // nose and a rounded trailing edge. Lines leave it along its normals, and turn into rays.
      const double t = 2 * M_PI * x[1] / around, c = std::cos(t), s = std::sin(t);
      const double dx = -0.5 * s, dy = 0.06 * (c * (1 - 0.6 * c) + 0.6 * s * s);
      const double size = std::hypot(dx, dy), h = heights[std::lround(x[0])];
      return { 0.5 * c + h * dy / size, 0.06 * s * (1 - 0.6 * c) - h * dx / size, 0.2 * x[2] };
    });
}

struct Figures
{
  double lean = 0;   ///< largest change of the angle between a line and the wall's normal, degrees
  double height = 0; ///< largest relative change of a first cell's height along the normal
  double growth = 0; ///< largest relative change of the growth of heights
  Index inverted = 0;
};

/// Moves the wall by `map`, keeps `count` layers (0: none), and morphs by `method`.
Figures kept(const Mesh& mesh, const std::function<bool(const Row&)>& isWall,
  const std::function<bool(const Row&)>& isFar, const motions::Map& map, Index count,
  Index measured, Morpher& method)
{
  meshes::ThreadedMonitor monitor(2);
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  const std::vector<std::uint8_t> wall = facesWhere(mesh, faces, isWall);
  const WallLayers layers = findWallLayers(mesh, faces, wall, measured, {});
  EXPECT_EQ(longest(layers), measured);
  EXPECT_EQ(shortest(layers), measured);
  Points target = mesh.points;
  std::vector<Index> prescribed;
  for (const Index n : faces.nodes)
  {
    if (isWall(mesh.points.row(n)))
    {
      target.row(n) = map(mesh.points.row(n));
    }
    if (isWall(mesh.points.row(n)) || isFar(mesh.points.row(n)))
    {
      prescribed.push_back(n);
    }
  }
  if (count > 0)
  {
    const WallLayers some = findWallLayers(mesh, faces, wall, count, {});
    moveLayers(mesh.points, faces, wall, some, target);
    prescribed.insert(prescribed.end(), some.columns.values.begin(), some.columns.values.end());
  }
  const NodePartition partition = partitionNodes(mesh, prescribed);
  Points moved =
    motions::morphed(method, mesh, partition, meshes::rows(target, partition.prescribed), monitor);

  Figures figures;
  figures.inverted =
    measureQuality(mesh, moved, cellSigns(mesh, connectedComponents(mesh)), {}, monitor).inverted;
  const auto normals = [&](const Points& points)
  {
    Points sum = Points::Zero(mesh.numberOfNodes(), 3);
    for (std::size_t f = 0; f < wall.size(); ++f)
    {
      const Index* n = faces.connectivity.data() + faces.offsets[f];
      const Row a = points.row(n[2]) - points.row(n[0]), b = points.row(n[3]) - points.row(n[1]);
      for (int k = 0; wall[f] && k < 4; ++k)
      {
        sum.row(n[k]) += a.cross(b).normalized();
      }
    }
    return sum;
  };
  const Points before = normals(mesh.points), after = normals(moved);
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    const Row n = -before.row(layers.walls[i]).normalized(),
              to = -after.row(layers.walls[i]).normalized();
    Index below = layers.walls[i];
    double last = 0, lastMoved = 0;
    for (const Index* node = layers.columns.begin(static_cast<Index>(i));
         node != layers.columns.end(static_cast<Index>(i)); ++node)
    {
      const Row line = mesh.points.row(*node) - mesh.points.row(below),
                lineMoved = moved.row(*node) - moved.row(below);
      const auto angle = [](const Row& a, const Row& b)
      { return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI; };
      figures.lean = std::max(figures.lean, std::abs(angle(lineMoved, to) - angle(line, n)));
      const double height = line.dot(n), heightMoved = lineMoved.dot(to);
      if (below == layers.walls[i])
      {
        figures.height = std::max(figures.height, std::abs(heightMoved / height - 1));
      }
      else
      {
        figures.growth =
          std::max(figures.growth, std::abs(heightMoved / lastMoved / (height / last) - 1));
      }
      last = height;
      lastMoved = heightMoved;
      below = *node;
    }
  }
  return figures;
}

/// The ring of the issue: first cell 1e-3, growth 1.2, its wall turned by 30 degrees.
const auto onInner = [](const Row& x) { return std::hypot(x[0], x[1]) < 1 + 1e-9; };
const auto onOuter = [](const Row& x) { return std::hypot(x[0], x[1]) > 14 - 1e-9; };
Row turn(const Row& x)
{
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  return { c * x[0] - s * x[1], s * x[0] + c * x[1], x[2] };
}
}

TEST(WallLayers, AreFoundAsStacks)
{
  Monitor monitor;
  for (Mesh (*box)(int, int, int) : { meshes::hexes, meshes::wedges })
  {
    const Mesh mesh = box(3, 3, 5);
    const BoundaryFaces faces = boundaryFaces(mesh, monitor);
    const std::vector<std::uint8_t> wall = facesWhere(mesh, faces, isBottom);
    for (const Index most : { 1, 3, 100 })
    {
      const WallLayers layers = findWallLayers(mesh, faces, wall, most, {});
      ASSERT_EQ(layers.walls.size(), 16u);
      for (std::size_t i = 0; i < layers.walls.size(); ++i)
      {
        const Index column = static_cast<Index>(i);
        // The last layer has the opposite boundary.
        ASSERT_EQ(
          layers.columns.end(column) - layers.columns.begin(column), std::min<Index>(most, 4));
        for (const Index* n = layers.columns.begin(column); n != layers.columns.end(column); ++n)
        {
          const Row above = Row(0, 0, static_cast<double>(n - layers.columns.begin(column) + 1));
          EXPECT_EQ(mesh.points.row(*n), mesh.points.row(layers.walls[i]) + above);
        }
      }
    }
  }
  // Hexahedra below, wedges above, whose quadrilaterals are no layers.
  const Mesh mixed = meshes::hexesAndWedges(3, 3, 6);
  const BoundaryFaces faces = boundaryFaces(mixed, monitor);
  const WallLayers layers =
    findWallLayers(mixed, faces, facesWhere(mixed, faces, isBottom), 100, {});
  EXPECT_GE(shortest(layers), 1);
  EXPECT_LT(longest(layers), 6);
  const Mesh tets = meshes::tets(3, 3, 3);
  const BoundaryFaces ofTets = boundaryFaces(tets, monitor);
  EXPECT_EQ(longest(findWallLayers(tets, ofTets, facesWhere(tets, ofTets, isBottom), 100, {})), 0);
}

TEST(WallLayers, EndWhereAnArrayOrAnotherWallSaysSo)
{
  Monitor monitor;
  const Mesh mesh = meshes::hexes(3, 3, 6);
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  std::vector<std::uint8_t> isLayer;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    isLayer.push_back(mesh.points(mesh.cell(c)[0], 2) < 1.5);
  }
  const auto wall = facesWhere(mesh, faces, isBottom);
  EXPECT_EQ(longest(findWallLayers(mesh, faces, wall, 100, isLayer)), 2);
  // Layers from both sides: no node is in two columns.
  const auto both = facesWhere(
    mesh, faces, [](const Row& x) { return isBottom(x) || isBottom(Row(0, 0, x[2] - 6)); });
  const WallLayers layers = findWallLayers(mesh, faces, both, 100, {});
  std::vector<Index> nodes = layers.columns.values;
  std::sort(nodes.begin(), nodes.end());
  EXPECT_TRUE(std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end());
  EXPECT_EQ(longest(layers), 2);
}

TEST(LayerMotion, FollowsRigidMotionsAndStaysBitForBit)
{
  Monitor monitor;
  Mesh mesh = meshes::hexes(4, 4, 5);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const BoundaryFaces faces = boundaryFaces(mesh, monitor);
  const auto wall = facesWhere(mesh, faces, isBottom);
  const WallLayers layers = findWallLayers(mesh, faces, wall, 3, {});
  Points still = mesh.points;
  moveLayers(mesh.points, faces, wall, layers, still);
  EXPECT_TRUE(motions::identical(still, mesh.points));

  const Eigen::Matrix3d rotation =
    Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Points expected = (mesh.points * rotation.transpose()).rowwise() + Row(5, -7, 1);
  Points moved = mesh.points;
  for (const Index n : faces.nodes)
  {
    moved.row(n) = expected.row(n);
  }
  moveLayers(mesh.points, faces, wall, layers, moved);
  for (const Index n : layers.columns.values)
  {
    EXPECT_LT((moved.row(n) - expected.row(n)).norm(), 1e-13);
  }
}

TEST(LayerMotion, ARingKeepsHeightsAndAngles)
{
  Mesh mesh = meshes::ring(32, 2, 1e-3 / 13);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double r = std::hypot(x[0], x[1]), to = 1 + 13 * (r - 1);
      return Row(x[0] * to / r, x[1] * to / r, x[2]);
    });
  constexpr Index Layers = 15;
  FemWarp femWarp;
  const Figures without = kept(mesh, onInner, onOuter, turn, 0, Layers, femWarp);
  EXPECT_NEAR(without.lean, 54, 1);
  EXPECT_NEAR(without.height, 0.27, 0.01);
  InversionFree inversionFree;
  for (Morpher* method : { static_cast<Morpher*>(&femWarp), static_cast<Morpher*>(&inversionFree) })
  {
    const Figures with = kept(mesh, onInner, onOuter, turn, Layers, Layers, *method);
    EXPECT_LT(with.lean, 1e-6);
    EXPECT_LT(with.height, 1e-9);
    EXPECT_LT(with.growth, 1e-9);
    EXPECT_EQ(with.inverted, 0);
  }
}

TEST(LayerMotion, AWingSectionKeepsHeightsAndAngles)
{
  const Mesh mesh = oGrid(64, 2, 1e-5);
  // Pitched by 15 degrees, and bent: the trailing half turns by up to 10 degrees more.
  const motions::Map pitchAndBend = [](const Row& x) -> Row
  {
    const double rear = std::max(0., x[0]);
    const double bent = x[1] - 0.17 * rear * rear * 2;
    const double c = std::cos(M_PI / 12), s = std::sin(M_PI / 12);
    return { c * x[0] + s * bent, -s * x[0] + c * bent, x[2] };
  };
  // The wall's nodes are the first of each line.
  std::vector<Row> wall;
  for (int k = 0; k <= 2; ++k)
  {
    for (int j = 0; j < 64; ++j)
    {
      const double t = 2 * M_PI * j / 64;
      wall.emplace_back(0.5 * std::cos(t), 0.06 * std::sin(t) * (1 - 0.6 * std::cos(t)), 0.2 * k);
    }
  }
  const auto isWall = [&](const Row& x)
  {
    return std::any_of(
      wall.begin(), wall.end(), [&](const Row& w) { return (w - x).squaredNorm() < 1e-16; });
  };
  const auto isFar = [](const Row& x) { return x.head<2>().norm() > 8; };
  constexpr Index Layers = 30;
  FemWarp femWarp, stiff;
  stiff.setStiffness({ CellStiffness::Kind::InverseVolume, 1, {}, {} });
  const Figures without = kept(mesh, isWall, isFar, pitchAndBend, 0, Layers, femWarp);
  EXPECT_GT(without.lean, 90);
  EXPECT_GT(without.inverted, 300);
  // Beyond the layers FEMWARP inverts cells, unless small ones are stiff.
  EXPECT_LT(kept(mesh, isWall, isFar, pitchAndBend, Layers, Layers, femWarp).inverted, 60);
  InversionFree inversionFree;
  for (Morpher* method : { static_cast<Morpher*>(&stiff), static_cast<Morpher*>(&inversionFree) })
  {
    const Figures with = kept(mesh, isWall, isFar, pitchAndBend, Layers, Layers, *method);
    EXPECT_LT(with.lean, 1e-6);
    EXPECT_LT(with.height, 1e-9);
    EXPECT_LT(with.growth, 1e-9);
    EXPECT_EQ(with.inverted, 0);
  }
}
