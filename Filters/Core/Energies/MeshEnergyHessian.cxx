// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/CellBatchKernel.h"
#include "Energies/MeshEnergy.h"
#include "Support/Error.h"
#include "Support/Simd.h"

#include <algorithm>
#include <limits>
#include <string>

namespace morph
{
namespace
{
using namespace foldover;

constexpr Index Grain = 64;     // batches
constexpr Index RowGrain = 256; // rows
// Their blocks stay in cache, and between two pieces it checks whether it is cancelled.
constexpr Index BatchesInPiece = 1024;
constexpr Index RowsToCheck = 16384;
constexpr double Largest = 1e20; // of an entry: its square is still a float

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

/// Computes the second derivatives of a batch's tetrahedra by pairs of corners a <= b of the cell.
/// Single precision, in the order cell, block, column, row. `begin`: the batch of start[0].
struct BatchHessian
{
  template <typename Density>
  static MORPH_SIMD_INLINE void run(Index batch, const CellBatches& batches, const Density& density,
    const Points& points, Index begin, const std::vector<Index>& start, std::vector<float>& out)
  {
    SimdVector x[8];
    cornersOf(batches, batch, points, x);
    const int n = batches.corners(batch);
    SimdMatrix sum[blocksOf(8)];
    for (Index k = 0; k < blocksOf(n); ++k)
    {
      sum[k] = {};
    }
    const SimplicialDecomposition parts = simplicialDecomposition(batches.shape(batch));
    const SimdTargets targets(batches, batch);
    for (int t = 0; t < parts.count; ++t)
    {
      const SimdTarget target(targets, parts.tets[t], t);
      addTetrahedra(x, parts.tets[t].corner, target, density, n, sum);
    }
    SimdFloat4 entries[9 * blocksOf(8)];
    for (Index k = 0; k < blocksOf(n); ++k)
    {
      for (Index j = 0; j < 3; ++j)
      {
        for (Index i = 0; i < 3; ++i)
        {
          entries[9 * k + 3 * j + i] = narrowed(sum[k][j][i]);
        }
      }
    }
    separateCells(entries, 9 * blocksOf(n), out.data() + start[batch - begin]);
  }

private:
  template <typename Density>
  static MORPH_SIMD_INLINE void addTetrahedra(const SimdVector (&x)[8], const int* corner,
    const SimdTarget& target, const Density& density, int n, SimdMatrix* sum)
  {
    SimdMatrix J, g, block[3][3];
    jacobian(x, corner, target, J);
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        g[j][i] = target.inverse[i][j];
      }
    }
    curvatureAt(density, J, g, block);
    SimdDouble4 most = {};
    for (int a = 0; a < 3; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        most = select(block[a][a][i][i] > most, block[a][a][i][i], most);
      }
    }
    const SimdDouble4 weight =
      target.weight * select(most > Largest, Largest / most, SimdDouble4{} + 1.);

    // A translation changes nothing: the blocks of corner 0 follow from the others.
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
          addPair(own, corner[a + 1], corner[b + 1], weight, n, sum);
        }
      }
      addPair(column, corner[0], corner[b + 1], weight, n, sum);
      for (int j = 0; j < 3; ++j)
      {
        for (int i = 0; i < 3; ++i)
        {
          first[j][i] -= column[j][i];
        }
      }
    }
    addPair(first, corner[0], corner[0], weight, n, sum);
  }

  static MORPH_SIMD_INLINE void addPair(
    const SimdMatrix& block, int a, int b, const SimdDouble4& weight, int n, SimdMatrix* sum)
  {
    addBlock(block, a > b, weight, sum[a > b ? blockOf(b, a, n) : blockOf(a, b, n)]);
  }
};
}

void MeshEnergy::openMatrix(BlockCsr3f& matrix, Monitor& monitor) const
{
  const auto rows = static_cast<Index>(this->free_.size());
  BlockPattern pattern;
  pattern.offsets.reserve(rows + 1);
  pattern.placeOffsets.reserve(rows + 1);
  // Calls add(column) for each corner of the row's cells from the row on.
  const auto forUpper = [&](Index i, const auto& add)
  {
    for (const Index* use = this->batches_.uses().begin(i); use != this->batches_.uses().end(i);
         ++use)
    {
      const Index batch = this->batches_.batchOf(*use), first = this->batches_.firstPlace(batch);
      const Index lane = (*use - first) % SimdWidth;
      for (int a = 0; a < this->batches_.corners(batch); ++a)
      {
        const std::int32_t column = this->batches_.row(first + a * SimdWidth + lane);
        if (column >= i)
        {
          add(column);
        }
      }
    }
  };
  Index places = 0;
  for (Index i = 0; i < rows; ++i)
  {
    forUpper(i, [&](std::int32_t) { ++places; });
  }
  pattern.places.reserve(places);
  std::vector<std::int32_t> row, found;
  for (Index i = 0; i < rows; ++i)
  {
    if (i % RowsToCheck == 0)
    {
      monitor.check();
    }
    found.clear();
    forUpper(i, [&](std::int32_t column) { found.push_back(column); });
    row = found;
    row.push_back(static_cast<std::int32_t>(i));
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    if (row.size() > std::numeric_limits<std::uint16_t>::max())
    {
      throw Error(Error::Kind::InvalidInput,
        "Node id " + std::to_string(this->free_[i]) +
          " has more than 65,535 neighbors, which is too many for Newton's method.");
    }
    for (std::int32_t column : found)
    {
      const auto place = std::lower_bound(row.begin(), row.end(), column) - row.begin();
      pattern.places.push_back(static_cast<std::uint16_t>(place));
    }
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.offsets.push_back(static_cast<Index>(pattern.columns.size()));
    pattern.placeOffsets.push_back(static_cast<Index>(pattern.places.size()));
  }
  pattern.columns.shrink_to_fit();
  matrix.open(this->pattern_, std::move(pattern));
}

