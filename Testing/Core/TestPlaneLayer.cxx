// SPDX-License-Identifier: BSD-3-Clause
// Plane meshes as solids one layer thick.
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/PlaneLayer.h"
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
  mesh.offsets = { 0 };
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

Row bent(const Row& x)
{
  return Row(x[0] + 0.3 * x[1] * x[1], x[1] - 0.2 * x[0] * x[1], 0);
}

/// The layer of a square in the turned plane, its sides prescribed.
struct Layer
{
  Mesh flat, mesh;
  morph::NodePartition partition;
  morph::Monitor monitor;

  explicit Layer(const std::string& cells)
    : flat(square(cells))
  {
    flat.points = motions::mapped(flat.points, turned);
    mesh = morph::thicken(flat);
    partition = motions::outerPartition(mesh);
  }

  Points moved(morph::Morpher& method, const motions::Map& map)
  {
    method.prepare(mesh, partition, monitor);
    Points result;
    method.evaluate(motions::targets(mesh, partition, map), result, monitor);
    return result;
  }
};

class PlaneLayer : public testing::TestWithParam<const char*>
{
protected:
  Layer layer{ GetParam() };
};
INSTANTIATE_TEST_SUITE_P(Cells, PlaneLayer, testing::Values("quads", "triangles", "mixed"),
  [](const auto& info) { return std::string(info.param); });
}

TEST_P(PlaneLayer, OnlyItsSidesAreBoundary)
{
  const morph::BoundaryFaces faces = morph::boundaryFaces(layer.mesh, layer.monitor);
  EXPECT_EQ(faces.cells.size(), 4u * Boxes);
  EXPECT_EQ(faces.nodes.size(), 8u * Boxes);
}

TEST_P(PlaneLayer, CellsHaveTheQualityOfTheirFaces)
{
  const auto measure = [&](const Mesh& mesh)
  {
    const std::vector<std::int8_t> signs(mesh.types.size(), 1);
    return morph::measureQuality(mesh, mesh.points, signs, {}, layer.monitor).scaledJacobian;
  };
  const auto solid = measure(layer.mesh), flat = measure(layer.flat);
  ASSERT_EQ(solid.size(), flat.size());
  for (std::size_t c = 0; c < flat.size(); ++c)
  {
    EXPECT_NEAR(solid[c], flat[c], 1e-12) << c;
  }
}

TEST_P(PlaneLayer, LinearMethodsAreExactForAffineMotionsAndKeepThePlane)
{
  const auto affine =
    inPlane([](const Row& x) { return Row(1.3 * x[0] + 0.4 * x[1] + 1, 0.8 * x[1] - 2, 0); });
  const Index nodes = layer.flat.numberOfNodes();
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    SCOPED_TRACE(method.name);
    const auto made = method.make();
    EXPECT_LT(
      motions::difference(layer.moved(*made, affine), motions::mapped(layer.mesh.points, affine)),
      1e-12);
    const Points moved = layer.moved(*made, inPlane(bent));
    EXPECT_LT(
      motions::mapped(moved.topRows(nodes), turnedBack).col(2).cwiseAbs().maxCoeff(), 1e-14);
    const Points motion = moved - layer.mesh.points;
    EXPECT_LT(motions::difference(motion.topRows(nodes), motion.middleRows(nodes, nodes)), 1e-14);
  }
}

TEST_P(PlaneLayer, TransposesBelongToTheMethods)
{
  std::mt19937 random(meshes::seed());
  std::normal_distribution<double> normal;
  const auto noise = [&](Index rows) -> Points
  { return Points::NullaryExpr(rows, 3, [&] { return normal(random); }); };
  for (const meshes::LinearMethod& method : meshes::linearMethods())
  {
    const auto made = method.make();
    made->prepare(layer.mesh, layer.partition, layer.monitor);
    const Points gradient = noise(layer.mesh.numberOfNodes());
    const Points boundary = noise(static_cast<Index>(layer.partition.prescribed.size()));
    const Points mode = made->basis({ boundary }, layer.monitor).front();
    Points adjoint;
    made->applyTranspose(gradient, adjoint, layer.monitor);
    EXPECT_NEAR(gradient.cwiseProduct(mode).sum(), adjoint.cwiseProduct(boundary).sum(), 1e-7)
      << method.name;
  }
}

TEST_P(PlaneLayer, TangledMeshesAreUntangledInThePlane)
{
  // A block comes in through the lower side, further than FEMWARP can follow.
  const auto map = inPlane(
    [](const Row& x)
    {
      const bool isBlock = x[1] < 0.01 && std::abs(x[0] - 0.5) < 0.2;
      return Row(x[0], x[1] + 0.75 * isBlock, 0);
    });
  const std::vector<std::int8_t> signs(layer.mesh.types.size(), 1);
  const Index nodes = layer.flat.numberOfNodes();
  morph::FemWarp warp;
  morph::InversionFree free;
  const auto inverted = [&](const Points& points)
  { return morph::measureQuality(layer.mesh, points, signs, {}, layer.monitor).inverted; };
  EXPECT_GT(inverted(layer.moved(warp, map)), 0);
  const Points moved = layer.moved(free, map);
  EXPECT_EQ(inverted(moved), 0);
  EXPECT_LT(motions::mapped(moved.topRows(nodes), turnedBack).col(2).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(PlaneLayer, FemWarpIsTheMembraneOfCotangents)
{
  Layer layer("triangles");
  morph::FemWarp warp;
  warp.setTolerance(1e-14);
  const Points moved = layer.moved(warp, inPlane(bent));
  // Each free node is the mean of its neighbors by the cotangents of the angles that face the edge.
  const Points& x = layer.flat.points;
  Points force = Points::Zero(x.rows(), 3);
  for (Index c = 0; c < layer.flat.numberOfCells(); ++c)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index* nodes = layer.flat.cell(c);
      const Index a = nodes[k], b = nodes[(k + 1) % 3], tip = nodes[(k + 2) % 3];
      const Row u = x.row(a) - x.row(tip), v = x.row(b) - x.row(tip);
      const double cotangent = u.dot(v) / u.cross(v).norm();
      const Row motion = (moved - layer.mesh.points).row(a) - (moved - layer.mesh.points).row(b);
      force.row(a) += cotangent * motion;
      force.row(b) -= cotangent * motion;
    }
  }
  for (const Index node : layer.partition.free)
  {
    EXPECT_LT(force.row(node % x.rows()).norm(), 1e-12) << node;
  }
}

TEST(PlaneLayer, CurvedShellsAndOtherCellsAreRefused)
{
  std::string message;
  Mesh shell = square("quads");
  shell.points.col(2) = shell.points.col(0).cwiseAbs2();
  motions::kindOf([&] { morph::thicken(shell); }, message);
  EXPECT_NE(message.find("curved shell"), std::string::npos) << message;
  Mesh other = square("quads");
  meshes::add(other, morph::Polygon, { 0, 1, 2, 9, 8 });
  motions::kindOf([&] { morph::thicken(other); }, message);
  EXPECT_NE(message.find("polygon, cell 36"), std::string::npos) << message;
  Mesh flat = square("quads");
  flat.points.col(1).setZero();
  motions::kindOf([&] { morph::thicken(flat); }, message);
  EXPECT_NE(message.find("without area"), std::string::npos) << message;
}
