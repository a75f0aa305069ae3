// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/Classification.h"
#include "Boundary/FaceQuality.h"
#include "LinearMethods/SimplexLinear.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/BoundaryDetermined.h"
#include "Quality/MovableQuality.h"
#include "Quality/ScaledJacobian.h"
#include "Session/IncrementalMorph.h"
#include "Untangling/InversionFree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace
{
using namespace morph;

struct Morphed
{
  Points moved;
  morph::EvaluateReport report;
  double minimum;
  Index inverted;
  std::vector<std::string> warnings;
};

Morphed run(InversionFree& method, const Mesh& mesh, const Points& target, int threads = 1)
{
  meshes::ThreadedMonitor monitor(threads);
  Morphed result;
  method.prepare(mesh, motions::outerPartition(mesh), monitor);
  result.report = method.evaluate(target, result.moved, monitor);
  // What the method promises: nodes between corners follow, whatever becomes of the curved cells.
  const morph::Quality quality = morph::measureCorners(
    mesh, result.moved, morph::cellSigns(mesh, morph::connectedComponents(mesh)), {}, monitor);
  result.minimum = quality.minimum;
  result.inverted = quality.inverted;
  result.warnings = monitor.warnings;
  return result;
}

/// Steep waves along a box of length 4.
motions::Row waves(const motions::Row& x)
{
  return { x[0], x[1], x[2] + 1.6 * std::sin(M_PI / 2 * x[0]) };
}

Points target(const Mesh& mesh, const motions::Map& map)
{
  return motions::targets(mesh, motions::outerPartition(mesh), map);
}
}

TEST(InversionFree, NoMotionIsTheIdentity)
{
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    InversionFree method;
    const Morphed result = run(method, mesh, target(mesh, [](const motions::Row& x) { return x; }));
    EXPECT_TRUE(motions::identical(result.moved, mesh.points));
  }
}

TEST(InversionFree, EveryKindOfMeshComesOutValidWhereFemWarpDoesNot)
{
  int helped = 0;
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    meshes::ThreadedMonitor monitor;
    morph::FemWarp femWarp;
    Points warped;
    const Points boundary = target(mesh, waves);
    femWarp.prepare(mesh, motions::outerPartition(mesh), monitor);
    femWarp.evaluate(boundary, warped, monitor);
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    helped += morph::invertedCells(mesh, warped, orientation, monitor).empty() ? 0 : 1;
    ASSERT_TRUE(
      morph::boundaryDeterminedInversions(mesh, femWarp.partition(), orientation, warped).empty());
    InversionFree method;
    const Morphed result = run(method, mesh, boundary);
    EXPECT_EQ(result.inverted, 0) << result.minimum;
    EXPECT_EQ(motions::count(result.report, "Untangled"), 1);
    EXPECT_TRUE(
      motions::identical(meshes::rows(result.moved, method.partition().prescribed), boundary));
  }
  EXPECT_GT(helped, 4);
}

TEST(InversionFree, MinimumIsNotBelowFemWarpsAndSimplexLinears)
{
  std::vector<std::tuple<std::string, Mesh, motions::Map>> cases;
  for (const auto& [name, mesh] : motions::jittered())
  {
    cases.emplace_back(
      name, mesh, [](const motions::Row& x) { return motions::twist(x, 4, 4, 0.5); });
  }
  for (const double angle : { 15., 60., 90., 120. })
  {
    // The linear methods' meshes are hard to beat here: every layer is sheared alike.
    cases.emplace_back("sheared by " + std::to_string(angle), meshes::hexes(8, 3, 3),
      [angle](const motions::Row& x) -> motions::Row {
        return { x[0], x[1], x[2] + 3 * std::sin(angle * M_PI / 180 * x[0] / 8) };
      });
  }
  int better = 0;
  for (const auto& [name, mesh, map] : cases)
  {
    SCOPED_TRACE(name);
    const Points boundary = target(mesh, map);
    meshes::ThreadedMonitor monitor;
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    const auto minimumOf = [&, &mesh = mesh](morph::Morpher& linear)
    {
      Points moved;
      linear.prepare(mesh, motions::outerPartition(mesh), monitor);
      linear.evaluate(boundary, moved, monitor);
      return morph::measureCorners(mesh, moved, orientation, {}, monitor).minimum;
    };
    morph::FemWarp femWarp;
    morph::SimplexLinear simplexLinear;
    const double known = std::max(minimumOf(femWarp), minimumOf(simplexLinear));
    ASSERT_GT(known, 0);
    InversionFree method;
    const Morphed result = run(method, mesh, boundary);
    EXPECT_GE(result.minimum, known);
    better += result.minimum > 1.01 * known ? 1 : 0;
  }
  EXPECT_GE(better, 4);
}

