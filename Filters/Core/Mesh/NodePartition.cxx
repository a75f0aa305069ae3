// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NodePartition.h"

#include "Geometry/PointOrders.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"

#include <algorithm>

namespace morph
{
NodePartition partitionNodes(const Mesh& mesh, std::vector<Index> prescribed)
{
  const Index nodes = mesh.numberOfNodes();
  std::sort(prescribed.begin(), prescribed.end());
  std::vector<Index> wrong, twice;
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    if (prescribed[i] < 0 || prescribed[i] >= nodes)
    {
      wrong.push_back(prescribed[i]);
    }
    else if (i > 0 && prescribed[i] == prescribed[i - 1])
    {
      twice.push_back(prescribed[i]);
    }
  }
  if (!wrong.empty())
  {
    throw Error("Prescribed node ids outside 0 to " + std::to_string(nodes - 1) + ": " +
                listIds(wrong) + ".");
  }
  if (!twice.empty())
  {
    throw Error("Node ids prescribed more than once: " + listIds(twice) + ".");
  }

  enum : std::uint8_t
  {
    Unused,
    Follower,
    Free,
    Prescribed
  };
  std::vector<std::uint8_t> role(nodes, Unused);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(mesh, c);
    if (!shape || shape->dimension != 3)
    {
      continue;
    }
    const Index corners = cornerCount(mesh, c, *shape);
    for (Index k = 0; k < mesh.cellSize(c); ++k)
    {
      std::uint8_t& r = role[mesh.cell(c)[k]];
      r = std::max<std::uint8_t>(r, k < corners ? Free : Follower);
    }
  }
  for (Index id : prescribed)
  {
    role[id] = Prescribed;
  }

  NodePartition partition;
  partition.prescribed = std::move(prescribed);
  for (Index n = 0; n < nodes; ++n)
  {
    if (role[n] == Free)
    {
      partition.free.push_back(n);
    }
    else if (role[n] == Follower)
    {
      partition.higherOrderNodes.push_back(n);
    }
  }
  return partition;
}

void requirePrescribedBodies(
  const ConnectedComponents& parts, const NodePartition& partition, const Communicator& processes)
{
  std::vector<double> held(parts.count, 0);
  for (Index id : partition.prescribed)
  {
    if (parts.ofNode[id] >= 0)
    {
      held[parts.ofNode[id]] = 1;
    }
  }
  processes.sum(held.data(), static_cast<int>(parts.count));
  const Index body = std::find(held.begin(), held.end(), 0) - held.begin();
  if (body == parts.count)
  {
    return;
  }
  std::vector<Index> cells;
  for (std::size_t c = 0; c < parts.ofCell.size(); ++c)
  {
    if (parts.ofCell[c] == body)
    {
      cells.push_back(static_cast<Index>(c));
    }
  }
  cells = processes.gatherCells(cells);
  throw Error(Error::Kind::Singular,
    "Body " + std::to_string(body) + " (" + std::to_string(cells.size()) +
      " cells, the first is cell " + std::to_string(cells.front()) +
      ") has no prescribed node, so nothing says where it goes. Prescribe at least one of its "
      "nodes, or remove it from the grid.");
}

std::vector<Index> unknownOrdering(const Mesh& mesh, const std::vector<Index>& free)
{
  constexpr Index Small = 10000; // fits a cache in any order
  // mean span of a cell, as a share of all ids, that counts as far
  constexpr double FarShare = 1. / 16;
  if (static_cast<Index>(free.size()) <= Small)
  {
    return free;
  }
  const Index cells = mesh.numberOfCells();
  double spans = 0;
  Index count = 0;
  for (Index c = 0; c < cells; ++c)
  {
    const int n = numberOfCorners(cellShape(mesh, c)->shape);
    if (n > 0)
    {
      const auto range = std::minmax_element(mesh.cell(c), mesh.cell(c) + n);
      spans += static_cast<double>(*range.second - *range.first);
      ++count;
    }
  }
  const bool far = spans > FarShare * static_cast<double>(count) * mesh.numberOfNodes();
  return far ? spatialOrder(mesh.points, free) : free;
}

Index indexInFree(const std::vector<Index>& rows, const std::vector<Index>& free, Index row)
{
  if (rows[row] == free[row])
  {
    return row;
  }
  return std::lower_bound(free.begin(), free.end(), rows[row]) - free.begin();
}
}
