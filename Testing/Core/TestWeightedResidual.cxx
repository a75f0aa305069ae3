// SPDX-License-Identifier: BSD-3-Clause
#include "DirectSolutions.h"
#include "Meshes.h"

#include "LinearMethods/WeightedResidual.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

using namespace morph;

namespace
{
const Eigen::Matrix3d Shear =
  (Eigen::Matrix3d() << 1.1, .3, .2, -.1, 1.4, .05, .2, .1, .9).finished();

Eigen::RowVector3d affine(const Eigen::RowVector3d& x)
{
  return x * Shear + Eigen::RowVector3d(3, -2, .5);
}

/// Far from affine.
Eigen::RowVector3d bend(const Eigen::RowVector3d& x)
{
  return { x[0] + .3 * std::sin(x[1]), x[1] + .1 * x[2] * x[0],
    1.2 * x[2] + .2 * std::cos(2 * x[0]) };
}

NodePartition outerPartition(const Mesh& mesh)
{
  Monitor monitor;
  return partitionNodes(mesh, boundaryFaces(mesh, monitor).nodes);
}

Points targets(const Mesh& mesh, const NodePartition& partition,
  const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& map)
{
  Mesh copy = mesh;
  meshes::transform(copy, map);
  return meshes::rows(copy.points, partition.prescribed);
}

struct Options
{
  Index neighbors = 80;
  int threads = 1;
};

Points morphed(const Mesh& mesh, const NodePartition& partition, const Points& target,
  const Options& options = {})
{
  meshes::ThreadedMonitor monitor(options.threads);
  WeightedResidual method;
  method.setNumberOfNeighbors(options.neighbors);
  method.prepare(mesh, partition, monitor);
  Points result;
  method.evaluate(target, result, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  return result;
}

/// All nodes a little off their lattice places, those on the outside too: no two distances are
/// equal.
std::vector<std::pair<std::string, Mesh>> generic(int nx, int ny, int nz)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> shift(-.1, .1);
  auto list = meshes::all(nx, ny, nz);
  for (auto& [name, mesh] : list)
  {
    mesh.points = mesh.points.unaryExpr([&](double v) { return v + shift(random); });
  }
  return list;
}

const std::vector<Options>& variants()
{
  static const std::vector<Options> list = { {}, { 9 }, { 1 } };
  return list;
}

bool sameBits(const Points& a, const Points& b)
{
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

/// Equations (3) to (6), with positions as they are printed: nothing shared with the library.
Eigen::RowVector3d byTheBook(
  const Points& rest, const Points& moved, const Eigen::RowVector3d& x, Index neighbors)
{
  // (3) to (5): x' = Gamma x + translation by least squares.
  Eigen::MatrixXd columns(rest.rows(), 4);
  columns << rest, Eigen::VectorXd::Ones(rest.rows());
  const Eigen::MatrixXd gamma = direct::leastSquares(columns, moved);
  const Eigen::MatrixXd residual = moved - direct::product(columns, gamma);
  // (6)
  std::vector<std::pair<double, Index>> near;
  for (Index k = 0; k < rest.rows(); ++k)
  {
    near.emplace_back((rest.row(k) - x).squaredNorm(), k);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min<Index>(neighbors, rest.rows()));
  double sum = 0;
  Eigen::RowVector3d result = Eigen::RowVector3d::Zero();
  for (const auto& [square, k] : near)
  {
    result += residual.row(k) / square;
    sum += 1 / square;
  }
  Eigen::RowVector4d extended;
  extended << x, 1;
  return extended * gamma + result / sum;
}
}

TEST(WeightedResidual, AgreesWithTheEquationsWrittenOut)
{
  for (const auto& [name, mesh] : generic(4, 3, 5))
  {
    const NodePartition partition = outerPartition(mesh);
    const Points rest = meshes::rows(mesh.points, partition.prescribed);
    const Points target = targets(mesh, partition, bend);
    for (Index neighbors : { 1, 7, 80, 100000 })
    {
      const Points result = morphed(mesh, partition, target, { neighbors });
      for (Index id : partition.free)
      {
        EXPECT_LT((result.row(id) - byTheBook(rest, target, mesh.points.row(id), neighbors)).norm(),
          1e-12 * meshes::size(mesh.points))
          << name << ", node " << id << ", " << neighbors << " neighbors";
      }
    }
  }
}

TEST(WeightedResidual, AffineMotionsAreExact)
{
  for (const Options& options : variants())
  {
    for (auto [name, mesh] : meshes::all(4, 4, 4))
    {
      meshes::jitterInterior(mesh, .1, meshes::seed());
      const NodePartition partition = outerPartition(mesh);
      Mesh expected = mesh;
      meshes::transform(expected, affine);
      const Points result = morphed(mesh, partition, targets(mesh, partition, affine), options);
      EXPECT_LT((result - expected.points).cwiseAbs().maxCoeff(), 1e-10 * meshes::size(mesh.points))
        << name;
    }
  }
}

TEST(WeightedResidual, NoMotionIsTheIdentityBitForBit)
{
  for (const Options& options : variants())
  {
    for (const auto& [name, mesh] : generic(3, 4, 3))
    {
      const NodePartition partition = outerPartition(mesh);
      const Points rest = meshes::rows(mesh.points, partition.prescribed);
      EXPECT_TRUE(sameBits(morphed(mesh, partition, rest, options), mesh.points)) << name;
    }
  }
}

TEST(WeightedResidual, PrescribedNodesGoExactlyWhereTheyAreSent)
{
  for (const auto& [name, mesh] : generic(3, 4, 3))
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, bend);
    const Points result = morphed(mesh, partition, target);
    EXPECT_TRUE(sameBits(meshes::rows(result, partition.prescribed), target)) << name;
  }
}

