// SPDX-License-Identifier: BSD-3-Clause
// Plane meshes and shells as solids one layer thick.
#include "Geometry/AffineFit.h"
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "Mesh/ShellLayer.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"
#include "Support/Error.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>

namespace
{
using morph::Index;
using morph::Mesh;
using morph::Points;
using motions::Row;

constexpr int Boxes = 6;

/// Turns the plane z = 0 into another one, away from the origin.
const Eigen::Matrix3d Turn = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, -3).normalized()).matrix();
const Row Shift(3, -1, 2);

Row turned(const Row& x)
{
  return x * Turn.transpose() + Shift;
}

Row turnedBack(const Row& x)
{
  return (x - Shift) * Turn;
}

/// [0, 1]^2 in the plane z = 0: quadrilaterals, triangles, or both.
Mesh square(const std::string& cells)
{
  Mesh mesh;
  mesh.points.resize((Boxes + 1) * (Boxes + 1), 3);
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  for (int i = 0; i <= Boxes; ++i)
  {
    for (int j = 0; j <= Boxes; ++j)
    {
      const bool inside = i > 0 && i < Boxes && j > 0 && j < Boxes;
      mesh.points.row(i * (Boxes + 1) + j) =
        Row(i + inside * jitter(random), j + inside * jitter(random), 0) / Boxes;
    }
  }
  for (Index box = 0; box < Boxes * Boxes; ++box)
  {
    const Index a = box / Boxes * (Boxes + 1) + box % Boxes, b = a + Boxes + 1;
    if (cells == "quads" || (cells == "mixed" && box % 2 == 0))
    {
      meshes::add(mesh, morph::Quad, { a, b, b + 1, a + 1 });
      continue;
    }
    meshes::add(mesh, morph::Triangle, { a, b, b + 1 });
    meshes::add(mesh, morph::Triangle, { a, b + 1, a + 1 });
  }
  return mesh;
}

/// A map of the plane, as one of the turned plane.
motions::Map inPlane(const motions::Map& map)
{
  return [map](const Row& x) -> Row
  {
    const Row flat = turnedBack(x);
    Row to = map(flat);
    to[2] = flat[2];
    return turned(to);
  };
}

Row curled(const Row& x)
{
  return Row(x[0] + 0.3 * x[1] * x[1], x[1] - 0.2 * x[0] * x[1], 0);
}

/// A plane mesh or a shell, and its layer.
struct Shell
{
  Mesh faces, mesh;
  morph::NodePartition partition;
  morph::Monitor monitor;

  /// Its sides are prescribed.
  explicit Shell(Mesh of)
    : faces(std::move(of))
    , mesh(morph::thicken(faces))
    , partition(motions::outerPartition(mesh))
  {
  }
  Shell(Mesh of, const std::function<bool(const Row&)>& isPrescribed)
    : Shell(std::move(of))
  {
    std::vector<Index> nodes;
    for (const Index image : { Index(0), faces.numberOfNodes() })
    {
      for (Index n = 0; n < faces.numberOfNodes(); ++n)
      {
        if (isPrescribed(faces.points.row(n)))
        {
          nodes.push_back(n + image);
        }
      }
    }
    partition = morph::partitionNodes(mesh, nodes);
  }
  Points moved(morph::Morpher& method, const motions::Map& map)
  {
    return motions::morphed(
      method, mesh, partition, motions::targets(mesh, partition, map), monitor);
  }
  Points front(const Points& points) const { return points.topRows(faces.numberOfNodes()); }
  morph::Quality quality(const Points& points) { return qualityOf(mesh, points); }
  morph::Quality qualityOf(const Mesh& of, const Points& points)
  {
    const std::vector<std::int8_t> signs(of.types.size(), 1);
    return morph::measureQuality(of, points, signs, {}, monitor);
  }
};

