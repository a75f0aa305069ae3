// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/OrientationPredicate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

/// A rounded result and what the rounding took away: together exact.
struct Pair
{
  double value;
  double tail;
};

Pair twoSum(double a, double b)
{
  const double sum = a + b;
  const double bPart = sum - a;
  return { sum, (a - (sum - bPart)) + (b - bPart) };
}

Pair twoProduct(double a, double b)
{
  const double product = a * b;
  return { product, std::fma(a, b, -product) };
}

/// An exact sum of doubles that do not overlap, smallest first.
class Expansion
{
public:
  void add(double term)
  {
    int kept = 0;
    for (int i = 0; i < this->size_; ++i)
    {
      const Pair sum = twoSum(term, this->parts_[i]);
      term = sum.value;
      if (sum.tail != 0)
      {
        this->parts_[kept++] = sum.tail;
      }
    }
    if (term != 0)
    {
      this->parts_[kept++] = term;
    }
    this->size_ = kept;
  }

  int sign() const { return this->size_ == 0 ? 0 : this->parts_[this->size_ - 1] > 0 ? 1 : -1; }

private:
  // Never more parts than terms: six products of three pairs, eight times four terms each.
  std::array<double, 192> parts_;
  int size_ = 0;
};

void addProduct(Expansion& sum, const Pair& a, const Pair& b, const Pair& c, double sign)
{
  for (const double x : { a.value, a.tail })
  {
    for (const double y : { b.value, b.tail })
    {
      const Pair xy = twoProduct(x, y);
      for (const double z : { c.value, c.tail })
      {
        for (const double part : { xy.value, xy.tail })
        {
          const Pair term = twoProduct(part, sign * z);
          sum.add(term.tail);
          sum.add(term.value);
        }
      }
    }
  }
}

int exactSign(const std::array<Vector, 4>& x)
{
  Pair edge[3][3];
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      edge[i][j] = twoSum(x[i + 1][j], -x[0][j]);
    }
  }
  Expansion sum;
  for (int j = 0; j < 3; ++j)
  {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    addProduct(sum, edge[0][j], edge[1][k], edge[2][l], 1);
    addProduct(sum, edge[0][j], edge[1][l], edge[2][k], -1);
  }
  return sum.sign();
}

/// Whether scaling is exact, and each product of three in the exact sum a multiple of 2^-1074 then.
bool isSafeFromUnderflow(const std::array<Vector, 4>& x, double scale)
{
  const double least = std::ldexp(1., -300);
  return std::all_of(x.begin(), x.end(),
    [&](const Vector& v)
    {
      return std::all_of(
        v.data(), v.data() + 3, [&](double c) { return c == 0 || std::abs(c) * scale >= least; });
    });
}

/// The sign of the rounded determinant where its error cannot change it, else 0.
int filteredSign(const std::array<Vector, 4>& x)
{
  const Vector a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  double determinant = 0, permanent = 0;
  for (int j = 0; j < 3; ++j)
  {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    const double first = b[k] * c[l], second = b[l] * c[k];
    determinant += a[j] * (first - second);
    permanent += std::abs(a[j]) * (std::abs(first) + std::abs(second));
  }
  // Eight roundings at most on the way of each product (three differences, two products, one
  // difference, two sums), and the like in the permanent. The second term bounds what coordinates
  // that underflow in the scaling contribute.
  const double bound =
    12 * std::numeric_limits<double>::epsilon() * permanent + std::ldexp(1., -400);
  return determinant > bound ? 1 : determinant < -bound ? -1 : 0;
}
}

double exactScale(const Vector* points, int count)
{
  double largest = 0;
  for (int i = 0; i < count; ++i)
  {
    if (!points[i].allFinite())
    {
      return 1;
    }
    largest = std::max(largest, points[i].cwiseAbs().maxCoeff());
  }
  // Subnormal coordinates would ask for a power that is no double; 2^1023 takes them far enough.
  return largest == 0 ? 1 : std::ldexp(1., std::min(299 - std::ilogb(largest), 1023));
}

std::optional<int> orientationSign(
  const Vector& a, const Vector& b, const Vector& c, const Vector& d)
{
  const std::array<Vector, 4> x = { a, b, c, d };
  if (!std::all_of(x.begin(), x.end(), [](const Vector& v) { return v.allFinite(); }))
  {
    return std::nullopt;
  }
  const double scale = exactScale(x.data(), 4);
  const std::array<Vector, 4> scaled = { a * scale, b * scale, c * scale, d * scale };
  if (const int sign = filteredSign(scaled))
  {
    return sign;
  }
  return isSafeFromUnderflow(x, scale) ? std::optional<int>(exactSign(scaled)) : std::nullopt;
}
}
