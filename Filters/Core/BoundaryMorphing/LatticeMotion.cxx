// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/LatticeMotion.h"

#include "Geometry/AffineFit.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr int MostPoints = 30;
constexpr double Outside = 1e-12; // of the box: rounding
constexpr Index Grain = 256;

/// Knot `i` of clamped uniform knots on [0, 1].
double knot(int i, int count, int degree)
{
  const int spans = count - degree;
  return std::clamp(i - degree, 0, spans) / static_cast<double>(spans);
}

/// The basis functions that are not 0 at a parameter: degree + 1 from `first` on.
struct BasisValues
{
  int first = 0;
  std::array<double, MostPoints> value{};

  BasisValues(double t, int count, int degree)
  {
    const int spans = count - degree;
    const int span = degree + std::min(static_cast<int>(t * spans), spans - 1);
    this->first = span - degree;
    std::array<double, MostPoints> left{}, right{};
    this->value[0] = 1;
    for (int j = 1; j <= degree; ++j)
    {
      left[j] = t - knot(span + 1 - j, count, degree);
      right[j] = knot(span + j, count, degree) - t;
      double saved = 0;
      for (int r = 0; r < j; ++r)
      {
        const double part = this->value[r] / (right[r + 1] + left[j - r]);
        this->value[r] = saved + right[r + 1] * part;
        saved = left[j - r] * part;
      }
      this->value[j] = saved;
    }
  }
};

/// Where `x` is between `low` and `high`, from 0 to 1; below 0 where it is outside.
double parameter(double x, double low, double high, double tolerance)
{
  if (!(x >= low - tolerance && x <= high + tolerance))
  {
    return -1;
  }
  return high > low ? std::clamp((x - low) / (high - low), 0.0, 1.0) : 0;
}
}

int LatticeMotion::degree(int direction) const
{
  const int most = this->size[direction] - 1;
  return this->basis == Basis::Bernstein ? most : std::min(3, most);
}

void LatticeMotion::surround(const Points& places, bool along)
{
  this->axes.setIdentity();
  this->origin.setZero();
  if (along)
  {
    this->origin = places.colwise().mean();
    const Points arms = places.rowwise() - this->origin;
    const PrincipalDirections directions(
      arms.transpose() * arms, static_cast<double>(places.rows()));
    this->axes = directions.axes().rowwise().reverse();
    // Either way is a principal axis: the one whose largest component is positive.
    for (int d = 0; d < 2; ++d)
    {
      Index largest = 0;
      this->axes.col(d).cwiseAbs().maxCoeff(&largest);
      this->axes.col(d) *= this->axes(largest, d) < 0 ? -1 : 1;
    }
    this->axes.col(2) = this->axes.col(0).cross(this->axes.col(1));
  }
  const Points inside = (places.rowwise() - this->origin) * this->axes;
  this->low = inside.colwise().minCoeff();
  this->high = inside.colwise().maxCoeff();
}

Points LatticeMotion::controlPoints() const
{
  std::array<std::vector<double>, 3> along;
  for (int d = 0; d < 3; ++d)
  {
    const int degree = this->degree(d);
    for (int i = 0; i < this->size[d]; ++i)
    {
      double sum = 0; // the Greville abscissa is the mean of the inner knots of a basis function
      for (int j = 1; j <= degree; ++j)
      {
        sum += knot(i + j, this->size[d], degree);
      }
      along[d].push_back(this->low[d] + sum / degree * (this->high[d] - this->low[d]));
    }
  }
  Points result(static_cast<Index>(this->size[0]) * this->size[1] * this->size[2], 3);
  Index row = 0;
  for (const double z : along[2])
  {
    for (const double y : along[1])
    {
      for (const double x : along[0])
      {
        result.row(row++) = this->origin + Eigen::RowVector3d(x, y, z) * this->axes.transpose();
      }
    }
  }
  return result;
}

Points LatticeMotion::displacements(const Points& places, Monitor& monitor) const
{
  Points result = Points::Zero(places.rows(), 3);
  const double tolerance = Outside * (this->high - this->low).norm();
  const auto move = [&](Index node)
  {
    const Eigen::RowVector3d place = (places.row(node) - this->origin) * this->axes;
    double t[3];
    for (int d = 0; d < 3; ++d)
    {
      t[d] = parameter(place[d], this->low[d], this->high[d], tolerance);
      if (t[d] < 0)
      {
        return;
      }
    }
    const BasisValues x(t[0], this->size[0], this->degree(0)),
      y(t[1], this->size[1], this->degree(1)), z(t[2], this->size[2], this->degree(2));
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int k = 0; k <= this->degree(2); ++k)
    {
      for (int j = 0; j <= this->degree(1); ++j)
      {
        const Index row =
          ((z.first + k) * Index(this->size[1]) + y.first + j) * this->size[0] + x.first;
        const double outer = z.value[k] * y.value[j];
        for (int i = 0; i <= this->degree(0); ++i)
        {
          sum += outer * x.value[i] * this->controlDisplacements.row(row + i);
        }
      }
    }
    result.row(node) = sum;
  };
  parallel(places.rows(), Grain, monitor, [&](Index node) { move(node); });
  return result;
}
}
