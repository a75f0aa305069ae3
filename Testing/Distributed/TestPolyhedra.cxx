// SPDX-License-Identifier: BSD-3-Clause
// Linear methods on meshes with polyhedra, against the serial methods on the whole mesh.
#include "Distributed/CutMesh.h"
#include "Distributed/RankCommunicator.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/WeightedResidual.h"
#include "Mesh/PolyhedronPieces.h"
#include "Mesh/Topology.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Morpher/SiteMethod.h"
#include "Pieces.h"
#include "PolyhedralMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace
{
using namespace morph;
using morph::distributed::CutMesh;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

using Make = std::function<std::unique_ptr<Morpher>()>;

std::vector<std::pair<std::string, Make>> methods()
{
  return {
    { "FEMWARP",
      []() -> std::unique_ptr<Morpher>
      {
        auto method = std::make_unique<morph::FemWarp>();
        method->setTolerance(1e-13);
        return method;
      } },
    { "stiff FEMWARP",
      []() -> std::unique_ptr<Morpher>
      {
        auto method = std::make_unique<morph::FemWarp>();
        method->setTolerance(1e-13);
        morph::CellStiffness stiffness;
        stiffness.kind = morph::CellStiffness::Kind::WallDistance;
        method->setStiffness(stiffness);
        return method;
      } },
    { "LBWARP",
      []() -> std::unique_ptr<Morpher>
      {
        auto method = std::make_unique<morph::LogBarrierWarp>();
        method->setTolerance(1e-13);
        return method;
      } },
    { "weighted residual", [] { return std::make_unique<morph::WeightedResidual>(); } },
    { "simplex-linear", [] { return std::make_unique<morph::SimplexLinear>(); } },
    { "radial basis", [] { return std::make_unique<morph::RadialBasis>(); } },
  };
}

Points bend(const Points& x)
{
  Points moved = x;
  moved.col(1).array() += 0.1 * (x.col(0).array()).sin();
  moved.col(2).array() += 0.05 * x.col(0).array() * x.col(1).array();
  return moved;
}

Points affine(const Points& x)
{
  Eigen::Matrix3d map;
  map << 1.2, 0.3, 0, -0.2, 0.9, 0.1, 0.1, 0, 1.1;
  return (x * map).rowwise() + Eigen::RowVector3d(0.5, -1, 2);
}

std::unique_ptr<Morpher> onPieces(std::unique_ptr<Morpher> serial)
{
  return morph::morpherForPolyhedra(morph::onProcesses(std::move(serial)));
}

std::vector<Index> outerNodes(const Mesh& mesh)
{
  Monitor monitor;
  return morph::boundaryFaces(mesh, monitor).nodes;
}
}

TEST(DistributedPolyhedra, MoveAsOnOneRank)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  unsigned seed = meshes::seed();
  for (const auto& [name, whole] : meshes::polyhedral())
  {
    const std::vector<Index> outer = outerNodes(whole);
    for (const auto& [method, make] : methods())
    {
      SCOPED_TRACE(method + ", " + name);
      auto serial = morph::morpherForPolyhedra(make());
      serial->prepare(whole, morph::partitionNodes(whole, outer), monitor);
      const pieces::OnRanks mine(ranks, whole, outer, onPieces(make()), ++seed, monitor);
      for (const bool isAffine : { false, true })
      {
        const Points target = (isAffine ? affine : bend)(whole.points);
        Points expected = target, moved;
        if (!isAffine)
        {
          serial->evaluate(Points(target(outer, morph::allColumns)), expected, monitor);
        }
        mine.evaluate(target, moved, monitor);
        EXPECT_LT(pieces::distance(mine.mesh, moved, expected) / meshes::size(whole.points),
          isAffine ? 1e-10 : 1e-9);
      }
    }
  }
}

