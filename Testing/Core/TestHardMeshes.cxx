// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP on what production meshes bring along: collapsed cells, slivers, coordinates far from the
// origin.
#include "Meshes.h"

#include "LinearMethods/FemWarp.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "Support/Error.h"
#include "Untangling/Smoothing.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>

#include <cmath>

using namespace morph;

namespace
{
Eigen::RowVector3d sheared(const Eigen::RowVector3d& x)
{
  return { 1.1 * x[0] + .3 * x[1], 1.4 * x[1] - .1 * x[2], .9 * x[2] + .2 * x[0] };
}

Eigen::RowVector3d bend(const Eigen::RowVector3d& x)
{
  return { x[0] + .02 * x[1] * x[1], x[1] + .3 * std::sin(x[2]), x[2] + .1 * x[0] * x[1] };
}

struct Outcome
{
  Points moved;
  EvaluateReport report;
  double trueResidual = 0;
};

/// Moves the outer nodes by `map`. The true residual is computed here, from the result.
Outcome morphOuter(const Mesh& mesh, Eigen::RowVector3d (*map)(const Eigen::RowVector3d&),
  meshes::ThreadedMonitor& monitor)
{
  const NodePartition partition = partitionNodes(mesh, boundaryFaces(mesh, monitor).nodes);
  Mesh copy = mesh;
  meshes::transform(copy, map);
  const Points target = meshes::rows(copy.points, partition.prescribed);
  FemWarp method;
  method.prepare(mesh, partition, monitor);
  Outcome result;
  result.report = method.evaluate(target, result.moved, monitor);
  const Points rhs =
    method.coupling() * Points(target - meshes::rows(mesh.points, partition.prescribed));
  const Points left =
    rhs + method.solver().matrix() * Points(meshes::rows(result.moved, method.rows()) -
                                            meshes::rows(mesh.points, method.rows()));
  for (int c = 0; c < 3; ++c)
  {
    result.trueResidual = std::max(result.trueResidual, left.col(c).norm() / rhs.col(c).norm());
  }
  return result;
}

/// A mesh of hexahedra about the z axis whose innermost cells are collapsed to wedges, or the same
/// cells as wedges.
Mesh polar(bool asWedges)
{
  constexpr int Around = 8, Rings = 4, Layers = 4;
  Mesh mesh;
  const auto axis = [](int k) -> Index { return k; };
  const auto at = [](int i, int j, int k) -> Index
  { return (Layers + 1) + (i % Around) + Around * ((j - 1) + Rings * k); };
  mesh.points.resize((Layers + 1) * (1 + Around * Rings), 3);
  for (int k = 0; k <= Layers; ++k)
  {
    mesh.points.row(axis(k)) = Eigen::RowVector3d(0, 0, k);
    for (int i = 0; i < Around; ++i)
    {
      for (int j = 1; j <= Rings; ++j)
      {
        const double angle = 2 * 3.14159265358979 * i / Around;
        mesh.points.row(at(i, j, k)) =
          Eigen::RowVector3d(j * std::cos(angle), j * std::sin(angle), k + .1 * std::sin(j + k));
      }
    }
  }
  for (int k = 0; k < Layers; ++k)
  {
    for (int i = 0; i < Around; ++i)
    {
      const Index a = axis(k), b = at(i, 1, k), c = at(i + 1, 1, k);
      const Index A = axis(k + 1), B = at(i, 1, k + 1), C = at(i + 1, 1, k + 1);
      if (asWedges)
      {
        meshes::add(mesh, Wedge, { a, b, c, A, B, C });
      }
      else
      {
        meshes::add(mesh, Hexahedron, { a, b, c, a, A, B, C, A });
      }
      for (int j = 1; j < Rings; ++j)
      {
        meshes::add(mesh, Hexahedron,
          { at(i, j, k), at(i, j + 1, k), at(i + 1, j + 1, k), at(i + 1, j, k), at(i, j, k + 1),
            at(i, j + 1, k + 1), at(i + 1, j + 1, k + 1), at(i + 1, j, k + 1) });
      }
    }
  }
  return mesh;
}
}

