// SPDX-License-Identifier: BSD-3-Clause
// What is particular to simplex-linear; TestLinearMorphers.cxx has what it shares with the other
// methods.
#include "LinearMethods/SimplexLinear.h"

#include "BoundaryShapes.h"
#include "Meshes.h"
#include "Motions.h"
#include "Support/Error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace morph;
using motions::affine;
using motions::count;
using motions::difference;
using motions::jittered;
using motions::outerPartition;
using motions::targets;
using motions::twistOf;
using Row = Eigen::RowVector3d;

namespace
{
struct Outcome
{
  SimplexLinear method;
  Points moved;
  EvaluateReport report;
};

std::unique_ptr<Outcome> morphed(
  const Mesh& mesh, const NodePartition& partition, const motions::Map& map)
{
  Monitor monitor;
  auto result = std::make_unique<Outcome>();
  result->method.prepare(mesh, partition, monitor);
  result->report = result->method.evaluate(targets(mesh, partition, map), result->moved, monitor);
  return result;
}

/// Appends the means of sites' values, by Eigen's own mean.
Points withMeans(const SimplexLinear& method, const Points& values)
{
  const Adjacency& means = method.means();
  const Index count = static_cast<Index>(means.offsets.size()) - 1;
  Points all(values.rows() + count, 3);
  all.topRows(values.rows()) = values;
  for (Index m = 0; m < count; ++m)
  {
    const std::vector<Index> sites(means.begin(m), means.end(m));
    all.row(values.rows() + m) = values(sites, allColumns).colwise().mean();
  }
  return all;
}

/// x = sum b_k corner_k, solved by itself.
Eigen::Vector4d barycentric(const Delaunay& delaunay, std::size_t t, const Row& x)
{
  Eigen::Matrix4d m;
  for (int k = 0; k < 4; ++k)
  {
    m.col(k) << delaunay.sites().row(delaunay.tetrahedra()[t].sites[k]).transpose(), 1;
  }
  return m.fullPivLu().solve(Eigen::Vector4d(x[0], x[1], x[2], 1));
}

std::set<std::set<int>> usedTetrahedra(const WeightMatrix& weights)
{
  std::set<std::set<int>> used;
  for (Index row = 0; row < weights.rows(); ++row)
  {
    used.emplace(weights.column(row), weights.column(row) + 4);
  }
  return used;
}

/// Two boxes of 2 x 3 x 3 hexahedra that touch, with nodes of their own where they do.
Mesh twoBodiesThatTouch()
{
  const Mesh one = meshes::hexes(2, 3, 3);
  return shapes::together(one, meshes::shifted(one, Row(2, 0, 0)));
}
}

TEST(SimplexLinear, AgreesWithASearchOfAllTetrahedra)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const auto result = morphed(mesh, partition, twistOf(4, 1.2));
    const Delaunay& delaunay = result->method.tessellation();
    const Points rest = meshes::rows(mesh.points, partition.free);
    const Points moved = withMeans(
      result->method, motions::mapped(result->method.sites().coordinates(), twistOf(4, 1.2)));
    for (Index i = 0; i < rest.rows(); ++i)
    {
      double best = -1;
      Row expected = Row::Zero();
      for (std::size_t t = 0; t < delaunay.tetrahedra().size(); ++t)
      {
        const Eigen::Vector4d b = barycentric(delaunay, t, rest.row(i));
        if (b.minCoeff() > best)
        {
          best = b.minCoeff();
          expected.setZero();
          for (int k = 0; k < 4; ++k)
          {
            expected += b[k] * moved.row(delaunay.tetrahedra()[t].sites[k]);
          }
        }
      }
      ASSERT_GT(best, -1e-12) << name;
      EXPECT_LT((result->moved.row(partition.free[i]) - expected).norm(), 1e-11) << name;
    }
  }
}

