// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowProducts.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define MORPH_HAS_AVX2_CODE
#endif

namespace morph
{
namespace
{
// Four sums per row hide the latency of an addition. All versions add in the same order: sums 0 and
// 2, sums 1 and 3, both, and then the entries that are left.

template <typename Row, typename Scalar, typename Vectors>
void plainProducts(const int* start, const int* column, const Scalar* value, const Vectors& x,
  Index first, Index last, Row* products)
{
  const auto term = [&](int k)
  { return Row(value[k] * x[column[k]].template cast<typename Row::Scalar>()); };
  for (Index i = first; i < last; ++i)
  {
    Row sum[4] = { Row::Zero(), Row::Zero(), Row::Zero(), Row::Zero() };
    int k = start[i];
    const int end = start[i + 1];
    for (; k + 3 < end; k += 4)
    {
      sum[0] += term(k);
      sum[1] += term(k + 1);
      sum[2] += term(k + 2);
      sum[3] += term(k + 3);
    }
    Row all = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    for (; k < end; ++k)
    {
      all += term(k);
    }
    products[i - first] = all;
  }
}

#ifdef MORPH_HAS_AVX2_CODE
bool hasAvx2()
{
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

__attribute__((target("avx2"))) void avx2Products(const int* start, const int* column,
  const float* value, const float* x, Index first, Index last, float* products)
{
  const __m256i firstPair = _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1);
  const __m256i secondPair = _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3);
  const auto row = [x](int j) __attribute__((target("avx2")))
  {
    return _mm_load_ps(x + 4 * static_cast<Index>(j));
  };
  for (Index i = first; i < last; ++i)
  {
    __m256 sums01 = _mm256_setzero_ps(), sums23 = sums01;
    int k = start[i];
    const int end = start[i + 1];
    for (; k + 3 < end; k += 4)
    {
      const __m256 values = _mm256_castps128_ps256(_mm_loadu_ps(value + k));
      const __m256 rows01 = _mm256_set_m128(row(column[k + 1]), row(column[k]));
      const __m256 rows23 = _mm256_set_m128(row(column[k + 3]), row(column[k + 2]));
      sums01 =
        _mm256_add_ps(sums01, _mm256_mul_ps(_mm256_permutevar8x32_ps(values, firstPair), rows01));
      sums23 =
        _mm256_add_ps(sums23, _mm256_mul_ps(_mm256_permutevar8x32_ps(values, secondPair), rows23));
    }
    const __m256 pair = _mm256_add_ps(sums01, sums23);
    __m128 all = _mm_add_ps(_mm256_castps256_ps128(pair), _mm256_extractf128_ps(pair, 1));
    for (; k < end; ++k)
    {
      all = _mm_add_ps(all, _mm_mul_ps(_mm_set1_ps(value[k]), row(column[k])));
    }
    _mm_store_ps(products + 4 * (i - first), all);
  }
}

__attribute__((target("avx2"), always_inline)) inline __m256d doubleRow(const double* x, int j)
{
  return _mm256_loadu_pd(x + 4 * static_cast<Index>(j));
}

__attribute__((target("avx2"), always_inline)) inline __m256d doubleRow(const float* x, int j)
{
  return _mm256_cvtps_pd(_mm_load_ps(x + 4 * static_cast<Index>(j)));
}

template <typename Scalar>
__attribute__((target("avx2"))) void avx2Products(const int* start, const int* column,
  const double* value, const Scalar* x, Index first, Index last, double* products)
{
  for (Index i = first; i < last; ++i)
  {
    __m256d sum[4] = { _mm256_setzero_pd(), _mm256_setzero_pd(), _mm256_setzero_pd(),
      _mm256_setzero_pd() };
    int k = start[i];
    const int end = start[i + 1];
    for (; k + 3 < end; k += 4)
    {
      for (int j = 0; j < 4; ++j)
      {
        sum[j] = _mm256_add_pd(
          sum[j], _mm256_mul_pd(_mm256_broadcast_sd(value + k + j), doubleRow(x, column[k + j])));
      }
    }
    __m256d all = _mm256_add_pd(_mm256_add_pd(sum[0], sum[2]), _mm256_add_pd(sum[1], sum[3]));
    for (; k < end; ++k)
    {
      all =
        _mm256_add_pd(all, _mm256_mul_pd(_mm256_broadcast_sd(value + k), doubleRow(x, column[k])));
    }
    _mm256_storeu_pd(products + 4 * (i - first), all);
  }
}
#endif

template <typename Row, typename Scalar, typename Vectors>
void anyProducts(const int* start, const int* column, const Scalar* value, const Vectors& x,
  Index first, Index last, Row* products)
{
#ifdef MORPH_HAS_AVX2_CODE
  if (hasAvx2())
  {
    avx2Products(start, column, value, x.data()->data(), first, last, products->data());
    return;
  }
#endif
  plainProducts(start, column, value, x, first, last, products);
}
}

void rowProducts(const CsrRows<float>& A, const FloatMultiVector& x, Index first, Index last,
  Eigen::Vector4f* products)
{
  anyProducts(A.start, A.column, A.value, x, first, last, products);
}

void rowProducts(
  const CsrMatrix& A, const MultiVector& x, Index first, Index last, MultiVectorRow* products)
{
  anyProducts(A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), x, first, last, products);
}

void rowProducts(
  const CsrMatrix& A, const FloatMultiVector& x, Index first, Index last, MultiVectorRow* products)
{
  anyProducts(A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), x, first, last, products);
}
}
