// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Bernstein.h"

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

const BernsteinDomain BoxDomain = { 6, 3, { 0, 0, 1, 1, 2, 2 },
  { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { 0, 0, 0 }, { 0, 0, 1 } }, { 0, 2, 4 },
  { 1, 3, 5 } };
const BernsteinDomain WedgeDomain = { 5, 2, { 0, 0, 0, 1, 1, -1 },
  { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 0 }, { 0, 0, 1 } }, { 0, 0, 3 }, { 1, 2, 4 } };
const BernsteinDomain TetDomain = { 4, 1, { 0, 0, 0, 0, -1, -1 },
  { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { 0, 0, 0 }, { 1, 2, 3 } };

namespace
{
double factorial(int n)
{
  return n < 2 ? 1 : n * factorial(n - 1);
}

/// Appends all ways to distribute each simplex's degree among its slots from `slot` on.
void enumerate(const BernsteinDomain& domain, int slot, Degrees left, Exponents& exponents,
  std::vector<Exponents>& result)
{
  if (slot == domain.slots)
  {
    result.push_back(exponents);
    return;
  }
  const int simplex = domain.simplex[slot];
  const int next = slot + 1;
  const bool isLast =
    next >= BernsteinDomain::MostSlots || next == domain.slots || domain.simplex[next] != simplex;
  const int all = left[simplex];
  for (int power = isLast ? all : 0; power <= all; ++power)
  {
    exponents[slot] = static_cast<std::int8_t>(power);
    left[simplex] = all - power;
    enumerate(domain, next, left, exponents, result);
  }
  exponents[slot] = 0;
}
}

BernsteinTerms::BernsteinTerms(const BernsteinDomain& domain, const Degrees& degrees)
  : domain_(&domain)
{
  Exponents none{};
  enumerate(domain, 0, degrees, none, this->exponents_);
  for (int term = 0; term < this->size(); ++term)
  {
    this->number_[this->exponents_[term]] = term;
  }
}

double BernsteinTerms::multinomial(int term) const
{
  const Exponents& exponents = this->exponents_[term];
  double result = 1;
  int degree[3] = { 0, 0, 0 };
  for (int slot = 0; slot < this->domain_->slots; ++slot)
  {
    degree[this->domain_->simplex[slot]] += exponents[slot];
    result /= factorial(exponents[slot]);
  }
  // Small integers: rounding the quotient makes it exact.
  return std::round(result * factorial(degree[0]) * factorial(degree[1]) * factorial(degree[2]));
}

BernsteinHalving::BernsteinHalving(const BernsteinDomain& domain, const BernsteinTerms& terms)
  : domain_(&domain)
  , size_(terms.size())
{
  for (int from = 0; from < domain.slots; ++from)
  {
    for (int to = from + 1; to < domain.slots && domain.simplex[to] == domain.simplex[from]; ++to)
    {
      Edge edge{ from, to, {}, {} };
      for (int first = 0; first < terms.size(); ++first)
      {
        Exponents term = terms[first];
        if (term[to] != 0)
        {
          continue;
        }
        edge.lengths.push_back(static_cast<std::uint8_t>(term[from] + 1));
        for (; term[from] >= 0; --term[from], ++term[to])
        {
          edge.terms.push_back(static_cast<std::uint8_t>(terms.find(term)));
        }
      }
      this->edges_.push_back(edge);
    }
  }
  for (int term = 0; term < terms.size(); ++term)
  {
    Corner corner{ term, { -1, -1, -1 } };
    int used = 0;
    for (int slot = 0; slot < domain.slots; ++slot)
    {
      if (terms[term][slot] > 0)
      {
        corner.slots[domain.simplex[slot]] = slot;
        ++used;
      }
    }
    if (used == domain.simplices)
    {
      this->corners_.push_back(corner);
    }
  }
}

BernsteinHalving::Part BernsteinHalving::whole() const
{
  Part part;
  std::copy(&this->domain_->place[0][0],
    &this->domain_->place[0][0] + 3 * BernsteinDomain::MostSlots, &part.place[0][0]);
  return part;
}

double BernsteinHalving::minimum(const Part& part) const
{
  return *std::min_element(part.c.begin(), part.c.begin() + this->size_);
}

double BernsteinHalving::minimumCorner(const Part& part, double (&at)[3]) const
{
  const auto corner = std::min_element(this->corners_.begin(), this->corners_.end(),
    [&part](const Corner& a, const Corner& b) { return part.c[a.term] < part.c[b.term]; });
  for (int j = 0; j < 3; ++j)
  {
    at[j] = 0;
    for (int simplex = 0; simplex < this->domain_->simplices; ++simplex)
    {
      at[j] += part.place[corner->slots[simplex]][j];
    }
  }
  return part.c[corner->term];
}

const BernsteinHalving::Edge& BernsteinHalving::mostCurved(const Part& part) const
{
  const Edge* best = &this->edges_.front();
  double most = -1;
  for (const Edge& edge : this->edges_)
  {
    double curvature = 0;
    const std::uint8_t* row = edge.terms.data();
    for (const int length : edge.lengths)
    {
      for (int i = 0; i + 2 < length; ++i)
      {
        curvature = std::max(
          curvature, std::abs(part.c[row[i]] - 2 * part.c[row[i + 1]] + part.c[row[i + 2]]));
      }
      row += length;
    }
    if (curvature > most)
    {
      most = curvature;
      best = &edge;
    }
  }
  return *best;
}

void BernsteinHalving::halve(const Part& part, Part& low, Part& high) const
{
  const Edge& edge = this->mostCurved(part);
  high = part;
  low = part;
  for (int j = 0; j < 3; ++j)
  {
    low.place[edge.to][j] = high.place[edge.from][j] =
      (part.place[edge.from][j] + part.place[edge.to][j]) / 2;
  }
  const std::uint8_t* row = edge.terms.data();
  for (const int length : edge.lengths)
  {
    double c[MostDegree + 1];
    for (int i = 0; i < length; ++i)
    {
      c[i] = high.c[row[i]];
    }
    for (int last = length - 2; last >= 0; --last)
    {
      for (int i = 0; i <= last; ++i)
      {
        c[i] = (c[i] + c[i + 1]) / 2;
      }
      low.c[row[length - 1 - last]] = c[0];
      high.c[row[last]] = c[last];
    }
    row += length;
  }
  low.halvings = high.halvings = part.halvings + 1;
}
}