TEST(InversionFree, MoreEffortRaisesTheMinimumOfValidTetrahedra)
{
  Mesh mesh = meshes::tets(6, 6, 6);
  meshes::jitterInterior(mesh, 0.1, meshes::seed());
  const Points boundary =
    target(mesh, [](const motions::Row& x) { return motions::twist(x, 6, 6, 1.2); });
  const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
  meshes::ThreadedMonitor monitor;
  morph::FemWarp femWarp;
  Points warped;
  femWarp.prepare(mesh, motions::outerPartition(mesh), monitor);
  femWarp.evaluate(boundary, warped, monitor);
  const double known = morph::measureCorners(mesh, warped, orientation, {}, monitor).minimum;
  ASSERT_GT(known, 0);
  ASSERT_LT(
    known, 0.75 * morph::measureCorners(mesh, mesh.points, orientation, {}, monitor).minimum);
  double least = known;
  for (const int steps : { morph::InversionFree::NoSteps, morph::InversionFree::QuickSteps,
         morph::InversionFree::DefaultSteps, morph::InversionFree::ThoroughSteps })
  {
    InversionFree method;
    method.setSteps(steps);
    const Morphed result = run(method, mesh, boundary);
    EXPECT_LE(motions::count(result.report, "NewtonSteps"), 2 * steps);
    EXPECT_GE(result.minimum, 0.998 * least);
    least = result.minimum;
  }
  EXPECT_GT(least, 1.05 * known);
}

TEST(InversionFree, TangledRestMeshesAreUntangled)
{
  for (const auto& [name, mesh] : meshes::all(4, 4, 4))
  {
    SCOPED_TRACE(name);
    Mesh tangled = mesh;
    meshes::jitterInterior(tangled, 0.9, meshes::seed());
    meshes::ThreadedMonitor monitor;
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    const auto inverted = [&](const Points& points)
    { return morph::measureCorners(tangled, points, orientation, {}, monitor).inverted; };
    ASSERT_GT(inverted(tangled.points), 0);
    InversionFree method;
    const Morphed result =
      run(method, tangled, target(tangled, [](const motions::Row& x) { return x; }));
    EXPECT_EQ(inverted(result.moved), 0);
  }
}

TEST(InversionFree, CellsThatTheBoundaryInvertsAreNamedAndTheOthersMorphed)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const Points boundary = target(
    mesh, [](const motions::Row& x) { return x.norm() == 0 ? motions::Row(1.5, 1.5, 1.5) : x; });
  InversionFree method;
  meshes::ThreadedMonitor monitor;
  Points moved;
  method.prepare(mesh, motions::outerPartition(mesh), monitor);
  const morph::EvaluateReport report = method.evaluate(boundary, moved, monitor);
  EXPECT_EQ(motions::count(report, "BoundaryDeterminedCells"), 1);
  ASSERT_EQ(monitor.warnings.size(), 1u);
  EXPECT_NE(monitor.warnings[0].find("cell ids 0."), std::string::npos) << monitor.warnings[0];
  const std::vector<Index> inverted =
    morph::invertedCells(mesh, moved, std::vector<std::int8_t>(mesh.numberOfCells(), 1), monitor);
  EXPECT_EQ(inverted, std::vector<Index>{ 0 });

  // A cell that was inverted before is none of these.
  Mesh pushed = mesh;
  pushed.points.row(0) << 1.5, 1.5, 1.5;
  meshes::ThreadedMonitor other;
  InversionFree again;
  again.prepare(pushed, motions::outerPartition(pushed), other);
  const morph::EvaluateReport next = again.evaluate(target(pushed, waves), moved, other);
  EXPECT_EQ(motions::count(next, "BoundaryDeterminedCells"), 0);
  for (const std::string& warning : other.warnings)
  {
    EXPECT_NE(warning.find("The reference mesh has"), std::string::npos) << warning;
  }
}

