// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CsrMatrix.h"

#include "Support/Error.h"
#include "Support/Parallel.h"

#include <limits>
#include <string>

namespace morph
{
namespace
{
constexpr Index Rows = 4096; // of a block

/// Some rows, one after the other.
struct Block
{
  std::vector<int> inside, outside; ///< numbers of entries of each row
  std::vector<int> column;
  std::vector<double> value;
};

Block makeBlock(Index first, Index last, Index inside, const MakeRow& makeRow)
{
  Block block;
  SparseRow row;
  for (Index i = first; i < last; ++i)
  {
    row.clear();
    makeRow(i, row);
    const std::size_t before = block.column.size();
    int count = 0;
    for (const auto& [column, value] : row.sorted())
    {
      block.column.push_back(column);
      block.value.push_back(value);
      count += column < inside;
    }
    block.inside.push_back(count);
    block.outside.push_back(static_cast<int>(block.column.size() - before) - count);
  }
  return block;
}

void allocate(CsrMatrix& matrix, Index rows, Index columns, const std::vector<Block>& blocks,
  std::vector<int> Block::*sizes)
{
  matrix.resize(rows, columns);
  Index entries = 0;
  int* end = matrix.outerIndexPtr();
  for (const Block& block : blocks)
  {
    for (const int size : block.*sizes)
    {
      entries += size;
      *++end = static_cast<int>(entries);
    }
    requireEntries(entries);
  }
  matrix.resizeNonZeros(entries);
}
}

SplitMatrix assembleRows(Index rows, Index inside, Index columns, Monitor& monitor,
  const std::function<MakeRow()>& makeRows, const std::function<void()>& allMade)
{
  std::vector<Block> blocks((rows + Rows - 1) / Rows);
  const auto count = static_cast<Index>(blocks.size());
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      const MakeRow makeRow = makeRows();
      for (Index b = first; b < last; ++b)
      {
        blocks[b] = makeBlock(b * Rows, std::min(rows, (b + 1) * Rows), inside, makeRow);
      }
    });
  allMade();
  SplitMatrix result;
  allocate(result.inside, rows, inside, blocks, &Block::inside);
  allocate(result.outside, rows, columns - inside, blocks, &Block::outside);
  const auto copy =
    [&](CsrMatrix& to, Index row, const Block& block, std::size_t from, int size, Index firstColumn)
  {
    const int at = to.outerIndexPtr()[row];
    std::transform(block.column.begin() + from, block.column.begin() + from + size,
      to.innerIndexPtr() + at, [&](int column) { return column - static_cast<int>(firstColumn); });
    std::copy_n(block.value.begin() + from, size, to.valuePtr() + at);
  };
  parallel(count, 1, monitor,
    [&](Index b)
    {
      Block block;
      std::swap(block, blocks[b]); // freed here
      std::size_t from = 0;
      for (std::size_t i = 0; i < block.inside.size(); ++i)
      {
        const Index row = b * Rows + static_cast<Index>(i);
        copy(result.inside, row, block, from, block.inside[i], 0);
        from += block.inside[i];
        copy(result.outside, row, block, from, block.outside[i], inside);
        from += block.outside[i];
      }
    });
  return result;
}

void requireEntries(Index entries)
{
  if (entries > std::numeric_limits<int>::max())
  {
    throw Error("The mesh is too large: its matrix has " + std::to_string(entries) +
                " entries, more than the solver can number (2^31 - 1).");
  }
}
}
