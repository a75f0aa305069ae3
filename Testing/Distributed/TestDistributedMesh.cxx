// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/WholeBoundary.h"
#include "Distributed/DistributedMesh.h"
#include "Distributed/RankCommunicator.h"
#include "Mesh/CellShape.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Pieces.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::Piece;
using morph::distributed::Ranks;
}

TEST(Ranks, AnErrorOnOneRankIsThrownOnAllWithTheSameMessage)
{
  const Ranks ranks = pieces::world();
  const int last = ranks.count() - 1;
  const std::string message = pieces::messageOf(
    [&]
    {
      ranks.together(
        [&]
        {
          if (ranks.rank() == last)
          {
            throw morph::Error("rank " + std::to_string(ranks.rank()) + " says no");
          }
        });
    });
  EXPECT_EQ(message, "rank " + std::to_string(last) + " says no");
}

TEST(DistributedMesh, TakesIdsBeyond32Bits)
{
  const Ranks ranks = pieces::world();
  const Mesh whole = meshes::hexes(4, 3, 3);
  constexpr std::int64_t Far = std::int64_t(1) << 40;
  Monitor monitor;
  const auto far = [&](std::int64_t by)
  {
    Piece piece = pieces::pieceOf(
      whole, pieces::randomOwners(whole, ranks.count(), meshes::seed()), ranks.rank());
    for (std::vector<std::int64_t>* ids : { &piece.nodeIds, &piece.cellIds })
    {
      for (std::int64_t& id : *ids)
      {
        id += by;
      }
    }
    return piece;
  };
  const DistributedMesh mesh(ranks, far(Far), 1, monitor);
  Index owned = 0;
  for (Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
  {
    owned += mesh.owns(n);
    ASSERT_GE(mesh.nodeId(n), Far);
    EXPECT_EQ(mesh.mesh().points.row(n), whole.points.row(mesh.nodeId(n) - Far));
  }
  EXPECT_EQ(ranks.sum(owned), whole.numberOfNodes());
  const std::string message =
    pieces::messageOf([&] { DistributedMesh(ranks, far(std::int64_t(1) << 52), 1, monitor); });
  EXPECT_NE(message.find("2^52"), std::string::npos) << message;
}

TEST(DistributedMesh, OwnsEachNodeOnceAndHasAllCellsAroundItsNodes)
{
  const Ranks ranks = pieces::world();
  for (const auto& [name, whole] : meshes::all(4, 3, 3))
  {
    for (int layers : { 1, 2 })
    {
      const DistributedMesh mesh = pieces::distribute(ranks, whole, layers, meshes::seed());
      Index owned = 0;
      for (Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
      {
        owned += mesh.owns(n);
        EXPECT_EQ(mesh.mesh().points.row(n), whole.points.row(mesh.nodeId(n)));
      }
      EXPECT_EQ(ranks.sum(owned), whole.numberOfNodes()) << name;
      const morph::Adjacency here = morph::nodeToCells(mesh.mesh());
      const morph::Adjacency all = morph::nodeToCells(whole);
      for (Index n = 0; n < mesh.pieceNodes(); ++n)
      {
        const Index id = mesh.nodeId(n);
        EXPECT_EQ(here.end(n) - here.begin(n), all.end(id) - all.begin(id)) << name;
      }
      std::set<std::int64_t> cells(mesh.cellIds().begin(), mesh.cellIds().end());
      EXPECT_EQ(cells.size(), mesh.cellIds().size()) << name;
    }
  }
}

TEST(DistributedMesh, OfACellThatTwoRanksHaveTheOneWithTheLowestIdCounts)
{
  const Ranks ranks = pieces::world();
  const Mesh once = meshes::hexes(4, 3, 3);
  const Index cell = 17, copy = once.numberOfCells();
  Mesh whole = once;
  const Index* n = once.cell(cell);
  meshes::add(whole, morph::Hexahedron, { n[1], n[2], n[3], n[0], n[5], n[6], n[7], n[4] });
  std::vector<int> owners = pieces::randomOwners(whole, ranks.count(), meshes::seed());
  owners[cell] = ranks.count() - 1;
  owners[copy] = 0;
  Monitor monitor;

  const DistributedMesh mesh(ranks, pieces::pieceOf(whole, owners, ranks.rank()), 1, monitor);

  const auto rest = pieces::undeformed(mesh);
  EXPECT_EQ(rest->repeatedCells(), (std::vector<Index>{ cell, copy }));
  EXPECT_EQ(ranks.sum(static_cast<Index>(rest->outerFaces().cells.size())),
    static_cast<Index>(morph::boundaryFaces(once, monitor).cells.size()));
  for (Index c = 0; c < mesh.mesh().numberOfCells(); ++c)
  {
    EXPECT_EQ(mesh.mesh().types[c] == morph::PolyVertex, mesh.cellId(c) == copy);
  }
}

TEST(DistributedMesh, HasTheOuterFacesBodiesAndOrientationOfTheWhole)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  for (auto& [name, whole] : meshes::all(4, 3, 3))
  {
    meshes::transform(
      whole, [](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(-x[0], x[1], 2 * x[2]); });
    const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, meshes::seed());
    const auto rest = pieces::undeformed(mesh);
    const morph::BoundaryFaces faces = morph::boundaryFaces(whole, monitor);
    EXPECT_EQ(ranks.sum(static_cast<Index>(rest->outerFaces().cells.size())),
      static_cast<Index>(faces.cells.size()))
      << name;
    for (Index node : rest->outerNodes().nodes)
    {
      EXPECT_TRUE(std::binary_search(faces.nodes.begin(), faces.nodes.end(), mesh.nodeId(node)))
        << name;
    }
    const morph::ConnectedComponents bodies = morph::connectedComponents(whole);
    EXPECT_EQ(mesh.bodies().count, bodies.count) << name;
    const std::vector<std::int8_t> signs = morph::cellSigns(whole, bodies);
    for (Index c = 0; c < mesh.mesh().numberOfCells(); ++c)
    {
      EXPECT_EQ(mesh.orientation()[c], signs[mesh.cellId(c)]) << name;
    }
    EXPECT_NEAR(mesh.size(), meshes::size(whole.points), 1e-12);

    const morph::Quality quality = morph::measureQuality(whole, whole.points, signs, {}, monitor);
    const morph::Quality reduced =
      morph::ofAll(morph::measureQuality(
                     mesh.mesh(), mesh.mesh().points, mesh.orientation(), mesh.isGhost(), monitor),
        morph::distributed::RankCommunicator(mesh));
    EXPECT_EQ(reduced.minimum, quality.minimum) << name;
    EXPECT_NEAR(reduced.mean, quality.mean, 1e-12) << name;
    EXPECT_EQ(reduced.measured, quality.measured) << name;
    EXPECT_EQ(reduced.inverted, quality.inverted) << name;
    EXPECT_EQ(reduced.worstCell, quality.worstCell) << name;
  }
}