Mesh mappedSquare(const std::string& cells, const motions::Map& map)
{
  Mesh mesh = square(cells);
  mesh.points = motions::mapped(mesh.points, map);
  return mesh;
}

/// How far points are from the turned plane.
double offPlane(const Points& points)
{
  return motions::mapped(points, turnedBack).col(2).cwiseAbs().maxCoeff();
}

/// A block comes in through the square's lower side, further than FEMWARP can follow.
Row blocked(const Row& x)
{
  const bool isBlock = x[1] < 0.01 && std::abs(x[0] - 0.5) < 0.2;
  return Row(x[0], x[1] + 0.75 * isBlock, 0);
}

/// Cells have the quality of their faces.
void expectQualityOfFaces(Shell& shell)
{
  const morph::Quality solid = shell.quality(shell.mesh.points),
                       flat = shell.qualityOf(shell.faces, shell.faces.points);
  EXPECT_EQ(solid.measured, flat.measured);
  ASSERT_EQ(solid.scaledJacobian.size(), flat.scaledJacobian.size());
  for (std::size_t c = 0; c < flat.scaledJacobian.size(); ++c)
  {
    EXPECT_NEAR(solid.scaledJacobian[c], flat.scaledJacobian[c], 1e-12) << c;
  }
}

/// Each edge pulls by the cotangents of the angles that face it times the difference of `motion`.
Points cotangentForces(const Mesh& triangles, const Points& motion)
{
  const Points& x = triangles.points;
  Points force = Points::Zero(x.rows(), 3);
  for (Index c = 0; c < triangles.numberOfCells(); ++c)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index* nodes = triangles.cell(c);
      const Index a = nodes[k], b = nodes[(k + 1) % 3], tip = nodes[(k + 2) % 3];
      const Row u = x.row(a) - x.row(tip), v = x.row(b) - x.row(tip);
      const Row pull = u.dot(v) / u.cross(v).norm() * (motion.row(a) - motion.row(b));
      force.row(a) += pull;
      force.row(b) -= pull;
    }
  }
  return force;
}

/// The method's transpose is that of its map. `boundary`: displacements of the prescribed nodes.
void expectTranspose(
  const meshes::LinearMethod& method, Shell& shell, const Points& boundary, const Points& gradient)
{
  const auto made = method.make();
  made->prepare(shell.mesh, shell.partition, shell.monitor);
  const Points mode = made->basis({ boundary }, shell.monitor).front();
  Points adjoint;
  made->applyTranspose(gradient, adjoint, shell.monitor);
  EXPECT_NEAR(gradient.cwiseProduct(mode).sum(), adjoint.cwiseProduct(boundary).sum(), 1e-7)
    << method.name;
}

class ShellLayers : public testing::TestWithParam<const char*>
{
protected:
  Shell layer{ mappedSquare(GetParam(), turned) };
};
INSTANTIATE_TEST_SUITE_P(Cells, ShellLayers, testing::Values("quads", "triangles", "mixed"),
  [](const auto& info) { return std::string(info.param); });
}

TEST_P(ShellLayers, OnlyItsSidesAreBoundary)
{
  const morph::BoundaryFaces faces = morph::boundaryFaces(layer.mesh, layer.monitor);
  EXPECT_EQ(faces.cells.size(), 4u * Boxes);
  EXPECT_EQ(faces.nodes.size(), 8u * Boxes);
}

TEST_P(ShellLayers, CellsHaveTheQualityOfTheirFaces)
{
  expectQualityOfFaces(layer);
}

TEST_P(ShellLayers, LinearMethodsAreExactForAffineMotionsAndKeepThePlane)
{
  const auto affine =
    inPlane([](const Row& x) { return Row(1.3 * x[0] + 0.4 * x[1] + 1, 0.8 * x[1] - 2, 0); });
  const Index nodes = layer.faces.numberOfNodes();
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    SCOPED_TRACE(method.name);
    const auto made = method.make();
    EXPECT_LT(
      motions::difference(layer.moved(*made, affine), motions::mapped(layer.mesh.points, affine)),
      1e-12);
    const Points moved = layer.moved(*made, inPlane(curled));
    EXPECT_LT(offPlane(layer.front(moved)), 1e-14);
    const Points motion = moved - layer.mesh.points;
    EXPECT_LT(motions::difference(motion.topRows(nodes), motion.middleRows(nodes, nodes)), 1e-14);
  }
}

