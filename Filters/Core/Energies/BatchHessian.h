// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatchKernel.h"
#include "Optimization/BlockCsr3f.h"
#include "Support/Monitor.h"
#include "Support/Simd.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace morph
{
namespace foldover
{
/// Returns the number of the block of corners a <= b in the upper triangle of a cell with `n`
/// corners.
MORPH_SIMD_INLINE Index blockOf(Index a, Index b, Index n)
{
  return a * n - a * (a - 1) / 2 + b - a;
}

constexpr Index blocksOf(Index corners)
{
  return corners * (corners + 1) / 2;
}

/// Computes to += factor * block, or its transpose if the corners have the reverse order.
MORPH_SIMD_INLINE void addBlock(
  const SimdMatrix& block, bool transposed, const SimdDouble4& factor, SimdMatrix& to)
{
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      to[j][i] += factor * (transposed ? block[i][j] : block[j][i]);
    }
  }
}

/// Rearranges `entries` of four interleaved cells into `count` numbers a cell, one cell after the
/// other.
MORPH_SIMD_INLINE void separateCells(const SimdFloat4* entries, Index count, float* to)
{
  Index e = 0;
  for (; e + SimdWidth <= count; e += SimdWidth)
  {
    SimdFloat4 cell[SimdWidth];
    transpose(entries + e, cell);
    for (Index lane = 0; lane < SimdWidth; ++lane)
    {
      store(cell[lane], to + lane * count + e);
    }
  }
  for (; e < count; ++e)
  {
    for (Index lane = 0; lane < SimdWidth; ++lane)
    {
      to[lane * count + e] = entries[e][lane];
    }
  }
}

MORPH_SIMD_INLINE void addPair(
  const SimdMatrix& block, int a, int b, const SimdDouble4& factor, int n, SimdMatrix* sum)
{
  addBlock(block, a > b, factor, sum[a > b ? blockOf(b, a, n) : blockOf(a, b, n)]);
}

/// Adds the second derivatives `block` by the edges from a tetrahedron's first corner to the pairs
/// of corners a <= b of its cell, times `weight`. A translation changes nothing: the blocks of the
/// first corner follow from the others. `block`: its upper triangle; `n`: corners of the cell.
MORPH_SIMD_INLINE void addByCorners(const SimdMatrix (&block)[3][3], const int* corner,
  const SimdDouble4& weight, int n, SimdMatrix* sum)
{
  constexpr double Largest = 1e20; // of an entry: its square is still a float
  SimdDouble4 most = {};
  for (int a = 0; a < 3; ++a)
  {
    for (int i = 0; i < 3; ++i)
    {
      most = select(block[a][a][i][i] > most, block[a][a][i][i], most);
    }
  }
  const SimdDouble4 factor = weight * select(most > Largest, Largest / most, SimdDouble4{} + 1.);
  SimdMatrix first = {};
  for (int b = 0; b < 3; ++b)
  {
    SimdMatrix column = {};
    for (int a = 0; a < 3; ++a)
    {
      const SimdMatrix& own = block[std::min(a, b)][std::max(a, b)];
      for (int j = 0; j < 3; ++j)
      {
        for (int i = 0; i < 3; ++i)
        {
          column[j][i] -= a <= b ? own[j][i] : own[i][j];
        }
      }
      if (a <= b)
      {
        addPair(own, corner[a + 1], corner[b + 1], factor, n, sum);
      }
    }
    addPair(column, corner[0], corner[b + 1], factor, n, sum);
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        first[j][i] -= column[j][i];
      }
    }
  }
  addPair(first, corner[0], corner[0], factor, n, sum);
}

/// Stores the blocks of a batch's cells in single precision, in the order cell, block, column, row.
MORPH_SIMD_INLINE void storeBlocks(const SimdMatrix* sum, Index blocks, float* to)
{
  SimdFloat4 entries[9 * blocksOf(8)];
  for (Index k = 0; k < blocks; ++k)
  {
    for (Index j = 0; j < 3; ++j)
    {
      for (Index i = 0; i < 3; ++i)
      {
        entries[9 * k + 3 * j + i] = narrowed(sum[k][j][i]);
      }
    }
  }
  separateCells(entries, 9 * blocks, to);
}
}

/// Opens `matrix` with the pattern of the batches' free nodes, for the owner `id`. `free`: their
/// ids, by rows. Cost: passes over the corners.
void openBlocks(const CellBatches& batches, const std::vector<Index>& free, const PatternId& id,
  BlockCsr3f& matrix, Monitor& monitor);

/// Adds the blocks of a piece of the batches to the rows of the matrix. A row adds its blocks in
/// the order of the cells, whatever the pieces.
class BlockGatherer
{
public:
  BlockGatherer(const CellBatches& batches, BlockCsr3f& matrix)
    : batches_(batches)
    , matrix_(matrix)
    , used_(matrix.rows(), { 0, 0 })
  {
  }

  /// `blocks`: of the batches in [begin, end), each at its entry of `start`.
  void add(Index begin, Index end, const std::vector<float>& blocks,
    const std::vector<Index>& start, Monitor& monitor);

private:
  struct Used
  {
    std::int32_t uses, places; ///< of the row, added before
  };

  void addToRow(Index row, Index begin, Index endPlace, const std::vector<float>& blocks,
    const std::vector<Index>& start);

  const CellBatches& batches_;
  BlockCsr3f& matrix_;
  std::vector<Used> used_; ///< #rows
};

namespace detail
{
template <typename Body>
struct StoredBlocks
{
  template <typename... Arguments>
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, Index begin,
    const std::vector<Index>& start, std::vector<float>& out, const Arguments&... arguments)
  {
    foldover::SimdMatrix sum[foldover::blocksOf(8)];
    const Index blocks = foldover::blocksOf(batches.corners(batch));
    for (Index k = 0; k < blocks; ++k)
    {
      sum[k] = {};
    }
    Body::run(batch, batches, arguments..., sum);
    foldover::storeBlocks(sum, blocks, out.data() + start[batch - begin]);
  }
};
}

/// Sums the second derivatives of all batches into an open matrix. Body::run(batch, batches,
/// arguments..., sum) adds those of a batch by pairs of corners a <= b of the cell, see blockOf().
template <typename Body, typename... Arguments>
void sumBlocks(
  const CellBatches& batches, BlockCsr3f& matrix, Monitor& monitor, const Arguments&... arguments)
{
  constexpr Index Grain = 64; // batches
  // Their blocks stay in cache, and between two pieces it checks whether it is cancelled.
  constexpr Index BatchesInPiece = 1024;
  matrix.setZero();
  BlockGatherer gatherer(batches, matrix);
  std::vector<Index> start(BatchesInPiece + 1, 0);
  std::vector<float> blocks;
  for (Index begin = 0; begin < batches.size(); begin += BatchesInPiece)
  {
    monitor.check();
    const Index end = std::min(begin + BatchesInPiece, batches.size());
    for (Index batch = begin; batch < end; ++batch)
    {
      start[batch - begin + 1] =
        start[batch - begin] + 9 * SimdWidth * foldover::blocksOf(batches.corners(batch));
    }
    blocks.resize(std::max<std::size_t>(blocks.size(), start[end - begin]));
    monitor.parallelFor(end - begin, Grain,
      [&](Index first, Index last)
      {
        dispatchedFor<detail::StoredBlocks<Body>>(
          begin + first, begin + last, batches, begin, start, blocks, arguments...);
      });
    gatherer.add(begin, end, blocks, start, monitor);
  }
}
}
