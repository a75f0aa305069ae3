// SPDX-License-Identifier: BSD-3-Clause
// What code of one mesh is told on ranks, against the same of the whole mesh.
#include "Distributed/RankCommunicator.h"
#include "Mesh/OwnCells.h"
#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Pieces.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace
{
using namespace morph;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

struct Case
{
  explicit Case(const Ranks& ranks)
    : whole(meshes::hexesAndPyramids(5, 4, 3))
    , mesh(pieces::distribute(ranks, whole, 1, meshes::seed()))
    , processes(mesh)
    , own(mesh.mesh(), morph::partitionNodes(mesh.mesh(), pieces::localNodes(mesh, { 0, 1, 2 })),
        mesh.orientation(), processes)
  {
  }

  /// The whole mesh's node.
  Index id(Index node) const { return this->mesh.nodeId(this->own.nodes()[node]); }

  morph::Mesh whole;
  DistributedMesh mesh;
  morph::distributed::RankCommunicator processes;
  OwnCells own;
};
}

TEST(RankCommunicator, SumsTheCopiesOfRows)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  Monitor monitor;
  // Each cell adds to its corners; then a row is what all cells around its node give.
  const auto give = [](const morph::Mesh& mesh, const auto& nameOf)
  {
    Points sums = Points::Zero(mesh.numberOfNodes(), 3);
    for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
    {
      double all = 0;
      for (Index k = 0; k < mesh.cellSize(cell); ++k)
      {
        all += static_cast<double>(nameOf(mesh.cell(cell)[k]));
      }
      for (Index k = 0; k < mesh.cellSize(cell); ++k)
      {
        sums.row(mesh.cell(cell)[k]) += Eigen::RowVector3d(1, all, all * all);
      }
    }
    return sums;
  };
  const Points expected = give(c.whole, [](Index node) { return node; });
  const Points local = give(c.own.mesh(), [&](Index node) { return c.id(node); });
  std::vector<Index> nodes(local.rows()), back(local.rows());
  std::iota(nodes.rbegin(), nodes.rend(), Index(0)); // rows in another order than nodes
  Points rows = local(nodes, morph::allColumns);
  double product = 0;
  c.own.communicator().together(
    [&]
    {
      const auto copies = c.own.communicator().rows(nodes);
      copies->add(rows);
      product = copies->dot(rows, rows, monitor);
    });
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    EXPECT_EQ(rows.row(static_cast<Index>(i)), expected.row(c.id(nodes[i])));
  }
  EXPECT_NEAR(product, expected.squaredNorm(), 1e-12 * expected.squaredNorm());
}

TEST(RankCommunicator, RowsThatTheirOwnerDoesNotHaveCountOnce)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  Monitor monitor;
  std::vector<Index> nodes; // none on the first rank, which owns all that it uses
  if (ranks.rank() > 0)
  {
    nodes.resize(c.own.nodes().size());
    std::iota(nodes.begin(), nodes.end(), Index(0));
  }
  Points ones = Points::Ones(static_cast<Index>(nodes.size()), 3);
  double product = 0;
  c.own.communicator().together(
    [&]
    {
      const auto copies = c.own.communicator().rows(nodes);
      product = copies->dot(ones, ones, monitor);
      copies->add(ones);
    });
  std::vector<Index> ids;
  for (const Index node : nodes)
  {
    ids.push_back(c.id(node));
  }
  ids = ranks.gather(ids);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    EXPECT_EQ(ones(static_cast<Index>(i), 1), std::count(ids.begin(), ids.end(), c.id(nodes[i])));
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  EXPECT_EQ(product, 3. * static_cast<double>(ids.size()));
}

TEST(RankCommunicator, RingsOfCellsCrossInterfaces)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  std::vector<Index> all(c.whole.numberOfNodes());
  std::iota(all.begin(), all.end(), Index(0));
  for (const int rings : { 0, 1, 2 })
  {
    const morph::KRing expected =
      morph::kRingOfCells(c.whole, morph::nodeToCells(c.whole), all, { 7 }, rings);
    morph::KRing mine;
    c.own.communicator().together(
      [&]
      {
        std::vector<Index> seeds, free(c.own.nodes().size());
        std::iota(free.begin(), free.end(), Index(0));
        for (Index cell = 0; cell < c.mesh.pieceCells(); ++cell)
        {
          if (c.mesh.cellId(cell) == 7)
          {
            seeds.push_back(cell);
          }
        }
        mine = morph::kRingOfCells(
          c.own.mesh(), morph::nodeToCells(c.own.mesh()), free, seeds, rings, c.own.communicator());
      });
    EXPECT_EQ(c.own.gatherIds(mine.cells), expected.cells);
    for (const Index node : mine.nodes)
    {
      EXPECT_TRUE(std::binary_search(expected.nodes.begin(), expected.nodes.end(), c.id(node)));
    }
  }
}

TEST(RankCommunicator, AFailureOfOneRankEndsAllWithItsMessage)
{
  const Ranks ranks = pieces::world();
  Case c(ranks);
  for (const int steps : { 0, 1, 5 })
  {
    const std::string message = pieces::messageOf(
      [&]
      {
        c.own.communicator().together(
          [&]
          {
            std::vector<Index> nodes = { 0 };
            const auto copies = c.own.communicator().rows(nodes);
            Points row = Points::Ones(1, 3);
            for (int step = 0; step < 6; ++step)
            {
              if (step == steps && ranks.rank() == ranks.count() - 1)
              {
                throw morph::Error("the last rank gives up");
              }
              copies->add(row);
              c.own.communicator().minimum(1.);
              c.own.communicator().spread(nodes);
            }
          });
      });
    EXPECT_EQ(message, "the last rank gives up");
  }
  double sum = 0; // and it works again
  c.own.communicator().together([&] { sum = c.own.communicator().sum(1.); });
  EXPECT_EQ(sum, ranks.count());
}
