// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/GaussSeidel.h"

#include "Solvers/RowSum.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>

namespace morph
{
struct GaussSeidel::Sweep
{
  static MORPH_SIMD_INLINE void run(Index first, Index last, const Place* place,
    const CsrRows<float>& A, const float* rhs, float* x)
  {
    for (Index i = first; i < last; ++i)
    {
      const Place& own = place[i];
      const SimdFloat4 before = rowSum<SimdFloat4>(own.first, own.diagonal, A.column, A.value, x);
      store(own.inverse * (load(rhs + SimdWidth * i) - before), x + SimdWidth * i);
    }
  }
};

/// The sweep has solved (D* + L) x = rhs, so rhs - A x = (D* - D - U - F) x.
struct GaussSeidel::Residual
{
  static MORPH_SIMD_INLINE void run(Index first, Index last, const Place* place,
    const CsrRows<float>& A, const float* x, float* residual)
  {
    for (Index i = first; i < last; ++i)
    {
      const Place& own = place[i];
      const SimdFloat4 rest =
        rowSum<SimdFloat4>(own.diagonal + 1, A.start[i + 1], A.column, A.value, x) +
        rowSum<SimdFloat4>(A.start[i], own.first, A.column, A.value, x);
      store(own.added * load(x + SimdWidth * i) - rest, residual + SimdWidth * i);
    }
  }
};

struct GaussSeidel::SweepBack
{
  static MORPH_SIMD_INLINE void run(Index first, Index last, const Place* place,
    const CsrRows<float>& A, const float* rhs, const float* x, float* to)
  {
    for (Index i = last; i-- > first;)
    {
      const Place& own = place[i];
      const SimdFloat4 rest =
        rowSum<SimdFloat4>(A.start[i], own.diagonal + 1, A.column, A.value, x) +
        rowSum<SimdFloat4>(own.last, A.start[i + 1], A.column, A.value, x) +
        rowSum<SimdFloat4>(own.diagonal + 1, own.last, A.column, A.value, to);
      store(load(x + SimdWidth * i) + own.inverse * (load(rhs + SimdWidth * i) - rest),
        to + SimdWidth * i);
    }
  }
};

Index GaussSeidel::blockSize() const
{
  constexpr Index Blocks = 16;
  constexpr Index Least = 4096; // of less, waking a thread would take as long
  return std::max((static_cast<Index>(this->places_.size()) + Blocks - 1) / Blocks, Least);
}

void GaussSeidel::locate(const CsrRows<float>& A, Index row)
{
  const Index first = row / this->blockSize() * this->blockSize();
  const auto find = [&](Index column)
  {
    return static_cast<int>(std::lower_bound(A.column + A.start[row], A.column + A.start[row + 1],
                              static_cast<int>(column)) -
                            A.column);
  };
  Place& own = this->places_[row];
  own.first = find(first);
  own.diagonal = find(row);
  own.last = find(std::min(first + this->blockSize(), A.rows));
}

bool GaussSeidel::prepare(const CsrRows<float>& A, float least, Monitor& monitor)
{
  this->places_.resize(A.rows);
  parallel(A.rows, monitor,
    [&](Index i)
    {
      this->locate(A, i);
      Place& own = this->places_[i];
      const bool isThere = own.diagonal < own.last && A.column[own.diagonal] == i;
      const float diagonal = isThere ? A.value[own.diagonal] : 0;
      float size = 0;
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        size += k < own.first || k >= own.last ? std::abs(A.value[k]) : 0;
      }
      own.added = size / 2;
      own.inverse = diagonal >= least && std::isfinite(diagonal) ? 1 / (diagonal + own.added) : 0;
    });
  return std::all_of(this->places_.begin(), this->places_.end(),
    [](const Place& place) { return place.inverse > 0; });
}

void GaussSeidel::prepareTransposed(
  const GaussSeidel& other, const CsrRows<float>& A, Monitor& monitor)
{
  this->places_ = other.places_;
  parallel(A.rows, monitor, [&](Index i) { this->locate(A, i); });
}

template <typename Body, typename... Arguments>
void GaussSeidel::forBlocks(Monitor& monitor, const CsrRows<float>& A, Arguments... arguments) const
{
  const Index size = this->blockSize();
  const Place* place = this->places_.data();
  parallel((A.rows + size - 1) / size, 1, monitor,
    [&](Index block)
    {
      const Index first = block * size, last = std::min(first + size, A.rows);
      dispatched<Body>(first, last, place, A, arguments...);
    });
}

void GaussSeidel::sweep(const CsrRows<float>& A, const Row* rhs, Row* x, Monitor& monitor) const
{
  this->forBlocks<Sweep>(monitor, A, rhs->data(), x->data());
}

void GaussSeidel::residual(
  const CsrRows<float>& A, const Row* x, Row* residual, Monitor& monitor) const
{
  this->forBlocks<Residual>(monitor, A, x->data(), residual->data());
}

void GaussSeidel::sweepBack(
  const CsrRows<float>& A, const Row* rhs, const Row* x, Row* to, Monitor& monitor) const
{
  this->forBlocks<SweepBack>(monitor, A, rhs->data(), x->data(), to->data());
}
}