TEST(InversionFree, WhereTheBoundaryInvertsCellsTheOthersAreMended)
{
  for (const Mesh& mesh : { meshes::hexes(8, 4, 4), meshes::tets(8, 4, 4) })
  {
    // Steep waves invert cells inside, and two corners of the boundary their own ones.
    const Points boundary = target(mesh,
      [](const motions::Row& x)
      {
        const bool isPushed = x.norm() == 0 || (x - motions::Row(8, 0, 0)).norm() == 0;
        return motions::Row(
          waves(x) + (isPushed ? motions::Row(0, 1.5, 1.5) : motions::Row(0, 0, 0)));
      });
    InversionFree method;
    const Morphed result = run(method, mesh, boundary);
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    const std::vector<Index> hopeless =
      morph::boundaryDeterminedInversions(mesh, method.partition(), orientation, result.moved);
    ASSERT_FALSE(hopeless.empty());
    meshes::ThreadedMonitor monitor;
    EXPECT_EQ(morph::invertedCells(mesh, result.moved, orientation, monitor), hopeless);
    const morph::MovableQuality others(
      mesh, orientation, method.partition().free, morph::Communicator::alone(), hopeless);
    EXPECT_GT(others.measure(result.moved, monitor).minimum, 0.05);
  }
}

TEST(InversionFree, CellsBehindAFoldOfTheBoundaryDoNotHoldUpTheOthers)
{
  for (const Mesh& mesh :
    { meshes::hexes(6, 6, 6), meshes::tets(6, 6, 6), meshes::hexesAndPyramids(6, 6, 6) })
  {
    // A node in the middle of the top goes past its neighbor there, and steep waves invert cells
    // elsewhere.
    Points boundary = target(mesh, waves);
    const morph::NodePartition partition = motions::outerPartition(mesh);
    Index folded = -1;
    for (std::size_t i = 0; i < partition.prescribed.size(); ++i)
    {
      const motions::Row x = mesh.points.row(partition.prescribed[i]);
      if ((x - motions::Row(3, 3, 6)).norm() < 1e-9)
      {
        folded = partition.prescribed[i];
        boundary(static_cast<Index>(i), 1) += 1.4;
      }
    }
    ASSERT_GE(folded, 0);
    InversionFree method;
    const Morphed result = run(method, mesh, boundary);
    EXPECT_EQ(motions::count(result.report, "Untangled"), 0);
    EXPECT_GT(result.inverted, 0);
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    meshes::ThreadedMonitor monitor;
    const morph::Quality quality =
      morph::measureQuality(mesh, result.moved, orientation, {}, monitor);
    const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
    const morph::FaceQuality boundaryQuality = morph::faceQuality(
      mesh.points, result.moved, faces, morph::classify(mesh, faces, {}, monitor));
    std::set<Index> onFold, nodesOnFold;
    for (Index f : boundaryQuality.folded)
    {
      onFold.insert(faces.cells[f]);
      nodesOnFold.insert(faces.connectivity.begin() + faces.offsets[f],
        faces.connectivity.begin() + faces.offsets[f + 1]);
    }
    EXPECT_FALSE(onFold.empty());
    Index invertedOnFolds = 0;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      invertedOnFolds += !(quality.scaledJacobian[c] > 0) && onFold.count(c) > 0 ? 1 : 0;
      if (morph::cellShape(mesh.types[c])->shape == morph::Shape::Pyramid)
      {
        // A base that stands on an edge turned round cannot be right on both of its sides.
        const auto onEdge = std::count_if(
          mesh.cell(c), mesh.cell(c) + 4, [&](Index node) { return nodesOnFold.count(node) > 0; });
        EXPECT_TRUE(quality.scaledJacobian[c] > 0 || onEdge >= 2) << c;
      }
      else
      {
        EXPECT_TRUE(quality.scaledJacobian[c] > 0 || onFold.count(c) > 0) << c;
      }
    }
    EXPECT_EQ(motions::count(result.report, "FoldedBoundaryCells"), invertedOnFolds);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("folded"), std::string::npos) << result.warnings[0];
  }
}

TEST(InversionFree, LinearIterationsOfUntanglingHardlyGrowWithTheMesh)
{
  // By diagonal blocks alone they double with the cells a side.
  const auto iterations = [](int side)
  {
    const Mesh mesh = meshes::hexes(side, side, side);
    InversionFree method;
    method.setSteps(morph::InversionFree::NoSteps);
    const Morphed result = run(method, mesh,
      target(mesh, [side](const motions::Row& x) { return motions::twist(x, side, side, 12.6); }));
    EXPECT_EQ(result.inverted, 0);
    EXPECT_GT(motions::count(result.report, "NewtonSteps"), 0);
    return static_cast<double>(motions::count(result.report, "LinearIterations")) /
           static_cast<double>(motions::count(result.report, "NewtonSteps"));
  };
  EXPECT_LT(iterations(16), 1.5 * iterations(8));
}

