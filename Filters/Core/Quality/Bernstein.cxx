// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Bernstein.h"

#include <algorithm>
#include <cmath>

namespace morph
{
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
