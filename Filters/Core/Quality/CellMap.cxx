// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/CellMap.h"

#include "Mesh/CellShape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace morph
{
double exactScale(const Eigen::Vector3d* points, int count)
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

namespace
{
constexpr double Unit = std::numeric_limits<double>::epsilon() / 2;
constexpr std::uint8_t Types[] = { Hexahedron, Wedge, QuadraticTetra, QuadraticHexahedron,
  QuadraticWedge, QuadraticPyramid, TriquadraticHexahedron, QuadraticLinearWedge,
  BiquadraticQuadraticWedge, BiquadraticQuadraticHexahedron };

/// A linear combination of the cell's nodes.
using Combination = Eigen::Matrix<double, CellMap::MostNodes, 1>;

const BernsteinDomain& domainOf(Shape shape)
{
  return shape == Shape::Tet ? TetDomain : shape == Shape::Wedge ? WedgeDomain : BoxDomain;
}

constexpr double CornerPlaces[3][8][3] = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
  { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } },
  { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 },
    { 0, 1, 1 } } };

/// Returns the two slots that share a simplex's degree of two; equal slots for its corner.
std::array<int, 2> slotsOf(const BernsteinDomain& domain, const Exponents& term, int simplex)
{
  std::array<int, 2> result = { -1, -1 };
  int found = 0;
  for (int slot = 0; slot < domain.slots; ++slot)
  {
    for (int power = 0; domain.simplex[slot] == simplex && power < term[slot]; ++power)
    {
      result[found++] = slot;
    }
  }
  return result;
}

/// Returns the term that has its simplex's degree at one slot.
Exponents moved(Exponents term, const std::array<int, 2>& from, int to)
{
  --term[from[0]];
  --term[from[1]];
  term[to] = static_cast<std::int8_t>(term[to] + 2);
  return term;
}
}

/// The points of the full lattice, then the map's Bernstein coefficients, as combinations of nodes.
struct CellMap::Rows
{
  int degree; ///< one or two, in each simplex
  /// A lattice point has a term's exponents / degree as barycentric coordinates.
  BernsteinTerms terms;
  std::vector<Combination> lattice, coefficients;
};

namespace
{
/// Computes the lattice points where the cell has no node.
class Lattice
{
public:
  Lattice(std::uint8_t type, const BernsteinDomain& domain, const BernsteinTerms& terms)
    : type_(type)
    , domain_(domain)
    , terms_(terms)
    , isKnown_(terms.size(), 0)
    , points(terms.size(), Combination::Zero())
  {
  }

  void set(int term, int node)
  {
    this->points[term](node) = 1;
    this->isKnown_[term] = 1;
  }

  void complete()
  {
    for (int term = 0; term < this->terms_.size(); ++term)
    {
      this->at(this->terms_[term]);
    }
  }

private:
  const Combination& at(const Exponents& exponents)
  {
    const int term = this->terms_.find(exponents);
    if (!this->isKnown_[term])
    {
      this->points[term] = this->missing(exponents);
      this->isKnown_[term] = 1;
    }
    return this->points[term];
  }

  Combination missing(const Exponents& exponents)
  {
    if (this->type_ == QuadraticPyramid && exponents[4] < 2)
    {
      return this->missingInPyramid(exponents);
    }
    const int last = this->domain_.simplices - 1;
    if (this->type_ == QuadraticLinearWedge)
    {
      const std::array<int, 2> pair = slotsOf(this->domain_, exponents, last);
      return (this->at(moved(exponents, pair, pair[0])) +
               this->at(moved(exponents, pair, pair[1]))) /
             2;
    }
    // The first two simplices whose middle it is.
    std::vector<std::array<int, 2>> pairs;
    for (int simplex = 0; simplex <= last; ++simplex)
    {
      const std::array<int, 2> pair = slotsOf(this->domain_, exponents, simplex);
      if (pair[0] != pair[1])
      {
        pairs.push_back(pair);
      }
    }
    return this->middleOfSquare(exponents, pairs[0], pairs[1]);
  }

  Combination middleOfSquare(
    const Exponents& exponents, const std::array<int, 2>& p, const std::array<int, 2>& q)
  {
    Combination result = Combination::Zero();
    for (const int i : p)
    {
      result += this->at(moved(exponents, p, i)) / 2;
      for (const int j : q)
      {
        result -= this->at(moved(moved(exponents, p, i), q, j)) / 4;
      }
    }
    for (const int j : q)
    {
      result += this->at(moved(exponents, q, j)) / 2;
    }
    return result;
  }