TEST_P(ShellLayers, TransposesBelongToTheMethods)
{
  std::mt19937 random(meshes::seed());
  std::normal_distribution<double> normal;
  const auto noise = [&](Index rows) -> Points
  { return Points::NullaryExpr(rows, 3, [&] { return normal(random); }); };
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    const Points gradient = noise(layer.mesh.numberOfNodes());
    const Points boundary = noise(static_cast<Index>(layer.partition.prescribed.size()));
    expectTranspose(method, layer, boundary, gradient);
  }
}

TEST_P(ShellLayers, TangledMeshesAreUntangledInThePlane)
{
  morph::FemWarp warp;
  morph::InversionFree free;
  EXPECT_GT(layer.quality(layer.moved(warp, inPlane(blocked))).inverted, 0);
  const Points moved = layer.moved(free, inPlane(blocked));
  EXPECT_EQ(layer.quality(moved).inverted, 0);
  EXPECT_LT(offPlane(layer.front(moved)), 1e-14);
}

TEST(ShellLayers, FemWarpIsTheMembraneOfCotangents)
{
  Shell layer(mappedSquare("triangles", turned));
  morph::FemWarp warp;
  warp.setTolerance(1e-14);
  const Points moved = layer.moved(warp, inPlane(curled));
  // Each free node is the mean of its neighbors by the cotangents of the angles that face the edge.
  const Points motion = moved - layer.mesh.points;
  const Points force = cotangentForces(layer.faces, motion);
  for (const Index node : layer.partition.free)
  {
    EXPECT_LT(force.row(node % force.rows()).norm(), 1e-12) << node;
  }
}

// The simplex methods refuse curved shells.
TEST(ShellLayers, NodesOffThePlaneOfTheFacesBendNothing)
{
  Mesh plane = square("quads");
  const Index end = plane.numberOfNodes();
  plane.points.conservativeResize(end + 2, 3);
  plane.points.bottomRows(2) << 0, 0, 5, 1, 1, std::nan("");
  meshes::add(plane, morph::Line, { 0, end });
  const Shell shell(plane);
  morph::Monitor monitor;
  morph::Session session;
  session.setMesh(shell.mesh, monitor);
  morph::Session::Options options;
  options.createMorpher = [] { return std::make_unique<morph::SimplexLinear>(); };
  const auto shear = [](const Row& x) -> Row { return x + Row(0.2 * x[1], 0.1 * x[0], 0); };

  const auto step = session.morph(
    { shell.partition.prescribed, motions::targets(shell.mesh, shell.partition, shear) }, options,
    monitor);

  for (Index n = 0; n < end; ++n)
  {
    EXPECT_LT((step->moved.row(n) - shear(plane.points.row(n))).norm(), 1e-12) << n;
  }
}

TEST(ShellLayers, OtherCellsAndCellsWithoutAreaAreRefused)
{
  Mesh other = square("quads");
  meshes::add(other, morph::Polygon, { 0, 1, 2, 9, 8 });
  motions::expectError([&] { morph::thicken(other); }, "polygon, cell 36");
  Mesh flat = square("quads");
  flat.points.col(1).setZero();
  motions::expectError([&] { morph::thicken(flat); }, "without area");
  Mesh few = square("quads");
  meshes::add(few, morph::Quad, { 0, 1, 2 });
  motions::expectError([&] { morph::thicken(few); }, "wrong number of nodes");
  Mesh line = square("quads");
  meshes::add(line, morph::Quad, { 0, 0, 1, 1 });
  motions::expectError([&] { morph::thicken(line); }, "three different corners: cell 36");
}

