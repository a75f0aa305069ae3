// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierSystem.h"

#include "LinearMethods/SplitRows.h"
#include "Mesh/Topology.h"

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

/// Appends a row with minus `weights` at `columns`, and 1 on the diagonal.
void append(SplitRows& chunk, int row, int rows, const std::vector<int>& columns,
  const std::vector<double>& weights)
{
  SplitRows::Part& inside = chunk.interior;
  SplitRows::Part& outside = chunk.coupling;
  const std::size_t before = inside.column.size(), outsideBefore = outside.column.size();
  const auto put = [](SplitRows::Part& part, int column, double value)
  {
    part.column.push_back(column);
    part.value.push_back(value);
  };
  std::size_t i = 0;
  for (; i < columns.size() && columns[i] < row; ++i)
  {
    put(inside, columns[i], -weights[i]);
  }
  put(inside, row, 1);
  for (; i < columns.size() && columns[i] < rows; ++i)
  {
    put(inside, columns[i], -weights[i]);
  }
  for (; i < columns.size(); ++i)
  {
    put(outside, columns[i] - rows, -weights[i]);
  }
  inside.size.push_back(static_cast<int>(inside.column.size() - before));
  outside.size.push_back(static_cast<int>(outside.column.size() - outsideBefore));
}
}

LogBarrierSystem logBarrierSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, Monitor& monitor)
{
  const Adjacency around = nodeToCells(mesh, monitor);
  const WeightColumns columns(mesh.numberOfNodes(), rows, prescribed);
  monitor.check();
  monitor.progress(0.1);

  const Index n = static_cast<Index>(rows.size());
  std::vector<Tally> tallies(chunksOf(n));
  SplitChunks chunks(n, static_cast<Index>(prescribed.size()));
  splitRows(0, n, chunks, monitor,
    [&]
    {
      return [&, weights = NodeWeights(mesh, around, columns)](Index i, SplitRows& chunk) mutable
      {
        const NodeWeights::Kind kind = weights.compute(rows[i], relax);
        tallies[i / ChunkRows].count(rows[i], kind, weights.iterations());
        if (kind == NodeWeights::Kind::None)
        {
          append(chunk, static_cast<int>(i), static_cast<int>(n), {}, {});
        }
        else
        {
          append(
            chunk, static_cast<int>(i), static_cast<int>(n), weights.columns(), weights.weights());
        }
      };
    });
  monitor.check();
  monitor.progress(0.5);

  LogBarrierSystem system;
  Index iterations = 0;
  for (const Tally& tally : tallies)
  {
    system.outside.insert(system.outside.end(), tally.outside.begin(), tally.outside.end());
    system.empty.insert(system.empty.end(), tally.empty.begin(), tally.empty.end());
    system.twoRing += tally.twoRing;
    system.affine += tally.affine;
    system.stiffness += tally.stiffness;
    system.mostIterations = std::max(system.mostIterations, tally.mostIterations);
    iterations += tally.iterations;
  }
  system.meanIterations = n > 0 ? static_cast<double>(iterations) / static_cast<double>(n) : 0;
  system.interior = std::move(chunks.interior);
  joinRows(std::move(chunks.coupling), system.coupling, monitor);
  return system;
}
}
