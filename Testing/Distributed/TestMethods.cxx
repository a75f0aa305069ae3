// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShapes.h"
#include "Distributed/HypreSolver.h"
#include "Distributed/RankCommunicator.h"
#include "LinearMethods.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Morpher/SiteMethod.h"
#include "Pieces.h"
#include "Session/Session.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::HypreSolver;
using morph::distributed::Ranks;

std::vector<std::pair<std::string, std::unique_ptr<Morpher>>> methods()
{
  std::vector<std::pair<std::string, std::unique_ptr<Morpher>>> all;
  auto fem = std::make_unique<morph::FemWarp>();
  fem->setTolerance(1e-13);
  all.emplace_back("FEMWARP", std::move(fem));
  auto barrier = std::make_unique<morph::LogBarrierWarp>();
  barrier->setTolerance(1e-13);
  all.emplace_back("LBWARP", std::move(barrier));
  all.emplace_back("weighted residual", std::make_unique<morph::WeightedResidual>());
  all.emplace_back("simplex-linear", std::make_unique<morph::SimplexLinear>());
  all.emplace_back("natural neighbor", std::make_unique<morph::SimplexNaturalNeighbor>());
  all.emplace_back("radial basis", std::make_unique<morph::RadialBasis>());
  auto few = std::make_unique<morph::RadialBasis>();
  few->setNumberOfCenters(20);
  all.emplace_back("radial basis, 20 centers", std::move(few));
  return all;
}

Points bend(const Points& x)
{
  Points moved = x;
  moved.col(1).array() += 0.2 * (x.col(0).array()).sin();
  moved.col(2).array() += 0.1 * x.col(0).array() * x.col(1).array();
  return moved;
}

Points affine(const Points& x)
{
  Eigen::Matrix3d map;
  map << 1.2, 0.3, 0, -0.2, 0.9, 0.1, 0.1, 0, 1.1;
  return (x * map).rowwise() + Eigen::RowVector3d(0.5, -1, 2);
}

/// Moves the nodes `outer` of `whole` by `motion` on all ranks; returns the largest distance from
/// the serial method's mesh, or from the motion of all nodes.
double difference(const Ranks& ranks, const Mesh& whole, const std::vector<Index>& outer,
  std::unique_ptr<Morpher> serial, Points (*motion)(const Points&), bool isAffine)
{
  Monitor monitor;
  const Points target = motion(whole.points);
  Points expected = target;
  if (!isAffine)
  {
    serial->prepare(whole, morph::partitionNodes(whole, outer), monitor);
    serial->evaluate(Points(target(outer, morph::allColumns)), expected, monitor);
  }
  const pieces::OnRanks mine(
    ranks, whole, outer, morph::onProcesses(std::move(serial)), meshes::seed(), monitor);
  Points moved;
  mine.evaluate(target, moved, monitor);
  return pieces::distance(mine.mesh, moved, expected) / meshes::size(whole.points);
}

/// The same for the whole boundary.
double difference(const Ranks& ranks, const Mesh& whole, std::unique_ptr<Morpher> serial,
  Points (*motion)(const Points&), bool isAffine)
{
  Monitor monitor;
  return difference(
    ranks, whole, morph::boundaryFaces(whole, monitor).nodes, std::move(serial), motion, isAffine);
}
}

TEST(DistributedMethods, AgreeWithTheSerialOnes)
{
  const Ranks ranks = pieces::world();
  for (auto& [name, whole] : meshes::all(4, 3, 3))
  {
    meshes::jitterInterior(whole, 0.1, 7);
    for (auto& [method, serial] : methods())
    {
      EXPECT_LT(difference(ranks, whole, std::move(serial), bend, false), 1e-9)
        << method << ", " << name;
    }
  }
}