  /// Returns a missing node above the base of a pyramid. Nodes: corners 0 to 3, apex 4, mid-sides
  /// of the base from 5, of the edges to the apex from 9.
  Combination missingInPyramid(const Exponents& e) const
  {
    Combination result = Combination::Zero();
    if (e[5] == 2)
    {
      result(4) = 1;
      return result;
    }
    // At half the height: the middle of the square, or of one side. Side i connects corners i and i
    // + 1.
    const bool isMiddle = e[0] == 1 && e[2] == 1;
    const int side = e[0] == 1 ? (e[2] == 2 ? 0 : 2) : (e[0] == 2 ? 3 : 1);
    for (int i = 0; i < 4; ++i)
    {
      if (isMiddle || i == side)
      {
        result(5 + i) += .25;
      }
      if (isMiddle)
      {
        result(i) -= .25;
        result(9 + i) += .25;
      }
      else if (i == side || i == (side + 1) % 4)
      {
        result(i) -= .125;
        result(9 + i) += .5;
      }
    }
    return result;
  }

  std::uint8_t type_;
  const BernsteinDomain& domain_;
  const BernsteinTerms& terms_;
  std::vector<char> isKnown_;

public:
  std::vector<Combination> points;
};

/// Returns a coefficient from the values on the lattice. In one simplex it is the value at a
/// corner, or 2 f(middle) - (f + f) / 2 between two corners.
Combination coefficient(const BernsteinDomain& domain, const BernsteinTerms& terms,
  const std::vector<Combination>& lattice, const Exponents& exponents, int simplex)
{
  if (simplex == domain.simplices)
  {
    return lattice[terms.find(exponents)];
  }
  const std::array<int, 2> pair = slotsOf(domain, exponents, simplex);
  const Combination here = coefficient(domain, terms, lattice, exponents, simplex + 1);
  if (pair[0] == pair[1])
  {
    return here;
  }
  return 2 * here -
         (coefficient(domain, terms, lattice, moved(exponents, pair, pair[0]), simplex + 1) +
           coefficient(domain, terms, lattice, moved(exponents, pair, pair[1]), simplex + 1)) /
           2;
}

/// Returns the maximum number of pairs (a, b) that give one term of the product.
int mostPairs(const std::vector<std::uint8_t>& product, int terms)
{
  std::vector<int> count(terms, 0);
  for (const std::uint8_t term : product)
  {
    ++count[term];
  }
  return *std::max_element(count.begin(), count.end());
}

Exponents operator+(const Exponents& a, const Exponents& b)
{
  Exponents sum{};
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(),
    [](int i, int j) { return static_cast<std::int8_t>(i + j); });
  return sum;
}

Degrees degreesOf(const BernsteinDomain& domain, const Exponents& exponents)
{
  Degrees degrees = { 0, 0, 0 };
  for (int slot = 0; slot < domain.slots; ++slot)
  {
    degrees[domain.simplex[slot]] += exponents[slot];
  }
  return degrees;
}
}

const CellMap* CellMap::find(std::uint8_t type)
{
  static const auto maps = []
  {
    std::array<std::unique_ptr<const CellMap>, 40> result;
    for (const std::uint8_t known : Types)
    {
      result[known].reset(new CellMap(known));
    }
    return result;
  }();
  return type < maps.size() ? maps[type].get() : nullptr;
}

CellMap::CellMap(std::uint8_t type)
{
  const CellShape& shape = *cellShape(type);
  this->domain_ = &domainOf(shape.shape);
  this->hasApex_ = shape.shape == Shape::Pyramid;
  this->nodes_ = shape.numberOfNodes;
  const int kind = shape.shape == Shape::Tet ? 0 : shape.shape == Shape::Wedge ? 1 : 2;
  for (int i = 0; i < this->nodes_; ++i)
  {
    const int extra = i - shape.numberOfCorners;
    const double* place = extra < 0 ? CornerPlaces[kind][i] : shape.extraNodes[extra];
    std::copy(place, place + 3, this->place_[i]);
  }

  const int degree = this->nodes_ > shape.numberOfCorners ? 2 : 1;
  Rows rows;
  rows.degree = degree;
  rows.terms = BernsteinTerms(*this->domain_, { degree, this->domain_->simplices > 1 ? degree : 0,
                                                this->domain_->simplices > 2 ? degree : 0 });
  Lattice lattice(type, *this->domain_, rows.terms);
  for (int term = 0; term < rows.terms.size(); ++term)
  {
    double place[3] = { 0, 0, 0 };
    for (int slot = 0; slot < this->domain_->slots; ++slot)
    {
      for (int j = 0; j < 3; ++j)
      {
        place[j] += rows.terms[term][slot] * this->domain_->place[slot][j] / degree;
      }
    }
    for (int i = 0; i < this->nodes_; ++i)
    {
      if (std::equal(place, place + 3, this->place_[i]))
      {
        lattice.set(term, i);
      }
    }
  }
  lattice.complete();
  rows.lattice = lattice.points;
  for (int term = 0; term < rows.terms.size(); ++term)
  {
    rows.coefficients.push_back(
      degree == 1 ? rows.lattice[term]
                  : coefficient(*this->domain_, rows.terms, rows.lattice, rows.terms[term], 0));
  }
  for (int coordinate = 0; coordinate < 3; ++coordinate)
  {
    this->setDerivative(coordinate, rows);
  }
  this->setProduct();
}

