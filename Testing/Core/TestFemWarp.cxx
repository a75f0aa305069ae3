// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Meshes.h"

#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Motions.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>

using namespace meshes;
using namespace morph;
using motions::affine;
using motions::jittered;
using motions::kindOf;
using motions::outerPartition;
using motions::targets;
using motions::twist;

namespace
{
Points morphed(const Mesh& mesh, const NodePartition& partition, const Points& target,
  double tolerance = 1e-12, int threads = 1)
{
  meshes::ThreadedMonitor monitor(threads);
  FemWarp method;
  method.setTolerance(tolerance);
  Points result = motions::morphed(method, mesh, partition, target, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  return result;
}
}

TEST(ElementStiffness, RowsSumToZeroAndAffineFieldsHaveTheirEnergy)
{
  for (const auto& [name, mesh] : jittered())
  {
    double energy = 0;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const CellShape& shape = *cellShape(mesh.types[c]);
      const int n = shape.numberOfCorners;
      double corners[8][3], K[36];
      for (int a = 0; a < n; ++a)
      {
        const auto p = mesh.points.row(mesh.cell(c)[a]);
        std::copy(p.data(), p.data() + 3, corners[a]);
      }
      ASSERT_EQ(elementStiffness(shape.shape, corners, K), 1) << name << " cell " << c;
      for (int a = 0; a < n; ++a)
      {
        double sum = 0, field = 0;
        for (int b = 0; b < n; ++b)
        {
          const double entry = K[triangleIndex(n, a, b)];
          sum += entry;
          field += entry * corners[b][0];
        }
        EXPECT_NEAR(sum, 0, 1e-14) << name;
        energy += field * corners[a][0];
      }
    }
    EXPECT_NEAR(energy, 64, 1e-11) << name; // the integral of |grad x|^2 is the volume
  }
}

TEST(ElementStiffness, UnitCubeHasTheTrilinearEntries)
{
  const double cube[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
    { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
  double K[36];
  ASSERT_EQ(elementStiffness(Shape::Hex, cube, K), 1);
  EXPECT_NEAR(K[triangleIndex(8, 0, 0)], 1. / 3, 1e-15);   // itself
  EXPECT_NEAR(K[triangleIndex(8, 0, 1)], 0, 1e-15);        // along an edge
  EXPECT_NEAR(K[triangleIndex(8, 0, 2)], -1. / 12, 1e-15); // across a face
  EXPECT_NEAR(K[triangleIndex(8, 0, 6)], -1. / 12, 1e-15); // through the cell
}

TEST(ElementStiffness, BadCellsGiveAPositiveMatrixAndSaySo)
{
  double flat[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 0 },
    { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  for (Shape shape : { Shape::Tet, Shape::Hex, Shape::Wedge, Shape::Pyramid })
  {
    const int n = numberOfCorners(shape);
    double K[36];
    double corners[8][3];
    std::memcpy(corners, flat, sizeof flat);
    if (shape != Shape::Hex)
    {
      for (int a = 3; a < n; ++a)
      {
        corners[a][0] += .1; // planar still
      }
    }
    EXPECT_EQ(elementStiffness(shape, corners, K), 0);
    Eigen::MatrixXd full(n, n);
    for (int a = 0; a < n; ++a)
    {
      for (int b = 0; b < n; ++b)
      {
        full(a, b) = K[triangleIndex(n, a, b)];
      }
    }
    EXPECT_TRUE(full.allFinite());
    EXPECT_GE(full.selfadjointView<Eigen::Upper>().eigenvalues().minCoeff(), -1e-9 * full.norm());
    EXPECT_GT(full.norm(), 0);
  }
}

TEST(FemWarp, AffineIsExactThroughTheEquationsToo)
{
  // Not by the affine first guess alone: A_I x_I + A_B x_B vanishes for the undeformed positions.
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    FemWarp method;
    method.prepare(mesh, partition, monitor);
    const Points residual = method.solver().matrix() * meshes::rows(mesh.points, partition.free) +
                            method.coupling() * meshes::rows(mesh.points, partition.prescribed);
    EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-13) << name;
  }
}

TEST(FemWarp, ANodeOfManyCellsAgreesWithADenseSolve)
{
  // Tetrahedra round an axis: both of its nodes share a cell with all others.
  constexpr int Round = 300;
  Mesh mesh;
  mesh.points.resize(Round + 2, 3);
  mesh.points.row(0) << 0, 0, -1;
  mesh.points.row(Round + 1) << 0, 0, 1;
  NodePartition partition;
  partition.prescribed.push_back(0);
  for (Index i = 1; i <= Round; ++i)
  {
    const double angle = 2 * std::acos(-1.) * static_cast<double>(i) / Round;
    mesh.points.row(i) << std::cos(angle), std::sin(angle), .1 * std::sin(5 * angle);
    meshes::add(mesh, Tetra, { 0, Round + 1, i, i % Round + 1 });
    (i % 2 == 0 ? partition.free : partition.prescribed).push_back(i);
  }
  partition.free.push_back(Round + 1);

  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(Round + 2, Round + 2);
  for (Index c = 0; c < Round; ++c)
  {
    double corners[4][3], K[triangleSize(4)];
    const Index* nodes = mesh.cell(c);
    copyCorners(mesh, c, *cellShape(Tetra), mesh.points, corners[0]);
    ASSERT_EQ(elementStiffness(Shape::Tet, corners, K), 1);
    for (int a = 0; a < 4; ++a)
    {
      for (int b = 0; b < 4; ++b)
      {
        dense(nodes[a], nodes[b]) += K[triangleIndex(4, a, b)];
      }
    }
  }
  const Points target = targets(mesh, partition, [](const auto& x) { return twist(x, 4, 4, 1.2); });
  const Points displacement = target - meshes::rows(mesh.points, partition.prescribed);
  const Eigen::MatrixXd A = dense(partition.free, partition.free);
  const Eigen::MatrixXd coupling = dense(partition.free, partition.prescribed);
  const Points expected = direct::solve(A, -direct::product(coupling, displacement));
  const Points found = meshes::rows(morphed(mesh, partition, target, 1e-13), partition.free) -
                       meshes::rows(mesh.points, partition.free);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-10);

  Monitor monitor;
  FemWarp method;
  method.prepare(mesh, partition, monitor);
  int widest = 0;
  const CsrMatrix interior = method.solver().matrix();
  for (const CsrMatrix* matrix : { &interior, &method.coupling() })
  {
    for (Index row = 0; row < matrix->rows(); ++row)
    {
      const int* first = matrix->innerIndexPtr() + matrix->outerIndexPtr()[row];
      const int* last = matrix->innerIndexPtr() + matrix->outerIndexPtr()[row + 1];
      EXPECT_TRUE(std::is_sorted(first, last));
      widest = std::max(widest, static_cast<int>(last - first));
    }
  }
  EXPECT_GT(widest, Round / 2);
}