TEST(DistributedMethods, AnswerToAffineHandlesAsOnOneProcess)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  Mesh whole = meshes::hexesAndPyramids(4, 3, 3);
  meshes::jitterInterior(whole, 0.1, 7);
  const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes;
  for (const auto& method : meshes::linearMethods())
  {
    SCOPED_TRACE(method.name);
    const int layers = morph::onProcesses(method.make())->layers();
    const DistributedMesh mesh = pieces::distribute(ranks, whole, layers, meshes::seed());
    const auto moved =
      [&](std::shared_ptr<const morph::UndeformedMesh> rest, const std::vector<Index>& ids)
    {
      const Points at = rest->mesh().points(ids, morph::allColumns);
      morph::Session::AffineHandle handle;
      handle.fields.resize(at.rows(), 4);
      for (Index i = 0; i < at.rows(); ++i)
      {
        const double weight = 1 / (1 + at(i, 0) * at(i, 0));
        handle.fields.row(i) << weight, weight * at.row(i);
      }
      handle.motion << 0.2, 0.1, 0, -0.1, -0.1, 0, 0.1, 0.1, 0.1, -0.1, 0, 0.2;
      morph::Session session;
      session.setMesh(std::move(rest));
      morph::Session::Options options;
      options.createMorpher = method.make;
      const Points targets = at + handle.fields * handle.motion.transpose();
      return session.morph({ ids, targets }, options, monitor, &handle)->moved;
    };
    const Points serial =
      moved(std::make_shared<const morph::UndeformedMesh>(whole, nullptr, monitor), outer);
    const Points own = moved(pieces::undeformed(mesh), pieces::localNodes(mesh, outer));
    EXPECT_LT(pieces::distance(mesh, own, serial), 1e-9);
  }
}

TEST(DistributedMethods, InterpolateEachBodyAlone)
{
  const Ranks ranks = pieces::world();
  Mesh above = meshes::tets(3, 3, 3);
  meshes::transform(
    above, [](const auto& x) { return Eigen::RowVector3d(x + Eigen::RowVector3d(0, 0, 4.01)); });
  const Mesh whole = shapes::together(meshes::hexes(4, 4, 4), above);
  Monitor monitor;
  const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes;
  for (auto& [name, method] : methods())
  {
    if (method->copyWithoutCells())
    {
      const Points target = bend(whole.points);
      Points expected, moved;
      morph::BodyByBody serial(method->copyWithoutCells());
      serial.prepare(whole, morph::partitionNodes(whole, outer), monitor);
      serial.evaluate(Points(target(outer, morph::allColumns)), expected, monitor);
      const pieces::OnRanks mine(
        ranks, whole, outer, morph::onProcesses(std::move(method)), meshes::seed(), monitor);
      mine.evaluate(target, moved, monitor);
      EXPECT_LT(pieces::distance(mine.mesh, moved, expected), 1e-9) << name;
    }
  }
}

TEST(DistributedMethods, AgreeFarFromANearlyFlatWall)
{
  // What is fitted to the wall's motion would move far nodes by its unevenness, multiplied out.
  const Ranks ranks = pieces::world();
  Mesh whole = meshes::hexes(5, 5, 5);
  std::vector<Index> wall;
  for (Index n = 0; n < whole.numberOfNodes(); ++n)
  {
    if (whole.points(n, 2) == 0)
    {
      whole.points(n, 2) = 1e-3 * std::sin(9. * static_cast<double>(n));
      wall.push_back(n);
    }
  }
  auto method = std::make_unique<morph::FemWarp>();
  method->setTolerance(1e-13);
  morph::CellStiffness stiffness;
  stiffness.kind = morph::CellStiffness::Kind::WallDistance;
  method->setStiffness(stiffness);
  EXPECT_LT(difference(ranks, whole, wall, std::move(method), bend, false), 1e-9);
}