void CellMap::setDerivative(int coordinate, const Rows& rows)
{
  const BernsteinDomain& domain = *this->domain_;
  const int from = domain.from[coordinate], to = domain.to[coordinate];
  Degrees degrees = degreesOf(domain, rows.terms[0]);
  --degrees[domain.simplex[from]];
  const bool hasFactor = this->hasApex_ && coordinate < 2;
  const BernsteinTerms all(domain, degrees);
  degrees[2] -= hasFactor;

  Derivative& result = this->derivative_[coordinate];
  result.terms = BernsteinTerms(domain, degrees);
  std::vector<Combination> combinations;
  for (int term = 0; term < result.terms.size(); ++term)
  {
    // The factor 1 - t is the barycentric coordinate of slot 4. Removing it does not change the
    // products of coefficients and multinomial coefficients.
    Exponents low = result.terms[term];
    low[4] = static_cast<std::int8_t>(low[4] + hasFactor);
    const double multinomial = all.multinomial(all.find(low));
    Exponents high = low;
    ++low[from];
    ++high[to];
    combinations.push_back(
      rows.degree * multinomial *
      (rows.coefficients[rows.terms.find(high)] - rows.coefficients[rows.terms.find(low)]));
    result.inverseMultinomial.push_back(1 / result.terms.multinomial(term));
  }

  // The factors of nodes on one line along the coordinate sum to 0 in every term. So only the
  // distances between these nodes matter, which can be short compared with the cell's other edges.
  // In pyramids the factors do not sum to 0.
  const auto isOnLine = [&](int a, int b)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (j != coordinate && this->place_[a][j] != this->place_[b][j])
      {
        return false;
      }
    }
    return !this->hasApex_;
  };
  const int apex = 4;
  int mostWeights = 0;
  double mostFactor = 0;
  for (int term = 0; term < result.terms.size(); ++term)
  {
    result.first.push_back(static_cast<int>(result.weights.size()));
    double sum = 0;
    for (int i = 0; i < this->nodes_; ++i)
    {
      int reference = this->hasApex_ ? apex : 0;
      while (!this->hasApex_ && !isOnLine(i, reference))
      {
        ++reference;
      }
      const double value = combinations[term](i);
      if (value != 0 && i != reference)
      {
        result.weights.push_back(
          { static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(reference), value });
        sum += std::abs(value);
      }
    }
    mostFactor = std::max(mostFactor, sum * result.inverseMultinomial[term]);
    mostWeights =
      std::max(mostWeights, static_cast<int>(result.weights.size()) - result.first.back());
  }
  result.first.push_back(static_cast<int>(result.weights.size()));
  // Each difference, each product and each sum is rounded once.
  result.errorFactor = (mostWeights + 2) * Unit * mostFactor;
}

void CellMap::setProduct()
{
  const BernsteinDomain& domain = *this->domain_;
  const BernsteinTerms &r = this->derivative_[0].terms, &s = this->derivative_[1].terms,
                       &t = this->derivative_[2].terms;
  const BernsteinTerms area(domain, degreesOf(domain, r[0] + s[0]));
  const BernsteinTerms volume(domain, degreesOf(domain, r[0] + s[0] + t[0]));
  for (int i = 0; i < r.size(); ++i)
  {
    for (int j = 0; j < s.size(); ++j)
    {
      this->areaTerm_.push_back(static_cast<std::uint8_t>(area.find(r[i] + s[j])));
    }
  }
  for (int i = 0; i < area.size(); ++i)
  {
    for (int j = 0; j < t.size(); ++j)
    {
      this->volumeTerm_.push_back(static_cast<std::uint8_t>(volume.find(area[i] + t[j])));
    }
  }
  this->areaTerms_ = area.size();
  this->volumeTerms_ = volume.size();
  for (int i = 0; i < volume.size(); ++i)
  {
    this->inverseMultinomial_.push_back(1 / volume.multinomial(i));
  }
  // A mixed product takes five roundings, each sum one per term, and the inverse multinomial
  // coefficient two.
  this->roundings_ =
    7 + mostPairs(this->areaTerm_, area.size()) + mostPairs(this->volumeTerm_, volume.size());
  const Degrees degrees = degreesOf(domain, volume[0]);
  this->roundingsOfHalving_ = *std::max_element(degrees.begin(), degrees.end());
  this->halving_ = BernsteinHalving(domain, volume);
}

