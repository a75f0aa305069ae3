// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Simd.h"
#include "Support/Types.h"

#include <algorithm>

namespace morph
{
MORPH_SIMD_INLINE void read(const float* x, SimdFloat4& row)
{
  row = load(x);
}
MORPH_SIMD_INLINE void read(const float* x, SimdDouble4& row)
{
  row = widened(x);
}
MORPH_SIMD_INLINE void read(const double* x, SimdDouble4& row)
{
  row = load(x);
}

/// Returns the sum of value[k] x[column[k]] for k in [first, last), of rows of four numbers. Four
/// sums hide the latency of an addition. They are added as (0 + 2) + (1 + 3), and then the entries
/// that are left.
template <typename Vector, typename Number, typename Scalar>
MORPH_SIMD_INLINE Vector rowSum(
  Index first, Index last, const int* column, const Number* value, const Scalar* x)
{
  // Written out: GCC 12 leaves a loop over the sums as one, and keeps them in memory.
  Vector sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {}, row;
  Index k = first;
  for (; last - k > 3; k += 4)
  {
    read(x + SimdWidth * column[k], row);
    sum0 += value[k] * row;
    read(x + SimdWidth * column[k + 1], row);
    sum1 += value[k + 1] * row;
    read(x + SimdWidth * column[k + 2], row);
    sum2 += value[k + 2] * row;
    read(x + SimdWidth * column[k + 3], row);
    sum3 += value[k + 3] * row;
  }
  sum0 = (sum0 + sum2) + (sum1 + sum3);
  for (; k < last; ++k)
  {
    read(x + SimdWidth * column[k], row);
    sum0 += value[k] * row;
  }
  return sum0;
}

/// Sets products[i - first] to (A x)_i for the rows in [first, last). `x`: a row for each column
/// of A, MultiVectorRow or Eigen::Vector4f, the latter alone for floats. It uses AVX2 where the
/// processor has it; the bits are the same without.
template <typename Number, typename Row>
void rowProducts(const CsrRows<Number>& A, const Row* x, Index first, Index last,
  Eigen::Matrix<Number, 4, 1>* products);

/// Calls use(i, (A x)_i) for the rows in [first, last), in their order. `use` may write other
/// vectors than x.
template <typename Number, typename Row, typename Use>
void forRowProducts(const CsrRows<Number>& A, const Row* x, Index first, Index last, const Use& use)
{
  constexpr Index Batch = 64; // its products stay in the fastest cache
  Eigen::Matrix<Number, 4, 1> products[Batch];
  for (Index start = first; start < last; start += Batch)
  {
    const Index end = std::min(last, start + Batch);
    rowProducts(A, x, start, end, products);
    for (Index i = start; i < end; ++i)
    {
      use(i, products[i - start]);
    }
  }
}
}
