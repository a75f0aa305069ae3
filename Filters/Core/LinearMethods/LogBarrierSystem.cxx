// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierSystem.h"

#include "Mesh/Topology.h"
#include "Solvers/AssembleRows.h"

#include <algorithm>
#include <utility>

namespace morph
{
namespace
{
struct Tally
{
  std::vector<Index> outside, empty;
  Index twoRing = 0, affine = 0, stiffness = 0, iterations = 0;
  int mostIterations = 0;

  void count(Index node, NodeWeights::Kind kind, int steps)
  {
    this->iterations += steps;
    this->mostIterations = std::max(this->mostIterations, steps);
    if (kind == NodeWeights::Kind::OneRing)
    {
      return;
    }
    this->outside.push_back(node);
    this->twoRing += kind == NodeWeights::Kind::TwoRing;
    this->affine += kind == NodeWeights::Kind::Affine;
    this->stiffness += kind == NodeWeights::Kind::Stiffness;
    if (kind == NodeWeights::Kind::None)
    {
      this->empty.push_back(node);
    }
  }
};
}

LogBarrierSystem logBarrierSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, Monitor& monitor)
{
  const Adjacency around = nodeToCells(mesh, monitor);
  const WeightColumns columns(mesh.numberOfNodes(), rows, prescribed);
  monitor.check();
  monitor.progress(0.1);

  struct Outcome
  {
    NodeWeights::Kind kind;
    int steps;
  };
  const Index n = static_cast<Index>(rows.size());
  std::vector<Outcome> outcomes(rows.size());
  const auto makeRows = [&]() -> MakeRow
  {
    return [&, weights = NodeWeights(mesh, around, columns)](Index i, SparseRow& row) mutable
    {
      const NodeWeights::Kind kind = weights.compute(rows[i], relax);
      outcomes[i] = { kind, weights.iterations() };
      row.add(static_cast<int>(i), 1);
      for (std::size_t k = 0; kind != NodeWeights::Kind::None && k < weights.columns().size(); ++k)
      {
        row.add(weights.columns()[k], -weights.weights()[k]);
      }
    };
  };
  SplitMatrix matrix =
    assembleRows(n, n, n + static_cast<Index>(prescribed.size()), monitor, makeRows);
  monitor.check();
  monitor.progress(0.5);

  Tally tally;
  for (Index i = 0; i < n; ++i)
  {
    tally.count(rows[i], outcomes[i].kind, outcomes[i].steps);
  }
  LogBarrierSystem system;
  system.outside = std::move(tally.outside);
  system.empty = std::move(tally.empty);
  system.twoRing = tally.twoRing;
  system.affine = tally.affine;
  system.stiffness = tally.stiffness;
  system.mostIterations = tally.mostIterations;
  system.meanIterations =
    n > 0 ? static_cast<double>(tally.iterations) / static_cast<double>(n) : 0;
  system.interior.swap(matrix.inside); // Eigen 3.4 would copy on a move
  system.coupling.swap(matrix.outside);
  return system;
}
}