TEST(SimplexLinear, WeightsAreBarycentricCoordinates)
{
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    const auto result = morphed(mesh, partition, affine);
    const WeightMatrix& weights = result->method.weights();
    const Points sites = withMeans(result->method, result->method.sites().coordinates());
    ASSERT_EQ(weights.rows(), static_cast<Index>(partition.free.size()));
    for (Index row = 0; row < weights.rows(); ++row)
    {
      double sum = 0;
      Row x = Row::Zero();
      for (int k = 0; k < 4; ++k)
      {
        const double b = weights.weight(row)[k];
        EXPECT_GT(b, -1e-9) << name;
        sum += b;
        x += b * sites.row(weights.column(row)[k]);
      }
      EXPECT_NEAR(sum, 1, 1e-14) << name;
      EXPECT_LT((x - mesh.points.row(partition.free[row])).norm(), 1e-13) << name;
    }
    EXPECT_EQ(count(result->report, "ExtrapolatedNodes"), 0) << name;
  }
}

TEST(SimplexLinear, RenumberingKeepsTheTetrahedraAndTheWeights)
{
  auto list = jittered();
  list.emplace_back(
    "lattice", meshes::hexes(5, 5, 5)); // every free node is on faces, edges or in ties
  // Two nodes so near that the space-filling curve does not tell them apart.
  Mesh near = meshes::hexes(5, 5, 5);
  near.points.row(86) = near.points.row(87) + Row(1e-8, 1e-8, 1e-8);
  list.emplace_back("near nodes", near);
  for (const auto& [name, mesh] : list)
  {
    const NodePartition partition = outerPartition(mesh);
    const auto reference = morphed(mesh, partition, affine);
    const std::vector<Index> order = motions::shuffledNumbers(mesh.numberOfNodes());
    const Mesh shuffled = meshes::renumbered(mesh, order);
    const NodePartition renamed = outerPartition(shuffled);
    const auto result = morphed(shuffled, renamed, affine);
    const WeightMatrix &before = reference->method.weights(), &after = result->method.weights();
    for (std::size_t i = 0; i < partition.free.size(); ++i)
    {
      const auto at =
        std::lower_bound(renamed.free.begin(), renamed.free.end(), order[partition.free[i]]);
      const Index row = static_cast<Index>(i), other = at - renamed.free.begin();
      EXPECT_TRUE(std::equal(before.column(row), before.column(row) + 4, after.column(other)))
        << name << " node " << partition.free[i];
      EXPECT_TRUE(std::equal(before.weight(row), before.weight(row) + 4, after.weight(other)))
        << name;
    }
  }
}

TEST(SimplexLinear, PrescribedNodesInOnePlaceMoveTheOthersByTheirMean)
{
  const Mesh mesh = twoBodiesThatTouch();
  const NodePartition partition = outerPartition(mesh);
  Monitor monitor;
  SimplexLinear method;
  method.prepare(mesh, partition, monitor);
  EXPECT_EQ(method.sites().size(), static_cast<Index>(partition.prescribed.size()) - 16);

  // The bodies move apart: in the face that they share each site moves by the mean, 0.5.
  Points target = meshes::rows(mesh.points, partition.prescribed);
  for (std::size_t i = 0; i < partition.prescribed.size(); ++i)
  {
    target(static_cast<Index>(i), 0) += partition.prescribed[i] >= mesh.numberOfNodes() / 2 ? 1 : 0;
  }
  const Points moved = motions::moved(method, target, monitor);
  EXPECT_TRUE(motions::identical(meshes::rows(moved, partition.prescribed), target));
  const WeightMatrix& weights = method.weights();
  Points step = method.sites().coordinates();
  step.col(0) = step.col(0).unaryExpr([](double x) { return x < 2 ? 0 : x > 2 ? 1 : .5; });
  step = withMeans(method, step);
  for (Index row = 0; row < weights.rows(); ++row)
  {
    double expected = 0;
    for (int k = 0; k < 4; ++k)
    {
      expected += weights.weight(row)[k] * step(weights.column(row)[k], 0);
    }
    const Index node = partition.free[row];
    EXPECT_NEAR(moved(node, 0) - mesh.points(node, 0), expected, 1e-14);
  }

  // The adjoint shares a site's gradient out among its nodes.
  Points gradient = Points::Zero(mesh.numberOfNodes(), 3), adjoint;
  for (Index node : partition.free)
  {
    gradient(node, 0) = 1 + static_cast<double>(node % 5);
  }
  method.applyTranspose(gradient, adjoint, monitor);
  const Points rest = meshes::rows(mesh.points, partition.prescribed);
  EXPECT_NEAR(adjoint.cwiseProduct(target - rest).sum(),
    gradient.cwiseProduct(moved - mesh.points).sum(), 1e-11);
}

