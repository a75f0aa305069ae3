// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Meshes.h"
#include "Motions.h"

#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/LogBarrierWeights.h"
#include "Mesh/CellShape.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

using namespace meshes;
using namespace motions;
using namespace morph;

namespace
{
using OutsideHull = LogBarrierWarp::OutsideHull;

Points morphed(const Mesh& mesh, const NodePartition& partition, const Points& target,
  double tolerance = 1e-12, int threads = 1)
{
  ThreadedMonitor monitor(threads);
  LogBarrierWarp method;
  method.setTolerance(tolerance);
  Points result = motions::morphed(method, mesh, partition, target, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  return result;
}

/// Rows of (I - W_I) x_I - W_B x_B, undeformed: how far the weights miss their nodes.
double missed(const LogBarrierWarp& method, const Mesh& mesh)
{
  const Points residual = method.solver().matrix() * rows(mesh.points, method.rows()) +
                          method.coupling() * rows(mesh.points, method.partition().prescribed);
  return residual.cwiseAbs().maxCoeff();
}

/// A mesh with one inner node that its neighbors cannot hold.
Mesh withNodeOutside(Index node, const Eigen::RowVector3d& shift)
{
  Mesh mesh = hexes(6, 6, 6);
  mesh.points.row(node) += shift;
  return mesh;
}
constexpr Index Center = 171; // of hexes(6, 6, 6)
}

TEST(LogBarrierWarp, WeightsSumToOneAndReproduceTheRestPositions)
{
  auto list = jittered();
  Mesh flat = hexes(5, 5, 5);
  jitterInterior(flat, .2, seed());
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  transform(flat, [&](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(Eigen::RowVector3d(x[0], .03 * x[1], 1e-4 * x[2]) * turn); });
  list.emplace_back("flat 1e4", flat);
  list.emplace_back("lattice", hexes(5, 5, 5));
  for (const auto& [name, mesh] : list)
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    LogBarrierWarp method;
    method.prepare(mesh, partition, monitor);
    EXPECT_LT(missed(method, mesh), 1e-12) << name;
    const CsrMatrix A = method.solver().matrix();
    const Eigen::VectorXd sums =
      A * Eigen::VectorXd::Ones(A.cols()) +
      method.coupling() * Eigen::VectorXd::Ones(method.coupling().cols());
    EXPECT_LT(sums.cwiseAbs().maxCoeff(), 1e-14) << name;
    // An M-matrix: a unit diagonal and nothing positive beside it.
    for (int i = 0; i < A.rows(); ++i)
    {
      for (CsrMatrix::InnerIterator entry(A, i); entry; ++entry)
      {
        EXPECT_TRUE(entry.col() == i ? entry.value() == 1 : entry.value() < 0) << name;
      }
    }
  }
}

TEST(LogBarrierWarp, NeighborsAreAllThatShareAVolumeCell)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    LogBarrierWarp method;
    method.prepare(mesh, partition, monitor);
    std::vector<std::set<Index>> expected(mesh.numberOfNodes()), found(mesh.numberOfNodes());
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const int n = cellShape(mesh.types[c])->numberOfCorners;
      for (int a = 0; a < n; ++a)
      {
        expected[mesh.cell(c)[a]].insert(mesh.cell(c), mesh.cell(c) + n);
      }
    }
    const CsrMatrix A = method.solver().matrix();
    for (int i = 0; i < static_cast<int>(method.rows().size()); ++i)
    {
      std::set<Index>& mine = found[method.rows()[i]];
      for (CsrMatrix::InnerIterator entry(A, i); entry; ++entry)
      {
        mine.insert(method.rows()[entry.col()]);
      }
      for (CsrMatrix::InnerIterator entry(method.coupling(), i); entry; ++entry)
      {
        mine.insert(partition.prescribed[entry.col()]);
      }
      EXPECT_EQ(mine, expected[method.rows()[i]]) << name << ' ' << i;
    }
  }
}

TEST(LogBarrierWarp, FreeNodesStayInTheHullOfThePrescribedOnes)
{
  std::mt19937 random(seed());
  std::uniform_real_distribution<double> value(-1, 1);
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Points target = rows(mesh.points, partition.prescribed); // scattered: FEMWARP need not obey
    target += 3 * target.unaryExpr([&](double) { return value(random); });
    const Points free = rows(morphed(mesh, partition, target), partition.free);
    for (int i = 0; i < 50; ++i)
    {
      const Eigen::Vector3d direction(value(random), value(random), value(random));
      EXPECT_LT((free * direction).maxCoeff(), (target * direction).maxCoeff()) << name;
    }
  }
}

