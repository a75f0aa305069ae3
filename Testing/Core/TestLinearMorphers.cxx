// SPDX-License-Identifier: BSD-3-Clause
// What every method with free = M prescribed has to do, for each of them.
#include "InThreads.h"
#include "LinearMethods.h"
#include "LinearMethods/WeightedResidual.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

using namespace morph;
using motions::affine;
using motions::difference;
using motions::identical;
using motions::jittered;
using motions::outerPartition;
using motions::targets;
using motions::twistOf;

namespace
{
class LinearMorphers : public testing::TestWithParam<meshes::LinearMethod>
{
protected:
  static Points morphed(
    const Mesh& mesh, const NodePartition& partition, const Points& target, int threads = 1)
  {
    meshes::ThreadedMonitor monitor(threads);
    const auto method = GetParam().make();
    Points result = motions::morphed(*method, mesh, partition, target, monitor);
    EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
    return result;
  }
};
}

// A caller with a large mesh shares it with the method.
TEST_P(LinearMorphers, SharedMeshesAreNotCopiedAndGiveTheSameBits)
{
  Mesh box = meshes::hexes(4, 4, 4);
  meshes::jitterInterior(box, 0.2, meshes::seed());
  const auto mesh = std::make_shared<const Mesh>(std::move(box));
  const auto partition = std::make_shared<const NodePartition>(outerPartition(*mesh));
  const Points target = targets(*mesh, *partition, twistOf(4));
  const auto method = GetParam().make();
  Monitor monitor;
  method->prepare(mesh, partition, monitor);
  EXPECT_EQ(method->restPoints().data(), mesh->points.data());
  EXPECT_EQ(&method->partition(), partition.get());
  const Points result = motions::moved(*method, target, monitor);
  EXPECT_TRUE(identical(result, morphed(*mesh, *partition, target)));
}

TEST_P(LinearMorphers, AffineMotionsComeOutExactly)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points result = morphed(mesh, partition, targets(mesh, partition, affine));
    EXPECT_LT(
      difference(result, motions::mapped(mesh.points, affine)), 1e-10 * meshes::size(mesh.points))
      << name;
  }
}

TEST_P(LinearMorphers, AffineMotionsComeOutExactlyInMirroredMeshes)
{
  for (auto [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    mesh.points.col(1) *= -1;
    const Points result = morphed(mesh, partition, targets(mesh, partition, affine));
    EXPECT_LT(
      difference(result, motions::mapped(mesh.points, affine)), 1e-10 * meshes::size(mesh.points))
      << name;
  }
}

TEST_P(LinearMorphers, NoMotionIsTheIdentityBitForBit)
{
  for (auto [name, mesh] : jittered())
  {
    mesh.points.array() -= 2; // signed zeros among the coordinates
    mesh.points.col(0) *= -1;
    mesh.points.col(1) *= -1;
    const NodePartition partition = outerPartition(mesh);
    const Points result = morphed(mesh, partition, meshes::rows(mesh.points, partition.prescribed));
    EXPECT_TRUE(identical(result, mesh.points)) << name;
  }
}

TEST_P(LinearMorphers, PrescribedNodesArriveExactly)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, twistOf(4));
    const Points result = morphed(mesh, partition, target);
    EXPECT_TRUE(identical(meshes::rows(result, partition.prescribed), target)) << name;
  }
}

TEST_P(LinearMorphers, RigidMotionAndScaleGoThrough)
{
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const motions::Map rigid = [&](const motions::Row& x)
  { return motions::Row(17.5 * x * R + motions::Row(40, -3, 8)); };
  auto list = motions::inGeneralPosition();
  if (GetParam().name != "RadialBasisFewCenters") // see SymmetriesOfTheMeshGoThrough
  {
    for (const auto& lattices : { meshes::all(4, 4, 4), jittered() })
    {
      list.insert(list.end(), lattices.begin(), lattices.end());
    }
  }
  for (const auto& [name, mesh] : list)
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, twistOf(4));
    const Points expected = motions::mapped(morphed(mesh, partition, target), rigid);
    Mesh turned = mesh;
    meshes::transform(turned, rigid);
    const Points result = morphed(turned, partition, motions::mapped(target, rigid));
    EXPECT_LT(difference(result, expected), 1e-10 * meshes::size(turned.points)) << name;
  }
}