TEST(FemWarp, ThreadsAndHistoryDoNotShow)
{
  Mesh mesh = meshes::hexes(24, 23, 22); // more rows than one block of the solver's sums
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, [](const auto& x) { return twist(x, 24, 22, 1); });
  const Points one = morphed(mesh, partition, target, 1e-10, 1);
  for (int threads : { 2, 3, 5 })
  {
    EXPECT_TRUE(motions::identical(one, morphed(mesh, partition, target, 1e-10, threads)));
  }
  Monitor monitor;
  FemWarp method;
  Points result =
    motions::morphed(method, mesh, partition, targets(mesh, partition, affine), monitor);
  method.evaluate(target, result, monitor);
  EXPECT_TRUE(motions::identical(one, result));
}

TEST(FemWarp, StretchedAndRandomlyNumberedMeshesConvergeFast)
{
  Mesh mesh = meshes::hexes(20, 20, 20);
  meshes::transform(mesh,
    [](const Eigen::RowVector3d& x)
    {
      return Eigen::RowVector3d(x[0], x[1], std::pow(1.6, x[2] - 20) * 20); // edges of 0.001 to 7.5
    });
  mesh = meshes::renumbered(mesh, motions::shuffledNumbers(mesh.numberOfNodes()));
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  FemWarp method;
  method.prepare(mesh, partition, monitor);
  Points result;
  const EvaluateReport report = method.evaluate(
    targets(mesh, partition, [](const auto& x) { return twist(x, 20, 20, 1); }), result, monitor);
  EXPECT_LT(report.iterations, 60);
}

TEST(FemWarp, LayersOfHexahedraConvergeFast)
{
  // Of these, two have rows whose far neighbors nearly outweigh the diagonal.
  const std::tuple<int, double, double> layers[] = { { 6, 0.03, 1.1 }, { 8, 1e-4, 1.2 },
    { 8, 1e-5, 1.2 }, { 5, 1e-3, 1.4 }, { 11, 3e-3, 1.15 } };
  for (const auto& [n, first, growth] : layers)
  {
    const Mesh mesh = meshes::layered(meshes::hexes, n, first, growth);
    const NodePartition partition = outerPartition(mesh);
    const Points target =
      targets(mesh, partition, [](const motions::Row& x) { return twist(x, 1, 1, 1); });
    ThreadedMonitor monitor(2);
    FemWarp method;
    method.prepare(mesh, partition, monitor);
    Points moved;
    const EvaluateReport report = method.evaluate(target, moved, monitor);
    EXPECT_LE(report.iterations, 40) << n << " " << first << " " << growth;
    EXPECT_LE(report.relativeResidual, 1e-10);
  }
}