namespace
{
Row saddle(const Row& x)
{
  return Row(x[0], x[1], 0.4 * x[0] * x[0] - 0.3 * x[0] * x[1] + 0.1 * x[1]);
}

/// [-1, 1]^3's surface on the unit sphere: quadrilaterals, triangles, or both.
Mesh sphere(const std::string& cells)
{
  const Mesh box = meshes::hexes(4, 4, 4);
  morph::Monitor monitor;
  const morph::BoundaryFaces faces = morph::boundaryFaces(box, monitor);
  Mesh mesh;
  mesh.points = box.points(faces.nodes, morph::allColumns) / 2;
  mesh.points.rowwise() -= Row(1, 1, 1);
  mesh.points.rowwise().normalize();
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    std::vector<Index> n;
    for (Index k = faces.offsets[f]; k < faces.offsets[f + 1]; ++k)
    {
      n.push_back(std::lower_bound(faces.nodes.begin(), faces.nodes.end(), faces.connectivity[k]) -
                  faces.nodes.begin());
    }
    if (cells == "quads" || (cells == "mixed" && f % 2 == 0))
    {
      meshes::add(mesh, morph::Quad, n);
      continue;
    }
    meshes::add(mesh, morph::Triangle, { n[0], n[1], n[2] });
    meshes::add(mesh, morph::Triangle, { n[0], n[2], n[3] });
  }
  return mesh;
}

/// A mesh of triangles and quadrilaterals with a node on each edge, bulged by `map` as its corners.
Mesh quadratic(const Mesh& linear, const motions::Map& map)
{
  Mesh mesh;
  std::map<std::pair<Index, Index>, Index> middles;
  std::vector<Row> points;
  for (const auto& row : linear.points.rowwise())
  {
    points.emplace_back(row);
  }
  for (Index c = 0; c < linear.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(linear.cell(c), linear.cell(c) + linear.cellSize(c));
    const std::size_t corners = nodes.size();
    for (std::size_t k = 0; k < corners; ++k)
    {
      const auto edge = std::minmax({ nodes[k], nodes[(k + 1) % corners] });
      const auto [at, isNew] = middles.emplace(edge, static_cast<Index>(points.size()));
      if (isNew)
      {
        points.emplace_back((linear.points.row(edge.first) + linear.points.row(edge.second)) / 2);
      }
      nodes.push_back(at->second);
    }
    meshes::add(mesh, corners == 3 ? morph::QuadraticTriangle : morph::QuadraticQuad, nodes);
  }
  mesh.points.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    mesh.points.row(static_cast<Index>(n)) = map(points[n]);
  }
  return mesh;
}

/// Of the square and its images by saddle().
bool isOnSide(const Row& x)
{
  return x[2] < 9 && (x[0] == 0 || x[0] == 1 || x[1] == 0 || x[1] == 1);
}

Shell openShell(const std::string& cells)
{
  return { mappedSquare(cells, saddle), isOnSide };
}

Shell quadraticShell(const std::string& cells)
{
  return { quadratic(square(cells), saddle), isOnSide };
}

/// The same with points of no cell far away, that come first.
Shell shellWithOthers(const std::string& cells)
{
  Mesh mesh = quadratic(square(cells), saddle);
  Points points(mesh.points.rows() + 3, 3);
  points.topRows(3) << 90, 0, 50, -90, 7, 50, 8, 90, 50;
  points.bottomRows(mesh.points.rows()) = mesh.points;
  mesh.points = points;
  for (Index& node : mesh.connectivity)
  {
    node += 3;
  }
  return { std::move(mesh), isOnSide };
}

Shell closedShell(const std::string& cells)
{
  return { sphere(cells), [](const Row& x) { return x[2] > 0.6 || x[2] < -0.8; } };
}

