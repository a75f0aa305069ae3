// SPDX-License-Identifier: BSD-3-Clause
#include "QuadraticCells.h"

#include "Quality/ScaledJacobian.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadratic
{
using namespace morph;
namespace
{
using Real = long double;

bool isInside(Shape shape, const Point& at)
{
  return at.minCoeff() >= 0 && at.maxCoeff() <= 1 &&
         (shape != Shape::Wedge || at[0] + at[1] <= 1) && (shape != Shape::Tet || at.sum() <= 1);
}

/// Of degree two through 0, 1/2 and 1: that of the node at `node`.
Real lagrange(Real node, Real x)
{
  return node == 0 ? (1 - x) * (1 - 2 * x) : node == 1 ? x * (2 * x - 1) : 4 * x * (1 - x);
}

Real linear(Real node, Real x)
{
  return node == 0 ? 1 - x : x;
}

/// The triangle's, by the nodes' places.
Real triangle(const Vector& node, Real r, Real s)
{
  const Real L[3] = { 1 - r - s, r, s };
  const double share[3] = { 1 - node[0] - node[1], node[0], node[1] };
  Real product = 1;
  for (int i = 0; i < 3; ++i)
  {
    if (share[i] == 1)
    {
      return L[i] * (2 * L[i] - 1);
    }
    product *= share[i] == .5 ? 2 * L[i] : 1;
  }
  return product;
}

/// The serendipity square's.
Real square(const Vector& node, Real r, Real s)
{
  const Real x = 2 * r - 1, y = 2 * s - 1, a = 2 * node[0] - 1, b = 2 * node[1] - 1;
  return a == 0   ? (1 - x * x) * (1 + b * y) / 2
         : b == 0 ? (1 - y * y) * (1 + a * x) / 2
                  : (1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4;
}

Real serendipity(const Vector& node, const Point& at)
{
  Real product = 1, sum = -2;
  int middles = 0;
  for (int j = 0; j < 3; ++j)
  {
    const Real x = 2 * at[j] - 1, a = 2 * node[j] - 1;
    product *= a == 0 ? 1 - x * x : 1 + a * x;
    sum += a * x;
    middles += a == 0;
  }
  return middles > 0 ? product / 4 : product * sum / 8;
}

Real serendipityWedge(const Vector& node, const Point& at)
{
  const Real L[3] = { 1 - at[0] - at[1], at[0], at[1] }, t = at[2];
  const double share[3] = { 1 - node[0] - node[1], node[0], node[1] };
  const auto corner = std::find(share, share + 3, 1.) - share;
  if (corner == 3)
  {
    return triangle(node, at[0], at[1]) * linear(node[2], t);
  }
  const Real l = L[corner];
  return node[2] == .5   ? 4 * t * (1 - t) * l
         : node[2] == 0. ? l * (1 - t) * (2 * l - 2 * t - 1)
                         : l * t * (2 * l + 2 * t - 3);
}

Real pyramid(const Vector& node, const Point& at)
{
  const Real r = 2 * at[0] - 1, s = 2 * at[1] - 1, t = 2 * at[2] - 1;
  if (node[2] == 1)
  {
    return t * (1 + t) / 2;
  }
  const Real x = (2 * node[0] - 1) * r, y = (2 * node[1] - 1) * s;
  if (node[2] == .5)
  {
    return (1 + x) * (1 + y) * (1 - t * t) / 4;
  }
  if (node[0] == .5)
  {
    return (1 - r * r) * (1 + y) * (1 - t) * (2 - y - y * t) / 8;
  }
  if (node[1] == .5)
  {
    return (1 - s * s) * (1 + x) * (1 - t) * (2 - x - x * t) / 8;
  }
  return -(1 + x) * (1 + y) * (1 - t) *
         (4 - 3 * x - 3 * y + 2 * x * y + 2 * t - x * t - y * t + 2 * x * y * t) / 16;
}

Real function(std::uint8_t type, const Vector& node, const Point& at)
{
  switch (type)
  {
    case QuadraticTetra:
    {
      const Real L[4] = { 1 - at.sum(), at[0], at[1], at[2] };
      const double share[4] = { 1 - node.sum(), node[0], node[1], node[2] };
      Real product = 1;
      for (int i = 0; i < 4; ++i)
      {
        if (share[i] == 1)
        {
          return L[i] * (2 * L[i] - 1);
        }
        product *= share[i] == .5 ? 2 * L[i] : 1;
      }
      return product;
    }
    case QuadraticHexahedron:
      return serendipity(node, at);
    case TriquadraticHexahedron:
      return lagrange(node[0], at[0]) * lagrange(node[1], at[1]) * lagrange(node[2], at[2]);
    case BiquadraticQuadraticHexahedron:
      return square(node, at[0], at[1]) * lagrange(node[2], at[2]);
    case QuadraticWedge:
      return serendipityWedge(node, at);
    case QuadraticLinearWedge:
      return triangle(node, at[0], at[1]) * linear(node[2], at[2]);
    case BiquadraticQuadraticWedge:
      return triangle(node, at[0], at[1]) * lagrange(node[2], at[2]);
    default:
      return pyramid(node, at);
  }
}

/// The derivative of a polynomial of degree two: the central difference has no error.
template <typename Function>
auto slope(const Function& f, const Point& at, int j)
{
  Point low = at, high = at;
  low[j] -= .5L;
  high[j] += .5L;
  return (f(high) - f(low)).eval();
}
}

const std::vector<Type> Types = { { QuadraticTetra, .34 }, { QuadraticHexahedron, .25 },
  { QuadraticWedge, .28 }, { QuadraticPyramid, .165 }, { TriquadraticHexahedron, .15 },
  { QuadraticLinearWedge, .4 }, { BiquadraticQuadraticWedge, .175 },
  { BiquadraticQuadraticHexahedron, .165 } };

Cell parametric(std::uint8_t type)
{
  const CellShape& shape = *cellShape(type);
  Cell result;
  switch (shape.shape)
  {
    case Shape::Tet:
      result = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
      break;
    case Shape::Wedge:
      result = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } };
      break;
    case Shape::Pyramid:
      result = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
      break;
    default:
      result = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
        { 1, 1, 1 }, { 0, 1, 1 } };
  }
  for (int i = shape.numberOfCorners; i < shape.numberOfNodes; ++i)
  {
    const double* x = shape.extraNodes[i - shape.numberOfCorners];
    result.emplace_back(x[0], x[1], x[2]);
  }
  return result;
}