TEST(HardMeshes, CollapsedHexahedraAreWedges)
{
  const Mesh collapsed = polar(false), wedges = polar(true);
  Monitor silent;
  EXPECT_EQ(boundaryFaces(collapsed, silent).nodes, boundaryFaces(wedges, silent).nodes);
  EXPECT_EQ(
    boundaryFaces(collapsed, silent).cells.size(), boundaryFaces(wedges, silent).cells.size());

  meshes::ThreadedMonitor monitor;
  const Outcome result = morphOuter(collapsed, sheared, monitor);
  Mesh expected = collapsed;
  meshes::transform(expected, sheared);
  EXPECT_LT(
    (result.moved - expected.points).cwiseAbs().maxCoeff(), 1e-10 * meshes::size(collapsed.points));
  EXPECT_TRUE(monitor.warnings.empty());

  // A hexahedron's shape functions collapse to a wedge's: the same nodes for any motion.
  const Outcome bent = morphOuter(collapsed, bend, monitor),
                same = morphOuter(wedges, bend, monitor);
  EXPECT_LT(bent.trueResidual, 1e-9);
  EXPECT_LT((bent.moved - same.moved).cwiseAbs().maxCoeff(), 1e-2);
}

TEST(HardMeshes, OneWedgeWrittenAsAHexahedronAmongWedges)
{
  Mesh mesh = meshes::wedges(4, 4, 4), changed;
  changed.points = mesh.points;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index* n = mesh.cell(c);
    if (c == 42)
    {
      meshes::add(changed, Hexahedron, { n[0], n[1], n[2], n[2], n[3], n[4], n[5], n[5] });
    }
    else
    {
      meshes::add(changed, Wedge, { n, n + 6 });
    }
  }
  Monitor monitor;
  EXPECT_EQ(boundaryFaces(changed, monitor).nodes, boundaryFaces(mesh, monitor).nodes);
  EXPECT_EQ(boundaryFaces(changed, monitor).cells, boundaryFaces(mesh, monitor).cells);
}

TEST(HardMeshes, FarFromTheOriginAffineMotionsKeepTheirDigits)
{
  for (auto [name, mesh] : meshes::all(4, 4, 4))
  {
    meshes::jitterInterior(mesh, .1, meshes::seed());
    mesh.points.rowwise() += Eigen::RowVector3d(1e6, -2e6, 3e6);
    meshes::ThreadedMonitor monitor;
    const Outcome result = morphOuter(mesh, sheared, monitor);
    Mesh expected = mesh;
    meshes::transform(expected, sheared);
    // The coordinates themselves are rounded to 5e-10.
    EXPECT_LT((result.moved - expected.points).cwiseAbs().maxCoeff(), 1e-7) << name;
    EXPECT_TRUE(monitor.warnings.empty()) << name;
  }
}

TEST(HardMeshes, ManySliversConvergeAndTheResidualIsTrue)
{
  for (double height : { 1e-3, 1e-6, 1e-9, 1e-11 })
  {
    Mesh mesh = meshes::tets(16, 16, 16);
    std::vector<std::uint8_t> taken(mesh.numberOfNodes(), 0);
    Monitor silent;
    for (Index id : boundaryFaces(mesh, silent).nodes)
    {
      taken[id] = 1;
    }
    // Every so often the last node of a tet moves to just above the opposite face.
    for (Index c = 0; c < mesh.numberOfCells(); c += 35)
    {
      const Index* n = mesh.cell(c);
      if (taken[n[3]])
      {
        continue;
      }
      const Eigen::RowVector3d a = mesh.points.row(n[0]), b = mesh.points.row(n[1]),
                               d = mesh.points.row(n[2]);
      mesh.points.row(n[3]) = (a + b + d) / 3 + height * (b - a).cross(d - a).normalized();
      for (int k = 0; k < 4; ++k)
      {
        taken[n[k]] = 1;
      }
    }
    meshes::ThreadedMonitor monitor;
    const Outcome result = morphOuter(mesh, bend, monitor);
    EXPECT_TRUE(result.moved.allFinite()) << height;
    EXPECT_LT(result.report.iterations, 1500) << height; // most at 1e-6, where they are stiffest
    // What is reported is what x really leaves, and where it is above the tolerance a warning says
    // so.
    EXPECT_NEAR(std::log10(result.report.relativeResidual), std::log10(result.trueResidual), 1)
      << height;
    if (result.trueResidual > 2e-9)
    {
      EXPECT_NE(monitor.warnings.back().find("Rounding"), std::string::npos) << height;
    }
  }
}