TEST(InversionFree, ABoundaryWithoutAMeshIsGivenUpSoon)
{
  // Half a turn folds the inner side; with less a mesh exists, and steep waves invert cells of both
  // linear meshes.
  const Mesh mesh = meshes::hexes(24, 8, 8);
  const auto bent = [&](double degrees, double height)
  {
    const double angle = degrees * M_PI / 180, radius = 24 / angle;
    const Points boundary = target(mesh,
      [&](const motions::Row& x) -> motions::Row
      {
        const double phi = angle * x[0] / 24, r = radius - x[1];
        return { r * std::sin(phi), radius - r * std::cos(phi),
          x[2] + height * std::sin(M_PI / 2 * x[0]) };
      });
    InversionFree method;
    return run(method, mesh, boundary);
  };
  const Morphed valid = bent(150, 3), folded = bent(180, 0);
  EXPECT_EQ(valid.inverted, 0);
  EXPECT_GT(motions::count(valid.report, "NewtonSteps"), 20);
  EXPECT_GT(folded.inverted, 0);
  EXPECT_EQ(motions::count(folded.report, "Untangled"), 0);
  EXPECT_GT(motions::count(folded.report, "NewtonSteps"), 0);
  EXPECT_LE(
    motions::count(folded.report, "NewtonSteps"), 2 * motions::count(valid.report, "NewtonSteps"));
  EXPECT_LE(motions::count(folded.report, "LinearIterations"),
    5 * motions::count(valid.report, "LinearIterations"));
}

TEST(InversionFree, ThreadsRenumberingRigidMotionAndScaleDoNotShow)
{
  Mesh mesh = meshes::hexesAndPyramids(4, 4, 4);
  meshes::jitterInterior(mesh, 0.1, meshes::seed());
  InversionFree one, three;
  const Points boundary = target(mesh, waves);
  const Points expected = run(one, mesh, boundary).moved;
  EXPECT_TRUE(motions::identical(expected, run(three, mesh, boundary, 3).moved));

  const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
  const Mesh other = meshes::renumbered(mesh, order);
  InversionFree renumbered;
  const Points moved = run(renumbered, other, target(other, waves)).moved;
  double difference = 0;
  for (Index i = 0; i < mesh.numberOfNodes(); ++i)
  {
    difference = std::max(difference, (moved.row(order[i]) - expected.row(i)).norm());
  }
  // Where the minimum is raised, steps end by tests that the order of sums can turn.
  EXPECT_LT(difference, 2e-2);

  const double angle = 0.6, scale = 300;
  const motions::Map turn = [&](const motions::Row& x) -> motions::Row
  {
    return scale * motions::Row(x[0] * std::cos(angle) - x[1] * std::sin(angle) + 5,
                     x[0] * std::sin(angle) + x[1] * std::cos(angle), x[2] - 3);
  };
  Mesh turned = mesh;
  turned.points = motions::mapped(mesh.points, turn);
  InversionFree rigid;
  const Morphed result = run(rigid, turned, motions::mapped(boundary, turn));
  EXPECT_LT(motions::difference(result.moved, motions::mapped(expected, turn)), 2e-2 * scale);
  EXPECT_NEAR(result.minimum, run(one, mesh, boundary).minimum, 2e-3);
}

TEST(InversionFree, RepairsAnotherMethodsMesh)
{
  Mesh mesh = meshes::quadraticHexes(3, 3, 3, true);
  meshes::ThreadedMonitor monitor;
  InversionFree method;
  method.prepare(mesh, motions::outerPartition(mesh), monitor);
  Points moved = mesh.points;
  Mesh tangled = mesh;
  meshes::jitterInterior(tangled, 0.9, meshes::seed());
  for (Index node : method.partition().free)
  {
    moved.row(node) = tangled.points.row(node);
  }
  const std::vector<std::int8_t> orientation(mesh.numberOfCells(), 1);
  ASSERT_FALSE(morph::invertedCells(mesh, moved, orientation, monitor).empty());
  EXPECT_EQ(motions::count(method.repair(moved, monitor), "Untangled"), 1);
  EXPECT_TRUE(morph::invertedCells(mesh, moved, orientation, monitor).empty());
  for (Index node : method.partition().prescribed)
  {
    EXPECT_EQ(moved.row(node), mesh.points.row(node));
  }
}