TEST(FemWarp, BadCellsWarnAndTheRestStillWorks)
{
  const Mesh good = meshes::hexes(5, 5, 5);
  const NodePartition partition = outerPartition(good);
  const Points target = targets(good, partition, [](const auto& x) { return twist(x, 5, 5, .5); });
  for (const char* kind : { "inverted", "zero volume" })
  {
    Mesh mesh = good;
    const Index cell = 62; // the middle one
    const std::vector<Index> nodes(mesh.cell(cell), mesh.cell(cell) + 8);
    if (std::string(kind) == "inverted")
    {
      for (int a = 0; a < 4; ++a)
      {
        mesh.points.row(nodes[a]).swap(mesh.points.row(nodes[a + 4]));
      }
    }
    else
    {
      for (int a = 0; a < 4; ++a)
      {
        mesh.points.row(nodes[a + 4]) = mesh.points.row(nodes[a]);
      }
    }
    meshes::ThreadedMonitor monitor;
    FemWarp method;
    method.prepare(mesh, partition, monitor);
    ASSERT_EQ(monitor.warnings.size(), 1u);
    EXPECT_NE(monitor.warnings[0].find("62"), std::string::npos) << monitor.warnings[0];
    EXPECT_NE(monitor.warnings[0].find(kind), std::string::npos) << monitor.warnings[0];
    const Points result = motions::moved(method, target, monitor);
    EXPECT_TRUE(result.allFinite());
    EXPECT_LT(meshes::size(result), 2 * meshes::size(good.points));
  }
}

TEST(FemWarp, CellsInvertedAtACornerAloneAreNamedToo)
{
  // A node pushed along a diagonal: the cell there is inverted at that corner, and nowhere that the
  // quadrature looks.
  Mesh mesh = meshes::hexes(9, 9, 9);
  const NodePartition partition = outerPartition(mesh);
  std::vector<Index> bad;
  for (int k : { 2, 4, 6 })
  {
    for (int j : { 2, 4, 6 })
    {
      mesh.points.row(4 + 10 * (j + 10 * Index(k))).array() += .4;
      bad.push_back(4 + 9 * (j + 9 * Index(k)));
    }
  }
  double corners[8][3], K[36];
  for (int a = 0; a < 8; ++a)
  {
    const auto p = mesh.points.row(mesh.cell(bad[0])[a]);
    std::copy(p.data(), p.data() + 3, corners[a]);
  }
  ASSERT_EQ(elementStiffness(Shape::Hex, corners, K), 1);
  ASSERT_LT(scaledJacobian(*cellShape(Hexahedron), corners), 0);

  meshes::ThreadedMonitor monitor;
  FemWarp method;
  method.prepare(mesh, partition, monitor);
  ASSERT_EQ(monitor.warnings.size(), 1u);
  const Quality quality = measureQuality(mesh, mesh.points, {}, {}, monitor);
  ASSERT_EQ(invertedCells(quality), bad);
  EXPECT_NE(monitor.warnings[0].find("9 inverted cells: ids " + listIds(bad)), std::string::npos)
    << monitor.warnings[0];
  EXPECT_EQ(monitor.warnings[0].find("approximately"), std::string::npos) << monitor.warnings[0];
  const Points result = motions::moved(method, targets(mesh, partition, affine), monitor);
  EXPECT_LT(motions::difference(result, motions::mapped(mesh.points, affine)), 1e-10);
}

TEST(FemWarp, CollapsedHexahedraAreNotNamed)
{
  Mesh mesh = meshes::hexes(4, 4, 4);
  const NodePartition partition = outerPartition(mesh);
  std::vector<Index> nodes(mesh.cell(21), mesh.cell(21) + 8);
  nodes[2] = nodes[3];
  nodes[6] = nodes[7];
  std::copy(nodes.begin(), nodes.end(), mesh.connectivity.begin() + mesh.offsets[21]);
  meshes::ThreadedMonitor monitor;
  FemWarp method;
  method.prepare(mesh, partition, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings[0];
}

TEST(FemWarp, NodesBetweenCollapsedCellsAreNamed)
{
  // All cells around the one free node shrink to that node.
  Mesh mesh = meshes::hexes(2, 2, 2);
  const NodePartition partition = outerPartition(mesh);
  mesh.points.setConstant(1);
  Monitor monitor;
  FemWarp method;
  motions::expectError(
    Error::Kind::Singular, [&] { method.prepare(mesh, partition, monitor); }, "node ids 13");
}
