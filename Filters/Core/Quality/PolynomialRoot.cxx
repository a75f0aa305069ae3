// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/PolynomialRoot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
constexpr int Size = MostPolynomialDegree + 1;
constexpr int MostHalvings = 60;

constexpr double Binomial[Size][Size] = { { 1 }, { 1, 1 }, { 1, 2, 1 }, { 1, 3, 3, 1 },
  { 1, 4, 6, 4, 1 }, { 1, 5, 10, 10, 5, 1 }, { 1, 6, 15, 20, 15, 6, 1 } };

/// A part [low, high] of [0, 1] and the Bernstein coefficients there.
struct Part
{
  double low, high;
  std::array<double, Size> b;
};

/// A lower bound of the positive roots: up to it each negative term is less than its share of a
/// positive one of a lower power. Infinity without negative terms.
double lowerBound(const double* a, int degree)
{
  const double negative = std::count_if(a, a + degree + 1, [](double c) { return c < 0; });
  double bound = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= degree; ++k)
  {
    if (a[k] < 0)
    {
      double best = 0;
      for (int j = 0; j < k; ++j)
      {
        const double ratio = std::max(a[j], 0.) / negative / -a[k];
        best = std::max(best, std::pow(ratio, 1. / (k - j)));
      }
      bound = std::min(bound, best);
    }
  }
  return bound;
}

/// Cuts off the lower half of `part`, which becomes the upper half.
Part cutLower(Part& part, int degree)
{
  const double middle = (part.low + part.high) / 2;
  Part lower = { part.low, middle, {} };
  for (int k = 0; k <= degree; ++k)
  {
    lower.b[k] = part.b[0];
    for (int i = 0; i < degree - k; ++i)
    {
      part.b[i] = (part.b[i] + part.b[i + 1]) / 2;
    }
  }
  // part.b[i] is now the coefficient at i + (degree - i) halvings: the upper half's.
  part.low = middle;
  return lower;
}
}

double firstPositiveRoot(const double* a, int degree, double precision)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  if (!std::all_of(a, a + degree + 1, [](double c) { return std::isfinite(c); }))
  {
    return 0; // nothing says that it is positive
  }
  // t = unit u / (1 - u): near u = 1 digits of t are lost.
  const double unit = lowerBound(a, degree);
  if (!(a[0] > 0 && unit > 0 && unit < Infinity))
  {
    return a[0] > 0 ? unit : 0;
  }
  Part stack[MostHalvings + 2];
  int top = 0;
  stack[0] = { 0, 1, {} };
  for (int k = 0; k <= degree; ++k)
  {
    stack[0].b[k] = a[k] / Binomial[degree][k];
    for (int power = 0; power < k; ++power)
    {
      stack[0].b[k] *= unit;
    }
  }
  while (top >= 0)
  {
    Part& part = stack[top];
    const double t = part.low < 1 ? part.low / (1 - part.low) : Infinity;
    if (!(part.b[0] > 0) || t == Infinity)
    {
      return unit * t;
    }
    if (std::all_of(part.b.begin(), part.b.begin() + degree + 1, [](double b) { return b >= 0; }))
    {
      --top;
      continue;
    }
    const double upper = part.high < 1 ? part.high / (1 - part.high) : Infinity;
    if ((upper < Infinity && upper - t <= precision * upper) || top == MostHalvings)
    {
      return unit * t;
    }
    stack[top + 1] = cutLower(part, degree);
    ++top;
  }
  return Infinity;
}

bool isPositiveUntil(const double* a, int degree, double last)
{
  if (std::isinf(last))
  {
    return a[0] > 0 && std::all_of(a, a + degree + 1, [](double c) { return c >= 0; });
  }
  if (degree == 3)
  {
    const double a1 = a[1] * last / 3, a2 = a[2] * last * last / 3;
    const double a3 = a[3] * last * last * last;
    return a[0] > 0 && a[0] + a1 > 0 && a[0] + 2 * a1 + a2 > 0 && a[0] + 3 * (a1 + a2) + a3 > 0;
  }
  double scaled[Size];
  double power = 1;
  for (int k = 0; k <= degree; ++k, power *= last)
  {
    scaled[k] = a[k] * power / Binomial[degree][k];
  }
  for (int j = 0; j <= degree; ++j)
  {
    double b = 0;
    for (int k = 0; k <= j; ++k)
    {
      b += Binomial[j][k] * scaled[k];
    }
    if (!(b > 0))
    {
      return false;
    }
  }
  return true;
}
}
