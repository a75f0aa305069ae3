// SPDX-License-Identifier: BSD-3-Clause
// Smoothing as a morph, on ranks against one process.
#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Morpher/SiteMethod.h"
#include "Motions.h"
#include "Pieces.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Untangling/Smoothing.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace
{
using namespace morph;
using morph::distributed::Ranks;

struct Result
{
  Points moved; ///< of the whole mesh
  morph::EvaluateReport report;
  std::vector<std::string> warnings;
};

/// `target`: where each node of the whole mesh goes that is prescribed.
Result serial(const Mesh& whole, const NodePartition& partition, const Points& target,
  const SmoothingOptions& options)
{
  meshes::ThreadedMonitor monitor;
  Smoothing method;
  method.setOptions(options);
  method.prepare(whole, partition, monitor);
  Result result;
  result.report =
    method.evaluate(meshes::rows(target, partition.prescribed), result.moved, monitor);
  result.warnings = monitor.warnings;
  return result;
}

Result onRanks(const Ranks& ranks, const Mesh& whole, const NodePartition& partition,
  const Points& target, const SmoothingOptions& options)
{
  meshes::ThreadedMonitor monitor;
  auto settings = std::make_unique<Smoothing>();
  settings->setOptions(options);
  const pieces::OnRanks mine(ranks, whole, partition.prescribed,
    morph::onProcesses(std::move(settings)), meshes::seed(), monitor);
  Points moved;
  Result result;
  result.report = mine.evaluate(target, moved, monitor);
  result.moved = pieces::gathered(mine.mesh, moved);
  result.warnings = monitor.warnings;
  for (const morph::Statistic& one : result.report.statistics)
  {
    EXPECT_EQ(ranks.minimum(one.value), ranks.maximum(one.value)) << one.name;
  }
  EXPECT_TRUE(motions::identical(
    meshes::rows(result.moved, partition.prescribed), meshes::rows(target, partition.prescribed)));
  return result;
}

morph::Quality qualityOf(const Mesh& mesh, const Points& points)
{
  morph::Monitor monitor;
  return morph::measureQuality(
    mesh, points, morph::cellSigns(mesh, morph::connectedComponents(mesh)), {}, monitor);
}

Index count(const Result& result, const std::string& name)
{
  for (const morph::Statistic& one : result.report.statistics)
  {
    if (one.name == name)
    {
      return one.value;
    }
  }
  ADD_FAILURE() << "no count " << name;
  return -1;
}

SmoothingOptions toTarget(SmoothingTarget target)
{
  SmoothingOptions options;
  options.target = target;
  return options;
}

/// The minimum on one process of the mesh with its nodes renumbered.
double renumberedMinimum(const Mesh& mesh, const Points& target, const SmoothingOptions& options)
{
  const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
  const Mesh other = meshes::renumbered(mesh, order);
  Points there(target.rows(), 3);
  there(order, morph::allColumns) = target;
  return qualityOf(other, serial(other, motions::outerPartition(other), there, options).moved)
    .minimum;
}

/// The part by which one minimum is below another.
double below(double mine, double expected)
{
  return (expected - mine) / std::abs(expected);
}

motions::Row gentle(const motions::Row& x)
{
  return motions::twist(x, 4, 4, .3);
}

/// Leaves inverted cells after the affine start.
motions::Row wavy(const motions::Row& x)
{
  return { x[0], x[1], x[2] + .7 * std::sin(M_PI / 2 * x[0]) };
}

Mesh twoBodies()
{
  const Mesh one = meshes::hexes(3, 3, 3);
  const Index nodes = one.numberOfNodes();
  Mesh two = one;
  two.points.conservativeResize(2 * nodes, 3);
  two.points.bottomRows(nodes) = one.points.rowwise() + motions::Row(10, 0, 0);
  for (Index c = 0; c < one.numberOfCells(); ++c)
  {
    std::vector<Index> corners(one.cell(c), one.cell(c) + 8);
    std::for_each(corners.begin(), corners.end(), [&](Index& node) { node += nodes; });
    meshes::add(two, morph::Hexahedron, corners);
  }
  return two;
}
}

