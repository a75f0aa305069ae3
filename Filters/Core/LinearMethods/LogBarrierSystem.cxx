// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierSystem.h"

#include "Mesh/Topology.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr Index ChunkRows = 4096;

/// The rows of one chunk, in the making.
struct Chunk
{
  std::vector<int> insideSize, outsideSize; ///< entries per row
  std::vector<int> insideColumn, outsideColumn;
  std::vector<double> insideValue, outsideValue;
  std::vector<Index> outside, empty;
  Index twoRing = 0, affine = 0, stiffness = 0, iterations = 0;
  int mostIterations = 0;

  void clear()
  {
    for (std::vector<int>* v :
      { &this->insideSize, &this->outsideSize, &this->insideColumn, &this->outsideColumn })
    {
      v->clear();
    }
    this->insideValue.clear();
    this->outsideValue.clear();
    this->outside.clear();
    this->empty.clear();
    this->twoRing = this->affine = this->stiffness = this->iterations = 0;
    this->mostIterations = 0;
  }

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

  void append(
    int row, int rows, const std::vector<int>& columns, const std::vector<double>& weights)
  {
    const std::size_t before = this->insideColumn.size(),
                      outsideBefore = this->outsideColumn.size();
    const auto put = [this](int column, double value)
    {
      this->insideColumn.push_back(column);
      this->insideValue.push_back(value);
    };
    std::size_t i = 0;
    for (; i < columns.size() && columns[i] < row; ++i)
    {
      put(columns[i], -weights[i]);
    }
    put(row, 1);
    for (; i < columns.size() && columns[i] < rows; ++i)
    {
      put(columns[i], -weights[i]);
    }
    for (; i < columns.size(); ++i)
    {
      this->outsideColumn.push_back(columns[i] - rows);
      this->outsideValue.push_back(-weights[i]);
    }
    this->insideSize.push_back(static_cast<int>(this->insideColumn.size() - before));
    this->outsideSize.push_back(static_cast<int>(this->outsideColumn.size() - outsideBefore));
  }
};

/// Puts the chunks' entries one after another into `matrix`. `sizes`, `column`, `value`: the
/// members of Chunk to take.
void join(CsrMatrix& matrix, Index rows, Index width, std::vector<Chunk>& chunks,
  std::vector<int> Chunk::*sizes, std::vector<int> Chunk::*column,
  std::vector<double> Chunk::*value, Monitor& monitor)
{
  std::vector<int> all;
  all.reserve(rows + 1);
  all.push_back(0);
  for (const Chunk& chunk : chunks)
  {
    all.insert(all.end(), (chunk.*sizes).begin(), (chunk.*sizes).end());
  }
  allocateRows(matrix, width, all);
  monitor.parallelFor(static_cast<Index>(chunks.size()), 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        Chunk& chunk = chunks[c];
        const int at = matrix.outerIndexPtr()[c * ChunkRows];
        std::copy((chunk.*column).begin(), (chunk.*column).end(), matrix.innerIndexPtr() + at);
        std::copy((chunk.*value).begin(), (chunk.*value).end(), matrix.valuePtr() + at);
        chunk.*column = {};
        chunk.*value = {};
      }
    });
}
}

LogBarrierSystem logBarrierSystem(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, Monitor& monitor)
{
  const Adjacency around = nodeToCells(mesh);
  const WeightColumns columns(mesh.numberOfNodes(), rows, prescribed);
  monitor.check();
  monitor.progress(0.1);

  const Index n = static_cast<Index>(rows.size());
  const Index count = (n + ChunkRows - 1) / ChunkRows;
  std::vector<Chunk> chunks(count);
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      NodeWeights row(mesh, around, columns);
      Chunk scratch; // keeps its capacity from chunk to chunk
      for (Index c = first; c < last; ++c)
      {
        scratch.clear();
        for (Index i = c * ChunkRows; i < std::min(n, (c + 1) * ChunkRows); ++i)
        {
          const NodeWeights::Kind kind = row.compute(rows[i], relax);
          scratch.count(rows[i], kind, row.iterations());
          if (kind == NodeWeights::Kind::None)
          {
            scratch.append(static_cast<int>(i), static_cast<int>(n), {}, {});
          }
          else
          {
            scratch.append(static_cast<int>(i), static_cast<int>(n), row.columns(), row.weights());
          }
        }
        chunks[c] = scratch;
      }
    });
  monitor.check();
  monitor.progress(0.5);

  LogBarrierSystem system;
  Index iterations = 0;
  for (const Chunk& chunk : chunks)
  {
    system.outside.insert(system.outside.end(), chunk.outside.begin(), chunk.outside.end());
    system.empty.insert(system.empty.end(), chunk.empty.begin(), chunk.empty.end());
    system.twoRing += chunk.twoRing;
    system.affine += chunk.affine;
    system.stiffness += chunk.stiffness;
    system.mostIterations = std::max(system.mostIterations, chunk.mostIterations);
    iterations += chunk.iterations;
  }
  system.meanIterations = n > 0 ? static_cast<double>(iterations) / static_cast<double>(n) : 0;
  join(system.interior, n, n, chunks, &Chunk::insideSize, &Chunk::insideColumn, &Chunk::insideValue,
    monitor);
  join(system.coupling, n, static_cast<Index>(prescribed.size()), chunks, &Chunk::outsideSize,
    &Chunk::outsideColumn, &Chunk::outsideValue, monitor);
  return system;
}
}