TEST(WeightedResidual, RenumberingTheNodesChangesNoBit)
{
  std::mt19937 random(meshes::seed());
  for (const Options& options : variants())
  {
    for (const auto& [name, mesh] : meshes::all(4, 4, 4)) // lattices: full of ties
    {
      std::vector<Index> order(mesh.numberOfNodes());
      std::iota(order.begin(), order.end(), Index(0));
      std::shuffle(order.begin(), order.end(), random);
      const Mesh shuffled = meshes::renumbered(mesh, order);
      const NodePartition partition = outerPartition(mesh), renamed = outerPartition(shuffled);
      const Points one = morphed(mesh, partition, targets(mesh, partition, bend), options);
      const Points other = morphed(shuffled, renamed, targets(shuffled, renamed, bend), options);
      const Points back = meshes::rows(other, order);
      EXPECT_TRUE(sameBits(meshes::rows(one, partition.free), meshes::rows(back, partition.free)))
        << name;
      EXPECT_LT((one - back).cwiseAbs().maxCoeff(), 1e-14 * meshes::size(mesh.points)) << name;
    }
  }
}

TEST(WeightedResidual, RigidMotionAndScaleOfTheRestMeshDoNotMatter)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, -2, .5).normalized()).toRotationMatrix();
  const auto place = [&](const Eigen::RowVector3d& x) -> Eigen::RowVector3d
  { return 1e3 * x * turn + Eigen::RowVector3d(500, -3000, 100); };
  // Lattices have many sites as far as the last neighbor.
  auto all = meshes::all(4, 4, 4);
  const auto others = generic(4, 4, 4);
  all.insert(all.end(), others.begin(), others.end());
  for (const Options& options : variants())
  {
    for (const auto& [name, mesh] : all)
    {
      const NodePartition partition = outerPartition(mesh);
      Mesh elsewhere = mesh;
      meshes::transform(elsewhere, place);
      const Points target = targets(mesh, partition, bend);
      Points targetElsewhere = target;
      for (Index i = 0; i < target.rows(); ++i)
      {
        targetElsewhere.row(i) = place(target.row(i));
      }
      Mesh expected = mesh;
      expected.points = morphed(mesh, partition, target, options);
      meshes::transform(expected, place);
      const Points result = morphed(elsewhere, partition, targetElsewhere, options);
      EXPECT_LT(
        (result - expected.points).cwiseAbs().maxCoeff(), 1e-10 * meshes::size(elsewhere.points))
        << name;
    }
  }
}