Cell ideal(std::uint8_t type)
{
  Cell cell = parametric(type);
  const Vector apex(.5, .5, .7);
  for (Vector& x : cell)
  {
    if (type == QuadraticPyramid)
    {
      x = Vector((1 - x[2]) * x[0], (1 - x[2]) * x[1], 0) + x[2] * apex;
    }
  }
  return cell;
}

Cell random(std::uint8_t type, double amount, std::mt19937& generator)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int corners = cellShape(type)->numberOfCorners;
  const Cell places = parametric(type);
  for (;;)
  {
    Cell cell = ideal(type);
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      const double most = static_cast<int>(i) < corners ? .1 : amount;
      cell[i] += most * Vector(uniform(generator), uniform(generator), uniform(generator));
    }
    double x[8][3];
    for (int i = 0; i < corners; ++i)
    {
      std::copy(cell[i].data(), cell[i].data() + 3, x[i]);
    }
    bool isPositive = scaledJacobian(*cellShape(type), x) > 0;
    for (int i = 0; i < corners && isPositive; ++i)
    {
      isPositive = determinant(type, cell, places[i].cast<Real>()) > 0;
    }
    if (isPositive)
    {
      return cell;
    }
  }
}

Eigen::Matrix<long double, Eigen::Dynamic, 1> functions(std::uint8_t type, const Point& at)
{
  const Cell nodes = parametric(type);
  Eigen::Matrix<Real, Eigen::Dynamic, 1> result(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    result[static_cast<Eigen::Index>(i)] = function(type, nodes[i], at);
  }
  return result;
}