/// The rectangle [0, length] x [0, width] in quadrilaterals, its long edges prescribed.
Shell strip(int along, int across, double length, double width)
{
  Mesh mesh;
  mesh.points.resize((along + 1) * (across + 1), 3);
  for (int i = 0; i <= along; ++i)
  {
    for (int j = 0; j <= across; ++j)
    {
      const Index n = i * (across + 1) + j;
      mesh.points.row(n) = Row(length * i / along, width * j / across, 0);
      if (i < along && j < across)
      {
        meshes::add(mesh, morph::Quad, { n, n + across + 1, n + across + 2, n + 1 });
      }
    }
  }
  Shell shell(std::move(mesh), [width](const Row& x) { return x[1] == 0 || x[1] == width; });
  shell.mesh = morph::bent(shell.mesh);
  return shell;
}

bool isSimplex(const std::string& name)
{
  return name.find("implex") != std::string::npos;
}

class CurvedShell : public testing::TestWithParam<const char*>
{
};
INSTANTIATE_TEST_SUITE_P(Cells, CurvedShell, testing::Values("quads", "triangles", "mixed"),
  [](const auto& info) { return std::string(info.param); });
}

TEST_P(CurvedShell, CellsHaveTheQualityOfTheirFaces)
{
  for (Shell shell : { openShell(GetParam()), closedShell(GetParam()) })
  {
    expectQualityOfFaces(shell);
  }
}

TEST_P(CurvedShell, HowTheCellsAreWoundHasNoEffect)
{
  morph::Monitor silent;
  const Mesh plane = square(GetParam());
  for (const Mesh& wound :
    { plane, quadratic(plane, [](const Row& x) { return x; }), quadratic(plane, saddle) })
  {
    Mesh mixed = wound;
    for (Index c = 0; c < mixed.numberOfCells(); c += 5)
    {
      const Index corners = morph::cellShape(mixed, c)->numberOfCorners;
      Index* cell = mixed.connectivity.data() + mixed.offsets[c];
      std::reverse(cell + 1, cell + corners);
      std::reverse(cell + corners, cell + mixed.cellSize(c)); // middles
    }
    const Mesh one = morph::thicken(wound), other = morph::thicken(mixed);
    const Index images = 2 * wound.numberOfNodes(); // those in middles have another order
    EXPECT_LT(motions::difference(one.points.topRows(images), other.points.topRows(images)), 1e-15);
    const std::vector<std::int8_t> signs(one.types.size(), 1);
    const auto measure = [&](const Mesh& mesh)
    { return morph::measureQuality(mesh, mesh.points, signs, {}, silent); };
    EXPECT_NEAR(measure(one).minimum, measure(other).minimum, 1e-12);
    EXPECT_EQ(measure(other).inverted, 0);
  }
}

TEST_P(CurvedShell, HowTheSheetsOfABranchAreWoundHasNoEffect)
{
  Mesh branch = square(GetParam());
  const Index nodes = branch.numberOfNodes(), cells = branch.numberOfCells();
  const Index middle = Boxes / 2 * (Boxes + 1);
  Points points(nodes + Boxes + 1, 3);
  points << branch.points, branch.points.middleRows(middle, Boxes + 1).rowwise() + Row(0, 0, 0.3);
  branch.points = points;
  for (Index j = 0; j < Boxes; ++j)
  {
    meshes::add(branch, morph::Quad, { middle + j + 1, middle + j, nodes + j, nodes + j + 1 });
  }
  const auto thickened = [&branch](Index firstTurned, Index lastTurned)
  {
    Mesh mesh = branch;
    for (Index c = firstTurned; c < lastTurned; ++c)
    {
      Index* cell = mesh.connectivity.data() + mesh.offsets[c];
      std::reverse(cell + 1, cell + mesh.cellSize(c));
    }
    return morph::thicken(mesh).points;
  };
  const Points expected = thickened(0, 0);
  EXPECT_LT(motions::difference(thickened(cells, cells + Boxes), expected), 1e-15); // the fin
  EXPECT_LT(motions::difference(thickened(0, cells / 2), expected), 1e-15);
}