CellMap::Derivatives CellMap::derivatives(const Vector* x) const
{
  Derivatives result;
  for (int coordinate = 0; coordinate < 3; ++coordinate)
  {
    const Derivative& derivative = this->derivative_[coordinate];
    double longest = 0, largest = 0;
    for (int term = 0; term < derivative.terms.size(); ++term)
    {
      Vector sum = Vector::Zero();
      for (int i = derivative.first[term]; i < derivative.first[term + 1]; ++i)
      {
        const Weight& weight = derivative.weights[i];
        const Vector difference = x[weight.node] - x[weight.reference];
        longest = std::max(longest, difference.cwiseAbs().maxCoeff());
        sum += weight.value * difference;
      }
      result.c[coordinate][term] = sum;
      largest = std::max(largest, sum.cwiseAbs().maxCoeff() * derivative.inverseMultinomial[term]);
    }
    result.largest[coordinate] = largest;
    result.error[coordinate] = derivative.errorFactor * longest;
  }
  return result;
}

CellMap::Magnitudes CellMap::magnitudes(const Vector* x) const
{
  Magnitudes result;
  for (int coordinate = 0; coordinate < 3; ++coordinate)
  {
    const Derivative& derivative = this->derivative_[coordinate];
    for (int term = 0; term < derivative.terms.size(); ++term)
    {
      Vector& sum = result.c[coordinate][term];
      sum.setZero();
      for (int i = derivative.first[term]; i < derivative.first[term + 1]; ++i)
      {
        const Weight& weight = derivative.weights[i];
        sum += std::abs(weight.value) * (x[weight.node] - x[weight.reference]).cwiseAbs();
      }
    }
  }
  return result;
}

void CellMap::areas(const Derivatives& derivatives, Vector* area) const
{
  std::fill(area, area + this->areaTerms_, Vector::Zero());
  const std::uint8_t* term = this->areaTerm_.data();
  for (int i = 0; i < this->derivative_[0].terms.size(); ++i)
  {
    for (int j = 0; j < this->derivative_[1].terms.size(); ++j)
    {
      area[*term++] += derivatives.c[0][i].cross(derivatives.c[1][j]);
    }
  }
}

double CellMap::determinant(
  const Derivatives& derivatives, int halvings, BernsteinHalving::Coefficients& c) const
{
  Vector area[BernsteinHalving::MostTerms];
  this->areas(derivatives, area);
  std::fill(c.begin(), c.begin() + this->volumeTerms_, 0);
  const std::uint8_t* term = this->volumeTerm_.data();
  for (int i = 0; i < this->areaTerms_; ++i)
  {
    for (int j = 0; j < this->derivative_[2].terms.size(); ++j)
    {
      c[*term++] += area[i].dot(derivatives.c[2][j]);
    }
  }
  for (int i = 0; i < this->volumeTerms_; ++i)
  {
    c[i] *= this->inverseMultinomial_[i];
  }

  // A coefficient is a weighted mean of determinants of derivatives' coefficients, and so is each
  // sum of absolute products. So it is at most 6 P, with P the product of the largest components.
  // The derivatives' own errors come in addition.
  double exact = 1;
  for (int j = 0; j < 3; ++j)
  {
    exact *= derivatives.largest[j] + derivatives.error[j];
  }
  double perturbation = 0;
  for (int j = 0; j < 3; ++j)
  {
    // Computes exact - P without the cancellation of that difference.
    perturbation += derivatives.error[j] *
                    (derivatives.largest[(j + 1) % 3] + derivatives.error[(j + 1) % 3]) *
                    (derivatives.largest[(j + 2) % 3] + derivatives.error[(j + 2) % 3]);
  }
  const int roundings = this->roundings_ + halvings * this->roundingsOfHalving_;
  // 1.01 covers terms of higher order; the last term covers coordinates that underflow in the
  // scaling.
  return 1.01 * 6 * (roundings * Unit * exact + perturbation) + std::ldexp(1., -400);
}