TEST(InversionFree, RepairMovesOnlyNodesNearTheInvertedCells)
{
  const Mesh mesh = meshes::hexes(40, 4, 4);
  meshes::ThreadedMonitor monitor;
  InversionFree method;
  method.prepare(mesh, motions::outerPartition(mesh), monitor);
  Points moved = mesh.points;
  for (Index node : method.partition().free)
  {
    moved(node, 0) += mesh.points(node, 0) < 2.5 ? 1.5 : 0;
  }
  const Points before = moved;
  const std::vector<std::int8_t> orientation(mesh.numberOfCells(), 1);
  ASSERT_FALSE(morph::invertedCells(mesh, moved, orientation, monitor).empty());
  const morph::EvaluateReport report = method.repair(moved, monitor);
  EXPECT_EQ(motions::count(report, "Untangled"), 1);
  EXPECT_GT(motions::count(report, "NewtonSteps"), 0);
  EXPECT_TRUE(morph::invertedCells(mesh, moved, orientation, monitor).empty());
  Index far = 0;
  for (Index node : method.partition().free)
  {
    if (mesh.points(node, 0) > 25)
    {
      EXPECT_EQ(moved.row(node), before.row(node));
      ++far;
    }
  }
  EXPECT_GT(far, 100);
}

TEST(InversionFree, NearOnlyRepairsOrLeavesTheMeshAsItIs)
{
  Mesh mesh = meshes::hexesAndPyramids(12, 6, 6);
  meshes::jitterInterior(mesh, 0.1, meshes::seed());
  const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
  meshes::ThreadedMonitor one(1), three(3);
  InversionFree method, again;
  method.setNearOnly(true);
  again.setNearOnly(true);
  method.prepare(mesh, motions::outerPartition(mesh), one);
  again.prepare(mesh, motions::outerPartition(mesh), three);
  Points moved = mesh.points;
  const Index node = method.partition().free[method.partition().free.size() / 2];
  moved.row(node) += motions::Row(1.6, 0, 0);
  ASSERT_FALSE(morph::invertedCells(mesh, moved, orientation, one).empty());
  Points other = moved;
  EXPECT_EQ(motions::count(method.repair(moved, one), "Untangled"), 1);
  EXPECT_TRUE(morph::invertedCells(mesh, moved, orientation, one).empty());
  again.repair(other, three);
  EXPECT_TRUE(motions::identical(moved, other));

  // A node of the top past its neighbor there: the boundary is folded.
  Points spoilt = mesh.points;
  for (const Index top : method.partition().prescribed)
  {
    if ((mesh.points.row(top) - motions::Row(6, 3, 6)).norm() < 1e-9)
    {
      spoilt(top, 1) += 1.4;
    }
  }
  const Points before = spoilt;
  ASSERT_FALSE(morph::invertedCells(mesh, spoilt, orientation, one).empty());
  EXPECT_EQ(motions::count(method.repair(spoilt, one), "Untangled"), 0);
  EXPECT_TRUE(motions::identical(spoilt, before));
  EXPECT_TRUE(one.warnings.empty());

  std::string message;
  EXPECT_EQ(
    motions::kindOf([&]
      { method.evaluate(target(mesh, [](const motions::Row& x) { return x; }), moved, one); },
      message),
    morph::Error::Kind::InvalidInput);
}

TEST(InversionFree, CancelLeavesTheResultUntouched)
{
  const Mesh mesh = meshes::hexes(5, 5, 5);
  meshes::ThreadedMonitor monitor;
  InversionFree method;
  method.prepare(mesh, motions::outerPartition(mesh), monitor);
  monitor.lastProgress = 0;
  monitor.cancelAt = 0.09; // the first guesses are there, and the minimum is raised
  Points moved = Points::Constant(2, 3, 7);
  std::string message;
  EXPECT_EQ(motions::kindOf([&] { method.evaluate(target(mesh, waves), moved, monitor); }, message),
    morph::Error::Kind::Cancelled);
  EXPECT_EQ(moved, Points::Constant(2, 3, 7));
}

TEST(SubSteps, RestMeshesWithInvertedCellsAreRefused)
{
  Mesh mesh = meshes::hexes(3, 3, 3);
  meshes::jitterInterior(mesh, 0.95, 3);
  const auto partition = motions::outerPartition(mesh);
  meshes::ThreadedMonitor monitor;
  motions::expectError(
    morph::Error::Kind::InvalidInput,
    [&]
    {
      morph::morphIncrementally(
        mesh, mesh.points, partition, std::vector<std::int8_t>(mesh.numberOfCells(), 1), {},
        morph::straightPath(mesh.points, partition, target(mesh, motions::affine)),
        [] { return std::make_unique<morph::FemWarp>(); }, {}, monitor);
    },
    "cell ids");
}