TEST(WeightedResidual, AdjointMatchesFiniteDifferences)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  for (const Options& options : variants())
  {
    for (const auto& [name, mesh] : generic(4, 4, 4))
    {
      const NodePartition partition = outerPartition(mesh);
      Monitor monitor;
      WeightedResidual method;
      method.setNumberOfNeighbors(options.neighbors);
      method.prepare(mesh, partition, monitor);
      Points gradient(mesh.numberOfNodes(), 3),
        step(static_cast<Index>(partition.prescribed.size()), 3);
      gradient = gradient.unaryExpr([&](double) { return value(random); });
      step = step.unaryExpr([&](double) { return value(random); });
      Points adjoint, plus, minus;
      method.applyTranspose(gradient, adjoint, monitor);
      ASSERT_EQ(adjoint.rows(), step.rows());

      // The map is linear, so central differences are exact but for rounding.
      const Points at = targets(mesh, partition, bend);
      method.evaluate(at + .5 * step, plus, monitor);
      method.evaluate(at - .5 * step, minus, monitor);
      const double difference = gradient.cwiseProduct(plus - minus).sum();
      EXPECT_NEAR(adjoint.cwiseProduct(step).sum(), difference, 1e-11 * gradient.squaredNorm())
        << name;
      // Prescribed coordinates one by one.
      for (Index i : { 0, 3, 40 })
      {
        Points single = Points::Zero(step.rows(), 3);
        single(i, i % 3) = .5;
        method.evaluate(at + single, plus, monitor);
        method.evaluate(at - single, minus, monitor);
        EXPECT_NEAR(adjoint(i, i % 3), gradient.cwiseProduct(plus - minus).sum(),
          1e-11 * gradient.squaredNorm())
          << name;
      }
    }
  }
}

TEST(WeightedResidual, ThreadsAndHistoryDoNotShow)
{
  Mesh mesh = meshes::hexes(15, 14, 14); // more nodes than one range of a loop has
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, bend);
  std::mt19937 random(meshes::seed());
  const Points gradient = mesh.points.unaryExpr(
    [&](double) { return std::uniform_real_distribution<double>(-1, 1)(random); });
  Points reference, referenceAdjoint;
  for (int threads : { 1, 2, 3, 5 })
  {
    meshes::ThreadedMonitor monitor(threads);
    WeightedResidual method;
    method.prepare(mesh, partition, monitor);
    Points result, adjoint;
    method.evaluate(targets(mesh, partition, affine), result, monitor);
    method.evaluate(target, result, monitor);
    method.applyTranspose(gradient, adjoint, monitor);
    if (threads == 1)
    {
      reference = result;
      referenceAdjoint = adjoint;
    }
    EXPECT_TRUE(sameBits(result, reference)) << threads;
    EXPECT_TRUE(sameBits(adjoint, referenceAdjoint)) << threads;
    EXPECT_TRUE(sameBits(result, morphed(mesh, partition, target, { 80, threads })));
  }
}

