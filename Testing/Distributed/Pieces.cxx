// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Distributed/RankCommunicator.h"
#include "Mesh/Polyhedra.h"
#include "Meshes.h"
#include "Support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace pieces
{
morph::distributed::Ranks world()
{
  return morph::distributed::Ranks(MPI_COMM_WORLD);
}

std::vector<int> randomOwners(const morph::Mesh& mesh, int ranks, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> rank(0, ranks - 1);
  std::vector<int> owners(mesh.numberOfCells());
  for (int& owner : owners)
  {
    owner = rank(random);
  }
  return owners;
}

morph::distributed::Piece pieceOf(const morph::Mesh& mesh, const std::vector<int>& owners, int rank)
{
  morph::distributed::Piece piece;
  std::vector<morph::Index> local(mesh.numberOfNodes(), -1);
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (owners[c] != rank)
    {
      continue;
    }
    for (morph::Index k = 0; k < mesh.cellSize(c); ++k)
    {
      const morph::Index node = mesh.cell(c)[k];
      if (local[node] < 0)
      {
        local[node] = static_cast<morph::Index>(piece.nodeIds.size());
        piece.nodeIds.push_back(node);
      }
      piece.mesh.connectivity.push_back(local[node]);
    }
    if (morph::hasPolyhedra(mesh))
    {
      piece.mesh.faceOffsets.resize(piece.mesh.types.size() + 1, 0);
      morph::forEachFace(mesh, c,
        [&](const morph::Index* nodes, morph::Index size)
        {
          piece.mesh.faces.push_back(size);
          for (morph::Index k = 0; k < size; ++k)
          {
            piece.mesh.faces.push_back(local[nodes[k]]);
          }
        });
      piece.mesh.faceOffsets.push_back(static_cast<morph::Index>(piece.mesh.faces.size()));
    }
    piece.mesh.types.push_back(mesh.types[c]);
    piece.mesh.offsets.push_back(static_cast<morph::Index>(piece.mesh.connectivity.size()));
    piece.cellIds.push_back(c);
  }
  piece.mesh.points = mesh.points(piece.nodeIds, morph::allColumns);
  return piece;
}

morph::distributed::DistributedMesh distribute(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole, int layers, unsigned seed)
{
  morph::Monitor monitor;
  return { ranks, pieceOf(whole, randomOwners(whole, ranks.count(), seed), ranks.rank()), layers,
    monitor };
}

std::shared_ptr<const morph::UndeformedMesh> undeformed(
  const morph::distributed::DistributedMesh& mesh)
{
  morph::Monitor monitor;
  return morph::distributed::undeformedMesh(
    std::shared_ptr<const morph::distributed::DistributedMesh>(&mesh, [](const auto*) {}), monitor);
}

std::vector<morph::Index> localNodes(
  const morph::distributed::DistributedMesh& mesh, const std::vector<morph::Index>& ids)
{
  std::vector<morph::Index> nodes;
  for (morph::Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
  {
    if (std::binary_search(ids.begin(), ids.end(), mesh.nodeId(n)))
    {
      nodes.push_back(n);
    }
  }
  return nodes;
}

morph::Points gathered(const morph::distributed::DistributedMesh& mesh, const morph::Points& moved)
{
  struct Placed
  {
    morph::Index node;
    double x[3];
  };
  std::vector<Placed> placed;
  for (morph::Index n = 0; n < moved.rows(); ++n)
  {
    if (mesh.owns(n))
    {
      placed.push_back({ mesh.nodeId(n), { moved(n, 0), moved(n, 1), moved(n, 2) } });
    }
  }
  placed = mesh.ranks().gather(placed);
  morph::Points all(static_cast<morph::Index>(placed.size()), 3);
  for (const Placed& one : placed)
  {
    all.row(one.node) << one.x[0], one.x[1], one.x[2];
  }
  double apart = 0;
  for (morph::Index n = 0; n < moved.rows(); ++n)
  {
    apart = std::max(apart, (moved.row(n) - all.row(mesh.nodeId(n))).norm());
  }
  EXPECT_EQ(apart, 0);
  return all;
}

double distance(const morph::distributed::DistributedMesh& mesh, const morph::Points& moved,
  const morph::Points& expected)
{
  double largest = 0;
  for (morph::Index n = 0; n < mesh.mesh().numberOfNodes(); ++n)
  {
    largest = std::max(largest, (moved.row(n) - expected.row(mesh.nodeId(n))).norm());
  }
  return mesh.ranks().maximum(largest);
}

OnRanks::OnRanks(const morph::distributed::Ranks& ranks, const morph::Mesh& whole,
  const std::vector<morph::Index>& outer, std::unique_ptr<morph::Morpher> unprepared, unsigned seed,
  morph::Monitor& monitor)
  : mesh(distribute(ranks, whole, unprepared->layers(), seed))
  , method(std::move(unprepared))
  , prescribed(localNodes(this->mesh, outer))
{
  this->method->prepare(this->mesh.mesh(),
    morph::partitionNodes(this->mesh.mesh(), this->prescribed), monitor,
    std::make_shared<morph::distributed::RankCommunicator>(this->mesh));
}

morph::EvaluateReport OnRanks::evaluate(
  const morph::Points& target, morph::Points& moved, morph::Monitor& monitor) const
{
  return this->method->evaluate(
    meshes::rows(target, this->mesh.idsOfNodes(this->prescribed)), moved, monitor);
}

void OnRanks::expectCancelled(const morph::Points& target, double at) const
{
  const morph::distributed::Ranks& ranks = this->mesh.ranks();
  meshes::ThreadedMonitor monitor;
  if (ranks.rank() == ranks.count() - 1)
  {
    monitor.cancelAt = at;
  }
  bool isCancelled = false;
  try
  {
    morph::Points moved;
    this->evaluate(target, moved, monitor);
  }
  catch (const morph::Error& error)
  {
    isCancelled = error.kind() == morph::Error::Kind::Cancelled;
  }
  EXPECT_TRUE(isCancelled) << at;
}

std::string messageOf(const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const morph::Error& error)
  {
    return error.what();
  }
  return "";
}
}
