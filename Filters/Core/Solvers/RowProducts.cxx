// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#include "Support/Simd.h"

namespace morph
{
namespace
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

/// `Vector`: of the products. Four sums hide the latency of an addition. They are added as
/// (0 + 2) + (1 + 3), and then the entries that are left.
template <typename Vector>
struct Product
{
  template <typename Number, typename Scalar>
  static MORPH_SIMD_INLINE void run(Index first, Index last, const int* start, const int* column,
    const Number* value, const Scalar* x, Number* products)
  {
    for (Index i = first; i < last; ++i)
    {
      // Written out: GCC 12 leaves a loop over the sums as one, and keeps them in memory.
      Vector sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {}, row;
      Index k = start[i];
      const Index end = start[i + 1];
      for (; end - k > 3; k += 4)
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
      for (; k < end; ++k)
      {
        read(x + SimdWidth * column[k], row);
        sum0 += value[k] * row;
      }
      store(sum0, products + SimdWidth * (i - first));
    }
  }
};

template <typename Vector, typename Number, typename Row>
void productsOf(const CsrRows<Number>& A, const Row* x, Index first, Index last,
  Eigen::Matrix<Number, 4, 1>* products)
{
  if (first < last) // vectors may be empty
  {
    const auto* numbers = x ? x->data() : nullptr;
    Number* to = products->data();
    dispatched<Product<Vector>>(first, last, A.start, A.column, A.value, numbers, to);
  }
}
}

void rowProducts(const CsrRows<float>& A, const Eigen::Vector4f* x, Index first, Index last,
  Eigen::Vector4f* products)
{
  productsOf<SimdFloat4>(A, x, first, last, products);
}

void rowProducts(const CsrRows<double>& A, const MultiVectorRow* x, Index first, Index last,
  MultiVectorRow* products)
{
  productsOf<SimdDouble4>(A, x, first, last, products);
}

void rowProducts(const CsrRows<double>& A, const Eigen::Vector4f* x, Index first, Index last,
  MultiVectorRow* products)
{
  productsOf<SimdDouble4>(A, x, first, last, products);
}
}
