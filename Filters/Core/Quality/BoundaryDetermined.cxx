// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/BoundaryDetermined.h"

#include "Geometry/ExactPredicates.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Quality/InvertedBefore.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace morph
{
namespace
{
constexpr Index NodesToCheck = 4096; // between two checks whether it is cancelled

std::vector<char> isPrescribed(const Mesh& mesh, const NodePartition& partition)
{
  std::vector<char> result(mesh.numberOfNodes(), 0);
  for (Index node : partition.prescribed)
  {
    result[node] = 1;
  }
  return result;
}

/// Adds to `result` the half-spaces where `node` makes its corners of cell `c` positive. It takes
/// the corners whose nodes are all prescribed except `node`. `isPrescribed`: #nodes. `points`:
/// #nodes x 3, read only at prescribed nodes.
void addHalfSpaces(const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index c,
  Index node, const std::vector<char>& isPrescribed, const Points& points,
  std::vector<HalfSpace>& result)
{
  const CellShape& shape = *cellShape(mesh, c);
  const WeightedTet* tets = simplicialDecomposition(shape.shape).tets;
  for (int t = 0; t < cornerTetrahedra(shape.shape); ++t)
  {
    std::array<Index, 4> id = nodesAt(mesh, c, shape, tets[t].corner);
    int own = -1, prescribed = 0;
    for (int k = 0; k < 4; ++k)
    {
      own = id[k] == node ? k : own;
      prescribed += isPrescribed[id[k]] ? 1 : 0;
    }
    if (own < 0 || prescribed != 3)
    {
      continue;
    }
    // Moves the node to the front, which inverts the tetrahedron unless it is there already.
    std::swap(id[0], id[own]);
    if ((own == 0) != (orientation[c] > 0))
    {
      std::swap(id[1], id[2]);
    }
    result.push_back({ points.row(id[1]), points.row(id[2]), points.row(id[3]) });
  }
}

/// Whether enough nodes are prescribed for a corner tetrahedron to have at most one free node.
/// Cells that are taken by their faces have none.
bool isHeld(const Mesh& mesh, Index c, const std::vector<char>& prescribed)
{
  if (hasFaces(mesh, c))
  {
    return false;
  }
  const Index* nodes = mesh.cell(c);
  const int corners = cellShape(mesh, c)->numberOfCorners;
  return std::count_if(nodes, nodes + corners, [&](Index n) { return prescribed[n] != 0; }) >= 3;
}

/// Whether some free node has no valid position for the corners of which it is the only free node.
bool leavesNoPlace(const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index c,
  const std::vector<char>& prescribed, const Points& points)
{
  const CellShape& shape = *cellShape(mesh, c);
  std::vector<HalfSpace> halfSpaces;
  for (int k = 0; k < numberOfCorners(shape.shape); ++k)
  {
    const Index node = mesh.cell(c)[shape.cornerNode[k]];
    if (!prescribed[node])
    {
      halfSpaces.clear();
      addHalfSpaces(mesh, orientation, c, node, prescribed, points, halfSpaces);
      if (halfSpaces.size() > 1 && !haveCommonPoint(halfSpaces))
      {
        return true;
      }
    }
  }
  return false;
}
}

std::vector<Index> boundaryDeterminedInversions(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points)
{
  if (mesh.layer.isCurved())
  {
    return {};
  }
  const std::vector<char> prescribed = isPrescribed(mesh, partition);
  std::vector<Index> result;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!isHeld(mesh, c, prescribed))
    {
      continue;
    }
    const CellShape& shape = *cellShape(mesh, c);
    const auto inverted = [&](const WeightedTet& tet)
    {
      const std::array<Index, 4> id = nodesAt(mesh, c, shape, tet.corner);
      if (!std::all_of(id.begin(), id.end(), [&](Index node) { return prescribed[node] != 0; }))
      {
        return false;
      }
      const Eigen::RowVector3d o = points.row(id[0]);
      const Eigen::RowVector3d a = points.row(id[1]) - o, b = points.row(id[2]) - o,
                               d = points.row(id[3]) - o;
      return !(orientation[c] * a.dot(b.cross(d)) > 0);
    };
    const WeightedTet* tets = simplicialDecomposition(shape.shape).tets;
    if (std::any_of(tets, tets + cornerTetrahedra(shape.shape), inverted) ||
        leavesNoPlace(mesh, orientation, c, prescribed, points))
    {
      result.push_back(c);
    }
  }
  return result;
}

std::vector<Index> inversionsByBoundaryMotion(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& rest, const Points& points,
  Monitor& monitor)
{
  std::vector<Index> cells = boundaryDeterminedInversions(mesh, partition, orientation, points);
  if (!cells.empty())
  {
    const Quality atRest = measureQuality(mesh, rest, orientation, {}, monitor);
    cells.erase(std::remove_if(cells.begin(), cells.end(),
                  [&](Index c) { return atRest.scaledJacobian[c] <= InvertedBefore::Flat; }),
      cells.end());
  }
  return cells;
}

void warnOfDetermined(const std::vector<Index>& ids, Monitor& monitor)
{
  if (!ids.empty())
  {
    monitor.warn(
      "The boundary itself inverts cells whose corners it prescribes: cell ids " + listIds(ids) +
      ". No method can repair them; move the boundary less, or leave some of their nodes free.");
  }
}

std::vector<NodeWithoutPlace> nodesWithoutPlace(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points, Monitor& monitor,
  const Communicator& processes)
{
  if (mesh.layer.isCurved())
  {
    return {};
  }
  const std::vector<Index> elsewhere = processes.rows()->countedElsewhere();
  const std::vector<char> prescribed = isPrescribed(mesh, partition);
  const Adjacency around = nodeToCells(mesh);
  std::vector<NodeWithoutPlace> result;
  for (std::size_t i = 0; i < partition.free.size(); ++i)
  {
    if (i % NodesToCheck == 0)
    {
      monitor.check();
    }
    const Index node = partition.free[i];
    const auto leaveNone = [&](const std::vector<Index>& cells)
    {
      std::vector<HalfSpace> halfSpaces;
      for (Index c : cells)
      {
        addHalfSpaces(mesh, orientation, c, node, prescribed, points, halfSpaces);
      }
      return !haveCommonPoint(halfSpaces);
    };
    std::vector<Index> cells;
    std::copy_if(around.begin(node), around.end(node), std::back_inserter(cells),
      [&](Index c) { return isHeld(mesh, c, prescribed); });
    if (std::binary_search(elsewhere.begin(), elsewhere.end(), node) || !leaveNone(cells))
    {
      continue;
    }
    // Reduces the cells to a minimal set that cannot all be valid. Which one, their order decides:
    // that of the whole mesh.
    const std::vector<Index> ids = processes.idsOfCells(cells);
    std::map<Index, Index> byId;
    std::transform(ids.begin(), ids.end(), cells.begin(), std::inserter(byId, byId.end()),
      [](Index id, Index cell) { return std::pair(id, cell); });
    std::transform(
      byId.begin(), byId.end(), cells.begin(), [](const auto& entry) { return entry.second; });
    for (std::size_t k = cells.size(); k-- > 0;)
    {
      std::vector<Index> others = cells;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      if (leaveNone(others))
      {
        cells.swap(others);
      }
    }
    if (cells.size() > 1)
    {
      std::sort(cells.begin(), cells.end());
      result.push_back({ node, cells });
    }
  }
  return result;
}
}
