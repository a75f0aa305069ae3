// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/GraphLaplace.h"

#include "Mesh/Topology.h"
#include "Solvers/MultigridSolver.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
constexpr double Tolerance = 1e-6; // the mesh is a start
constexpr int MaxIterations = 1000;

std::vector<std::pair<int, int>> edgesOf(const Mesh& mesh)
{
  std::vector<std::pair<int, int>> edges;
  forCellEdges(mesh,
    [&](Index a, Index b)
    {
      if (a != b) // a collapsed cell has such edges
      {
        edges.emplace_back(static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b)));
      }
    });
  sortUnique(edges);
  return edges;
}
}

Points graphLaplaceMesh(
  const Mesh& mesh, const NodePartition& partition, const Points& points, Monitor& monitor)
{
  const std::vector<std::pair<int, int>> edges = edgesOf(mesh);
  monitor.check();
  std::vector<int> row(mesh.numberOfNodes(), -1);
  for (std::size_t i = 0; i < partition.free.size(); ++i)
  {
    row[partition.free[i]] = static_cast<int>(i);
  }
  const Index n = static_cast<Index>(partition.free.size());
  // Distances from the middle lose no digits far from the origin.
  const Eigen::RowVector3d middle = partition.prescribed.empty()
                                      ? Eigen::RowVector3d::Zero()
                                      : Eigen::RowVector3d(points.row(partition.prescribed[0]));
  Points b = Points::Zero(n, 3), x = Points::Zero(n, 3);
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(4 * edges.size());
  const auto add = [&](int own, int other)
  {
    const int i = row[own], j = row[other];
    if (i < 0)
    {
      return;
    }
    entries.emplace_back(i, i, 1.);
    if (j >= 0)
    {
      entries.emplace_back(i, j, -1.);
    }
    else
    {
      b.row(i) += points.row(other) - middle;
    }
  };
  for (const auto& [first, last] : edges)
  {
    add(first, last);
    add(last, first);
  }
  // All edges count alike: the nodes' places say nothing.
  LinearEquations equations = { CsrMatrix(n, n), Points::Zero(n, 3) };
  equations.matrix.setFromTriplets(entries.begin(), entries.end());
  SpdSolver solver;
  ProgressRange preparing(monitor, 0, 0.5), solving(monitor, 0.5, 1);
  solver.prepare(std::move(equations), preparing);
  solver.solve(b, x, Tolerance, MaxIterations, solving);
  Points result = points;
  for (Index i = 0; i < n; ++i)
  {
    result.row(partition.free[i]) = x.row(i) + middle;
  }
  return result;
}
}