Gradients gradients(std::uint8_t type, const Point& at)
{
  Gradients result(cellShape(type)->numberOfNodes, 3);
  for (int j = 0; j < 3; ++j)
  {
    const auto along = [&](const Point& p)
    { return slope([&](const Point& q) { return functions(type, q); }, p, j); };
    if (type != QuadraticPyramid || j == 2)
    {
      result.col(j) = along(at);
    }
    else if (at[2] < 1)
    {
      result.col(j) = along(at) / (1 - at[2]);
    }
    else
    {
      result.col(j) = -slope(along, at, 2);
    }
  }
  return result;
}

Eigen::Matrix<long double, 3, 3> jacobian(const Cell& cell, const Gradients& gradients)
{
  Eigen::Matrix<Real, 3, 3> result = Eigen::Matrix<Real, 3, 3>::Zero();
  for (std::size_t i = 0; i < cell.size(); ++i)
  {
    result += cell[i].cast<Real>() * gradients.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

long double determinant(std::uint8_t type, const Cell& cell, const Point& at)
{
  return jacobian(cell, gradients(type, at)).determinant();
}

Sampler::Sampler(std::uint8_t type, int lattice, const GradientsAt& gradientsAt)
{
  const Shape shape = cellShape(type)->shape;
  for (int i = 0; i <= lattice; ++i)
  {
    for (int j = 0; j <= lattice; ++j)
    {
      for (int k = 0; k <= lattice; ++k)
      {
        const Point at = Point(i, j, k) / lattice;
        if (isInside(shape, at))
        {
          this->points_.push_back(at);
        }
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(this->points_.size());
  for (Eigen::MatrixXd& m : this->gradients_)
  {
    m.resize(count, cellShape(type)->numberOfNodes);
  }
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const Gradients all = gradientsAt(this->points_[i]);
    for (int j = 0; j < 3; ++j)
    {
      this->gradients_[j].row(i) = all.col(j).transpose().cast<double>();
    }
  }
}

double Sampler::minimum(const Cell& cell, Point& at) const
{
  const auto nodes = static_cast<Eigen::Index>(cell.size());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> x(
    cell[0].data(), nodes, 3);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> r = this->gradients_[0] * x,
                                                 s = this->gradients_[1] * x,
                                                 t = this->gradients_[2] * x;
  const Eigen::ArrayXd a0 = r.col(0), a1 = r.col(1), a2 = r.col(2);
  const Eigen::ArrayXd b0 = s.col(0), b1 = s.col(1), b2 = s.col(2);
  const Eigen::ArrayXd all = (a1 * b2 - a2 * b1) * t.col(0).array() +
                             (a2 * b0 - a0 * b2) * t.col(1).array() +
                             (a0 * b1 - a1 * b0) * t.col(2).array();
  Eigen::Index place = 0;
  const double least = all.minCoeff(&place);
  at = this->points_[place];
  return least;
}

long double searchedMinimum(std::uint8_t type, const Cell& cell, const Point& from)
{
  const Shape shape = cellShape(type)->shape;
  Point best = from;
  Real least = determinant(type, cell, from);
  for (Real step = .1L; step > 1e-6L;)
  {
    bool isBetter = false;
    const Point middle = best;
    for (int code = 0; code < 27; ++code)
    {
      const Point at = middle + step * Point(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
      if (isInside(shape, at))
      {
        const Real value = determinant(type, cell, at);
        if (value < least)
        {
          least = value;
          best = at;
          isBetter = true;
        }
      }
    }
    step *= isBetter ? 1 : .5L;
  }
  return least;
}
}