TEST_P(CurvedShell, LinearMethodsAreExactForAffineMotions)
{
  for (Shell shell : { openShell(GetParam()), quadraticShell(GetParam()),
         shellWithOthers(GetParam()), closedShell(GetParam()) })
  {
    const Points expected = motions::mapped(
      shell.faces.points, [](const Row& x) { return x[2] < 9 ? motions::affine(x) : x; });
    for (const meshes::LinearMethod& method : meshes::linearMethods())
    {
      SCOPED_TRACE(method.name);
      const auto made = method.make();
      if (isSimplex(method.name))
      {
        motions::expectError(
          [&] { shell.moved(*made, motions::affine); }, "curved shell encloses none");
        continue;
      }
      const Points moved = shell.moved(*made, motions::affine);
      EXPECT_LT(motions::difference(shell.front(moved), expected), 1e-12);
    }
  }
}

TEST_P(CurvedShell, LinearMethodsHaveTheirTransposes)
{
  std::mt19937 random(meshes::seed());
  std::normal_distribution<double> normal;
  for (Shell shell : { openShell(GetParam()), quadraticShell(GetParam()) })
  {
    const Index nodes = shell.faces.numberOfNodes();
    Points boundary = Points::Zero(shell.mesh.numberOfNodes(), 3), gradient = boundary;
    gradient.topRows(nodes) = Points::NullaryExpr(nodes, 3, [&] { return normal(random); });
    boundary.topRows(nodes) = Points::NullaryExpr(nodes, 3, [&] { return normal(random); });
    boundary.middleRows(nodes, nodes) = boundary.topRows(nodes);
    const Points given = boundary(shell.partition.prescribed, morph::allColumns);
    for (const meshes::LinearMethod& method : meshes::linearMethods())
    {
      if (!isSimplex(method.name))
      {
        expectTranspose(method, shell, given, gradient);
      }
    }
  }
}

TEST_P(CurvedShell, ACellThatFoldsOverIsInvertedHoweverTheShellTurns)
{
  for (Shell shell : { openShell(GetParam()), closedShell(GetParam()) })
  {
    // A free node goes beyond the far side of its cell.
    const Index node = shell.partition.free[shell.partition.free.size() / 4];
    Points points = shell.mesh.points;
    const Index* cell = shell.mesh.cell(morph::nodeToCells(shell.mesh).begin(node)[0]);
    const Index last = shell.mesh.cellSize(0) == 8 ? 4 : 3;
    Row far = Row::Zero();
    for (Index k = 0; k < last; ++k)
    {
      far += points.row(cell[k]) / static_cast<double>(last);
    }
    points.row(node) += 2.2 * (far - points.row(node));
    const auto folded = [&](const Eigen::Matrix3d& turn)
    {
      Points turnedPoints = points * turn;
      morph::placeImages(shell.mesh, turnedPoints);
      return morph::invertedCells(shell.quality(turnedPoints));
    };
    const std::vector<Index> cells = folded(Eigen::Matrix3d::Identity());
    EXPECT_GT(cells.size(), 0u);
    EXPECT_LT(cells.size(), 5u);
    EXPECT_EQ(folded(Turn), cells);
    EXPECT_EQ(folded(Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX()).matrix()), cells);
  }
}

