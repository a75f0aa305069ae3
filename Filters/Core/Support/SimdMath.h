// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Simd.h"

#include <cmath>

namespace morph
{
/// Functions on lanes are inlined always: they then use the registers that their caller is compiled for.
#define MORPH_LANES_INLINE inline __attribute__((always_inline))

MORPH_LANES_INLINE Lanes load(const double (&x)[LaneCount])
{
  return Lanes{ x[0], x[1], x[2], x[3] };
}

MORPH_LANES_INLINE double squareRoot(double x)
{
  return std::sqrt(x);
}

MORPH_LANES_INLINE Lanes squareRoot(const Lanes& x)
{
  return Lanes{ std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]) };
}

MORPH_LANES_INLINE bool any(bool condition)
{
  return condition;
}

/// `mask`: of a comparison.
template <typename Mask>
MORPH_LANES_INLINE bool any(const Mask& mask)
{
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

MORPH_LANES_INLINE double inverseCubeRoot(double x)
{
  return 1 / std::cbrt(x);
}

/// x^(-1/3) of normal numbers above 0, to some units in the last place: a third of the exponent, then Newton's method.
MORPH_LANES_INLINE Lanes inverseCubeRoot(const Lanes& x)
{
  using Integers = long long __attribute__((vector_size(32)));
  constexpr double Magic = 0x1p52; // to it and from it integers below 2^52 are the mantissa
  constexpr double Exponent =
    1430257664. - 50000; // 4/3 of 1's upper word; less makes both errors of the guess alike
  constexpr int Iterations = 5;
  const Lanes magic = { Magic, Magic, Magic, Magic };
  const Integers upper = (reinterpret_cast<Integers>(x) >> 32) | reinterpret_cast<Integers>(magic);
  const Lanes guess = Exponent - (reinterpret_cast<Lanes>(upper) - Magic) / 3. + Magic;
  Lanes y = reinterpret_cast<Lanes>(reinterpret_cast<Integers>(guess) << 32);
  for (int i = 0; i < Iterations; ++i)
  {
    y *= (4. - x * y * y * y) * (1. / 3);
  }
  return y;
}
}
