// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Simd.h"
#include "Support/Types.h"

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
}