void CellMap::gradient(const Derivatives& derivatives,
  const BernsteinHalving::Coefficients& weights, Vector* gradient) const
{
  // The passes of determinant() and derivatives(), backwards.
  Vector area[BernsteinHalving::MostTerms], byArea[BernsteinHalving::MostTerms];
  this->areas(derivatives, area);
  std::fill(byArea, byArea + this->areaTerms_, Vector::Zero());
  Derivatives slope;
  std::fill(&slope.c[0][0], &slope.c[0][0] + 3 * MostTerms, Vector::Zero());
  const std::uint8_t* term = this->volumeTerm_.data();
  for (int i = 0; i < this->areaTerms_; ++i)
  {
    for (int j = 0; j < this->derivative_[2].terms.size(); ++j, ++term)
    {
      const double weight = weights[*term] * this->inverseMultinomial_[*term];
      byArea[i] += weight * derivatives.c[2][j];
      slope.c[2][j] += weight * area[i];
    }
  }
  term = this->areaTerm_.data();
  for (int i = 0; i < this->derivative_[0].terms.size(); ++i)
  {
    for (int j = 0; j < this->derivative_[1].terms.size(); ++j, ++term)
    {
      slope.c[0][i] += derivatives.c[1][j].cross(byArea[*term]);
      slope.c[1][j] += byArea[*term].cross(derivatives.c[0][i]);
    }
  }
  std::fill(gradient, gradient + this->nodes_, Vector::Zero());
  for (int j = 0; j < 3; ++j)
  {
    const Derivative& derivative = this->derivative_[j];
    for (int k = 0; k < derivative.terms.size(); ++k)
    {
      for (int i = derivative.first[k]; i < derivative.first[k + 1]; ++i)
      {
        const Weight& weight = derivative.weights[i];
        gradient[weight.node] += weight.value * slope.c[j][k];
        gradient[weight.reference] -= weight.value * slope.c[j][k];
      }
    }
  }
}

/// Calls sum(j, term, factor) for the terms of the three derivatives.
template <typename Sum>
void CellMap::evaluate(const double (&at)[3], Sum&& sum) const
{
  const BernsteinDomain& domain = *this->domain_;
  // A simplex's first slot has the rest of the barycentric coordinates, which sum to 1.
  double coordinate[BernsteinDomain::MostSlots];
  for (int slot = domain.slots - 1; slot >= 0; --slot)
  {
    const double* place = domain.place[slot];
    const auto axis = std::max_element(place, place + 3) - place;
    if (place[axis] != 0)
    {
      coordinate[slot] = at[axis];
      continue;
    }
    coordinate[slot] = 1;
    for (int other = slot + 1;
         other < domain.slots && domain.simplex[other] == domain.simplex[slot]; ++other)
    {
      coordinate[slot] -= coordinate[other];
    }
  }
  for (int j = 0; j < 3; ++j)
  {
    const BernsteinTerms& terms = this->derivative_[j].terms;
    for (int term = 0; term < terms.size(); ++term)
    {
      double factor = 1;
      for (int slot = 0; slot < domain.slots; ++slot)
      {
        for (int power = 0; power < terms[term][slot]; ++power)
        {
          factor *= coordinate[slot];
        }
      }
      sum(j, term, factor);
    }
  }
}

Eigen::Matrix3d CellMap::jacobian(const Derivatives& derivatives, const double (&at)[3]) const
{
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  this->evaluate(
    at, [&](int j, int term, double factor) { result.col(j) += factor * derivatives.c[j][term]; });
  return result;
}

bool CellMap::isNegative(
  const Derivatives& derivatives, const Magnitudes& magnitudes, const double (&at)[3]) const
{
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero(), size = Eigen::Matrix3d::Zero();
  this->evaluate(at,
    [&](int j, int term, double factor)
    {
      J.col(j) += factor * derivatives.c[j][term];
      size.col(j) += factor * magnitudes.c[j][term];
    });
  // The determinant with all its products added, which is at least the sum of their magnitudes.
  double products = 0;
  for (int i = 0; i < 3; ++i)
  {
    const int k = (i + 1) % 3, l = (i + 2) % 3;
    products += size(i, 0) * (size(k, 1) * size(l, 2) + size(l, 1) * size(k, 2));
  }
  // An entry of J takes a rounding for each node and each term, three times for its factor, and a
  // few more: fewer than 128. A product takes five, with three such entries.
  return J.determinant() < -(3 * 128 + 8) * Unit * products;
}
}
