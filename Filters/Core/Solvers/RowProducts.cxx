// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#include "Support/Simd.h"
#include "Support/SimdDispatch.h"
#include "Support/SimdMath.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace morph
{
namespace
{
using SimdFloat8 = float __attribute__((vector_size(32)));

/// Copies row j of a multivector.
///@{
MORPH_SIMD_INLINE void loadRow(const float* x, int j, SimdFloat4& row)
{
  std::memcpy(&row, x + SimdWidth * j, sizeof(row));
}
MORPH_SIMD_INLINE void loadRow(const double* x, int j, SimdDouble4& row)
{
  std::memcpy(&row, x + SimdWidth * j, sizeof(row));
}
MORPH_SIMD_INLINE void loadRow(const float* x, int j, SimdDouble4& row)
{
  row = widened(x + SimdWidth * j);
}
///@}

// Four sums hide the latency of an addition. They are added as (0 + 2) + (1 + 3), and then the
// entries that are left.

/// In double precision, of values that are split as in MixedPrecisionMatrix.
struct DoubleProduct
{
  template <typename Scalar>
  static MORPH_SIMD_INLINE void run(Index i, const int* start, const int* column,
    const float* rounded, const int* rest, double unit, const Scalar* x, Index first,
    MultiVectorRow* products)
  {
    SimdDouble4 sum[4] = {}, row;
    int k = start[i];
    const int end = start[i + 1];
    for (; k + 3 < end; k += 4)
    {
      const SimdDouble4 value = joinValues(rounded + k, rest + k);
      loadRow(x, column[k], row);
      sum[0] += __builtin_shufflevector(value, value, 0, 0, 0, 0) * row;
      loadRow(x, column[k + 1], row);
      sum[1] += __builtin_shufflevector(value, value, 1, 1, 1, 1) * row;
      loadRow(x, column[k + 2], row);
      sum[2] += __builtin_shufflevector(value, value, 2, 2, 2, 2) * row;
      loadRow(x, column[k + 3], row);
      sum[3] += __builtin_shufflevector(value, value, 3, 3, 3, 3) * row;
    }
    SimdDouble4 all = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    for (; k < end; ++k)
    {
      loadRow(x, column[k], row);
      all += joinValue(rounded[k], rest[k]) * row;
    }
    all *= unit; // a power of two: nothing is rounded
    std::memcpy(products[i - first].data(), &all, sizeof(all));
  }

private:
  static MORPH_SIMD_INLINE SimdDouble4 joinValues(const float* rounded, const int* rest)
  {
    return reinterpret_cast<SimdDouble4>(
      reinterpret_cast<SimdInteger4>(widened(rounded)) + widened(rest));
  }
  static MORPH_SIMD_INLINE double joinValue(float rounded, int rest)
  {
    double number = rounded;
    std::int64_t bits;
    std::memcpy(&bits, &number, sizeof(bits));
    bits += rest;
    std::memcpy(&number, &bits, sizeof(bits));
    return number;
  }
};

/// In single precision. Two sums share a register, which saves 8 % of an evaluation with AVX2.
struct FloatProduct
{
  static MORPH_SIMD_INLINE void run(Index i, const int* start, const int* column,
    const float* value, const float* x, Index first, Eigen::Vector4f* products)
  {
    SimdFloat8 sums01 = {}, sums23 = {};
    SimdFloat4 row[4], values;
    int k = start[i];
    const int end = start[i + 1];
    for (; k + 3 < end; k += 4)
    {
      std::memcpy(&values, value + k, sizeof(values));
      for (int j = 0; j < 4; ++j)
      {
        loadRow(x, column[k + j], row[j]);
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
      loadRow(x, column[k], row[0]);
      all += value[k] * row[0];
    }
    std::memcpy(products[i - first].data(), &all, sizeof(all));
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
  const Index origin = first;
  dispatchedFor<DoubleProduct>(
    first, last, A.start, A.column, A.value, rest, unit, numbers, origin, products);
}
}

void rowProducts(const CsrRows<float>& A, const Eigen::Vector4f* x, Index first, Index last,
  Eigen::Vector4f* products)
{
  const float* numbers = numbersOf(x);
  const Index origin = first;
  dispatchedFor<FloatProduct>(first, last, A.start, A.column, A.value, numbers, origin, products);
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