TEST(DistributedPolyhedra, HaveTheAdjointOfOneRank)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  unsigned seed = meshes::seed() + 100;
  for (const auto& [name, whole] : meshes::polyhedral())
  {
    const std::vector<Index> outer = outerNodes(whole);
    const Points gradient = (3 * whole.points.array()).sin();
    for (const auto& [method, make] : methods())
    {
      SCOPED_TRACE(method + ", " + name);
      auto serial = morph::morpherForPolyhedra(make());
      serial->prepare(whole, morph::partitionNodes(whole, outer), monitor);
      Points expected, found;
      dynamic_cast<morph::LinearMorpher&>(*serial).applyTranspose(gradient, expected, monitor);
      const pieces::OnRanks mine(ranks, whole, outer, onPieces(make()), ++seed, monitor);
      dynamic_cast<morph::LinearMorpher&>(*mine.method)
        .applyTranspose(gradient(mine.mesh.nodeIds(), morph::allColumns), found, monitor);
      for (std::size_t k = 0; k < mine.prescribed.size(); ++k)
      {
        if (mine.mesh.owns(mine.prescribed[k]))
        {
          const Index id = mine.mesh.nodeId(mine.prescribed[k]);
          const Index row = std::lower_bound(outer.begin(), outer.end(), id) - outer.begin();
          EXPECT_LT(
            (found.row(static_cast<Index>(k)) - expected.row(row)).norm(), 1e-9 * expected.norm());
        }
      }
    }
  }
}

TEST(DistributedPolyhedra, MoveWhereARankHasNoCells)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  const Mesh whole = meshes::honeycomb(4);
  const std::vector<Index> outer = outerNodes(whole);
  const std::vector<int> owners =
    pieces::randomOwners(whole, std::max(1, ranks.count() - 1), meshes::seed() + 300);
  const DistributedMesh mesh(ranks, pieces::pieceOf(whole, owners, ranks.rank()), 1, monitor);
  const std::vector<Index> prescribed = pieces::localNodes(mesh, outer);
  for (const auto& [name, make] : methods())
  {
    SCOPED_TRACE(name);
    const std::unique_ptr<Morpher> method = onPieces(make());
    method->prepare(mesh.mesh(), morph::partitionNodes(mesh.mesh(), prescribed), monitor,
      std::make_shared<morph::distributed::RankCommunicator>(mesh));
    const Points target = affine(mesh.mesh().points);
    Points moved;
    method->evaluate(target(prescribed, morph::allColumns), moved, monitor);
    EXPECT_LT(
      pieces::distance(mesh, moved, affine(whole.points)), 1e-10 * meshes::size(whole.points));
  }
}

TEST(DistributedPolyhedra, AreCutIntoThePiecesOfOneRank)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  unsigned seed = meshes::seed() + 200;
  for (const auto& [name, whole] : meshes::polyhedral())
  {
    SCOPED_TRACE(name);
    const morph::PolyhedronPieces expected(whole, monitor);
    const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, ++seed);
    const CutMesh cut(mesh, mesh.mesh(), 1, monitor);
    const DistributedMesh& found = cut.pieces();
    Index cells = 0, nodes = 0;
    for (Index c = 0; c < found.pieceCells(); ++c)
    {
      cells += found.isGhost()[c] == 0;
    }
    for (Index n = 0; n < found.mesh().numberOfNodes(); ++n)
    {
      nodes += found.owns(n);
    }
    EXPECT_EQ(ranks.sum(cells), expected.mesh().numberOfCells());
    EXPECT_EQ(ranks.sum(nodes), expected.mesh().numberOfNodes());
    EXPECT_EQ(found.bodies().count, morph::connectedComponents(whole).count);
    // No face between two ranks is an outer one: they conform.
    EXPECT_EQ(ranks.sum(static_cast<Index>(pieces::undeformed(found)->outerFaces().cells.size())),
      static_cast<Index>(morph::boundaryFaces(expected.mesh(), monitor).cells.size()));
  }
}