namespace
{
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
    const std::vector<Index>& start, Monitor& monitor)
  {
    const Index firstPlace = this->batches_.firstPlace(begin),
                endPlace = end < this->batches_.size() ? this->batches_.firstPlace(end)
                                                       : this->batches_.places();
    std::int32_t low = static_cast<std::int32_t>(this->matrix_.rows()), high = -1;
    for (Index place = firstPlace; place < endPlace; ++place)
    {
      const std::int32_t row = this->batches_.row(place);
      low = row >= 0 ? std::min(low, row) : low;
      high = std::max(high, row);
    }
    monitor.parallelFor(std::max<Index>(0, high + 1 - low), RowGrain,
      [&](Index first, Index last)
      {
        for (Index row = low + first; row < low + last; ++row)
        {
          this->addToRow(row, begin, endPlace, blocks, start);
        }
      });
  }

private:
  struct Used
  {
    std::int32_t uses, places; ///< of the row, added before
  };

  void addToRow(Index row, Index begin, Index endPlace, const std::vector<float>& blocks,
    const std::vector<Index>& start)
  {
    const Adjacency& uses = this->batches_.uses();
    Used& used = this->used_[row];
    const Index *firstUse = uses.begin(row) + used.uses, *use = firstUse;
    const std::uint16_t *firstPlace = this->matrix_.places(row) + used.places, *place = firstPlace;
    float* out = this->matrix_.blocks(row);
    for (; use != uses.end(row) && *use < endPlace; ++use)
    {
      const Index batch = this->batches_.batchOf(*use), first = this->batches_.firstPlace(batch);
      const int n = this->batches_.corners(batch);
      const Index own = (*use - first) / SimdWidth, lane = (*use - first) % SimdWidth;
      const float* cell = blocks.data() + start[batch - begin] + lane * 9 * blocksOf(n);
      for (Index other = 0; other < n; ++other)
      {
        if (this->batches_.row(first + other * SimdWidth + lane) < row)
        {
          continue;
        }
        float* block = out + 9 * static_cast<Index>(*place);
        ++place;
        const float* in = cell + 9 * blockOf(std::min(own, other), std::max(own, other), n);
        for (Index j = 0; j < 3; ++j)
        {
          for (Index i = 0; i < 3; ++i)
          {
            block[3 * j + i] += in[own <= other ? 3 * j + i : 3 * i + j];
          }
        }
      }
    }
    used.uses += static_cast<std::int32_t>(use - firstUse);
    used.places += static_cast<std::int32_t>(place - firstPlace);
  }

  const CellBatches& batches_;
  BlockCsr3f& matrix_;
  std::vector<Used> used_; ///< #rows
};
}

void MeshEnergy::hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    this->openMatrix(result, monitor);
  }
  result.setZero();
  this->parts_.resize(0, 3); // the solution of a system needs its memory more
  BlockGatherer gatherer(this->batches_, result);
  std::vector<Index> start(BatchesInPiece + 1, 0);
  std::vector<float> blocks;
  for (Index begin = 0; begin < this->batches_.size(); begin += BatchesInPiece)
  {
    monitor.check();
    const Index end = std::min(begin + BatchesInPiece, this->batches_.size());
    for (Index batch = begin; batch < end; ++batch)
    {
      start[batch - begin + 1] =
        start[batch - begin] + 9 * SimdWidth * blocksOf(this->batches_.corners(batch));
    }
    blocks.resize(std::max<std::size_t>(blocks.size(), start[end - begin]));
    monitor.parallelFor(end - begin, Grain,
      [&](Index first, Index last)
      {
        if (this->isCondition_)
        {
          const ConditionDensity density;
          dispatchedFor<BatchHessian>(
            begin + first, begin + last, this->batches_, density, points, begin, start, blocks);
          return;
        }
        dispatchedFor<BatchHessian>(begin + first, begin + last, this->batches_, this->density_,
          points, begin, start, blocks);
      });
    gatherer.add(begin, end, blocks, start, monitor);
  }
}
}