TEST(CurvedShell, FemWarpIsTheMembraneOfCotangentsBesideTheAffinePart)
{
  Shell shell = openShell("triangles");
  morph::FemWarp warp;
  warp.setTolerance(1e-14);
  const Points moved = shell.front(shell.moved(warp, curled));
  const Points& x = shell.faces.points;
  std::vector<Index> edge;
  for (const Index node : shell.partition.prescribed)
  {
    if (node < x.rows())
    {
      edge.push_back(node);
    }
  }
  const Points motion = moved - x;
  const morph::AffineFit fit =
    morph::AffineLeastSquares(x(edge, morph::allColumns)).fit(motion(edge, morph::allColumns));
  const Points rest =
    motion - motions::mapped(x, [&](const Row& p) { return fit.displacement(p); });
  const Points force = cotangentForces(shell.faces, rest);
  for (const Index node : shell.partition.free)
  {
    EXPECT_LT(force.row(node % x.rows()).norm(), 1e-12) << node;
  }
}

TEST(CurvedShell, AStripBentOntoACylinderKeepsItsLengths)
{
  constexpr double Radius = 20, Width = 1; // a quarter of the cylinder
  Shell shell = strip(60, 4, Radius * EIGEN_PI / 2, Width);
  const motions::Map cylinder = [](const Row& x)
  { return Row(Radius * std::sin(x[0] / Radius), x[1], Radius * (1 - std::cos(x[0] / Radius))); };
  morph::FemWarp warp;
  const Points moved = shell.moved(warp, cylinder);
  // At the free ends the displacement has no slope along the strip, for the width or two.
  for (Index c = 16; c < shell.faces.numberOfCells() - 16; ++c)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Index a = shell.faces.cell(c)[k], b = shell.faces.cell(c)[(k + 1) % 4];
      const double before = (shell.faces.points.row(a) - shell.faces.points.row(b)).norm();
      EXPECT_NEAR((moved.row(a) - moved.row(b)).norm() / before, 1, 1e-3) << c;
    }
  }
  EXPECT_EQ(shell.quality(moved).inverted, 0);
}

TEST(CurvedShell, AStripTwistsBy720DegreesWithoutInversion)
{
  Shell shell = strip(96, 4, 10, 1);
  const motions::Map twist = [](const Row& x)
  {
    const double angle = 4 * EIGEN_PI * x[0] / 10, y = x[1] - 0.5;
    return Row(x[0], y * std::cos(angle), y * std::sin(angle));
  };
  morph::FemWarp warp;
  const Points moved = shell.moved(warp, twist);
  const morph::Quality quality = shell.quality(moved);
  EXPECT_EQ(quality.inverted, 0);
  EXPECT_GT(quality.minimum, 0.8);
}

TEST_P(CurvedShell, TangledShellsAreUntangledNearTheirSurface)
{
  Shell shell = openShell(GetParam());
  const motions::Map map = [](const Row& x) { return saddle(blocked(x)); };
  morph::FemWarp warp;
  morph::InversionFree free;
  EXPECT_GT(shell.quality(shell.moved(warp, map)).inverted, 0);
  const Points moved = shell.moved(free, map);
  EXPECT_EQ(shell.quality(moved).inverted, 0);
  const Points on = motions::mapped(shell.front(moved), saddle);
  EXPECT_LT((shell.front(moved) - on).col(2).cwiseAbs().maxCoeff(), 0.1);
}

TEST_P(CurvedShell, SmoothingMovesNodesNearTheSurfaceAndNothingWithoutAMotion)
{
  Shell shell = openShell(GetParam());
  morph::Smoothing smoothing;
  morph::SmoothingOptions options;
  options.target = morph::SmoothingTarget::Initial;
  smoothing.setOptions(options);
  EXPECT_EQ(
    shell.front(shell.moved(smoothing, [](const Row& x) { return x; })), shell.faces.points);
  const motions::Map lift = [](const Row& x)
  { return Row(x[0] + 0.2 * x[1] * x[1], x[1], x[2] + 0.2 * x[0] * x[1]); };
  const Points moved = shell.moved(smoothing, lift);
  EXPECT_EQ(shell.quality(moved).inverted, 0);
  morph::FemWarp warp;
  EXPECT_LT(motions::difference(shell.front(moved), shell.front(shell.moved(warp, lift))), 0.1);
}