TEST_P(LinearMorphers, SymmetriesOfTheMeshGoThrough)
{
  if (GetParam().name == "RadialBasisFewCenters")
  {
    GTEST_SKIP() << "Which of equally far sites become centers depends on their order.";
  }
  Mesh cube = meshes::hexes(6, 6, 6); // each place has many sites as far as the last neighbor
  cube.points.array() -= 3;
  const NodePartition partition = outerPartition(cube);
  const motions::Map bend = [](const motions::Row& x)
  {
    return motions::Row(
      x + motions::Row(.2 * std::sin(x[1]), .1 * x[0] * x[2], .2 * std::cos(x[0] + .3)));
  };
  const Points expected = morphed(cube, partition, targets(cube, partition, bend));
  for (const Eigen::Matrix3d& S : motions::symmetries())
  {
    const motions::Map turnedBend = [&](const motions::Row& x)
    { return motions::Row(bend(x * S.transpose()) * S); };
    const Points result = morphed(cube, partition, targets(cube, partition, turnedBend));
    EXPECT_LT(difference(meshes::rows(result, motions::images(cube.points, S)), expected * S), 6e-9)
      << S;
  }
}

TEST_P(LinearMorphers, UnitAndOriginGoThroughWhereNeighborsAreEquallyFar)
{
  const Mesh cube = meshes::hexes(6, 6, 6);
  const NodePartition partition = outerPartition(cube);
  const Points expected =
    morphed(cube, partition, targets(cube, partition, twistOf(6, .5))) - cube.points;
  for (const double unit : { 1e-9, 1e-3, .7, 1e6 })
  {
    Mesh scaled = cube;
    scaled.points *= unit;
    const Points moved =
      morphed(scaled, partition, unit * targets(cube, partition, twistOf(6, .5)));
    EXPECT_LT(difference((moved - scaled.points) / unit, expected), 6e-9) << unit;
  }
  Mesh shifted = cube;
  shifted.points = (cube.points / 7).array() + 6e6; // rounded: a tenth of a millionth is left
  const Points target =
    meshes::rows(shifted.points, partition.prescribed) +
    (targets(cube, partition, twistOf(6, .5)) - meshes::rows(cube.points, partition.prescribed)) /
      7;
  const Points moved = morphed(shifted, partition, target);
  EXPECT_LT(difference(7 * (moved - shifted.points), expected), 1e-6);
}

TEST_P(LinearMorphers, RenumberingGoesThrough)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points reference = morphed(mesh, partition, targets(mesh, partition, twistOf(4)));
    const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
    const Mesh shuffled = meshes::renumbered(mesh, order);
    const NodePartition renamed = outerPartition(shuffled);
    const Points result = morphed(shuffled, renamed, targets(shuffled, renamed, twistOf(4)));
    EXPECT_LT(difference(meshes::rows(result, order), reference), 1e-10 * meshes::size(mesh.points))
      << name;
  }
}

TEST_P(LinearMorphers, AdjointEqualsFiniteDifferences)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> value(-1, 1);
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    Monitor monitor;
    const auto method = GetParam().make();
    method->prepare(mesh, partition, monitor);
    Points gradient(mesh.numberOfNodes(), 3),
      step(static_cast<Index>(partition.prescribed.size()), 3);
    gradient = gradient.unaryExpr([&](double) { return value(random); });
    step = step.unaryExpr([&](double) { return value(random); });

    Points adjoint;
    method->applyTranspose(gradient, adjoint, monitor);
    ASSERT_EQ(adjoint.rows(), step.rows());

    // Objective: gradient . positions. The map is linear, so central differences are exact but for
    // rounding.
    const Points at = targets(mesh, partition, twistOf(4, .8));
    Points plus, minus;
    method->evaluate(at + 0.5 * step, plus, monitor);
    method->evaluate(at - 0.5 * step, minus, monitor);
    const double change = gradient.cwiseProduct(plus - minus).sum();
    EXPECT_NEAR(adjoint.cwiseProduct(step).sum(), change, 1e-9 * std::abs(change) + 1e-9) << name;

    // One coordinate by itself.
    Points single = Points::Zero(step.rows(), 3);
    single(3, 1) = 1e-3;
    method->evaluate(at + single, plus, monitor);
    method->evaluate(at - single, minus, monitor);
    EXPECT_NEAR(
      adjoint(3, 1), gradient.cwiseProduct(plus - minus).sum() / 2e-3, 1e-7 * gradient.norm())
      << name;
  }
}

TEST_P(LinearMorphers, ThreadsAndHistoryDoNotShow)
{
  Mesh mesh = meshes::hexes(15, 14, 14); // more free nodes than one block of any sum
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, twistOf(14, 1));
  Monitor serial;
  const auto method = GetParam().make();
  method->prepare(mesh, partition, serial);
  Points one, oneAdjoint;
  method->evaluate(targets(mesh, partition, affine), one, serial);
  method->evaluate(target, one, serial);
  method->applyTranspose(mesh.points, oneAdjoint, serial);
  for (int threads : { 2, 3, 5 })
  {
    meshes::ThreadedMonitor monitor(threads);
    const auto other = GetParam().make();
    other->prepare(mesh, partition, monitor);
    Points many, adjoint;
    other->evaluate(target, many, monitor);
    EXPECT_TRUE(identical(many, one)) << threads;
    other->applyTranspose(mesh.points, adjoint, monitor);
    EXPECT_TRUE(identical(adjoint, oneAdjoint)) << threads;
  }
}

