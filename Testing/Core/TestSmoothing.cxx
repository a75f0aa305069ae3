// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShapes.h"
#include "Differences.h"
#include "Meshes.h"
#include "Motions.h"
#include "RandomMeshes.h"

#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "Energies/UntangleEnergy.h"
#include "Mesh/Topology.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Untangling/SmoothMesh.h"
#include "Untangling/Smoothing.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace meshes;
using namespace motions;
using namespace morph;

namespace
{
std::vector<std::int8_t> orientationOf(const Mesh& mesh)
{
  return cellSigns(mesh, connectedComponents(mesh));
}

/// By the corners, which are what is smoothed.
Quality qualityOf(const Mesh& mesh, const Points& points)
{
  Monitor monitor;
  return measureCorners(mesh, points, orientationOf(mesh), {}, monitor);
}

SmoothingReport smooth(
  const Mesh& mesh, Points& points, const SmoothingOptions& options = {}, int threads = 1)
{
  ThreadedMonitor monitor(threads);
  return smoothMesh(mesh, orientationOf(mesh), outerPartition(mesh), options, points, monitor);
}

Points morphed(
  const Mesh& mesh, const Points& target, const SmoothingOptions& options = {}, int threads = 1)
{
  ThreadedMonitor monitor(threads);
  Smoothing method;
  method.setOptions(options);
  Points result = motions::morphed(method, mesh, outerPartition(mesh), target, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  return result;
}

SmoothingOptions toTarget(SmoothingTarget target)
{
  SmoothingOptions options;
  options.target = target;
  return options;
}

constexpr SmoothingObjective Objectives[] = { SmoothingObjective::MeanRatio,
  SmoothingObjective::ConditionNumber, SmoothingObjective::Adaptive };

SmoothingOptions with(SmoothingObjective objective, SmoothingTarget target = SmoothingTarget::Ideal)
{
  SmoothingOptions options = toTarget(target);
  options.objective = objective;
  return options;
}

/// The mean condition number.
double conditionOf(const Mesh& mesh, const Points& points, SmoothingTarget target)
{
  Monitor monitor;
  MeshEnergy energy(mesh, outerPartition(mesh).free);
  energy.setTargets(smoothingTargets(mesh, orientationOf(mesh), target, monitor));
  energy.setDensity(ConditionDensity());
  return energy.evaluate(points, monitor).energy;
}

/// The free nodes moved by up to `amount`.
Points scrambled(const Mesh& mesh, double amount)
{
  std::mt19937 random(seed());
  std::uniform_real_distribution<double> jitter(-amount, amount);
  Points points = mesh.points;
  for (Index node : outerPartition(mesh).free)
  {
    points.row(node) += Row(jitter(random), jitter(random), jitter(random));
  }
  return points;
}

/// The mean inverse mean ratio.
double measure(const Mesh& mesh, const Points& points, SmoothingTarget target)
{
  Monitor monitor;
  MeshEnergy energy(mesh, outerPartition(mesh).free);
  energy.setTargets(smoothingTargets(mesh, orientationOf(mesh), target, monitor));
  return energy.evaluate(points, monitor).energy;
}

Row gentle(const Row& x)
{
  return twist(x, 4, 4, .3);
}

}

TEST(UntangleEnergy, GradientIsTheSlope)
{
  for (const auto& [name, mesh] : jittered())
  {
    for (const SmoothingTarget target : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
    {
      Monitor monitor;
      const std::vector<Index> free = outerPartition(mesh).free;
      const UntangleEnergy energy(
        mesh, free, smoothingTargets(mesh, orientationOf(mesh), target, monitor), .3);
      const Points gradient = differences::expectGradient(energy, scrambled(mesh, .8), 5e-8);
      ASSERT_GT(gradient.cwiseAbs().maxCoeff(), 1e-6) << name;
    }
  }
}

TEST(UntangleEnergy, IsKnuppsMeasureAndZeroWhereNothingIsTangled)
{
  Monitor monitor;
  const Mesh mesh = hexes(4, 4, 4);
  const std::vector<Index> free = outerPartition(mesh).free;
  const TargetMatrices targets =
    smoothingTargets(mesh, orientationOf(mesh), SmoothingTarget::Ideal, monitor);
  EXPECT_EQ(UntangleEnergy(mesh, free, targets, .9).value(mesh.points, monitor).energy, 0);
  // Every corner of the unit cubes lacks a tenth.
  EXPECT_NEAR(
    UntangleEnergy(mesh, free, targets, 1.1).value(mesh.points, monitor).energy, .04, 1e-12);
}

TEST(SmoothMesh, RecoversTheLattice)
{
  const Mesh mesh = hexes(5, 5, 5);
  Points points = scrambled(mesh, .25);
  const SmoothingReport report = smooth(mesh, points);
  EXPECT_TRUE(report.isValid);
  EXPECT_EQ(report.untangleSteps, 0);
  EXPECT_LT(difference(points, mesh.points), 1e-3);
}

TEST(SmoothMesh, ValidStaysValidAndGetsBetter)
{
  for (const auto& [name, mesh] : jittered())
  {
    for (const SmoothingTarget target : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
    {
      Points points = scrambled(mesh, .05);
      const Points start = points;
      ASSERT_GT(qualityOf(mesh, start).minimum, 0) << name;
      const SmoothingReport report = smooth(mesh, points, toTarget(target));
      EXPECT_TRUE(report.isValid) << name;
      EXPECT_EQ(qualityOf(mesh, points).inverted, 0) << name;
      EXPECT_LT(measure(mesh, points, target), measure(mesh, start, target)) << name;
      for (Index node : outerPartition(mesh).prescribed)
      {
        EXPECT_EQ(points.row(node), start.row(node)) << name;
      }
    }
  }
}

TEST(SmoothMesh, Untangles)
{
  for (const auto& [name, mesh] : jittered())
  {
    Points points = scrambled(mesh, .6);
    ASSERT_GT(qualityOf(mesh, points).inverted, 0) << name;
    const SmoothingReport report = smooth(mesh, points);
    EXPECT_TRUE(report.isValid) << name;
    EXPECT_GT(report.untangleSteps, 0) << name;
    EXPECT_EQ(qualityOf(mesh, points).inverted, 0) << name;
  }
}

TEST(SmoothMesh, WorksFirstRoundFewBadCells)
{
  const Mesh mesh = hexes(40, 5, 5);
  Points points = mesh.points;
  const Index node = 20 + 41 * (2 + 6 * 2);
  points.row(node) += Row(.46, .46, 0);
  ASSERT_GT(qualityOf(mesh, points).minimum, 0);
  ASSERT_LT(qualityOf(mesh, points).minimum, .2);
  const SmoothingReport report = smooth(mesh, points);
  EXPECT_EQ(report.patches, 1);
  EXPECT_LT(report.newtonSteps, 10);
  EXPECT_LT(difference(points, mesh.points), 1e-3);
}

TEST(SmoothMesh, EachObjectiveLowersItsOwnMeasure)
{
  for (const auto& [name, mesh] : jittered())
  {
    for (const SmoothingTarget target : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
    {
      const Points start = scrambled(mesh, .05);
      ASSERT_GT(qualityOf(mesh, start).minimum, 0) << name;
      Points ofRatio = start, ofCondition = start;
      const SmoothingReport ratio =
        smooth(mesh, ofRatio, with(SmoothingObjective::MeanRatio, target));
      const SmoothingReport condition =
        smooth(mesh, ofCondition, with(SmoothingObjective::ConditionNumber, target));
      EXPECT_EQ(ratio.conditionSteps, 0) << name;
      EXPECT_EQ(condition.conditionSteps, condition.newtonSteps) << name;
      EXPECT_GT(condition.newtonSteps, 0) << name;
      EXPECT_EQ(qualityOf(mesh, ofCondition).inverted, 0) << name;
      // Each is the better one by its own measure, up to the tolerance of the iteration.
      EXPECT_LE(
        conditionOf(mesh, ofCondition, target), conditionOf(mesh, ofRatio, target) * (1 + 1e-5))
        << name;
      EXPECT_LE(measure(mesh, ofRatio, target), measure(mesh, ofCondition, target) * (1 + 1e-5))
        << name;
    }
  }
}

TEST(SmoothMesh, TheConditionNumberEndsWhereItsSlopeIsZero)
{
  const Mesh mesh = hexesAndPyramids(4, 4, 4);
  const NodePartition partition = outerPartition(mesh);
  Points points = scrambled(mesh, .2);
  SmoothingOptions options = with(SmoothingObjective::ConditionNumber);
  options.stopMove = 1e-12;
  options.iterationLimit = 200;
  MeshEnergy energy(mesh, partition.free);
  Monitor monitor;
  energy.setTargets(smoothingTargets(mesh, orientationOf(mesh), options.target, monitor));
  energy.setDensity(ConditionDensity());
  Points before, after;
  ASSERT_TRUE(smooth(mesh, points, options).isValid);
  energy.gradient(points, after, monitor);
  energy.gradient(scrambled(mesh, .05), before, monitor);
  EXPECT_LT(after.norm(), 1e-2 * before.norm());
}

TEST(SmoothMesh, AdaptiveIsNeverBelowTheMeanRatio)
{
  // Boxes squeezed so that cells near a corner are bad whatever the interior does.
  Index steps = 0, better = 0;
  for (const auto& [name, mesh] : jittered())
  {
    Mesh squeezed = mesh;
    transform(
      squeezed, [](const Row& x) { return Row(x[0] + .35 * x[1] * x[2], x[1] + .8 * x[2], x[2]); });
    if (!(qualityOf(squeezed, squeezed.points).minimum > 0))
    {
      continue;
    }
    for (const SmoothingTarget target : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
    {
      Points ofRatio = squeezed.points, adaptive = squeezed.points;
      smooth(squeezed, ofRatio, with(SmoothingObjective::MeanRatio, target));
      const SmoothingReport report =
        smooth(squeezed, adaptive, with(SmoothingObjective::Adaptive, target));
      const double least = qualityOf(squeezed, ofRatio).minimum;
      EXPECT_GE(qualityOf(squeezed, adaptive).minimum, least) << name;
      EXPECT_EQ(report.conditionSteps > 0, least < .2) << name;
      EXPECT_EQ(qualityOf(squeezed, adaptive).inverted, 0) << name;
      steps += report.conditionSteps;
      better += qualityOf(squeezed, adaptive).minimum > least * (1 + 1e-6) ? 1 : 0;
    }
  }
  EXPECT_GT(steps, 0);
  EXPECT_GT(better, 0);
}

TEST(SmoothMesh, NeverWorseGoesBack)
{
  // A boundary layer: cubes are not what its cells should become, and the mean may improve at the
  // cost of the worst.
  Mesh mesh = hexes(4, 4, 4);
  transform(mesh, [](const Row& x) { return Row(x[0], x[1], .01 * x[2] * x[2] * x[2]); });
  SmoothingOptions options;
  options.neverWorse = true;
  Points points = mesh.points;
  const SmoothingReport report = smooth(mesh, points, options);
  EXPECT_GE(qualityOf(mesh, points).minimum, qualityOf(mesh, mesh.points).minimum);
  EXPECT_TRUE(report.wasKept);
  EXPECT_TRUE(identical(points, mesh.points));

  options.neverWorse = false;
  EXPECT_FALSE(smooth(mesh, points, options).wasKept);
  EXPECT_GT(difference(points, mesh.points), 1e-3);
}

TEST(SmoothMesh, WhatStaysTangledIsNoWorseThanItsStart)
{
  // Nodes of the boundary are thrown about, so that no mesh inside can be valid.
  const Mesh mesh = hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  std::mt19937 random(seed());
  int kept = 0;
  for (int i = 0; i < 100; ++i)
  {
    Points start = mesh.points + meshes::noise(mesh.points.rows(), .8, random);
    start(partition.free, allColumns) = mesh.points(partition.free, allColumns);
    Points points = start;
    const SmoothingReport report = smooth(mesh, points);
    const Quality before = qualityOf(mesh, start), after = qualityOf(mesh, points);
    EXPECT_LE(after.inverted, before.inverted);
    EXPECT_TRUE(after.inverted < before.inverted || after.minimum >= before.minimum);
    kept += report.wasKept;
  }
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, 100);
}

TEST(SmoothMesh, OptionsEndItEarly)
{
  const Mesh mesh = tets(4, 4, 4);
  const Points start = scrambled(mesh, .2);
  SmoothingOptions options;
  options.iterationLimit = 1;
  Points one = start, all = start;
  EXPECT_EQ(smooth(mesh, one, options).newtonSteps, 1);
  options.iterationLimit = 50;
  options.stopMove = 10;
  Points coarse = start;
  EXPECT_EQ(smooth(mesh, coarse, options).newtonSteps, 1);
  EXPECT_TRUE(identical(coarse, one));
  EXPECT_GT(smooth(mesh, all).newtonSteps, 1);
}

TEST(SmoothMesh, AnUnmovableMeshAndCancel)
{
  const Mesh mesh = hexes(4, 4, 4);
  ThreadedMonitor monitor;
  Points points = mesh.points;
  smoothMesh(mesh, orientationOf(mesh), NodePartition(), {}, points, monitor);
  EXPECT_TRUE(identical(points, mesh.points));

  monitor.cancelAt = -1;
  points = scrambled(mesh, .2);
  const Points start = points;
  EXPECT_THROW(
    smoothMesh(mesh, orientationOf(mesh), outerPartition(mesh), {}, points, monitor), Error);
  EXPECT_TRUE(identical(points, start));
}

TEST(Smoothing, PrescribedNodesAreExactAndGentleMotionsStayValid)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points target = targets(mesh, partition, gentle);
    for (const SmoothingTarget shape : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
    {
      const Points result = morphed(mesh, target, toTarget(shape));
      EXPECT_TRUE(identical(rows(result, partition.prescribed), target)) << name;
      EXPECT_EQ(qualityOf(mesh, result).inverted, 0) << name;
    }
  }
}

TEST(Smoothing, NoMotionIsTheIdentityForTheInitialShapesOnly)
{
  for (const auto& [name, mesh] : jittered())
  {
    const Points target = rows(mesh.points, outerPartition(mesh).prescribed);
    EXPECT_TRUE(identical(morphed(mesh, target, toTarget(SmoothingTarget::Initial)), mesh.points))
      << name;
    EXPECT_GT(difference(morphed(mesh, target), mesh.points), 1e-3) << name;
  }
}

TEST(Smoothing, AffineMotionsComeOutForTheInitialShapes)
{
  for (const auto& [name, mesh] : jittered())
  {
    const auto map = [](const Row& x) -> Row { return x + .4 * (affine(x) - x); };
    for (const SmoothingObjective objective : Objectives)
    {
      const Points result = morphed(
        mesh, targets(mesh, outerPartition(mesh), map), with(objective, SmoothingTarget::Initial));
      EXPECT_LT(difference(result, mapped(mesh.points, map)), 1e-3 * size(mesh.points)) << name;
    }
  }
}

TEST(Smoothing, RigidMotionsKeepTheMinimum)
{
  for (const auto& [name, mesh] : jittered())
  {
    const double minimum = qualityOf(mesh, mesh.points).minimum;
    ASSERT_GT(minimum, 0) << name;
    for (const double degrees : { 0., 5., 30., 180. })
    {
      const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d(1, 2, -1).normalized())
          .toRotationMatrix();
      const auto move = [&](const Row& x) -> Row { return x * turn + Row(4, 0, 1) * degrees; };
      const Points target = targets(mesh, outerPartition(mesh), move);
      for (const SmoothingTarget shape : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
      {
        const Points result = morphed(mesh, target, toTarget(shape));
        EXPECT_GE(qualityOf(mesh, result).minimum, minimum - 1e-12) << name << ' ' << degrees;
        if (shape == SmoothingTarget::Initial)
        {
          EXPECT_LT(difference(result, mapped(mesh.points, move)), 1e-9 * (1 + degrees)) << name;
        }
      }
    }
  }
}

TEST(Smoothing, ABodyHeldByAPlaneOrALineTurnsWithIt)
{
  const Mesh mesh = hexes(4, 4, 4);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto move = [&](const Row& x) -> Row { return 2 * x * turn; };
  const auto held = [&](int planes)
  {
    std::vector<Index> ids;
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      if (mesh.points(n, 1) == 0 && (planes < 2 || mesh.points(n, 0) == 0))
      {
        ids.push_back(n);
      }
    }
    return partitionNodes(mesh, ids);
  };
  for (const int planes : { 1, 2 })
  {
    const NodePartition partition = held(planes);
    Smoothing method;
    method.setOptions(toTarget(SmoothingTarget::Initial));
    ThreadedMonitor monitor;
    Points result =
      motions::morphed(method, mesh, partition, targets(mesh, partition, move), monitor);
    EXPECT_TRUE(monitor.warnings.empty());
    EXPECT_NEAR(qualityOf(mesh, result).minimum, 1, 1e-9) << planes;
    EXPECT_LT(
      difference(rows(result, partition.prescribed), targets(mesh, partition, move)), 1e-12);
  }
}

TEST(Smoothing, EveryBodyFollowsItsOwnBoundary)
{
  const Mesh mesh = hexes(3, 3, 3), two = shapes::together(mesh, shifted(mesh, Row(10, 0, 0)));
  // One stays, the other turns round.
  const auto move = [](const Row& x) -> Row
  { return x[0] < 5 ? x : Row(30 - x[0], 3 - x[1], x[2]); };
  const Points result =
    morphed(two, targets(two, outerPartition(two), move), toTarget(SmoothingTarget::Initial));
  EXPECT_LT(difference(result, mapped(two.points, move)), 1e-9);
}

TEST(Smoothing, ABoundaryAtRestNeverLosesTheMinimum)
{
  // A boundary layer: smoothing for the mean alone takes its worst cells lower.
  int taken = 0;
  for (const auto& [name, mesh] : all(4, 4, 4))
  {
    Mesh layer = mesh;
    transform(layer, [](const Row& x) { return Row(x[0], x[1], .01 * x[2] * x[2] * x[2]); });
    // Quadratic cells by all of their nodes: some are inverted inside, and have nothing to keep.
    ThreadedMonitor monitor;
    const auto minimumOf = [&, &layer = layer](const Points& points)
    { return measureQuality(layer, points, orientationOf(layer), {}, monitor).minimum; };
    const double minimum = minimumOf(layer.points);
    if (!(minimum > 0))
    {
      continue;
    }
    const NodePartition partition = outerPartition(layer);
    Smoothing method;
    method.prepare(layer, partition, monitor);
    Points result;
    const EvaluateReport report =
      method.evaluate(rows(layer.points, partition.prescribed), result, monitor);
    EXPECT_GE(minimumOf(result), minimum) << name;
    EXPECT_EQ(report.statistics[5].name, "NodesTakenBack");
    taken += report.statistics[5].value > 0 ? 1 : 0;
  }
  EXPECT_GT(taken, 0);
}

TEST(Smoothing, PositionRotationAndScaleDoNotShow)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(.8, Eigen::Vector3d(1, -2, 1).normalized()).toRotationMatrix();
  double scale = 1e-7;
  for (const auto& [name, mesh] : jittered())
  {
    const auto move = [&](const Row& x) -> Row { return scale * (x * turn + Row(3, -1, 2)); };
    const Points target = targets(mesh, outerPartition(mesh), gentle);
    Mesh other = mesh;
    other.points = mapped(mesh.points, move);
    for (const SmoothingObjective objective : Objectives)
    {
      const Points expected = mapped(morphed(mesh, target, with(objective)), move);
      // The edges have length 1, and the iteration ends at moves of 1e-3.
      const Points found = morphed(other, mapped(target, move), with(objective));
      EXPECT_LT(difference(found, expected) / scale, 1e-3) << name;
    }
    scale *= 100;
  }
}

TEST(Smoothing, NumberingDoesNotShow)
{
  for (const auto& [name, mesh] : jittered())
  {
    const std::vector<Index> order = shuffledNumbers(mesh.numberOfNodes());
    const Mesh other = renumbered(mesh, order);
    const Points a = morphed(mesh, targets(mesh, outerPartition(mesh), gentle));
    const Points b = morphed(other, targets(other, outerPartition(other), gentle));
    Points back(a.rows(), 3);
    for (Index n = 0; n < a.rows(); ++n)
    {
      back.row(n) = b.row(order[n]);
    }
    EXPECT_LT(difference(a, back), 1e-4) << name;
  }
}

TEST(Smoothing, ThreadsAndEarlierCallsDoNotShow)
{
  const Mesh mesh = hexesAndPyramids(4, 4, 4);
  const NodePartition partition = outerPartition(mesh);
  const Points target = targets(mesh, partition, [](const Row& x) { return twist(x, 4, 4, .6); });
  ThreadedMonitor one(1), three(3);
  for (const SmoothingObjective objective : Objectives)
  {
    Smoothing method;
    method.setOptions(with(objective));
    method.prepare(mesh, partition, three);
    Points a, b, c;
    method.evaluate(target, a, one);
    method.evaluate(rows(mesh.points, partition.prescribed), b, one);
    method.evaluate(target, c, three);
    EXPECT_TRUE(identical(a, c));
  }
}

TEST(Smoothing, ABoundaryThatInvertsCellsIsNamed)
{
  const Mesh mesh = hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  Points target = rows(mesh.points, partition.prescribed);
  // The corner of the box through its cell: its seven other nodes are on the outside too, but for
  // one.
  target.row(0) = Row(1.5, 1.5, 1.5);
  ThreadedMonitor monitor;
  Smoothing method;
  method.prepare(mesh, partition, monitor);
  Points result;
  const EvaluateReport report = method.evaluate(target, result, monitor);
  ASSERT_FALSE(monitor.warnings.empty());
  EXPECT_NE(monitor.warnings.front().find("cell ids 0."), std::string::npos)
    << monitor.warnings.front();
  EXPECT_EQ(report.statistics.back().name, "BoundaryDeterminedCells");
  EXPECT_EQ(report.statistics.back().value, 1);

  // A cell that was inverted before is none of these.
  Mesh pushed = mesh;
  pushed.points.row(0) = target.row(0);
  method.prepare(pushed, partition, monitor);
  target.rowwise() += Row(0, 0, .1);
  EXPECT_EQ(method.evaluate(target, result, monitor).statistics.back().value, 0);
}

TEST(Smoothing, WhatCannotBeUntangledComesWithAWarning)
{
  // The two ends of a box pushed through each other: no interior can be valid.
  const Mesh mesh = hexes(3, 3, 3);
  const NodePartition partition = outerPartition(mesh);
  const Points target =
    targets(mesh, partition, [](const Row& x) { return Row(-x[0], x[1], x[2]); });
  ThreadedMonitor monitor;
  Smoothing method;
  Points result = motions::morphed(method, mesh, partition, target, monitor);
  ASSERT_FALSE(monitor.warnings.empty());
  EXPECT_NE(monitor.warnings.back().find("could not untangle"), std::string::npos);
  EXPECT_TRUE(identical(rows(result, partition.prescribed), target));
  EXPECT_TRUE(result.allFinite());
}

TEST(Smoothing, ABodyWithoutAPrescribedNodeIsNamed)
{
  const Mesh mesh = hexes(3, 3, 3), two = shapes::together(mesh, shifted(mesh, Row(10, 0, 0)));
  const NodePartition first = partitionNodes(two, outerPartition(mesh).prescribed);
  Monitor monitor;
  Smoothing method;
  motions::expectError(
    Error::Kind::Singular, [&] { method.prepare(two, first, monitor); }, "no prescribed node");
}