TEST(DistributedMethods, ABodyThatMovesByLittleHasAsManyDigits)
{
  const Ranks ranks = pieces::world();
  const Mesh body = meshes::hexes(5, 5, 5);
  Mesh whole = body;
  const Index before = body.numberOfNodes();
  whole.points.conservativeResize(2 * before, 3);
  whole.points.bottomRows(before) = body.points.rowwise() + Eigen::RowVector3d(20, 0, 0);
  for (Index c = 0; c < body.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(body.cell(c), body.cell(c) + 8);
    for (Index& node : nodes)
    {
      node += before;
    }
    meshes::add(whole, morph::Hexahedron, nodes);
  }
  Monitor monitor;
  const double small = 1e-5;
  const std::vector<Index> outer = morph::boundaryFaces(whole, monitor).nodes,
                           ofOne = morph::boundaryFaces(body, monitor).nodes;
  Points target = bend(whole.points), expected;
  target.bottomRows(before) =
    whole.points.bottomRows(before) + small * (bend(body.points) - body.points);
  morph::FemWarp alone;
  alone.setTolerance(1e-13);
  alone.prepare(body, morph::partitionNodes(body, ofOne), monitor);
  alone.evaluate(Points(bend(body.points)(ofOne, morph::allColumns)), expected, monitor);
  const pieces::OnRanks mine(ranks, whole, outer,
    morph::onProcesses(std::make_unique<morph::FemWarp>()), meshes::seed(), monitor);
  Points moved;
  mine.evaluate(target, moved, monitor);
  double off = 0;
  for (Index n = 0; n < mine.mesh.mesh().numberOfNodes(); ++n)
  {
    const Index node = mine.mesh.nodeId(n) - before;
    if (node >= 0)
    {
      const Eigen::RowVector3d wanted = small * (expected.row(node) - body.points.row(node));
      off = std::max(off, (moved.row(n) - whole.points.row(node + before) - wanted).norm());
    }
  }
  EXPECT_LT(ranks.maximum(off), 1e-8 * small);
}

TEST(DistributedMethods, ReproduceAffineMotions)
{
  const Ranks ranks = pieces::world();
  for (auto& [name, whole] : meshes::all(4, 3, 3))
  {
    for (auto& [method, serial] : methods())
    {
      EXPECT_LT(difference(ranks, whole, std::move(serial), affine, true), 1e-12)
        << method << ", " << name;
    }
  }
}

TEST(DistributedMethods, NameABodyWithoutAPrescribedNode)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  Mesh whole = meshes::hexes(2, 2, 2);
  const Mesh other = meshes::hexes(2, 1, 1);
  const Index before = whole.numberOfNodes();
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    std::vector<Index> nodes(other.cell(c), other.cell(c) + 8);
    for (Index& node : nodes)
    {
      node += before;
    }
    meshes::add(whole, morph::Hexahedron, nodes);
  }
  whole.points.conservativeResize(before + other.numberOfNodes(), 3);
  whole.points.bottomRows(other.numberOfNodes()) = other.points.array() + 10;
  const DistributedMesh mesh(ranks,
    pieces::pieceOf(whole, pieces::randomOwners(whole, ranks.count(), 3), ranks.rank()), 1,
    monitor);
  std::vector<Index> prescribed;
  for (Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
  {
    if (mesh.nodeId(n) < 9)
    {
      prescribed.push_back(n);
    }
  }
  const auto method = morph::onProcesses(std::make_unique<morph::FemWarp>());
  const std::string message = pieces::messageOf(
    [&]
    {
      method->prepare(mesh.mesh(), morph::partitionNodes(mesh.mesh(), prescribed), monitor,
        std::make_shared<morph::distributed::RankCommunicator>(mesh));
    });
  EXPECT_NE(
    message.find("(2 cells, the first is cell 8) has no prescribed node"), std::string::npos)
    << message;
}

TEST(HypreSolver, RefusesMoreUnknownsThanItsIntegersNumber)
{
  const Ranks ranks = pieces::world();
  constexpr std::int64_t TooMany = std::int64_t(1) << 31;
  if (HypreSolver::mostUnknowns() >= TooMany)
  {
    GTEST_SKIP() << "this hypre has integers of 64 bits";
  }
  // The sum counts, not what a rank has.
  const auto shareOf = [&](std::int64_t all)
  {
    const std::int64_t equal = all / ranks.count();
    return ranks.rank() == 0 ? all - (ranks.count() - 1) * equal : equal;
  };
  EXPECT_EQ(HypreSolver::countUnknowns(ranks, shareOf(TooMany - 1)), TooMany - 1);
  EXPECT_EQ(pieces::messageOf([&] { HypreSolver::countUnknowns(ranks, shareOf(TooMany)); }),
    "The mesh has 2147483648 free nodes; this build of hypre numbers 2147483647. Build with a "
    "hypre of 64-bit integers (libhypre64m-dev).");
}