TEST_P(CurvedShell, APatchOfAClosedShellMovesAndTheRestFollows)
{
  Shell shell = closedShell(GetParam());
  morph::FemWarp warp;
  const Points moved = shell.front(
    shell.moved(warp, [](const Row& x) { return Row(x[0], x[1], x[2] + 0.4 * (x[2] > 0.6)); }));
  const Points motion = moved - shell.faces.points;
  EXPECT_LT(motion.leftCols(2).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_GT(motion.col(2).minCoeff(), -0.02);
  EXPECT_LT(motion.col(2).maxCoeff(), 0.42);
  for (Index n = 0; n < motion.rows(); ++n)
  {
    const double z = shell.faces.points(n, 2);
    EXPECT_TRUE(z > 0.6 ? std::abs(motion(n, 2) - 0.4) < 1e-14 : z > -0.8 || motion(n, 2) == 0);
  }
}

TEST(CurvedShell, AFeatureLineOfAPanelMovesAndItsEdgesStay)
{
  // A door: a panel with the crease x = 0.5, which rises in its middle.
  Mesh mesh = square("quads");
  for (Index i = 0; i <= Boxes; ++i)
  {
    mesh.points(Boxes / 2 * (Boxes + 1) + i, 0) = 0.5;
  }
  const auto door = [](const Row& x) { return Row(x[0], x[1], 0.3 - 0.3 * std::abs(x[0] - 0.5)); };
  mesh.points = motions::mapped(mesh.points, door);
  Shell shell(std::move(mesh),
    [](const Row& x) { return x[0] == 0 || x[0] == 1 || x[0] == 0.5 || x[1] == 0 || x[1] == 1; });
  const motions::Map rise = [](const Row& x)
  { return Row(x[0], x[1], x[2] + (x[0] == 0.5 ? 0.2 * std::sin(EIGEN_PI * x[1]) : 0.)); };
  morph::FemWarp warp;
  const Points moved = shell.moved(warp, rise);
  EXPECT_EQ(shell.quality(moved).inverted, 0);
  for (const Index n : shell.partition.prescribed)
  {
    const Index node = n % shell.faces.numberOfNodes();
    EXPECT_EQ(Row(moved.row(node)), rise(shell.faces.points.row(node))) << node;
  }
  const Eigen::VectorXd height = (shell.front(moved) - shell.faces.points).col(2);
  EXPECT_GT(height.minCoeff(), -0.02);
  EXPECT_LT(height.maxCoeff(), 0.21);
}

TEST(CurvedShell, ShellsWithOneSideOrNoNormalAreRefused)
{
  Shell strips = strip(12, 1, 6, 0.5);
  Mesh moebius = strips.faces;
  for (Index i = 0; i <= 12; ++i) // half a turn, and the ends joined
  {
    const double angle = 2 * EIGEN_PI * i / 12;
    for (const int side : { 0, 1 })
    {
      const double r = 1 + (side - 0.5) * std::cos(angle / 2);
      moebius.points.row(2 * i + side) =
        Row(r * std::cos(angle), r * std::sin(angle), (side - 0.5) * std::sin(angle / 2));
    }
  }
  for (Index& node : moebius.connectivity)
  {
    node = node == 24 ? 1 : node == 25 ? 0 : node;
  }
  motions::expectError([&] { morph::thicken(moebius); }, "one side alone");
  Mesh hairpin;
  hairpin.points = (Points(5, 3) << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1e-9, 0, 0, 0, 1).finished();
  meshes::add(hairpin, morph::Triangle, { 0, 1, 2 });
  meshes::add(hairpin, morph::Triangle, { 1, 0, 3 });
  meshes::add(hairpin, morph::Triangle, { 0, 2, 4 });
  motions::expectError([&] { morph::thicken(hairpin); }, "no normal at node ids");
}