TEST_P(LinearMorphers, SeveralThreadsMayEvaluateAtOnce)
{
  Mesh mesh = meshes::hexes(9, 8, 8);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  const auto method = GetParam().make();
  method->prepare(mesh, partition, monitor);
  constexpr int Threads = 4, Rounds = 3;
  Points expected[Threads], expectedAdjoint[Threads], target[Threads], gradient[Threads];
  for (int t = 0; t < Threads; ++t)
  {
    target[t] = targets(mesh, partition, twistOf(8, .3 * (t + 1)));
    gradient[t] = (t + 1) * mesh.points;
    method->evaluate(target[t], expected[t], monitor);
    method->applyTranspose(gradient[t], expectedAdjoint[t], monitor);
  }
  // As prepared before: what the first calls leave behind is not there yet.
  method->prepare(mesh, partition, monitor);
  std::atomic<int> different{ 0 };
  meshes::inThreads(Threads,
    [&](int t)
    {
      meshes::ThreadedMonitor own(2);
      for (int round = 0; round < Rounds; ++round)
      {
        Points moved, adjoint;
        method->evaluate(target[t], moved, own);
        method->applyTranspose(gradient[t], adjoint, own);
        different += !identical(moved, expected[t]) + !identical(adjoint, expectedAdjoint[t]);
      }
    });
  EXPECT_EQ(different, 0);
}

TEST_P(LinearMorphers, AnObjectCanBePreparedAgain)
{
  Monitor monitor;
  const auto method = GetParam().make();
  const Mesh first = meshes::tets(5, 4, 3), second = meshes::wedges(3, 4, 4);
  method->prepare(first, outerPartition(first), monitor);
  const NodePartition partition = outerPartition(second);
  const Points target = targets(second, partition, twistOf(4));
  Points result = motions::morphed(*method, second, partition, target, monitor);
  EXPECT_TRUE(identical(result, morphed(second, partition, target)));
}

TEST_P(LinearMorphers, PrescribedInnerNodesStayWhereTheyArePut)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  std::vector<Index> ids = outerPartition(mesh).prescribed;
  const Index center = 62;
  ids.push_back(center);
  const NodePartition partition = partitionNodes(mesh, ids);
  Points target = meshes::rows(mesh.points, partition.prescribed);
  const auto at = std::find(partition.prescribed.begin(), partition.prescribed.end(), center);
  target(at - partition.prescribed.begin(), 0) += .3;
  const Points result = morphed(mesh, partition, target);
  EXPECT_EQ(result(center, 0), mesh.points(center, 0) + .3);
  // Its neighbors follow: all of them together, for ties may leave one of them out.
  double sum = 0;
  for (Index step : { 1, 5, 25 })
  {
    sum += result(center + step, 0) + result(center - step, 0) - 2 * mesh.points(center, 0);
  }
  EXPECT_GT(sum, .006);
}

TEST_P(LinearMorphers, UnusedNodesAndLowerCellsStay)
{
  Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition before = outerPartition(mesh);
  mesh.points.conservativeResize(66, 3);
  mesh.points.bottomRows(2).setConstant(9);
  meshes::add(mesh, Line, { 64, 65 });
  const NodePartition partition = partitionNodes(mesh, before.prescribed);
  const Points result = morphed(mesh, partition, targets(mesh, partition, affine));
  EXPECT_EQ(result.bottomRows(2), mesh.points.bottomRows(2));
}

// No place in the parametric cell answers to such a node, yet it has to follow.
TEST_P(LinearMorphers, MidNodesFarOutsideTheirCellFollowAffineMotions)
{
  Mesh mesh = meshes::quadraticHexes(2, 2, 2, false);
  const NodePartition partition = outerPartition(mesh);
  ASSERT_FALSE(partition.higherOrderNodes.empty());
  for (Index node : partition.higherOrderNodes)
  {
    mesh.points.row(node) += motions::Row(1.7, -2.3, 1.1);
  }
  Points expected = motions::mapped(mesh.points, affine);
  EXPECT_LT(difference(morphed(mesh, partition, targets(mesh, partition, affine)), expected),
    1e-10 * meshes::size(mesh.points));
}

