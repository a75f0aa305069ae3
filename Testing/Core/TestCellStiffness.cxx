// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/CellShape.h"
#include "Meshes.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Motions.h"
#include "PolyhedralMeshes.h"
#include "Quality/MovableQuality.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace morph;
using motions::kindOf;
using motions::outerPartition;
using motions::Row;
using motions::targets;
using Kind = CellStiffness::Kind;

namespace
{
/// A ring whose first cell is 1e-3 and which grows by 1.2, from 1 to about 14.
Mesh wideRing()
{
  Mesh mesh = meshes::ring(32, 2, 1e-3 / 13);
  meshes::transform(mesh,
    [](const Row& x)
    {
      const double r = std::hypot(x[0], x[1]);
      const double to = 1 + 13 * (r - 1);
      return Row(x[0] * to / r, x[1] * to / r, x[2]);
    });
  return mesh;
}

struct Layer
{
  double lean = 0; ///< degrees between a wall-normal line of the first cells and the wall's normal
  double height = 0; ///< of the first cell along the normal, in units of the undeformed one
  Index inverted = 0;
};

/// Turns the inner wall by 30 degrees; the outer one stays, and the sides are free.
Layer turned(Kind kind, double exponent = 1)
{
  const Mesh mesh = wideRing();
  std::vector<Index> walls, prescribed;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const double r = std::hypot(mesh.points(n, 0), mesh.points(n, 1));
    if (r < 1 + 1e-9)
    {
      walls.push_back(n);
    }
    if (r < 1 + 1e-9 || r > 14 - 1e-9)
    {
      prescribed.push_back(n);
    }
  }
  const NodePartition partition = partitionNodes(mesh, prescribed);
  const Points target = targets(mesh, partition,
    [](const Row& x) -> Row
    {
      const double a = std::hypot(x[0], x[1]) < 2 ? M_PI / 6 : 0;
      return { std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1],
        x[2] };
    });
  FemWarp method;
  method.setStiffness({ kind, exponent, walls, {} });
  meshes::ThreadedMonitor monitor(2);
  Points moved = motions::morphed(method, mesh, partition, target, monitor);
  Layer result;
  result.height = 1;
  result.inverted = MovableQuality(mesh, cellSigns(mesh, connectedComponents(mesh)), partition.free)
                      .measure(moved, monitor)
                      .inverted;
  for (const Index n : walls)
  {
    const Row normal = Row(moved(n, 0), moved(n, 1), 0).normalized();
    const Row line = moved.row(n + 1) - moved.row(n); // nodes are numbered outwards
    const double along = line.dot(normal);
    result.lean = std::max(result.lean, std::acos(along / line.norm()) * 180 / M_PI);
    result.height =
      std::min(result.height, along / (mesh.points.row(n + 1) - mesh.points.row(n)).norm());
  }
  return result;
}
}

TEST(CellStiffness, KeepsTheFirstLayersOfARingBetter)
{
  // Nodes follow the wall without turning at best: a line then leans by the wall's 30 degrees.
  const Layer uniform = turned(Kind::Uniform);
  EXPECT_NEAR(uniform.lean, 54, 1);
  EXPECT_NEAR(uniform.height, 0.73, 0.01);
  const Layer volume = turned(Kind::InverseVolume);
  EXPECT_LT(volume.lean, 31);
  EXPECT_GT(volume.height, 0.86);
  const Layer distance = turned(Kind::WallDistance);
  EXPECT_LT(distance.lean, 42);
  EXPECT_GT(distance.height, 0.81);
  const Layer quadratic = turned(Kind::WallDistance, 2);
  EXPECT_LT(quadratic.lean, 37);
  EXPECT_GT(quadratic.height, 0.83);
  for (const Layer& each : { uniform, volume, distance, quadratic })
  {
    EXPECT_EQ(each.inverted, 0);
  }
}

TEST(CellStiffness, FactorsAreThoseOfTheDefinition)
{
  Monitor monitor;
  Mesh mesh = meshes::hexes(3, 1, 1);
  meshes::transform(mesh, [](const Row& x) { return Row(x[0] * x[0], x[1], x[2]); });
  const double volume[] = { 1, 3, 5 }, middle[] = { 0.5, 2.5, 6.5 };
  std::vector<Index> wall; // x = 0
  for (Index n = 0; n < mesh.numberOfNodes(); n += 4)
  {
    wall.push_back(n);
  }
  const std::vector<double> byVolume =
    stiffnessFactors(mesh, {}, { Kind::InverseVolume, 2, {}, {} }, monitor);
  const std::vector<double> byDistance =
    stiffnessFactors(mesh, wall, { Kind::WallDistance, 1, {}, {} }, monitor);
  const auto distance = [&](int c) { return std::hypot(middle[c], std::sqrt(0.5)); };
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(byVolume[c], 1 / (volume[c] * volume[c]), 1e-14);
    EXPECT_NEAR(byDistance[c], distance(0) / distance(c), 1e-14);
  }
  EXPECT_EQ(byDistance, stiffnessFactors(mesh, {}, { Kind::WallDistance, 1, wall, {} }, monitor));
  EXPECT_TRUE(stiffnessFactors(mesh, {}, {}, monitor).empty());
  const std::vector<double> limited =
    stiffnessFactors(mesh, {}, { Kind::Uniform, 1, {}, { 1e30, 1, 1e25 } }, monitor);
  EXPECT_EQ(limited, std::vector<double>({ 1, 1e-10, 1e-5 }));
}