TEST(SimplexLinear, FreeNodesOnTheHullAreInside)
{
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Mesh mesh = meshes::hexes(6, 6, 6);
  std::vector<Index> corners;
  for (Index k : { 0, 6 })
  {
    for (Index j : { 0, 6 })
    {
      for (Index i : { 0, 6 })
      {
        corners.push_back(i + 7 * (j + 7 * k));
      }
    }
  }
  const NodePartition partition = partitionNodes(mesh, corners);
  ASSERT_EQ(partition.free.size(), 335u);
  for (bool turned : { false, true })
  {
    if (turned) // the nodes of a face no longer lie in one plane
    {
      meshes::transform(mesh, [&](const Row& x) { return Row(x * R + Row(40, -3, 8)); });
    }
    const auto result = morphed(mesh, partition, affine);
    EXPECT_EQ(count(result->report, "ExtrapolatedNodes"), 0);
    EXPECT_LT(difference(result->moved, motions::mapped(mesh.points, affine)),
      1e-10 * meshes::size(mesh.points));
  }
}

TEST(SimplexLinear, NodesOnTheHullMoveAlikeFarFromTheOrigin)
{
  // Far away, rounding makes tetrahedra of sites that lie in one face of the box.
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (auto& [name, mesh] : jittered())
  {
    SCOPED_TRACE(name);
    std::vector<Index> ids = outerPartition(mesh).prescribed;
    ids.erase(
      std::remove_if(ids.begin(), ids.end(), [](Index id) { return id % 4 == 1; }), ids.end());
    const NodePartition partition = partitionNodes(mesh, ids);
    Mesh far = mesh;
    meshes::transform(mesh, [&](const Row& x) { return Row(x * R); });
    meshes::transform(far, [&](const Row& x) { return Row(x * R + Row(1e6, -2e6, 3e6)); });
    Points target = motions::targets(mesh, partition, twistOf(4, 1.2));
    const auto near = morphed(mesh, partition, twistOf(4, 1.2));
    target.rowwise() += Row(1e6, -2e6, 3e6);
    Outcome there;
    Monitor monitor;
    there.method.prepare(far, partition, monitor);
    there.method.evaluate(target, there.moved, monitor);
    there.moved.rowwise() -= Row(1e6, -2e6, 3e6);
    EXPECT_LT(difference(there.moved, near->moved), 1e-6) << name;
  }
}

TEST(SimplexLinear, NodesBeyondTheHullAreExtrapolatedAndCounted)
{
  Mesh mesh = meshes::hexes(4, 4, 4);
  meshes::jitterInterior(mesh, .15, meshes::seed());
  std::vector<Index> ids;
  for (Index id : outerPartition(mesh).prescribed)
  {
    if (mesh.points(id, 0) <= 2)
    {
      ids.push_back(id);
    }
  }
  const NodePartition partition = partitionNodes(mesh, ids);
  const auto beyond = std::count_if(
    partition.free.begin(), partition.free.end(), [&](Index id) { return mesh.points(id, 0) > 2; });
  const auto result = morphed(mesh, partition, affine);
  EXPECT_GE(beyond, 50);
  EXPECT_EQ(count(result->report, "ExtrapolatedNodes"), beyond);
  EXPECT_LT(difference(result->moved, motions::mapped(mesh.points, affine)),
    1e-10 * meshes::size(mesh.points));
}

