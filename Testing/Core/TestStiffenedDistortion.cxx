// SPDX-License-Identifier: BSD-3-Clause
#include "Differences.h"
#include "Energies/StiffenedDistortion.h"
#include "Meshes.h"
#include "Motions.h"
#include "Quality/MovableQuality.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace
{
using namespace morph;

StiffenedDistortion distortion(const Mesh& mesh, const Points& start)
{
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (morph::cellShape(mesh.types[c])->dimension == 3)
    {
      cells.push_back(c);
    }
  }
  return { mesh, morph::cellSigns(mesh, morph::connectedComponents(mesh)), cells,
    motions::outerPartition(mesh).free, start };
}

StiffenedDistortion distortion(const Mesh& mesh)
{
  return distortion(mesh, mesh.points);
}

/// The whole matrix, and not its upper part alone.
Eigen::MatrixXd dense(const StiffenedDistortion& objective, const Points& points)
{
  meshes::ThreadedMonitor monitor;
  morph::BlockCsr3f matrix;
  objective.hessian(points, matrix, monitor);
  const Index n = matrix.rows();
  Eigen::MatrixXd result(3 * n, 3 * n);
  for (Index i = 0; i < 3 * n; ++i)
  {
    Points x = Points::Zero(n, 3), y;
    x(i / 3, i % 3) = 1;
    matrix.multiply(x, y, monitor);
    result.col(i) = Eigen::Map<const Eigen::VectorXd>(y.data(), 3 * n);
  }
  return result;
}
}

TEST(StiffenedDistortion, LargestIsThatOfTheMinimumScaledJacobian)
{
  meshes::ThreadedMonitor monitor;
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const auto orientation = morph::cellSigns(mesh, morph::connectedComponents(mesh));
    const std::vector<Index> free = motions::outerPartition(mesh).free;
    const double minimum =
      morph::MovableQuality(mesh, orientation, free).measure(mesh.points, monitor).minimum;
    const double largest = distortion(mesh).evaluate(mesh.points, monitor).largest;
    EXPECT_NEAR(1 / std::sqrt(largest), minimum, 1e-12);
  }
}

TEST(StiffenedDistortion, GradientIsThatOfFiniteDifferences)
{
  meshes::ThreadedMonitor monitor;
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    StiffenedDistortion objective = distortion(mesh);
    objective.setLevel(0.8 / objective.evaluate(mesh.points, monitor).largest);
    differences::expectGradient(objective, mesh.points, 1e-6);
    // Edges are short, then long beside these.
    differences::expectGradient(distortion(mesh, 8 * mesh.points), mesh.points, 1e-6);
    differences::expectGradient(distortion(mesh, mesh.points / 8), mesh.points, 1e-6);
  }
}

TEST(StiffenedDistortion, MatrixIsSemiDefiniteAndNearTheCurvatureWhereCosinesAreFixed)
{
  // At the ideal cell all cosines are stationary in f, and Gauss-Newton is exact but for the
  // proximity of edges.
  meshes::ThreadedMonitor monitor;
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    StiffenedDistortion objective = distortion(mesh);
    objective.setLevel(0.9 / objective.evaluate(mesh.points, monitor).largest);
    const Eigen::MatrixXd H = dense(objective, mesh.points);
    EXPECT_LT((H - H.transpose()).norm(), 1e-6 * H.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(H);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0);
  }
  const Mesh cube = meshes::hexes(2, 2, 2);
  const StiffenedDistortion objective = distortion(cube);
  const Eigen::MatrixXd H = dense(objective, cube.points);
  ASSERT_EQ(H.rows(), 3);
  const auto energy = [&](double by)
  {
    Points points = cube.points;
    points(objective.free()[0], 0) += by;
    return objective.value(points, monitor).energy;
  };
  const double h = 1e-3, curvature = (energy(h) - 2 * energy(0) + energy(-h)) / (h * h);
  // Each of the 12 corners on an edge of the middle node along x, and those across, has 30.
  EXPECT_NEAR(H(0, 0) - curvature, 30 * 48, 1e-2 * curvature);
}

TEST(StiffenedDistortion, InfiniteWhereACornerIsInvertedOrBeyondTheBarrier)
{
  meshes::ThreadedMonitor monitor;
  Mesh mesh = meshes::hexes(3, 3, 3);
  StiffenedDistortion objective = distortion(mesh);
  EXPECT_TRUE(objective.value(mesh.points, monitor).allowed);
  objective.setLevel(1.01);
  EXPECT_FALSE(objective.value(mesh.points, monitor).allowed);
  objective.setLevel(0.5);
  mesh.points.row(objective.free()[0]) += Eigen::RowVector3d(1.5, 0, 0);
  const morph::Objective::Value value = objective.value(mesh.points, monitor);
  EXPECT_TRUE(std::isinf(value.energy));
  EXPECT_FALSE(value.allowed);
}

TEST(StiffenedDistortion, ThreadsDoNotShow)
{
  meshes::ThreadedMonitor one(1), three(3);
  for (const auto& [name, mesh] : motions::jittered())
  {
    SCOPED_TRACE(name);
    const StiffenedDistortion objective = distortion(mesh);
    Points first, second;
    objective.gradient(mesh.points, first, one);
    objective.gradient(mesh.points, second, three);
    EXPECT_EQ(first, second);
    EXPECT_EQ(objective.value(mesh.points, one).energy, objective.value(mesh.points, three).energy);
  }
}

TEST(StiffenedDistortion, EdgesOfHexahedraDoNotCollapse)
{
  // Layers of hexahedra have right angles whatever their thickness.
  meshes::ThreadedMonitor monitor;
  const Mesh mesh = meshes::hexes(3, 3, 3);
  const StiffenedDistortion objective = distortion(mesh);
  const auto value = [&](double height)
  {
    Points points = mesh.points;
    for (Index node = 0; node < mesh.numberOfNodes(); ++node)
    {
      points(node, 2) = points(node, 2) == 1 ? height : points(node, 2);
    }
    return objective.value(points, monitor).energy / objective.value(mesh.points, monitor).energy;
  };
  EXPECT_LT(value(0.5), 1.01);
  EXPECT_GT(value(0.05), 10);
}

TEST(StiffenedDistortion, SamplesAtTheirBoundCountAsTheFloor)
{
  // The node above the slanted top's corner is the only free one of some corners.
  meshes::ThreadedMonitor monitor;
  Mesh mesh = meshes::hexes(4, 4, 4);
  meshes::transform(
    mesh, [](const motions::Row& x) { return motions::Row(x[0] + 0.7 * x[1], x[1], x[2]); });
  StiffenedDistortion objective = distortion(mesh);
  const double sine = 1 / std::sqrt(1 + 0.7 * 0.7);
  EXPECT_NEAR(objective.evaluate(mesh.points, monitor).largest, 1 / (sine * sine), 1e-12);
  objective.setFloor(0.5 * sine);
  EXPECT_NEAR(objective.evaluate(mesh.points, monitor).largest, 1 / (sine * sine), 1e-12);
}
