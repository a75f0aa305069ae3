// SPDX-License-Identifier: BSD-3-Clause
// What is particular to weighted residuals; TestLinearMorphers.cxx has what they share with the
// other methods, also with few neighbors.
#include "BoundaryShapes.h"
#include "DirectSolutions.h"
#include "Meshes.h"
#include "Motions.h"

#include "LinearMethods/WeightedResidual.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

using namespace morph;
using motions::affine;
using motions::bend;
using motions::identical;
using motions::outerPartition;
using motions::targets;
using Row = Eigen::RowVector3d;

namespace
{
Points morphed(
  const Mesh& mesh, const NodePartition& partition, const Points& target, Index neighbors = 80)
{
  meshes::ThreadedMonitor monitor;
  WeightedResidual method;
  method.setNumberOfNeighbors(neighbors);
  Points result = motions::morphed(method, mesh, partition, target, monitor);
  EXPECT_TRUE(monitor.warnings.empty()) << monitor.warnings.front();
  return result;
}

/// Equations (3) to (6), with positions as they are printed: nothing shared with the library.
Row byTheBook(const Points& rest, const Points& moved, const Row& x, Index neighbors)
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
  Row result = Row::Zero();
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
  for (const auto& [name, mesh] : motions::inGeneralPosition())
  {
    const NodePartition partition = outerPartition(mesh);
    const Points rest = meshes::rows(mesh.points, partition.prescribed);
    const Points target = targets(mesh, partition, bend);
    for (Index neighbors : { 1, 7, 80, 100000 })
    {
      const Points result = morphed(mesh, partition, target, neighbors);
      for (Index id : partition.free)
      {
        EXPECT_LT((result.row(id) - byTheBook(rest, target, mesh.points.row(id), neighbors)).norm(),
          1e-12 * meshes::size(mesh.points))
          << name << ", node " << id << ", " << neighbors << " neighbors";
      }
    }
  }
}

TEST(WeightedResidual, RenumberingTheNodesChangesNoBitInside)
{
  for (const Index neighbors : { 80, 9, 1 })
  {
    for (const auto& [name, mesh] : meshes::all(4, 4, 4)) // lattices: full of ties
    {
      const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
      const Mesh shuffled = meshes::renumbered(mesh, order);
      const NodePartition partition = outerPartition(mesh), renamed = outerPartition(shuffled);
      const Points one = morphed(mesh, partition, targets(mesh, partition, bend), neighbors);
      const Points back = meshes::rows(
        morphed(shuffled, renamed, targets(shuffled, renamed, bend), neighbors), order);
      EXPECT_TRUE(identical(meshes::rows(one, partition.free), meshes::rows(back, partition.free)))
        << name;
      EXPECT_LT(motions::difference(one, back), 1e-14 * meshes::size(mesh.points)) << name;
    }
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

// Nodes off a plane, a line or a place move as the nearest point on it.
TEST(WeightedResidual, FlatSetsOfPrescribedNodesKeepTheMapLinear)
{
  const Mesh mesh = meshes::hexes(4, 4, 4);
  const auto inPlane = [](const Row& x) -> Row {
    return { 1.5 * x[0] + .2 * x[1] + 1, .8 * x[1] - .3 * x[0], .4 * x[0] - .1 * x[1] + 2 };
  };
  const std::vector<std::pair<int, Row>> sets = { { 25, Row(1, 1, 0) }, { 5, Row(1, 0, 0) },
    { 1, Row(0, 0, 0) } }; // the first nodes, and the coordinates that they do not share
  for (const auto& [count, free] : sets)
  {
    std::vector<Index> ids(count);
    std::iota(ids.begin(), ids.end(), Index(0));
    const NodePartition partition = partitionNodes(mesh, ids);
    const Points result = morphed(mesh, partition, targets(mesh, partition, inPlane), 10);
    for (Index n = 0; n < mesh.numberOfNodes(); ++n)
    {
      const Row foot = mesh.points.row(n).cwiseProduct(free);
      EXPECT_LT((result.row(n) - mesh.points.row(n) - (inPlane(foot) - foot)).norm(),
        count == 1 ? 1e-13 : 1e-12)
        << n;
    }
    // The adjoint there, too.
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
  const auto displacement = [&](Index id) -> Row { return result.row(id) - mesh.points.row(id); };
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
  const Mesh box = meshes::hexes(3, 3, 3);
  const Mesh mesh = shapes::together(box, meshes::shifted(box, Row(3, 0, 0)));
  const NodePartition partition = outerPartition(mesh);
  std::vector<Index> once;
  for (const Index id : partition.prescribed)
  {
    if (id < box.numberOfNodes() || mesh.points(id, 0) > 3)
    {
      once.push_back(id);
    }
  }
  ASSERT_LT(once.size(), partition.prescribed.size());
  const Points rest = meshes::rows(mesh.points, once), moved = motions::mapped(rest, bend);
  const Points result = morphed(mesh, partition, targets(mesh, partition, bend), 1000);
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
  Points result =
    motions::morphed(method, mesh, partition, targets(mesh, partition, bend), monitor);
  method.evaluate(targets(mesh, partition,
                    [](const Row& x) -> Row
                    {
                      return { -x[0], -x[1], x[2] }; // half a turn is none of it
                    }),
    result, monitor);
  EXPECT_TRUE(monitor.warnings.empty());
  const auto mirror = [](const Row& x) -> Row { return { x[0], -2 * x[1], x[2] }; };
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
  const Points moved =
    motions::moved(method, meshes::rows(mesh.points, partition.prescribed) + mode, monitor);
  EXPECT_EQ(monitor.warnings.size(), 1u);
}

TEST(WeightedResidual, RefusesWhatItCannotUse)
{
  WeightedResidual method;
  EXPECT_THROW(method.setNumberOfNeighbors(0), Error);
  EXPECT_THROW(method.setNumberOfNeighbors(-3), Error);
  EXPECT_EQ(method.numberOfNeighbors(), 80);

  Mesh mesh = meshes::hexes(3, 3, 3);
  mesh.points(21, 0) = 1e160; // a free node
  Monitor monitor;
  EXPECT_THROW(method.prepare(mesh, outerPartition(mesh), monitor), Error);
}
