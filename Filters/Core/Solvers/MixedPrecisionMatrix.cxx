// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/MixedPrecisionMatrix.h"

#include "Solvers/ChunkedMatrix.h"
#include "Support/HugePages.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

namespace morph
{
namespace
{
constexpr Index Grain = 65536; // entries
constexpr Index RowGrain = 4096;

/// Returns the largest finite size; 0 where there is none.
double largestSize(const double* value, Index count)
{
  double most = 0;
  for (Index k = 0; k < count; ++k)
  {
    const double size = std::abs(value[k]);
    most = size > most && size <= std::numeric_limits<double>::max() ? size : most;
  }
  return most;
}
}

MixedPrecisionMatrix::MixedPrecisionMatrix(const CsrMatrix& matrix, Monitor& monitor)
{
  if (!matrix.isCompressed())
  {
    CsrMatrix compressed = matrix;
    compressed.makeCompressed();
    *this = MixedPrecisionMatrix(compressed, monitor);
    return;
  }
  const Index entries = matrix.nonZeros();
  this->allocate(matrix.rows(), matrix.cols(), entries, largestSize(matrix.valuePtr(), entries));
  std::copy_n(matrix.outerIndexPtr(), matrix.rows() + 1, this->rounded_.ownStart.data());
  monitor.parallelFor(entries, Grain,
    [&](Index first, Index last)
    {
      std::copy(matrix.innerIndexPtr() + first, matrix.innerIndexPtr() + last,
        this->columnsInWork() + first);
      this->store(matrix.valuePtr() + first, last - first, first);
    });
}

MixedPrecisionMatrix::MixedPrecisionMatrix(ChunkedMatrix chunked, Monitor& monitor)
{
  std::vector<StoredRows<double>>& chunks = chunked.chunks;
  const auto count = static_cast<Index>(chunks.size());
  std::vector<double> largest(chunks.size(), 0);
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        largest[c] = largestSize(chunks[c].values(), static_cast<Index>(chunks[c].entries()));
      }
    });
  this->allocate(chunked.rows, chunked.columns, chunked.entries(),
    largest.empty() ? 0 : *std::max_element(largest.begin(), largest.end()));
  chunked.setStarts(this->rounded_.ownStart.data());
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const Index at = this->rounded_.start[c * ChunkRows];
        this->store(chunks[c].values(), static_cast<Index>(chunks[c].entries()), at);
        chunks[c].copyColumns(this->columnsInWork() + at);
        chunks[c] = {};
      }
    });
}

void MixedPrecisionMatrix::allocate(Index rows, Index columns, Index entries, double largest)
{
  constexpr int MostExponent = 1000; // its power of two and the inverse are finite
  const int exponent =
    largest > 0 ? std::clamp(std::ilogb(largest) - LargestExponent, -MostExponent, MostExponent)
                : 0;
  this->unit_ = std::ldexp(1., exponent);
  this->width_ = columns;
  this->rounded_.rows = static_cast<int>(rows);
  this->rounded_.ownStart.resize(rows + 1);
  this->columns_ = PageBlock(entries * sizeof(int));
  resizeUndefined(this->rounded_.ownValue, entries);
  resizeUndefined(this->rest_, entries);
  this->rounded_.adopt();
  this->rounded_.column = this->columnsInWork();
}

void MixedPrecisionMatrix::store(const double* value, Index count, Index k)
{
  constexpr double Least = std::numeric_limits<float>::min();
  const double scale = 1 / this->unit_;
  const auto bitsOf = [](double number)
  {
    std::int64_t bits;
    std::memcpy(&bits, &number, sizeof(bits));
    return bits;
  };
  float* rounded = this->rounded_.ownValue.data() + k;
  int* rest = this->rest_.data() + k;
  for (Index i = 0; i < count; ++i)
  {
    double number = value[i] * scale;
    if (std::abs(number) < Least && value[i] != 0)
    {
      number = std::copysign(Least, number);
    }
    rounded[i] = static_cast<float>(number);
    // At most half of what the last digit of a float counts in those of a double: 2^28.
    rest[i] = static_cast<int>(bitsOf(number) - bitsOf(rounded[i]));
  }
}

bool MixedPrecisionMatrix::columnsAreNear(Monitor& monitor) const
{
  std::atomic<bool> areNear = true;
  monitor.parallelFor(this->rows(), RowGrain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last && areNear; ++i)
      {
        this->forSteps(i,
          [&](int, Index step)
          {
            if (step < 0 || step > NarrowColumns::MostStep)
            {
              areNear = false;
            }
          });
      }
    });
  return areNear;
}

bool MixedPrecisionMatrix::narrowColumns(Monitor& monitor)
{
  CsrRows<float>& A = this->rounded_;
  if (A.step)
  {
    return true;
  }
  if (!this->columnsAreNear(monitor))
  {
    return false;
  }
  // Steps take the place of columns that have been read: band by band, through a copy.
  constexpr Index Band = 16 * RowGrain;
  std::vector<std::uint16_t> steps;
  for (Index begin = 0; begin < A.rows; begin += Band)
  {
    const Index end = std::min<Index>(A.rows, begin + Band);
    const int start = A.start[begin];
    steps.resize(A.start[end] - start);
    monitor.parallelFor(end - begin, RowGrain,
      [&](Index first, Index last)
      {
        for (Index i = begin + first; i < begin + last; ++i)
        {
          this->forSteps(
            i, [&](int k, Index step) { steps[k - start] = static_cast<std::uint16_t>(step); });
        }
      });
    constexpr std::size_t Size = sizeof(std::uint16_t);
    if (!steps.empty())
    {
      std::memcpy(this->columns_.data() + Size * start, steps.data(), Size * steps.size());
    }
  }
  this->columns_.shrink(sizeof(std::uint16_t) * this->entries());
  A.column = nullptr;
  A.step = reinterpret_cast<const std::uint16_t*>(this->columns_.data());
  return true;
}

Eigen::VectorXd MixedPrecisionMatrix::diagonal(Monitor& monitor) const
{
  Eigen::VectorXd diagonal(this->rows());
  monitor.parallelFor(this->rows(), RowGrain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        diagonal[i] = 0;
        this->forRow(
          i, [&](int column, int k) { diagonal[i] += column == i ? this->value(k) : 0; });
      }
    });
  return diagonal;
}

CsrMatrix MixedPrecisionMatrix::toCsr() const
{
  const auto entries = static_cast<Index>(this->entries());
  CsrMatrix matrix;
  allocateRows(matrix, this->rows(), this->width_, entries);
  matrix.outerIndexPtr()[0] = 0;
  for (Index i = 0; i < this->rows(); ++i)
  {
    matrix.outerIndexPtr()[i + 1] = this->rounded_.start[i + 1];
    this->forRow(i,
      [&](int column, int k)
      {
        matrix.innerIndexPtr()[k] = column;
        matrix.valuePtr()[k] = this->value(k);
      });
  }
  return matrix;
}

double MixedPrecisionMatrix::bytesRead() const
{
  return this->rounded_.bytesRead() + sizeof(int) * static_cast<double>(this->entries());
}

std::size_t MixedPrecisionMatrix::memory() const
{
  return sizeof(int) * (this->rounded_.ownStart.size() + this->rest_.size()) +
         sizeof(float) * this->rounded_.ownValue.size() + this->columns_.bytes();
}
}