TEST_P(LinearMorphers, CurvedEdgesKeepTheirPlaceInTheCell)
{
  // A mid-side node off the chord of its edge moves with the linear cell around it, not with the
  // chord's ends alone.
  Mesh mesh = meshes::quadraticHexes(3, 3, 3, false);
  const NodePartition partition = outerPartition(mesh);
  ASSERT_FALSE(partition.higherOrderNodes.empty());
  const Index node = partition.higherOrderNodes[4];
  mesh.points.row(node) += motions::Row(.05, -.04, .06);
  const Points result = morphed(mesh, partition, targets(mesh, partition, affine));
  EXPECT_LT((result.row(node) - affine(mesh.points.row(node))).norm(), 1e-10);
}

TEST_P(LinearMorphers, WithoutAFreeNodeTheTargetsAreTheResult)
{
  for (const Mesh& mesh : { meshes::hexes(1, 1, 1), meshes::quadraticHexes(1, 1, 1, true) })
  {
    // The boundary's nodes; in the quadratic cell the body's node follows.
    NodePartition partition = outerPartition(mesh);
    ASSERT_TRUE(partition.free.empty());
    meshes::ThreadedMonitor monitor;
    const auto method = GetParam().make();
    Points moved = motions::morphed(
      *method, mesh, partition, motions::targets(mesh, partition, motions::affine), monitor);
    EXPECT_LT(
      motions::difference(moved, motions::mapped(mesh.points, motions::affine)), 1e-14 * 10);
    EXPECT_TRUE(motions::identical(meshes::rows(moved, partition.prescribed),
      motions::targets(mesh, partition, motions::affine)));
    if (partition.higherOrderNodes.empty())
    {
      Points gradient = Points::Random(mesh.numberOfNodes(), 3), prescribed;
      method->applyTranspose(gradient, prescribed, monitor);
      EXPECT_TRUE(motions::identical(prescribed, meshes::rows(gradient, partition.prescribed)));
    }
  }
}

TEST_P(LinearMorphers, RefuseWhatTheyCannotUse)
{
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  const auto method = GetParam().make();
  using motions::kindOf;

  motions::expectError(
    Error::Kind::Singular, [&] { method->prepare(mesh, partitionNodes(mesh, {}), monitor); },
    "No node is prescribed");

  method->prepare(mesh, partition, monitor);
  Points moved = Points::Constant(1, 3, 5);
  Points target = meshes::rows(mesh.points, partition.prescribed);
  motions::expectError(
    [&] { method->evaluate(target.topRows(4), moved, monitor); }, "4 rows where 56");
  target(7, 2) = std::numeric_limits<double>::infinity();
  motions::expectError([&] { method->evaluate(target, moved, monitor); },
    "node ids " + std::to_string(partition.prescribed[7]));
  motions::expectError([&] { method->applyTranspose(target, moved, monitor); }, "56 rows where 64");
  EXPECT_EQ(moved, Points::Constant(1, 3, 5)); // untouched
}

TEST_P(LinearMorphers, CancelStopsAndLeavesTheResultAlone)
{
  const Mesh mesh = meshes::hexes(8, 8, 8);
  const NodePartition partition = outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  const auto method = GetParam().make();
  std::string message;
  using motions::kindOf;
  monitor.cancelAt = 0.05;
  EXPECT_EQ(
    kindOf([&] { method->prepare(mesh, partition, monitor); }, message), Error::Kind::Cancelled);

  monitor.cancelAt = 2;
  method->prepare(mesh, partition, monitor);
  EXPECT_EQ(monitor.lastProgress, 1);
  const Points target = targets(mesh, partition, twistOf(8));
  monitor.cancelAt = 0; // at once
  Points moved = Points::Constant(1, 3, 5);
  EXPECT_EQ(
    kindOf([&] { method->evaluate(target, moved, monitor); }, message), Error::Kind::Cancelled);
  EXPECT_EQ(kindOf([&] { method->applyTranspose(mesh.points, moved, monitor); }, message),
    Error::Kind::Cancelled);
  EXPECT_EQ(moved, Points::Constant(1, 3, 5));
}

INSTANTIATE_TEST_SUITE_P(Methods, LinearMorphers, testing::ValuesIn(meshes::linearMethods()),
  [](const auto& info) { return info.param.name; });

template <Index Neighbors>
std::unique_ptr<LinearMorpher> weightedResidualOf()
{
  auto method = std::make_unique<WeightedResidual>();
  method->setNumberOfNeighbors(Neighbors);
  return method;
}
INSTANTIATE_TEST_SUITE_P(FewNeighbors, LinearMorphers,
  testing::Values(meshes::LinearMethod{ "WeightedResidual1", weightedResidualOf<1> },
    meshes::LinearMethod{ "WeightedResidual9", weightedResidualOf<9> }),
  [](const auto& info) { return info.param.name; });