TEST(SimplexLinear, WeightsFarOutsideTheHullAreBoundedAndCounted)
{
  // The bottom is prescribed up to `high`; the node farthest away is 20 / high of that off.
  Mesh mesh = meshes::hexes(3, 3, 20);
  mesh.points.rowwise() += Row(1e4, 0, 0);
  for (const double high : { 1., 12. })
  {
    std::vector<Index> ids;
    for (Index id : outerPartition(mesh).prescribed)
    {
      if (mesh.points(id, 2) <= high)
      {
        ids.push_back(id);
      }
    }
    const NodePartition partition = partitionNodes(mesh, ids);
    SimplexLinear method;
    meshes::ThreadedMonitor monitor;
    method.prepare(mesh, partition, monitor);
    Points moved;
    const EvaluateReport report =
      method.evaluate(motions::targets(mesh, partition, affine), moved, monitor);
    EXPECT_LT(difference(moved, motions::mapped(mesh.points, affine)),
      1e-10 * mesh.points.cwiseAbs().maxCoeff());
    Index affineRows = 0;
    for (Index row = 0; row < method.weights().rows(); ++row)
    {
      const Index n = method.weights().entries(row);
      const double* weight = method.weights().weight(row);
      EXPECT_TRUE(std::all_of(weight, weight + n, [](double w) { return std::abs(w) <= 10; }));
      affineRows += n > 4 ? 1 : 0;
    }
    EXPECT_EQ(count(report, "AffineNodes"), affineRows);
    EXPECT_EQ(affineRows > 0, high == 1);
    ASSERT_EQ(monitor.warnings.size(), high == 1 ? 1u : 0u);
    if (high == 1)
    {
      EXPECT_NE(monitor.warnings[0].find("far outside the convex hull"), std::string::npos);
      EXPECT_NE(monitor.warnings[0].find("affine fit"), std::string::npos);
    }
    // The adjoint is that of the same weights.
    const Points u = Points::Random(static_cast<Index>(ids.size()), 3);
    const Points g = Points::Random(mesh.numberOfNodes(), 3);
    Points y, sum;
    method.evaluate(meshes::rows(mesh.points, partition.prescribed) + u, y, monitor);
    method.applyTranspose(g, sum, monitor);
    EXPECT_NEAR((y - mesh.points).cwiseProduct(g).sum(), sum.cwiseProduct(u).sum(), 1e-7);
  }
}

TEST(SimplexLinear, FoldedTetrahedraAreThoseWithNodesInThemAndNoVolume)
{
  const motions::Map fold = [](const Row& x) { return Row(std::abs(x[0] - 3.5), x[1], x[2]); };
  const std::vector<std::pair<std::string, motions::Map>> motionsOfAll = { { "affine", affine },
    { "twist", twistOf(4, 1) }, { "strong twist", twistOf(4, 3) }, { "fold", fold } };
  for (const auto& [name, mesh] : jittered())
  {
    const NodePartition partition = outerPartition(mesh);
    for (const auto& [motion, map] : motionsOfAll)
    {
      const auto result = morphed(mesh, partition, map);
      const Points& sites = result->method.sites().coordinates();
      const Points rest = withMeans(result->method, sites);
      const Points moved = withMeans(result->method, motions::mapped(sites, map));
      Index folded = 0;
      for (const std::set<int>& t : usedTetrahedra(result->method.weights()))
      {
        const std::vector<int> s(t.begin(), t.end());
        const auto volume = [&s](const Points& x)
        {
          Eigen::Matrix3d edges;
          edges << x.row(s[1]) - x.row(s[0]), x.row(s[2]) - x.row(s[0]), x.row(s[3]) - x.row(s[0]);
          return edges.determinant();
        };
        folded += volume(rest) * volume(moved) > 0 ? 0 : 1;
      }
      EXPECT_EQ(count(result->report, "FoldedTetrahedra"), folded) << name << " " << motion;
      EXPECT_TRUE(motion == "affine" ? folded == 0 : motion != "fold" || folded > 0) << name;
    }
  }
}

TEST(SimplexLinear, PrescribedNodesInOnePlaneAreRefused)
{
  const Eigen::Matrix3d R =
    Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Mesh mesh = meshes::hexes(4, 4, 4);
  std::vector<Index> ids;
  for (Index id = 0; id < 25; ++id)
  {
    ids.push_back(id);
  }
  const NodePartition partition = partitionNodes(mesh, ids);
  for (bool turned : { false, true })
  {
    if (turned) // no longer in one plane, to the last bit
    {
      meshes::transform(mesh, [&](const Row& x) { return Row(x * R + Row(40, -3, 8)); });
    }
    motions::expectError(
      Error::Kind::Singular, [&] { morphed(mesh, partition, affine); }, "FEMWARP");
  }
}
