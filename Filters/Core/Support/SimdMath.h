// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Simd.h"

#include <cmath>

namespace morph
{
/// These functions are always inlined, so they use the registers that their caller is compiled for.
#define MORPH_SIMD_INLINE inline __attribute__((always_inline))

MORPH_SIMD_INLINE SimdDouble4 load(const double (&x)[SimdWidth])
{
  return SimdDouble4{ x[0], x[1], x[2], x[3] };
}

/// Reads four numbers. GCC 12 makes one instruction of this, and five of __builtin_convertvector.
///@{
MORPH_SIMD_INLINE SimdDouble4 widened(const float* x)
{
  return SimdDouble4{ x[0], x[1], x[2], x[3] };
}
MORPH_SIMD_INLINE SimdInteger4 widened(const int* x)
{
  return SimdInteger4{ x[0], x[1], x[2], x[3] };
}
///@}

MORPH_SIMD_INLINE double squareRoot(double x)
{
  return std::sqrt(x);
}

MORPH_SIMD_INLINE SimdDouble4 squareRoot(const SimdDouble4& x)
{
  return SimdDouble4{ std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]) };
}

MORPH_SIMD_INLINE bool any(bool condition)
{
  return condition;
}

/// `mask`: the result of a comparison.
template <typename Mask>
MORPH_SIMD_INLINE bool any(const Mask& mask)
{
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

MORPH_SIMD_INLINE double inverseCubeRoot(double x)
{
  return 1 / std::cbrt(x);
}

/// Computes x^(-1/3) of normal positive numbers, to a few units in the last place. The first guess
/// divides the exponent by three; Newton's method refines it.
MORPH_SIMD_INLINE SimdDouble4 inverseCubeRoot(const SimdDouble4& x)
{
  using Integers = long long __attribute__((vector_size(32)));
  constexpr double Magic = 0x1p52; // adding it puts integers below 2^52 into the mantissa
  constexpr double Exponent =
    1430257664. - 50000; // 4/3 of 1's upper word, reduced to balance the guess's errors
  constexpr int Iterations = 5;
  const SimdDouble4 magic = { Magic, Magic, Magic, Magic };
  const Integers upper = (reinterpret_cast<Integers>(x) >> 32) | reinterpret_cast<Integers>(magic);
  const SimdDouble4 guess = Exponent - (reinterpret_cast<SimdDouble4>(upper) - Magic) / 3. + Magic;
  SimdDouble4 y = reinterpret_cast<SimdDouble4>(reinterpret_cast<Integers>(guess) << 32);
  for (int i = 0; i < Iterations; ++i)
  {
    y *= (4. - x * y * y * y) * (1. / 3);
  }
  return y;
}

MORPH_SIMD_INLINE double positivePart(double x)
{
  return x > 0 ? x : 0;
}

MORPH_SIMD_INLINE SimdDouble4 positivePart(const SimdDouble4& x)
{
  return x > 0. ? x : SimdDouble4{ 0, 0, 0, 0 };
}

MORPH_SIMD_INLINE double logarithm(double x)
{
  return std::log(x);
}

/// Computes the natural logarithm of normal positive numbers, to a few units in the last place of
/// the larger of |log x| and 1. With x = 2^e m, m in [1/sqrt(2), sqrt(2)), s = (m - 1) / (m + 1),
/// it is e log 2 + 2 (s + s^3 / 3 + s^5 / 5 + ...), where |s| < 0.172.
MORPH_SIMD_INLINE SimdDouble4 logarithm(const SimdDouble4& x)
{
  using Integers = long long __attribute__((vector_size(32)));
  constexpr long long RootOfHalf = 0x3fe6a09e667f3bcdll; // the bits of sqrt(1/2)
  constexpr long long Bias = 1023;                       // keeps the exponent positive
  constexpr long long Magic = 0x4330000000000000ll;      // the bits of 2^52
  const Integers bits = reinterpret_cast<Integers>(x);
  const Integers exponent = (bits - RootOfHalf + (Bias << 52)) >> 52;
  const SimdDouble4 m = reinterpret_cast<SimdDouble4>(bits - ((exponent - Bias) << 52));
  const Integers mantissa = exponent | Magic;
  const SimdDouble4 e =
    reinterpret_cast<SimdDouble4>(mantissa) - (0x1p52 + static_cast<double>(Bias));
  const SimdDouble4 s = (m - 1.) / (m + 1.), z = s * s;
  SimdDouble4 series = { 1. / 21, 1. / 21, 1. / 21, 1. / 21 };
  for (int k = 19; k >= 1; k -= 2)
  {
    series = series * z + 1. / k;
  }
  return e * 0.693147180559945309417232121458 + 2. * s * series;
}
}