TEST(CellStiffness, OfEqualValuesIsUniform)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target =
      targets(mesh, partition, [](const Row& x) { return motions::twist(x, 4, 4, 1); });
    Monitor monitor;
    FemWarp uniform, equal;
    uniform.setTolerance(1e-13);
    equal.setTolerance(1e-13);
    equal.setStiffness({ Kind::Uniform, 1, {}, std::vector<double>(mesh.numberOfCells(), 7.) });
    Points one, other;
    uniform.prepare(mesh, partition, monitor);
    uniform.evaluate(target, one, monitor);
    equal.prepare(mesh, partition, monitor);
    equal.evaluate(target, other, monitor);
    EXPECT_LT(motions::difference(one, other), 1e-10) << name;
  }
}

TEST(CellStiffness, MultipliesTheMatrixOfTheCell)
{
  Mesh mesh = meshes::hexes(5, 5, 5);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const Index cell = 62; // the middle one, with free nodes alone
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  FemWarp uniform, soft;
  std::vector<double> values(mesh.numberOfCells(), 4);
  values[cell] = 1;
  soft.setStiffness({ Kind::Uniform, 1, {}, values });
  uniform.prepare(mesh, partition, monitor);
  soft.prepare(mesh, partition, monitor);
  ASSERT_EQ(uniform.rows(), soft.rows());
  Eigen::MatrixXd expected = uniform.solver().matrix();
  double corners[8][3], K[triangleSize(8)];
  copyCorners(mesh, cell, *cellShape(mesh.types[cell]), mesh.points, corners[0]);
  elementStiffness(Shape::Hex, corners, K);
  const auto row = [&](int corner)
  {
    return std::find(uniform.rows().begin(), uniform.rows().end(), mesh.cell(cell)[corner]) -
           uniform.rows().begin();
  };
  for (int a = 0; a < 8; ++a)
  {
    for (int b = 0; b < 8; ++b)
    {
      expected(row(a), row(b)) -= 0.75 * K[triangleIndex(8, a, b)];
    }
  }
  const Eigen::MatrixXd found = soft.solver().matrix();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT(expected.ldlt().vectorD().minCoeff(), 0);
}

TEST(CellStiffness, PiecesOfAPolyhedronHaveItsStiffness)
{
  const Mesh mesh = meshes::polyhedral().back().second;
  const NodePartition partition = outerPartition(mesh);
  const Points target =
    targets(mesh, partition, [](const Row& x) { return motions::twist(x, 4, 4, 1); });
  const auto morphed = [&](const std::vector<double>& values)
  {
    auto method = std::make_unique<FemWarp>();
    method->setTolerance(1e-13);
    if (!values.empty())
    {
      method->setStiffness({ Kind::Uniform, 1, {}, values });
    }
    const auto onPieces = morpherForPolyhedra(std::move(method));
    Monitor monitor;
    Points moved;
    onPieces->prepare(mesh, partition, monitor);
    onPieces->prepare(mesh, partition, monitor); // again
    onPieces->evaluate(target, moved, monitor);
    return moved;
  };
  std::vector<double> values(mesh.numberOfCells(), 3);
  const Points uniform = morphed({});
  EXPECT_LT(motions::difference(morphed(values), uniform), 1e-10);
  values.back() = 1;
  EXPECT_GT(motions::difference(morphed(values), uniform), 1e-6);
}

TEST(CellStiffness, RefusesWhatDoesNotFit)
{
  const Mesh mesh = meshes::hexes(2, 2, 2);
  const NodePartition partition = outerPartition(mesh);
  const auto message = [&](const CellStiffness& stiffness)
  {
    std::string text;
    Monitor monitor;
    FemWarp method;
    method.setStiffness(stiffness);
    EXPECT_EQ(
      kindOf([&] { method.prepare(mesh, partition, monitor); }, text), Error::Kind::InvalidInput);
    return text;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values(8, 1);
  EXPECT_NE(message({ Kind::Uniform, 1, {}, { 1, 2 } }).find("2 values"), std::string::npos);
  for (const double wrong : { 0., -1., nan, std::numeric_limits<double>::infinity() })
  {
    values[5] = wrong;
    EXPECT_NE(message({ Kind::Uniform, 1, {}, values }).find("cell ids 5."), std::string::npos);
  }
  EXPECT_NE(message({ Kind::WallDistance, 1, { 3, 99 }, {} }).find("99"), std::string::npos);
  for (const double wrong : { -1., 5., nan })
  {
    EXPECT_NE(message({ Kind::InverseVolume, wrong, {}, {} }).find("[0, 4]"), std::string::npos);
  }
}