TEST(RankSmoothing, IsAsGoodAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  double worst = 0, worstRenumbered = 0;
  for (const auto& [name, mesh] : motions::jittered())
  {
    for (const auto& [motion, map] :
      { std::pair<const char*, motions::Map>("gentle", gentle), { "wavy", wavy } })
    {
      for (const SmoothingObjective objective : { SmoothingObjective::MeanRatio,
             SmoothingObjective::ConditionNumber, SmoothingObjective::Adaptive })
      {
        for (const SmoothingTarget shape : { SmoothingTarget::Ideal, SmoothingTarget::Initial })
        {
          SCOPED_TRACE(name + ", " + motion + ", objective " +
                       std::to_string(static_cast<int>(objective)) + ", target " +
                       std::to_string(static_cast<int>(shape)));
          SmoothingOptions options = toTarget(shape);
          options.objective = objective;
          const NodePartition outer = motions::outerPartition(mesh);
          const Points target = motions::mapped(mesh.points, map);
          const Result expected = serial(mesh, outer, target, options);
          const Result mine = onRanks(ranks, mesh, outer, target, options);
          const morph::Quality there = qualityOf(mesh, expected.moved),
                               here = qualityOf(mesh, mine.moved);
          EXPECT_EQ(here.inverted + here.degenerate, there.inverted + there.degenerate);
          EXPECT_EQ(count(mine, "UntangleSteps") > 0, count(expected, "UntangleSteps") > 0);
          EXPECT_EQ(
            count(mine, "BoundaryDeterminedCells"), count(expected, "BoundaryDeterminedCells"));
          EXPECT_LT(below(here.minimum, there.minimum), 0.01);
          worst = std::max(worst, below(here.minimum, there.minimum));
          worstRenumbered = std::max(
            worstRenumbered, below(renumberedMinimum(mesh, target, options), there.minimum));
        }
      }
    }
  }
  if (ranks.rank() == 0)
  {
    std::cout << "minimum below that of one rank by at most " << 100 * worst
              << " %; of one rank with its nodes renumbered by " << 100 * worstRenumbered << " %\n";
  }
}

TEST(RankSmoothing, AffineMotionsComeOut)
{
  const Ranks ranks = pieces::world();
  for (const auto& [name, mesh] : motions::jittered())
  {
    for (const motions::Map& map :
      { motions::Map(motions::affine), motions::Map([](const motions::Row& x) { return x; }) })
    {
      const Points target = motions::mapped(mesh.points, map);
      const Result mine = onRanks(
        ranks, mesh, motions::outerPartition(mesh), target, toTarget(SmoothingTarget::Initial));
      EXPECT_LT(motions::difference(mine.moved, target), 1e-10 * meshes::size(target)) << name;
      EXPECT_TRUE(mine.warnings.empty()) << name;
    }
    const Result still = onRanks(
      ranks, mesh, motions::outerPartition(mesh), mesh.points, toTarget(SmoothingTarget::Initial));
    EXPECT_TRUE(motions::identical(still.moved, mesh.points)) << name;
  }
}

TEST(RankSmoothing, EveryBodyFollowsItsOwnBoundary)
{
  const Ranks ranks = pieces::world();
  const Mesh mesh = twoBodies();
  // One stays, the other turns round.
  const Points target = motions::mapped(mesh.points,
    [](const motions::Row& x) { return x[0] < 5 ? x : motions::Row(30 - x[0], 3 - x[1], x[2]); });
  const Result mine =
    onRanks(ranks, mesh, motions::outerPartition(mesh), target, toTarget(SmoothingTarget::Initial));
  EXPECT_LT(motions::difference(mine.moved, target), 1e-9);
}

