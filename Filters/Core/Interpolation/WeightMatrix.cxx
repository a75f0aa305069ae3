// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/WeightMatrix.h"

#include "Support/Error.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>
#include <utility>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr Index MostBlocks = 32;
/// 800 GB are not even requested, and Eigen counts as wide as addresses are.
constexpr Index MostEntries =
  std::min<Index>(Index(1) << 36, std::numeric_limits<Eigen::Index>::max());

using PaddedPoints = WeightMatrix::PaddedPoints;

/// Four numbers a site fill vector registers; three do not.
MORPH_SIMD_INLINE SimdDouble4 site(const double* sites, std::int32_t column)
{
  return load(sites + SimdWidth * static_cast<Index>(column));
}

/// Computes the weighted sum of `n` sites, three numbers each. Four partial sums hide the latency
/// of an addition.
MORPH_SIMD_INLINE void weightedSum(
  const std::int32_t* column, const double* weight, Index n, const double* sites, double* sum)
{
  SimdDouble4 first = {}, second = first, third = first, fourth = first;
  Index e = 0;
  for (; n - e > 3; e += 4)
  {
    first += weight[e] * site(sites, column[e]);
    second += weight[e + 1] * site(sites, column[e + 1]);
    third += weight[e + 2] * site(sites, column[e + 2]);
    fourth += weight[e + 3] * site(sites, column[e + 3]);
  }
  first = (first + third) + (second + fourth);
  for (; e < n; ++e)
  {
    first += weight[e] * site(sites, column[e]);
  }
  sum[0] = first[0];
  sum[1] = first[1];
  sum[2] = first[2];
}

struct MultiplyRow
{
  static MORPH_SIMD_INLINE void run(
    Index row, const WeightMatrix& matrix, const PaddedPoints& sites, Points& free)
  {
    weightedSum(matrix.column(row), matrix.weight(row), matrix.entries(row), sites.data(),
      free.data() + 3 * row);
  }
};
}

void WeightMatrix::open(Index columns, std::vector<Index> offsets)
{
  if (columns > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("There are " + std::to_string(columns) +
                " prescribed places, more than the weights can number (2^31 - 1).");
  }
  const Index entries = offsets.back();
  bool fits = entries <= MostEntries;
  try
  {
    this->column_.resize(fits ? entries : 0);
    this->weight_.resize(fits ? entries : 0);
  }
  catch (const std::bad_alloc&)
  {
    fits = false;
  }
  if (!fits)
  {
    *this = WeightMatrix();
    throw Error("The weights need " + std::to_string(12 * entries / 1000000) +
                " MB, more than there is. Use fewer neighbors, or prescribe fewer nodes.");
  }
  this->columns_ = columns;
  this->offsets_ = std::move(offsets);
}

void WeightMatrix::open(Index rows, Index columns, Index entries)
{
  std::vector<Index> offsets(rows + 1);
  for (Index i = 0; i <= rows; ++i)
  {
    offsets[i] = i * entries;
  }
  this->open(columns, std::move(offsets));
}

void WeightMatrix::multiply(const Points& sites, Points& free, Monitor& monitor) const
{
  this->multiplyPadded(padded(sites, monitor), free, monitor);
}

PaddedPoints WeightMatrix::padded(const Points& sites, Monitor& monitor)
{
  PaddedPoints result(sites.rows(), 4);
  parallel(sites.rows(), monitor, [&](Index s) { result.row(s) << sites.row(s), 0; });
  return result;
}

void WeightMatrix::multiplyPadded(const PaddedPoints& sites, Points& free, Monitor& monitor) const
{
  free.resize(this->rows(), 3);
  monitor.parallelFor(this->rows(), Grain,
    [&](Index first, Index last) { dispatchedFor<MultiplyRow>(first, last, *this, sites, free); });
}

void WeightMatrix::multiplyTranspose(const Points& free, Points& sites, Monitor& monitor) const
{
  // As many blocks as keep their sums smaller than the matrix. The number depends on sizes only,
  // never on threads.
  const Index blocks = std::min(
    MostBlocks, std::max<Index>(1, this->entries() / (8 * std::max<Index>(1, this->columns()))));
  const Index length = (this->rows() + blocks - 1) / blocks;
  std::vector<Points> part(blocks);
  parallel(blocks, 1, monitor,
    [&](Index b)
    {
      part[b].setZero(this->columns(), 3);
      const Index last = std::min(this->rows(), (b + 1) * length);
      for (Index row = b * length; row < last; ++row)
      {
        const std::int32_t* column = this->column(row);
        const double* weight = this->weight(row);
        const double* y = free.data() + 3 * row;
        const Index n = this->entries(row);
        for (Index e = 0; e < n; ++e)
        {
          double* at = part[b].data() + 3 * static_cast<Index>(column[e]);
          at[0] += weight[e] * y[0];
          at[1] += weight[e] * y[1];
          at[2] += weight[e] * y[2];
        }
      }
    });
  sites.resize(this->columns(), 3);
  monitor.parallelFor(this->columns(), Grain,
    [&](Index first, Index last)
    {
      const Index n = last - first;
      sites.middleRows(first, n) = part[0].middleRows(first, n);
      for (Index b = 1; b < blocks; ++b)
      {
        sites.middleRows(first, n) += part[b].middleRows(first, n);
      }
    });
}
}