TEST(WeightedResidual, WeightsArePositiveAndSumToOne)
{
  const Mesh mesh = meshes::hexes(7, 6, 5);
  bool hasTies = false;
  Monitor monitor;
  WeightedResidual method;
  method.setNumberOfNeighbors(30);
  method.prepare(mesh, outerPartition(mesh), monitor);
  const WeightMatrix& weights = method.weights();
  ASSERT_EQ(weights.rows(), 6 * 5 * 4);
  for (Index row = 0; row < weights.rows(); ++row)
  {
    ASSERT_GE(weights.entries(row), 30);
    hasTies = hasTies || weights.entries(row) > 30;
    double sum = 0;
    for (Index e = 0; e < weights.entries(row); ++e)
    {
      EXPECT_GT(weights.weight(row)[e], 0);
      EXPECT_TRUE(e == 0 || weights.column(row)[e] > weights.column(row)[e - 1]);
      sum += weights.weight(row)[e];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
  }
  EXPECT_TRUE(hasTies);
}

TEST(WeightedResidual, FlatSetsOfPrescribedNodesKeepTheMapLinear)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const auto inPlane = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return { 1.5 * x[0] + .2 * x[1] + 1, .8 * x[1] - .3 * x[0], .4 * x[0] - .1 * x[1] + 2 };
  };
  std::vector<Index> plane, line;
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    if (mesh.points(n, 2) == 0)
    {
      plane.push_back(n);
      if (mesh.points(n, 1) == 0)
      {
        line.push_back(n);
      }
    }
  }
  // In a plane: nodes off it move as the place below them.
  NodePartition partition = partitionNodes(mesh, plane);
  Points result = morphed(mesh, partition, targets(mesh, partition, inPlane), { 10 });
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const Eigen::RowVector3d foot(mesh.points(n, 0), mesh.points(n, 1), 0);
    EXPECT_LT((result.row(n) - mesh.points.row(n) - (inPlane(foot) - foot)).norm(), 1e-12) << n;
  }
  // On a line, and at one place.
  partition = partitionNodes(mesh, line);
  result = morphed(mesh, partition, targets(mesh, partition, inPlane), { 10 });
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    const Eigen::RowVector3d foot(mesh.points(n, 0), 0, 0);
    EXPECT_LT((result.row(n) - mesh.points.row(n) - (inPlane(foot) - foot)).norm(), 1e-12) << n;
  }
  partition = partitionNodes(mesh, { 31 });
  result = morphed(mesh, partition, targets(mesh, partition, affine), { 10 });
  const Eigen::RowVector3d shift = affine(mesh.points.row(31)) - mesh.points.row(31);
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    EXPECT_LT((result.row(n) - mesh.points.row(n) - shift).norm(), 1e-13) << n;
  }
  // The adjoint there, too.
  for (const std::vector<Index>& ids : { plane, line, std::vector<Index>{ 31, 90 } })
  {
    partition = partitionNodes(mesh, ids);
    Monitor monitor;
    WeightedResidual method;
    method.prepare(mesh, partition, monitor);
    const Points step = targets(mesh, partition, bend), gradient = mesh.points;
    Points adjoint, moved;
    method.applyTranspose(gradient, adjoint, monitor);
    method.evaluate(step + meshes::rows(mesh.points, partition.prescribed), moved, monitor);
    const double value = gradient.cwiseProduct(moved - mesh.points).sum();
    EXPECT_NEAR(adjoint.cwiseProduct(step).sum(), value, 1e-12 * std::abs(value));
  }
}

TEST(WeightedResidual, NodesAtAPrescribedPlaceGoWithIt)
{
  Mesh mesh = meshes::hexes(4, 4, 4);
  const NodePartition partition = outerPartition(mesh);
  const Index center = 62, corner = 0, beside = 63, side = 64;
  mesh.points.row(center) = mesh.points.row(corner);
  mesh.points.row(beside) = mesh.points.row(side).array() + 1e-13;
  const Points target = targets(mesh, partition, bend);
  const Points result = morphed(mesh, partition, target);
  const auto displacement = [&](Index id) -> Eigen::RowVector3d
  { return result.row(id) - mesh.points.row(id); };
  EXPECT_LT((displacement(center) - displacement(corner)).norm(), 1e-14);
  EXPECT_LT((displacement(beside) - displacement(side)).norm(), 1e-12);
  EXPECT_TRUE(result.allFinite());

  // Very near is not at: the weights approach those of the place.
  mesh.points.row(beside) = mesh.points.row(side).array() + 1e-9;
  const Points near = morphed(mesh, partition, target);
  EXPECT_LT((near.row(beside) - near.row(side)).norm(), 1e-8);
}

TEST(WeightedResidual, CoincidentPrescribedNodesCountOnce)
{
  // Two boxes that touch without sharing nodes: the wall between them is there twice.
  Mesh mesh = meshes::hexes(3, 3, 3);
  const Mesh other = mesh;
  mesh.points.conservativeResize(128, 3);
  mesh.points.bottomRows(64) = other.points.rowwise() + Eigen::RowVector3d(3, 0, 0);
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(other.cell(c), other.cell(c) + 8);
    for (Index& n : nodes)
    {
      n += 64;
    }
    meshes::add(mesh, Hexahedron, nodes);
  }
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, bend);
  std::vector<Index> once;
  for (std::size_t i = 0; i < partition.prescribed.size(); ++i)
  {
    const Index id = partition.prescribed[i];
    if (id < 64 || mesh.points(id, 0) > 3)
    {
      once.push_back(static_cast<Index>(i));
    }
  }
  ASSERT_LT(once.size(), partition.prescribed.size());
  const Points rest = meshes::rows(meshes::rows(mesh.points, partition.prescribed), once);
  const Points moved = meshes::rows(target, once);
  const Points result = morphed(mesh, partition, target, { 1000 });
  for (Index id : partition.free)
  {
    EXPECT_LT((result.row(id) - byTheBook(rest, moved, mesh.points.row(id), 1000)).norm(), 1e-12);
  }
}

