// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#include <type_traits>

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
}

template <typename Number, typename Row>
void rowProducts(const CsrRows<Number>& A, const Row* x, Index first, Index last,
  Eigen::Matrix<Number, 4, 1>* products)
{
  using Vector = std::conditional_t<std::is_same_v<Number, float>, SimdFloat4, SimdDouble4>;
  if (first < last) // vectors may be empty
  {
    const auto* numbers = x ? x->data() : nullptr;
    Number* to = products->data();
    dispatched<Product<Vector>>(first, last, A.start, A.column, A.value, numbers, to);
  }
}

template void rowProducts(
  const CsrRows<float>&, const Eigen::Vector4f*, Index, Index, Eigen::Vector4f*);
template void rowProducts(
  const CsrRows<double>&, const MultiVectorRow*, Index, Index, MultiVectorRow*);
template void rowProducts(
  const CsrRows<double>&, const Eigen::Vector4f*, Index, Index, MultiVectorRow*);
}
