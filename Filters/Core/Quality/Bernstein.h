// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace morph
{
/// The highest degree of a polynomial here.
constexpr int MostPolynomialDegree = 6;

/// Returns the first root of a polynomial in (0, infinity), a lower bound of it within `precision`
/// of it, or infinity where the polynomial is positive throughout. 0 if its value at 0 is not
/// positive, or a coefficient is not finite. `a`: degree + 1 coefficients, that of power 0 first. A
/// place where the polynomial only touches zero counts as a root. Isolates the root by subdividing
/// the Bernstein form on [0, infinity), u = t / (unit + t) (de Casteljau), the unit being a lower
/// bound of the roots. Cost: some hundred operations.
double firstPositiveRoot(const double* a, int degree, double precision = 1e-12);

/// Whether the polynomial is certainly positive on [0, `last`]: its Bernstein coefficients there
/// are. False proves nothing. `last`: positive, finite or not.
bool isPositiveUntil(const double* a, int degree, double last);

/// The parametric domain of a volume cell as a product of simplices. A box is edge x edge x edge, a
/// wedge is triangle x edge, and a tetrahedron is itself. Each corner of a simplex is a slot with a
/// barycentric coordinate.
struct BernsteinDomain
{
  static constexpr int MostSlots = 6;

  int slots;
  int simplices;
  int simplex[MostSlots]; ///< of each slot, ascending
  /// A parametric point is the sum of barycentric coordinate times place over the slots.
  double place[MostSlots][3];
  /// Each parametric coordinate grows from slot `from` to slot `to`.
  int from[3], to[3];
};

/// VTK's parametric domains: r, s, t in [0, 1]; r + s <= 1; r + s + t <= 1.
extern const BernsteinDomain BoxDomain, WedgeDomain, TetDomain;

using Exponents = std::array<std::int8_t, BernsteinDomain::MostSlots>;
using Degrees = std::array<int, 3>; ///< of each simplex; 0 where there is none

/// The terms of a Bernstein polynomial of given degrees: products of powers of barycentric
/// coordinates.
class BernsteinTerms
{
public:
  BernsteinTerms() = default;
  BernsteinTerms(const BernsteinDomain& domain, const Degrees& degrees);

  int size() const { return static_cast<int>(this->exponents_.size()); }
  const Exponents& operator[](int term) const { return this->exponents_[term]; }
  /// Returns the number of a term, which must exist.
  int find(const Exponents& exponents) const { return this->number_.at(exponents); }
  /// Returns the product of the simplices' multinomial coefficients.
  double multinomial(int term) const;

private:
  const BernsteinDomain* domain_ = nullptr;
  std::vector<Exponents> exponents_;
  std::map<Exponents, int> number_;
};

/// De Casteljau's algorithm: halves Bernstein coefficients along the edges of a domain. An edge of
/// a simplex is cut in its middle. Terms that differ only in the edge's two slots form one row.
class BernsteinHalving
{
public:
  static constexpr int MostTerms = 216, MostDegree = 5;
  using Coefficients = std::array<double, MostTerms>;

  /// A part of the domain: the places of its slots and the polynomial's coefficients on it.
  struct Part
  {
    Coefficients c;
    double place[BernsteinDomain::MostSlots][3];
    int halvings = 0;
  };

  BernsteinHalving() = default;
  /// `terms`: at most MostTerms, of degree at most MostDegree.
  BernsteinHalving(const BernsteinDomain& domain, const BernsteinTerms& terms);

  /// Returns the whole domain; the caller fills in its coefficients.
  Part whole() const;
  /// Returns the minimum of the coefficients, a lower bound of the polynomial.
  double minimum(const Part& part) const;
  /// Returns the minimum of the corner coefficients, which are values of the polynomial, and its
  /// place.
  double minimumCorner(const Part& part, double (&at)[3]) const;
  /// Cuts the part where its coefficients are farthest from linear. `low` may be `part` itself.
  void halve(const Part& part, Part& low, Part& high) const;

private:
  struct Edge
  {
    int from, to;
    std::vector<std::uint8_t> terms; ///< of all rows, by ascending power of `to`
    std::vector<std::uint8_t> lengths;
  };
  struct Corner
  {
    int term;
    std::array<int, 3> slots; ///< one of each simplex
  };

  const Edge& mostCurved(const Part& part) const;

  const BernsteinDomain* domain_ = nullptr;
  int size_ = 0;
  std::vector<Edge> edges_;
  std::vector<Corner> corners_;
};
}