TEST(DistributedMesh, HasTheOrientationOfTangledCellsOfSeveralShapes)
{
  const Ranks ranks = pieces::world();
  for (unsigned seed = meshes::seed(); seed < meshes::seed() + 10; ++seed)
  {
    Mesh whole = meshes::hexesAndWedges(4, 4, 4);
    for (Index c = 0; c < whole.numberOfCells(); ++c)
    {
      Index* node = whole.connectivity.data() + whole.offsets[c];
      if (whole.types[c] == morph::Wedge)
      {
        std::swap_ranges(node, node + 3, node + 3);
      }
    }
    meshes::jitterInterior(whole, 2, seed);
    const std::vector<std::int8_t> signs =
      morph::cellSigns(whole, morph::connectedComponents(whole));

    const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, seed);

    for (Index c = 0; c < mesh.mesh().numberOfCells(); ++c)
    {
      EXPECT_EQ(int(mesh.orientation()[c]), int(signs[mesh.cellId(c)])) << c;
    }
  }
}

TEST(DistributedMesh, HasTheBoundaryOfOneProcessOnEachRank)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  for (const auto& [name, whole] : meshes::all(4, 3, 3))
  {
    const DistributedMesh mesh = pieces::distribute(ranks, whole, 1, meshes::seed());
    const morph::distributed::RankCommunicator processes(mesh);
    const morph::WholeBoundary mine(
      mesh.mesh(), pieces::undeformed(mesh)->outerFaces(), mesh.orientation(), processes);
    const morph::WholeBoundary serial(whole, morph::boundaryFaces(whole, monitor),
      morph::cellSigns(whole, morph::connectedComponents(whole)), morph::Communicator::alone());
    EXPECT_EQ(mine.cells(), serial.cells()) << name;
    EXPECT_EQ(mine.nodes(), serial.nodes()) << name;
    EXPECT_EQ(mine.orientation(), serial.orientation()) << name;
    EXPECT_EQ(mine.faces().sides, serial.faces().sides) << name;
    EXPECT_EQ(mine.faces().connectivity, serial.faces().connectivity) << name;
    const morph::Adjacency &own = mine.faces().between, &between = serial.faces().between;
    ASSERT_EQ(own.offsets, between.offsets) << name;
    for (Index n = 0; n < mine.rest().rows(); ++n)
    {
      EXPECT_TRUE(std::is_permutation(own.begin(n), own.end(n), between.begin(n))) << name;
    }
    EXPECT_EQ(mine.rest(), serial.rest()) << name;
    EXPECT_EQ(mine.gather(2 * mesh.mesh().points), 2 * serial.rest()) << name;
  }
}