TEST(WeightedResidual, AFitThatTurnsTheMeshInsideOutIsToldOf)
{
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  WeightedResidual method;
  method.prepare(mesh, partition, monitor);
  Points result;
  method.evaluate(targets(mesh, partition, bend), result, monitor);
  method.evaluate(targets(mesh, partition,
                    [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d
                    {
                      return { -x[0], -x[1], x[2] }; // half a turn is none of it
                    }),
    result, monitor);
  EXPECT_TRUE(monitor.warnings.empty());
  const auto mirror = [](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return { x[0], -2 * x[1], x[2] };
  };
  method.evaluate(targets(mesh, partition, mirror), result, monitor);
  ASSERT_EQ(monitor.warnings.size(), 1u);
  EXPECT_NE(monitor.warnings[0].find("determinant -2"), std::string::npos) << monitor.warnings[0];
  Mesh expected = mesh;
  meshes::transform(expected, mirror);
  EXPECT_LT((result - expected.points).norm(), 1e-12); // and the map stays linear
}

TEST(WeightedResidual, AModeIsNoMotionToWarnOf)
{
  // One wall's share of a motion turns the fit inside out, which says nothing of the motion.
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  WeightedResidual method;
  method.prepare(mesh, partition, monitor);
  Points mode = meshes::rows(mesh.points, partition.prescribed);
  mode.leftCols<2>().setZero();
  mode *= -20;
  method.basis({ mode }, monitor);
  FourFields fields = FourFields::Zero(mode.rows(), 4);
  fields.leftCols<3>() = mode;
  method.fields(fields, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  Points moved;
  method.evaluate(meshes::rows(mesh.points, partition.prescribed) + mode, moved, monitor);
  EXPECT_EQ(monitor.warnings.size(), 1u);
}

TEST(WeightedResidual, RefusesWhatItCannotUse)
{
  WeightedResidual method;
  EXPECT_THROW(method.setNumberOfNeighbors(0), Error);
  EXPECT_THROW(method.setNumberOfNeighbors(-3), Error);
  EXPECT_EQ(method.numberOfNeighbors(), 80);

  const Mesh mesh = meshes::hexes(3, 3, 3);
  Monitor monitor;
  Points moved = Points::Constant(1, 3, 5);
  EXPECT_THROW(method.evaluate(mesh.points, moved, monitor), Error); // not prepared
  EXPECT_THROW(method.prepare(mesh, partitionNodes(mesh, {}), monitor), Error);
  const NodePartition partition = outerPartition(mesh);
  method.prepare(mesh, partition, monitor);
  Points target = targets(mesh, partition, bend);
  target(5, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(method.evaluate(target, moved, monitor), Error);
  EXPECT_EQ(moved, Points::Constant(1, 3, 5)); // untouched

  Mesh far = mesh;
  far.points(21, 0) = 1e160; // a free node
  EXPECT_THROW(method.prepare(far, partition, monitor), Error);
  EXPECT_THROW(method.evaluate(mesh.points, moved, monitor), Error); // not prepared any more
}

TEST(WeightedResidual, CancelStopsAndLeavesTheResultAlone)
{
  const Mesh mesh = meshes::hexes(8, 8, 8);
  const NodePartition partition = outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  WeightedResidual method;
  monitor.cancelAt = .1;
  try
  {
    method.prepare(mesh, partition, monitor);
    ADD_FAILURE() << "not cancelled";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.kind(), Error::Kind::Cancelled);
  }
  monitor.cancelAt = 2;
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(monitor.lastProgress, 1);
  monitor.cancelAt = 0;
  Points moved = Points::Constant(1, 3, 5);
  EXPECT_THROW(method.evaluate(targets(mesh, partition, bend), moved, monitor), Error);
  EXPECT_EQ(moved, Points::Constant(1, 3, 5));
}