TEST(HardMeshes, ManyCellsRoundOneNode)
{
  // A wheel of thin wedges round an axis.
  constexpr int Around = 20000;
  Mesh mesh;
  mesh.points.resize(2 * Around + 2, 3);
  for (int k = 0; k < 2; ++k)
  {
    mesh.points.row(2 * Around + k) = Eigen::RowVector3d(0, 0, k);
    for (int i = 0; i < Around; ++i)
    {
      const double angle = 2 * 3.14159265358979 * i / Around;
      mesh.points.row(k * Around + i) = Eigen::RowVector3d(std::cos(angle), std::sin(angle), k);
    }
  }
  for (Index i = 0; i < Around; ++i)
  {
    const Index next = (i + 1) % Around;
    meshes::add(mesh, Wedge, { 2 * Around, i, next, 2 * Around + 1, Around + i, Around + next });
  }
  Monitor monitor;
  EXPECT_EQ(boundaryFaces(mesh, monitor).cells.size(), 3u * Around);
}

TEST(Misuse, PositionsThatOverflowAreAnError)
{
  Mesh mesh = meshes::hexes(5, 5, 5);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  mesh.points *= 1e160;
  const NodePartition partition = motions::outerPartition(mesh);
  Points target = meshes::rows(mesh.points, partition.prescribed);
  target(0, 0) += 1e159;
  meshes::ThreadedMonitor monitor;
  Smoothing method;
  method.prepare(mesh, partition, monitor);
  Points moved = Points::Constant(1, 3, 5);
  motions::expectError([&] { method.evaluate(target, moved, monitor); }, "not finite");
  EXPECT_EQ(moved, Points::Constant(1, 3, 5)); // untouched
}

TEST(Misuse, EvaluateNeedsASuccessfulPrepare)
{
  const Mesh small = meshes::hexes(4, 4, 4), large = meshes::hexes(8, 8, 8);
  meshes::ThreadedMonitor monitor;
  const NodePartition partition = partitionNodes(small, boundaryFaces(small, monitor).nodes);
  const Points target = meshes::rows(small.points, partition.prescribed);
  FemWarp method;
  Points moved;
  EXPECT_THROW(method.evaluate(target, moved, monitor), Error);
  EXPECT_THROW(method.applyTranspose(small.points, moved, monitor), Error);

  method.prepare(small, partition, monitor);
  EXPECT_NO_THROW(method.evaluate(target, moved, monitor));
  monitor.lastProgress = 0;
  monitor.cancelAt = 0.3;
  const NodePartition other = partitionNodes(large, boundaryFaces(large, monitor).nodes);
  EXPECT_THROW(method.prepare(large, other, monitor), Error);
  EXPECT_THROW(
    method.evaluate(meshes::rows(large.points, other.prescribed), moved, monitor), Error);
}

TEST(Misuse, OffsetsThatFallAreRefusedBeforeTheyAreUsed)
{
  Mesh mesh = meshes::hexes(2, 1, 1);
  mesh.types.assign(2, PolyVertex);
  mesh.offsets = { 0, 100000, 16 };
  EXPECT_THROW(validate(mesh), Error);
}

TEST(Misuse, NodesOfCellsAreFinite)
{
  Mesh mesh = meshes::hexes(1, 1, 1);
  mesh.points.conservativeResize(9, 3);
  mesh.points.row(8).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NO_THROW(validate(mesh)); // no cell has it
  mesh.points(3, 0) = mesh.points(8, 0);
  std::string message;
  motions::kindOf([&] { validate(mesh); }, message);
  EXPECT_NE(message.find("node ids 3."), std::string::npos) << message;
}
