// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/BatchHessian.h"

#include "Support/Error.h"
#include "Support/Lists.h"

#include <limits>
#include <string>

namespace morph
{
namespace
{
using foldover::blockOf;
using foldover::blocksOf;

constexpr Index RowGrain = 256; // rows
constexpr Index RowsToCheck = 16384;
}

void openBlocks(const CellBatches& batches, const std::vector<Index>& free, const PatternId& id,
  BlockCsr3f& matrix, Monitor& monitor)
{
  const auto rows = static_cast<Index>(free.size());
  BlockPattern pattern;
  pattern.offsets.reserve(rows + 1);
  pattern.placeOffsets.reserve(rows + 1);
  // Calls add(column) for each corner of the row's cells from the row on.
  const auto forUpper = [&](Index i, const auto& add)
  {
    for (const Index* use = batches.uses().begin(i); use != batches.uses().end(i); ++use)
    {
      const Index batch = batches.batchOf(*use), first = batches.firstPlace(batch);
      const Index lane = (*use - first) % SimdWidth;
      for (int a = 0; a < batches.corners(batch); ++a)
      {
        const std::int32_t column = batches.row(first + a * SimdWidth + lane);
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
    sortUnique(row);
    if (row.size() > std::numeric_limits<std::uint16_t>::max())
    {
      throw Error(Error::Kind::InvalidInput,
        "Node id " + std::to_string(free[i]) +
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
  matrix.open(id, std::move(pattern));
}

void BlockGatherer::add(Index begin, Index end, const std::vector<float>& blocks,
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

void BlockGatherer::addToRow(Index row, Index begin, Index endPlace,
  const std::vector<float>& blocks, const std::vector<Index>& start)
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
}
