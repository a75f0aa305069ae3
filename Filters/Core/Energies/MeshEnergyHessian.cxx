// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/CellBatchKernel.h"
#include "Energies/MeshEnergy.h"
#include "Support/SimdDispatch.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace morph
{
namespace
{
using namespace foldover;

constexpr Index Grain = 64;                                // groups
constexpr Index RowGrain = 256;                            // rows
constexpr Index GroupsToCheck = 4096, RowsToCheck = 16384; // whether it is cancelled
constexpr double Largest = 1e20; // of an entry: its square still is a float

/// Where the block of corners a <= b stands in the upper triangle of a cell with `n` corners.
MORPH_LANES_INLINE Index blockOf(Index a, Index b, Index n)
{
  return a * n - a * (a - 1) / 2 + b - a;
}

constexpr Index blocksOf(Index corners)
{
  return corners * (corners + 1) / 2;
}

/// to += block, or its transpose where the corners stand the other way round.
MORPH_LANES_INLINE void addBlock(
  const LaneMatrix& block, bool transposed, const Lanes& factor, LaneMatrix& to)
{
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      to[j][i] += factor * (transposed ? block[i][j] : block[j][i]);
    }
  }
}

/// Turns `entries`, of four cells side by side, into `count` numbers a cell, one cell after the other.
MORPH_LANES_INLINE void separateCells(const FloatLanes* entries, Index count, float* to)
{
  Index e = 0;
  for (; e + LaneCount <= count; e += LaneCount)
  {
    const FloatLanes *in = entries + e, ab = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5),
                     AB = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7),
                     cd = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5),
                     CD = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7),
                     cell[] = { __builtin_shufflevector(ab, cd, 0, 1, 4, 5),
                       __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
                       __builtin_shufflevector(AB, CD, 0, 1, 4, 5),
                       __builtin_shufflevector(AB, CD, 2, 3, 6, 7) };
    for (Index lane = 0; lane < LaneCount; ++lane)
    {
      std::memcpy(to + lane * count + e, &cell[lane], sizeof(FloatLanes));
    }
  }
  for (; e < count; ++e)
  {
    for (Index lane = 0; lane < LaneCount; ++lane)
    {
      to[lane * count + e] = entries[e][lane];
    }
  }
}

/// The second derivatives of a group's tetrahedra, by pairs of corners a <= b of the cell, in single precision: cell, block, column, row.
struct GroupHessian
{
  static MORPH_LANES_INLINE void run(Index group, const CellGroups& groups,
    const FoldoverDensity& density, const Points& points, const std::vector<Index>& start,
    std::vector<float>& out)
  {
    LaneVector x[8];
    cornersOf(groups, group, points, x);
    const int n = groups.corners(group);
    LaneMatrix sum[blocksOf(8)];
    for (Index k = 0; k < blocksOf(n); ++k)
    {
      sum[k] = {};
    }
    const SimplicialDecomposition parts = simplicialDecomposition(groups.shape(group));
    const CellGroups::Tetrahedra* tetrahedra = groups.targets(group);
    for (int t = 0; t < parts.count; ++t, ++tetrahedra)
    {
      addTetrahedra(x, parts.tets[t].corner, *tetrahedra, density, n, sum);
    }
    FloatLanes entries[9 * blocksOf(8)];
    for (Index k = 0; k < blocksOf(n); ++k)
    {
      for (Index j = 0; j < 3; ++j)
      {
        for (Index i = 0; i < 3; ++i)
        {
          entries[9 * k + 3 * j + i] = __builtin_convertvector(sum[k][j][i], FloatLanes);
        }
      }
    }
    separateCells(entries, 9 * blocksOf(n), out.data() + start[group]);
  }

private:
  static MORPH_LANES_INLINE void addTetrahedra(const LaneVector (&x)[8], const int* corner,
    const CellGroups::Tetrahedra& tetrahedra, const FoldoverDensity& density, int n,
    LaneMatrix* sum)
  {
    LaneMatrix inverse, J, g, block[3][3];
    inverseOf(tetrahedra, inverse);
    jacobian(x, corner, tetrahedra, inverse, J);
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        g[j][i] = inverse[i][j];
      }
    }
    Parameters<Lanes> parameters;
    parametersOf(density, tetrahedra, parameters);
    hessian(parameters, J, g, block);
    Lanes most = {};
    for (int a = 0; a < 3; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        most = block[a][a][i][i] > most ? block[a][a][i][i] : most;
      }
    }
    const Lanes weight = load(tetrahedra.weight) * (most > Largest ? Largest / most : Lanes{} + 1.);

    // Moving all four corners alike changes nothing: the blocks of corner 0 follow from the others.
    LaneMatrix first = {};
    for (int b = 0; b < 3; ++b)
    {
      LaneMatrix column = {};
      for (int a = 0; a < 3; ++a)
      {
        const LaneMatrix& own = block[std::min(a, b)][std::max(a, b)];
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

  static MORPH_LANES_INLINE void addPair(
    const LaneMatrix& block, int a, int b, const Lanes& weight, int n, LaneMatrix* sum)
  {
    addBlock(block, a > b, weight, sum[a > b ? blockOf(b, a, n) : blockOf(a, b, n)]);
  }
};
}