TEST(RankSmoothing, ABodyHeldByAPlaneOrALineStartsAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  Mesh mesh = meshes::hexes(4, 4, 4);
  meshes::transform(
    mesh, [](const motions::Row& x) { return motions::Row(x + motions::Row(1e5, -1e5, 0)); });
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Points target = motions::mapped(
    mesh.points, [&](const motions::Row& x) -> motions::Row { return 2 * x * turn; });
  for (const int planes : { 1, 2 })
  {
    std::vector<Index> ids;
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      if (mesh.points(n, 1) == -1e5 && (planes < 2 || mesh.points(n, 0) == 1e5))
      {
        ids.push_back(n);
      }
    }
    const NodePartition partition = morph::partitionNodes(mesh, ids);
    const SmoothingOptions options = toTarget(SmoothingTarget::Initial);
    const Result expected = serial(mesh, partition, target, options),
                 mine = onRanks(ranks, mesh, partition, target, options);
    EXPECT_NEAR(qualityOf(mesh, mine.moved).minimum, 1, 1e-6) << planes;
    EXPECT_LT(motions::difference(mine.moved, expected.moved), 1e-8 * meshes::size(target))
      << planes;
  }
}

TEST(RankSmoothing, TakesNodesBackAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  Index taken = 0;
  for (const auto box : { meshes::hexes, meshes::tets })
  {
    // A boundary layer: smoothing for the mean alone takes its worst cells lower.
    Mesh mesh = meshes::layered(box, 4, 0.05, 1.6);
    meshes::jitterInterior(mesh, 0.01, meshes::seed());
    SmoothingOptions options;
    options.objective = SmoothingObjective::MeanRatio;
    const NodePartition outer = motions::outerPartition(mesh);
    const Result expected = serial(mesh, outer, mesh.points, options),
                 mine = onRanks(ranks, mesh, outer, mesh.points, options);
    EXPECT_EQ(count(mine, "NodesTakenBack"), count(expected, "NodesTakenBack"));
    EXPECT_GE(qualityOf(mesh, mine.moved).minimum, qualityOf(mesh, mesh.points).minimum - 1e-12);
    taken += count(mine, "NodesTakenBack");
  }
  EXPECT_GT(taken, 0);
}

TEST(RankSmoothing, WarnsAsOnOneRankAndOnlyThere)
{
  const Ranks ranks = pieces::world();
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const NodePartition outer = motions::outerPartition(mesh);
  Points target = mesh.points;
  target.row(0) = motions::Row(1.5, 1.5, 1.5); // the corner of the box through its cell
  const Result expected = serial(mesh, outer, target, {}),
               mine = onRanks(ranks, mesh, outer, target, {});
  ASSERT_FALSE(expected.warnings.empty());
  EXPECT_EQ(mine.warnings, ranks.rank() == 0 ? expected.warnings : std::vector<std::string>());
  EXPECT_EQ(count(mine, "BoundaryDeterminedCells"), 1);
}

TEST(RankSmoothing, ABodyWithoutAPrescribedNodeIsNamedOnAllRanks)
{
  const Ranks ranks = pieces::world();
  const Mesh mesh = twoBodies();
  NodePartition one = motions::outerPartition(mesh);
  one.prescribed.erase(
    std::lower_bound(one.prescribed.begin(), one.prescribed.end(), mesh.numberOfNodes() / 2),
    one.prescribed.end());
  const std::string message = pieces::messageOf(
    [&] { onRanks(ranks, mesh, morph::partitionNodes(mesh, one.prescribed), mesh.points, {}); });
  EXPECT_NE(message.find("no prescribed node"), std::string::npos) << message;
}

TEST(RankSmoothing, ACancelledRankEndsAll)
{
  const Ranks ranks = pieces::world();
  const Mesh whole = meshes::hexes(4, 4, 4);
  meshes::ThreadedMonitor monitor;
  const pieces::OnRanks mine(ranks, whole, motions::outerPartition(whole).prescribed,
    morph::onProcesses(std::make_unique<Smoothing>()), meshes::seed(), monitor);
  for (const double at : { 0.1, 0.45, 0.7 })
  {
    mine.expectCancelled(motions::mapped(whole.points, wavy), at);
  }
}
