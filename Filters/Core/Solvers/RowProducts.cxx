// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#include "Solvers/RowSum.h"

namespace morph
{
namespace
{
/// `Vector`: of the products.
template <typename Vector>
struct Product
{
  template <typename Number, typename Scalar>
  static MORPH_SIMD_INLINE void run(Index first, Index last, const int* start, const int* column,
    const Number* value, const Scalar* x, Number* products)
  {
    for (Index i = first; i < last; ++i)
    {
      store(rowSum<Vector>(start[i], start[i + 1], column, value, x),
        products + SimdWidth * (i - first));
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
