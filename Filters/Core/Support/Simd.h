// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cmath>
#include <cstddef>
#include <cstring>

// The only file with extensions of GCC and Clang. Other compilers, and those that define
// MORPH_SCALAR_SIMD, take the twin: the same names as plain loops over four numbers.
#if defined(__GNUC__) && !defined(MORPH_SCALAR_SIMD)
#define MORPH_HAS_GNU_VECTORS
// Vectors are only passed to inlined functions, which have no calling convention.
#pragma GCC diagnostic ignored "-Wpsabi"
/// Always inlined, so that it uses the registers that its caller is compiled for.
#define MORPH_SIMD_INLINE inline __attribute__((always_inline))
#else
#define MORPH_SIMD_INLINE inline
#endif

namespace morph
{
constexpr std::ptrdiff_t SimdWidth = 4;

#if defined(MORPH_HAS_GNU_VECTORS)
/// Vectors of four numbers: one AVX register, or two SSE registers. Each operation acts on the four
/// numbers separately, so results do not depend on the processor.
using SimdDouble4 = double __attribute__((vector_size(32)));
using SimdFloat4 = float __attribute__((vector_size(16)));
using SimdMask4 = decltype(SimdDouble4{} < SimdDouble4{}); ///< of comparisons

/// Returns a where the mask is set, and b elsewhere.
MORPH_SIMD_INLINE SimdDouble4 select(
  const SimdMask4& mask, const SimdDouble4& a, const SimdDouble4& b)
{
  return mask ? a : b;
}

/// Returns {a0, b0, a1, b1, ...} of pairs' sums: lane k is the sum of the k-th vector.
MORPH_SIMD_INLINE SimdDouble4 sumsOf(
  const SimdDouble4& a, const SimdDouble4& b, const SimdDouble4& c, const SimdDouble4& d)
{
  const SimdDouble4 ab =
    __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const SimdDouble4 cd =
    __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// Makes rows columns.
MORPH_SIMD_INLINE void transpose(const SimdFloat4* in, SimdFloat4 (&out)[4])
{
  const SimdFloat4 ab = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5),
                   AB = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7),
                   cd = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5),
                   CD = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
  out[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  out[2] = __builtin_shufflevector(AB, CD, 0, 1, 4, 5);
  out[3] = __builtin_shufflevector(AB, CD, 2, 3, 6, 7);
}
#else
/// The twin of GNU's vectors.
template <typename Number>
struct SimdLanes
{
  Number lane[SimdWidth] = {};

  SimdLanes() = default;
  SimdLanes(Number all) // NOLINT(google-explicit-constructor): numbers mix with vectors
    : SimdLanes(all, all, all, all)
  {
  }
  SimdLanes(Number a, Number b, Number c, Number d)
    : lane{ a, b, c, d }
  {
  }
  Number& operator[](std::ptrdiff_t i) { return this->lane[i]; }
  const Number& operator[](std::ptrdiff_t i) const { return this->lane[i]; }
};
template <typename Number, typename Operation>
SimdLanes<Number> simdLanes(const Operation& operation)
{
  return { Number(operation(0)), Number(operation(1)), Number(operation(2)), Number(operation(3)) };
}
using SimdDouble4 = SimdLanes<double>;
using SimdFloat4 = SimdLanes<float>;
using SimdMask4 = SimdLanes<bool>;

// For doubles and for floats: friends of the template would be looked for by conversions, too.
#define MORPH_SIMD_OPERATOR(Vector, Number, Result, operation)                  \
  inline SimdLanes<Result> operator operation(const Vector& a, const Vector& b) \
  {                                                                             \
    return simdLanes<Result>([&](int i) { return a[i] operation b[i]; });       \
  }
#define MORPH_SIMD_ARITHMETIC(Vector, Number, operation)           \
  MORPH_SIMD_OPERATOR(Vector, Number, Number, operation)           \
  inline Vector& operator operation##=(Vector& a, const Vector& b) \
  {                                                                \
    return a = a operation b;                                      \
  }
#define MORPH_SIMD_OPERATORS(Vector, Number)                \
  MORPH_SIMD_ARITHMETIC(Vector, Number, +)                  \
  MORPH_SIMD_ARITHMETIC(Vector, Number, -)                  \
  MORPH_SIMD_ARITHMETIC(Vector, Number, *)                  \
  MORPH_SIMD_ARITHMETIC(Vector, Number, /)                  \
  inline Vector operator-(const Vector& a)                  \
  {                                                         \
    return simdLanes<Number>([&](int i) { return -a[i]; }); \
  }
MORPH_SIMD_OPERATORS(SimdDouble4, double)
MORPH_SIMD_OPERATORS(SimdFloat4, float)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, <)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, >)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, <=)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, >=)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, ==)
MORPH_SIMD_OPERATOR(SimdDouble4, double, bool, !=)
MORPH_SIMD_OPERATOR(SimdMask4, bool, bool, &)
MORPH_SIMD_OPERATOR(SimdMask4, bool, bool, |)
#undef MORPH_SIMD_OPERATORS
#undef MORPH_SIMD_ARITHMETIC
#undef MORPH_SIMD_OPERATOR