TEST(DistributedMesh, MakesIdsByPosition)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  const Mesh whole = meshes::tets(4, 3, 3);
  Piece piece = pieces::pieceOf(
    whole, pieces::randomOwners(whole, ranks.count(), meshes::seed()), ranks.rank());
  const std::vector<std::int64_t> ids = piece.nodeIds;
  piece.nodeIds.clear();
  piece.cellIds.clear();
  morph::distributed::requireNodeIds(ranks, piece);
  morph::distributed::requireCellIds(ranks, piece);
  // Made and given ids tell the same nodes apart.
  using Pair = std::array<std::int64_t, 2>;
  std::vector<Pair> pairs;
  for (std::size_t n = 0; n < ids.size(); ++n)
  {
    pairs.push_back({ piece.nodeIds[n], ids[n] });
  }
  pairs = ranks.gather(pairs);
  const std::set<Pair> distinct(pairs.begin(), pairs.end());
  EXPECT_EQ(static_cast<Index>(distinct.size()), whole.numberOfNodes());
  EXPECT_EQ(distinct.rbegin()->front(), whole.numberOfNodes() - 1);
  std::vector<std::int64_t> cells = ranks.gather(piece.cellIds);
  std::sort(cells.begin(), cells.end());
  EXPECT_EQ(static_cast<Index>(cells.size()), whole.numberOfCells());
  EXPECT_EQ(cells.back(), whole.numberOfCells() - 1);
}

TEST(DistributedMesh, RefusesIdsThatDoNotFit)
{
  const Ranks ranks = pieces::world();
  Monitor monitor;
  const Mesh whole = meshes::hexes(3, 3, 3);
  if (ranks.count() < 2)
  {
    GTEST_SKIP() << "needs several ranks";
  }
  const std::vector<int> owners = pieces::randomOwners(whole, ranks.count(), 5);
  const auto build = [&](const std::function<void(Piece&)>& spoil)
  {
    Piece piece = pieces::pieceOf(whole, owners, ranks.rank());
    spoil(piece);
    return pieces::messageOf(
      [&]
      {
        morph::distributed::requireNodeIds(ranks, piece);
        DistributedMesh(ranks, piece, 1, monitor);
      });
  };
  const bool isLast = ranks.rank() == ranks.count() - 1;
  EXPECT_NE(build(
              [&](Piece& piece)
              {
                if (isLast)
                {
                  piece.mesh.points.col(0).array() += 0.5;
                }
              })
              .find("different positions"),
    std::string::npos);
  EXPECT_NE(build(
              [&](Piece& piece)
              {
                if (isLast)
                {
                  piece.nodeIds[0] = piece.nodeIds[1];
                }
              })
              .find("same global point id"),
    std::string::npos);
  EXPECT_NE(build(
              [&](Piece& piece)
              {
                if (isLast)
                {
                  piece.nodeIds.clear();
                }
              })
              .find("Global point ids are on"),
    std::string::npos);
  EXPECT_NE(build(
              [&](Piece& piece)
              {
                // Two inner nodes, which all ranks have.
                for (std::size_t n = 0; n < piece.nodeIds.size(); ++n)
                {
                  if (piece.nodeIds[n] == 22)
                  {
                    piece.mesh.points.row(static_cast<Index>(n)) = whole.points.row(21);
                  }
                }
                piece.nodeIds.clear();
              })
              .find("positions do not tell"),
    std::string::npos);
}
