// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#include "Support/Prefetch.h"
#include "Support/Simd.h"
#include "Support/SimdDispatch.h"
#include "Support/SimdMath.h"

#include <cstdint>
#include <cstring>

namespace morph
{
namespace
{
using SimdFloat8 = float __attribute__((vector_size(32)));

/// Copies the row of a multivector that starts after `at` doubles.
///@{
MORPH_SIMD_INLINE void load(const float* x, Index at, SimdFloat4& row)
{
  std::memcpy(&row, x + 2 * at, sizeof(row));
}
MORPH_SIMD_INLINE void load(const float* x, Index at, SimdDouble4& row)
{
  row = widened(x + 2 * at);
}
MORPH_SIMD_INLINE void load(const double* x, Index at, SimdDouble4& row)
{
  std::memcpy(&row, x + at, sizeof(row));
}
///@}

/// How a row's columns are read, one after the other. `Doubles`: the size of a multivector's row.
/// `at`: where the multivector's row of the column before starts, in doubles, and then that of this
/// column. x86 multiplies by 2, 4 and 8 while it adds and addresses, which saves an instruction.
///@{
template <Index Doubles>
struct WideColumn
{
  using Stored = int;
  static constexpr int Lines = 2;
  static MORPH_SIMD_INLINE Index before(Index) { return 0; }
  static MORPH_SIMD_INLINE void next(const int* stored, Index& at) { at = Doubles * *stored; }
};
template <Index Doubles>
struct NarrowColumn
{
  using Stored = std::uint16_t;
  static constexpr int Lines = 1;
  static MORPH_SIMD_INLINE Index before(Index row) { return Doubles * NarrowColumns::before(row); }
  static MORPH_SIMD_INLINE void next(const std::uint16_t* stored, Index& at)
  {
    at += Doubles * *stored;
  }
};
///@}

// Asking for memory ahead saves 15 to 25 % of a product on hexahedra. Their rows have two lines.
// Each body makes all rows by itself, as its pointers then stay in registers.
// Four sums hide the latency of an addition. They are added as (0 + 2) + (1 + 3), and then the
// entries that are left.

/// In double precision, of values that are split as in MixedPrecisionMatrix.
template <template <Index> typename ColumnOf>
struct DoubleProduct
{
  template <typename Scalar>
  static MORPH_SIMD_INLINE void run(Index first, Index last, const int* start,
    const typename ColumnOf<1>::Stored* column, const float* rounded, const int* rest, double unit,
    const Scalar* x, MultiVectorRow* products)
  {
    using Column = ColumnOf<SimdWidth * sizeof(Scalar) / sizeof(double)>;
    for (Index i = first; i < last; ++i)
    {
      SimdDouble4 sum[4] = {}, row;
      Index at = Column::before(i);
      int k = start[i];
      const int end = start[i + 1];
      prefetchAhead(column, k, Column::Lines);
      prefetchAhead(rounded, k, 2);
      prefetchAhead(rest, k, 2);
      for (; end - k > 3; k += 4)
      {
        // Written out: GCC 12 leaves a loop here as one, and copies rows through memory.
        const SimdDouble4 value = joinValues(rounded + k, rest + k);
        Column::next(column + k, at);
        load(x, at, row);
        sum[0] += __builtin_shufflevector(value, value, 0, 0, 0, 0) * row;
        Column::next(column + k + 1, at);
        load(x, at, row);
        sum[1] += __builtin_shufflevector(value, value, 1, 1, 1, 1) * row;
        Column::next(column + k + 2, at);
        load(x, at, row);
        sum[2] += __builtin_shufflevector(value, value, 2, 2, 2, 2) * row;
        Column::next(column + k + 3, at);
        load(x, at, row);
        sum[3] += __builtin_shufflevector(value, value, 3, 3, 3, 3) * row;
      }
      SimdDouble4 all = (sum[0] + sum[2]) + (sum[1] + sum[3]);
      for (; k < end; ++k)
      {
        Column::next(column + k, at);
        load(x, at, row);
        all += MixedPrecisionMatrix::joined(rounded[k], rest[k]) * row;
      }
      all *= unit; // a power of two: nothing is rounded
      std::memcpy(products[i - first].data(), &all, sizeof(all));
    }
  }

private:
  static MORPH_SIMD_INLINE SimdDouble4 joinValues(const float* rounded, const int* rest)
  {
    return reinterpret_cast<SimdDouble4>(
      reinterpret_cast<SimdInteger4>(widened(rounded)) + widened(rest));
  }
};

/// In single precision. Two sums share a register, which saves 8 % of an evaluation with AVX2.
template <template <Index> typename ColumnOf>
struct FloatProduct
{
  static MORPH_SIMD_INLINE void run(Index first, Index last, const int* start,
    const typename ColumnOf<1>::Stored* column, const float* value, const float* x,
    Eigen::Vector4f* products)
  {
    using Column = ColumnOf<SimdWidth * sizeof(float) / sizeof(double)>;
    for (Index i = first; i < last; ++i)
    {
      SimdFloat8 sums01 = {}, sums23 = {};
      SimdFloat4 row[4], values;
      Index at = Column::before(i);
      int k = start[i];
      const int end = start[i + 1];
      prefetchAhead(column, k, Column::Lines);
      prefetchAhead(value, k, 2);
      for (; end - k > 3; k += 4)
      {
        std::memcpy(&values, value + k, sizeof(values));
        for (int j = 0; j < 4; ++j)
        {
          Column::next(column + k + j, at);
          load(x, at, row[j]);
        }
        sums01 += __builtin_shufflevector(values, values, 0, 0, 0, 0, 1, 1, 1, 1) *
                  __builtin_shufflevector(row[0], row[1], 0, 1, 2, 3, 4, 5, 6, 7);
        sums23 += __builtin_shufflevector(values, values, 2, 2, 2, 2, 3, 3, 3, 3) *
                  __builtin_shufflevector(row[2], row[3], 0, 1, 2, 3, 4, 5, 6, 7);
      }
      const SimdFloat8 pairs = sums01 + sums23;
      SimdFloat4 all = __builtin_shufflevector(pairs, pairs, 0, 1, 2, 3) +
                       __builtin_shufflevector(pairs, pairs, 4, 5, 6, 7);
      for (; k < end; ++k)
      {
        Column::next(column + k, at);
        load(x, at, row[0]);
        all += value[k] * row[0];
      }
      std::memcpy(products[i - first].data(), &all, sizeof(all));
    }
  }
};

/// The numbers of a multivector, which may be empty.
template <typename Row>
const typename Row::Scalar* numbersOf(const Row* x)
{
  return x ? x->data() : nullptr;
}

template <typename Row>
void doubleProducts(const MixedPrecisionMatrix& matrix, const Row* x, Index first, Index last,
  MultiVectorRow* products)
{
  const CsrRows<float>& A = matrix.rounded();
  const int* rest = matrix.rest();
  const double unit = matrix.unit();
  const auto* numbers = numbersOf(x);
  if (A.step)
  {
    dispatched<DoubleProduct<NarrowColumn>>(
      first, last, A.start, A.step, A.value, rest, unit, numbers, products);
    return;
  }
  dispatched<DoubleProduct<WideColumn>>(
    first, last, A.start, A.column, A.value, rest, unit, numbers, products);
}
}

void rowProducts(const CsrRows<float>& A, const Eigen::Vector4f* x, Index first, Index last,
  Eigen::Vector4f* products)
{
  const float* numbers = numbersOf(x);
  if (A.step)
  {
    dispatched<FloatProduct<NarrowColumn>>(
      first, last, A.start, A.step, A.value, numbers, products);
    return;
  }
  dispatched<FloatProduct<WideColumn>>(first, last, A.start, A.column, A.value, numbers, products);
}

void rowProducts(const MixedPrecisionMatrix& A, const MultiVectorRow* x, Index first, Index last,
  MultiVectorRow* products)
{
  doubleProducts(A, x, first, last, products);
}

void rowProducts(const MixedPrecisionMatrix& A, const Eigen::Vector4f* x, Index first, Index last,
  MultiVectorRow* products)
{
  doubleProducts(A, x, first, last, products);
}
}