inline SimdMask4 operator!(const SimdMask4& a)
{
  return simdLanes<bool>([&](int i) { return !a[i]; });
}
inline SimdDouble4 select(const SimdMask4& mask, const SimdDouble4& a, const SimdDouble4& b)
{
  return simdLanes<double>([&](int i) { return mask[i] ? a[i] : b[i]; });
}
inline SimdDouble4 sumsOf(
  const SimdDouble4& a, const SimdDouble4& b, const SimdDouble4& c, const SimdDouble4& d)
{
  const auto sum = [](const SimdDouble4& x) { return (x[0] + x[1]) + (x[2] + x[3]); };
  return { sum(a), sum(b), sum(c), sum(d) };
}
inline void transpose(const SimdFloat4* in, SimdFloat4 (&out)[4])
{
  for (int k = 0; k < 4; ++k)
  {
    out[k] = simdLanes<float>([&](int i) { return in[i][k]; });
  }
}
#endif

/// Formulas for vectors are also those for single numbers.
MORPH_SIMD_INLINE double select(bool mask, double a, double b)
{
  return mask ? a : b;
}
MORPH_SIMD_INLINE bool any(bool mask)
{
  return mask;
}
MORPH_SIMD_INLINE bool any(const SimdMask4& mask)
{
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

MORPH_SIMD_INLINE SimdDouble4 load(const double* x)
{
  return SimdDouble4{ x[0], x[1], x[2], x[3] };
}
/// GCC 12 makes one instruction of this, and five of __builtin_convertvector.
MORPH_SIMD_INLINE SimdDouble4 widened(const float* x)
{
  return SimdDouble4{ x[0], x[1], x[2], x[3] };
}
MORPH_SIMD_INLINE SimdFloat4 load(const float* x)
{
  return SimdFloat4{ x[0], x[1], x[2], x[3] };
}
MORPH_SIMD_INLINE SimdFloat4 narrowed(const SimdDouble4& x)
{
  return SimdFloat4{ static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]),
    static_cast<float>(x[3]) };
}
MORPH_SIMD_INLINE void store(const SimdDouble4& x, double* to)
{
  std::memcpy(to, &x, sizeof(x));
}
MORPH_SIMD_INLINE void store(const SimdFloat4& x, float* to)
{
  std::memcpy(to, &x, sizeof(x));
}
/// Whether bit `bit` is set in each number.
MORPH_SIMD_INLINE SimdMask4 hasBit(const long long* bits, int bit)
{
  const auto number = [&](int i) { return static_cast<double>((bits[i] >> bit) & 1); };
  return SimdDouble4{ number(0), number(1), number(2), number(3) } != SimdDouble4{};
}

MORPH_SIMD_INLINE double squareRoot(double x)
{
  return std::sqrt(x);
}
MORPH_SIMD_INLINE SimdDouble4 squareRoot(const SimdDouble4& x)
{
  return SimdDouble4{ std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]) };
}
MORPH_SIMD_INLINE double cubeRoot(double x)
{
  return std::cbrt(x);
}
MORPH_SIMD_INLINE SimdDouble4 cubeRoot(const SimdDouble4& x)
{
  return SimdDouble4{ std::cbrt(x[0]), std::cbrt(x[1]), std::cbrt(x[2]), std::cbrt(x[3]) };
}
MORPH_SIMD_INLINE double logarithm(double x)
{
  return std::log(x);
}
MORPH_SIMD_INLINE SimdDouble4 logarithm(const SimdDouble4& x)
{
  return SimdDouble4{ std::log(x[0]), std::log(x[1]), std::log(x[2]), std::log(x[3]) };
}

namespace detail
{
// GCC does not align the stack of Windows for AVX (GCC bug 54412).
#if defined(MORPH_HAS_GNU_VECTORS) && defined(__x86_64__) && !defined(_WIN32)
template <typename Body, typename... Arguments>
__attribute__((target("avx2"))) void runWithAvx2(Arguments&... arguments)
{
  Body::run(arguments...);
}
inline bool hasAvx2()
{
  return __builtin_cpu_supports("avx2");
}
#else
template <typename Body, typename... Arguments>
void runWithAvx2(Arguments&... arguments)
{
  Body::run(arguments...);
}
inline bool hasAvx2()
{
  return false;
}
#endif

/// Runs Body for each i.
template <typename Body>
struct Loop
{
  template <typename... Arguments>
  static MORPH_SIMD_INLINE void run(Index first, Index last, Arguments&... arguments)
  {
    for (Index i = first; i < last; ++i)
    {
      Body::run(i, arguments...);
    }
  }
};
}

/// Calls Body::run(arguments...), compiled for this processor's widest registers. Body::run is a
/// static function; it and all that it calls must be MORPH_SIMD_INLINE. AVX2 has no fused
/// multiplication and addition, so every version does the same operations.
template <typename Body, typename... Arguments>
void dispatched(Arguments&... arguments)
{
  detail::hasAvx2() ? detail::runWithAvx2<Body>(arguments...) : Body::run(arguments...);
}

/// Calls Body::run(i, arguments...) for i in [first, last), as dispatched().
template <typename Body, typename... Arguments>
void dispatchedFor(Index first, Index last, Arguments&... arguments)
{
  dispatched<detail::Loop<Body>>(first, last, arguments...);
}
}