void MeshEnergy::openMatrix(BlockMatrix& matrix, Monitor& monitor) const
{
  BlockPattern pattern;
  std::vector<std::int32_t> row, found;
  for (Index i = 0; i < static_cast<Index>(this->free_.size()); ++i)
  {
    if (i % RowsToCheck == 0)
    {
      monitor.check();
    }
    found.clear();
    for (const Index* use = this->groups_.uses().begin(i); use != this->groups_.uses().end(i);
         ++use)
    {
      const Index group = this->groups_.groupOf(*use), first = this->groups_.firstPlace(group);
      const Index lane = (*use - first) % LaneCount;
      for (int a = 0; a < this->groups_.corners(group); ++a)
      {
        found.push_back(this->groups_.row(first + a * LaneCount + lane));
      }
    }
    row.assign(1, static_cast<std::int32_t>(i));
    std::copy_if(found.begin(), found.end(), std::back_inserter(row),
      [](std::int32_t column) { return column >= 0; });
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    for (std::int32_t column : found)
    {
      const auto place = std::lower_bound(row.begin(), row.end(), column) - row.begin();
      pattern.places.push_back(column < 0 ? -1 : static_cast<std::int32_t>(place));
    }
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.offsets.push_back(static_cast<Index>(pattern.columns.size()));
    pattern.placeOffsets.push_back(static_cast<Index>(pattern.places.size()));
  }
  matrix.open(this->pattern_, std::move(pattern));
}

void MeshEnergy::hessian(const Points& points, BlockMatrix& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    this->openMatrix(result, monitor);
  }
  // The blocks of each group; then each row gathers its own, cell by cell.
  std::vector<Index> start(this->groups_.size() + 1, 0);
  for (Index group = 0; group < this->groups_.size(); ++group)
  {
    start[group + 1] = start[group] + 9 * LaneCount * blocksOf(this->groups_.corners(group));
  }
  std::vector<float>& blocks = result.scratch();
  blocks.resize(start.back());
  // In pieces that end within tenths of a second, and between them a look at whether it is
  // cancelled.
  for (Index begin = 0; begin < this->groups_.size(); begin += GroupsToCheck)
  {
    monitor.check();
    monitor.parallelFor(std::min(GroupsToCheck, this->groups_.size() - begin), Grain,
      [&](Index first, Index last)
      {
        vectorLoop<GroupHessian>(
          begin + first, begin + last, this->groups_, this->density_, points, start, blocks);
      });
  }
  monitor.check();
  this->gatherBlocks(blocks, start, result, monitor);
}

void MeshEnergy::gatherBlocks(const std::vector<float>& blocks, const std::vector<Index>& start,
  BlockMatrix& result, Monitor& monitor) const
{
  monitor.parallelFor(result.rows(), RowGrain,
    [&](Index firstRow, Index lastRow)
    {
      for (Index row = firstRow; row < lastRow; ++row)
      {
        float* out = result.blocks(row);
        std::fill(out, result.blocks(row + 1), 0.f);
        const std::int32_t* place = result.places(row);
        for (const Index* use = this->groups_.uses().begin(row);
             use != this->groups_.uses().end(row); ++use)
        {
          const Index group = this->groups_.groupOf(*use), first = this->groups_.firstPlace(group);
          const int n = this->groups_.corners(group);
          const Index own = (*use - first) / LaneCount, lane = (*use - first) % LaneCount;
          const float* cell = blocks.data() + start[group] + lane * 9 * blocksOf(n);
          for (Index other = 0; other < n; ++other, ++place)
          {
            if (*place < 0)
            {
              continue;
            }
            float* block = out + 9 * static_cast<Index>(*place);
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
      }
    });
}
}