TEST(LogBarrierWarp, StretchedAndGradedMeshesConvergeFast)
{
  for (const char* kind : { "graded", "flat" })
  {
    Mesh mesh = hexes(20, 20, 20);
    jitterInterior(mesh, .1, seed());
    const bool graded = std::string(kind) == "graded";
    transform(mesh,
      [graded](const Eigen::RowVector3d& x)
      {
        return graded ? Eigen::RowVector3d(
                          x[0], x[1], std::pow(1.6, x[2] - 20) * 20) // edges of 0.001 to 7.5
                      : Eigen::RowVector3d(x[0], .01 * x[1], 1e-4 * x[2]);
      });
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    LogBarrierWarp method;
    method.prepare(mesh, partition, monitor);
    EXPECT_LT(missed(method, mesh), 1e-11) << kind;
    Points result;
    const EvaluateReport report = method.evaluate(
      targets(mesh, partition, [](const auto& x) { return twist(x, 20, 20, 1); }), result, monitor);
    EXPECT_LT(report.iterations, 40) << kind;
  }
}

TEST(LogBarrierWarp, FreeNodesOnAFlatOuterFaceKeepToIt)
{
  // The inner nodes of the face z = 0 are left free: the limit of their weights lies within the
  // face.
  Mesh mesh = hexes(5, 5, 5);
  jitterInterior(mesh, .15, seed());
  const NodePartition outer = outerPartition(mesh);
  std::vector<Index> ids;
  for (Index id : outer.prescribed)
  {
    const auto p = mesh.points.row(id);
    if (p[2] > 0 || p[0] == 0 || p[0] == 5 || p[1] == 0 || p[1] == 5)
    {
      ids.push_back(id);
    }
  }
  ASSERT_EQ(ids.size() + 16, outer.prescribed.size());
  const NodePartition partition = partitionNodes(mesh, ids);
  Monitor monitor;
  LogBarrierWarp method;
  method.prepare(mesh, partition, monitor);
  EXPECT_LT(missed(method, mesh), 1e-10);
  Points result;
  const EvaluateReport report = method.evaluate(
    targets(mesh, partition, [](const auto& x) { return twist(x, 5, 5, 1); }), result, monitor);
  EXPECT_EQ(count(report, "OutsideHullNodes"), 0);
  for (Index id : outer.prescribed)
  {
    if (mesh.points(id, 2) == 0)
    {
      EXPECT_NEAR(result(id, 2), 0, 1e-12);
    }
  }
}

TEST(LogBarrierWarp, FreeNodesOnTheEdgesOfGrowingLayersAreInTheirHull)
{
  // On an edge of the box the neighbors above and below are unequally far: the weights' system is
  // singular to rounding.
  for (const double growth : { 1.05, 1.1, 1.2, 1.5 })
  {
    const int layers = 24;
    Mesh mesh = meshes::hexes(4, 4, layers);
    const double most = std::pow(growth, layers) - 1;
    meshes::transform(mesh, [&](const Eigen::RowVector3d& x)
      { return Eigen::RowVector3d(x[0] / 4, x[1] / 4, (std::pow(growth, x[2]) - 1) / most); });
    std::vector<Index> ends;
    for (Index i = 0; i < mesh.numberOfNodes(); ++i)
    {
      if (mesh.points(i, 2) == 0 || mesh.points(i, 2) == 1)
      {
        ends.push_back(i);
      }
    }
    const NodePartition partition = partitionNodes(mesh, ends);
    Monitor monitor;
    LogBarrierWarp method;
    Points moved = motions::morphed(
      method, mesh, partition, motions::targets(mesh, partition, motions::affine), monitor);
    EXPECT_LT(motions::difference(moved, motions::mapped(mesh.points, motions::affine)), 1e-12)
      << growth;
  }
}

TEST(LogBarrierWarp, ANodeOutsideItsHullIsNamed)
{
  const Mesh mesh = withNodeOutside(Center, { 1.3, .1, .2 });
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  LogBarrierWarp method;
  EXPECT_EQ(method.outsideHull(), OutsideHull::Error);
  std::string message;
  kindOf([&] { method.prepare(mesh, partition, monitor); }, message);
  EXPECT_EQ(message.rfind("1 free node does not lie inside the hull", 0), 0u) << message;
  EXPECT_NE(message.find("node ids 171."), std::string::npos) << message;
  EXPECT_NE(message.find("Relax"), std::string::npos) << message;
  Points moved;
  EXPECT_THROW(method.evaluate(rows(mesh.points, partition.prescribed), moved, monitor), Error);
}

