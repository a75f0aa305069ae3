// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Types.h"

#include <algorithm>

namespace morph
{
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