TEST(LogBarrierWarp, RelaxTakesTheSecondRingFirst)
{
  const Mesh mesh = withNodeOutside(Center, { 1.3, .1, .2 });
  const NodePartition partition = outerPartition(mesh);
  ThreadedMonitor monitor;
  LogBarrierWarp method;
  method.setOutsideHull(OutsideHull::Relax);
  method.prepare(mesh, partition, monitor);
  ASSERT_EQ(monitor.warnings.size(), 1u);
  EXPECT_NE(monitor.warnings[0].find("node ids 171."), std::string::npos) << monitor.warnings[0];
  EXPECT_LT(missed(method, mesh), 1e-12);
  Points result;
  const EvaluateReport report = method.evaluate(targets(mesh, partition, affine), result, monitor);
  EXPECT_EQ(count(report, "OutsideHullNodes"), 1);
  EXPECT_EQ(count(report, "TwoRingNodes"), 1);
  EXPECT_EQ(count(report, "AffineNodes"), 0);
  EXPECT_EQ(count(report, "StiffnessNodes"), 0);
  Mesh expected = mesh;
  transform(expected, affine);
  EXPECT_LT((result - expected.points).cwiseAbs().maxCoeff(), 1e-9);

  // The row is wider than the ring and its transpose has entries where it has none.
  Points gradient = Points::Zero(mesh.numberOfNodes(), 3), step, plus, minus;
  gradient(Center + 1, 0) = 1;
  method.applyTranspose(gradient, step, monitor);
  const Points at = rows(mesh.points, partition.prescribed);
  method.evaluate(at + step, plus, monitor);
  method.evaluate(at - step, minus, monitor);
  EXPECT_NEAR((plus(Center + 1, 0) - minus(Center + 1, 0)) / 2, step.squaredNorm(),
    1e-8 * step.squaredNorm());
}

TEST(LogBarrierWarp, RelaxThenTakesAffineWeights)
{
  // The one free node lies outside the whole mesh.
  Mesh mesh = hexes(2, 2, 2);
  mesh.points.row(13) = Eigen::RowVector3d(3, 1.1, .9);
  const NodePartition partition = outerPartition(mesh);
  ThreadedMonitor monitor;
  LogBarrierWarp method;
  method.setOutsideHull(OutsideHull::Relax);
  method.prepare(mesh, partition, monitor);
  EXPECT_LT(missed(method, mesh), 1e-13);
  Points result;
  const EvaluateReport report = method.evaluate(targets(mesh, partition, affine), result, monitor);
  EXPECT_EQ(count(report, "OutsideHullNodes"), 1);
  EXPECT_EQ(count(report, "AffineNodes"), 1);
  EXPECT_LT((result.row(13) - affine(mesh.points.row(13))).norm(), 1e-12);

  // Least norm: the weights are affine functions of the neighbors' places.
  const Points neighbors = rows(mesh.points, partition.prescribed);
  const Eigen::VectorXd w = -Eigen::MatrixXd(method.coupling()).transpose().col(0);
  Eigen::MatrixXd affineFunctions(26, 4);
  affineFunctions << Eigen::VectorXd::Ones(26), neighbors;
  const Eigen::VectorXd fit =
    direct::product(affineFunctions, direct::leastSquares(affineFunctions, w));
  EXPECT_LT((fit - w).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(LogBarrierWarp, RelaxAtLastTakesTheStiffness)
{
  // All neighbors lie in one plane and the node off it: no weights of sum 1 reach it.
  Mesh mesh = hexes(2, 2, 2);
  mesh.points.col(2).setZero();
  mesh.points(13, 2) = 1;
  std::vector<Index> ids(27);
  std::iota(ids.begin(), ids.end(), Index(0));
  ids.erase(ids.begin() + 13);
  const NodePartition partition = partitionNodes(mesh, ids);
  ThreadedMonitor monitor;
  LogBarrierWarp method;
  method.setOutsideHull(OutsideHull::Relax);
  method.prepare(mesh, partition, monitor);
  Points result;
  const Points target =
    rows(mesh.points, partition.prescribed).rowwise() + Eigen::RowVector3d(1, 2, 3);
  const EvaluateReport report = method.evaluate(target, result, monitor);
  EXPECT_EQ(count(report, "StiffnessNodes"), 1);
  EXPECT_LT((result.row(13) - mesh.points.row(13) - Eigen::RowVector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(LogBarrierWarp, ScrambledMeshesGetAResultWhereRelaxed)
{
  Mesh mesh = hexes(12, 12, 12);
  jitterInterior(mesh, 1.2, seed()); // most cells inverted
  const NodePartition partition = outerPartition(mesh);
  ThreadedMonitor monitor;
  LogBarrierWarp method;
  motions::expectError([&] { method.prepare(mesh, partition, monitor); }, "in all");
  method.setOutsideHull(OutsideHull::Relax);
  method.prepare(mesh, partition, monitor);
  EXPECT_LT(missed(method, mesh), 1e-9);
  Points result;
  const EvaluateReport report = method.evaluate(targets(mesh, partition, affine), result, monitor);
  EXPECT_GT(count(report, "OutsideHullNodes"), 10);
  EXPECT_EQ(count(report, "OutsideHullNodes"),
    count(report, "TwoRingNodes") + count(report, "AffineNodes") + count(report, "StiffnessNodes"));
  Mesh expected = mesh;
  transform(expected, affine);
  EXPECT_LT((result - expected.points).cwiseAbs().maxCoeff(), 1e-8);
}
