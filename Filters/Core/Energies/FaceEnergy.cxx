// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/FaceEnergy.h"

#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace morph
{
namespace
{
/// 1 / (2 chi) and its derivatives by the determinant d.
struct Weight
{
  double value, first, second;

  Weight(double d, double epsilon)
  {
    const double root = std::sqrt(d * d + epsilon * epsilon);
    // Two forms of one number, each without cancellation where it is used.
    this->value = d > 0 ? 1 / (d + root) : (root - d) / (epsilon * epsilon);
    this->first = -this->value / root;
    this->second = 1 / (root * root * root);
  }
};

/// J = U diag(s) V^T with rotations U and V; s[1] has the sign of the determinant.
struct PlaneSingularValues
{
  Eigen::Matrix2d U, V;
  Eigen::Vector2d s;

  explicit PlaneSingularValues(const Eigen::Matrix2d& J)
  {
    const double e = (J(0, 0) + J(1, 1)) / 2, f = (J(0, 0) - J(1, 1)) / 2;
    const double g = (J(1, 0) + J(0, 1)) / 2, h = (J(1, 0) - J(0, 1)) / 2;
    const double sum = std::hypot(e, h), difference = std::hypot(f, g);
    this->s << sum + difference, sum - difference;
    const double a = std::atan2(g, f), b = std::atan2(h, e);
    this->U = rotation((b + a) / 2);
    this->V = rotation((a - b) / 2);
  }

  static Eigen::Matrix2d rotation(double angle)
  {
    Eigen::Matrix2d R;
    R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return R;
  }
};

double infiniteUnlessFinite(double value)
{
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

double toPower(double value, int power)
{
  double result = value;
  for (int i = 1; i < power; ++i)
  {
    result *= value;
  }
  return result;
}
}

Eigen::Matrix2d FaceDensity::cofactor(const Eigen::Matrix2d& J)
{
  Eigen::Matrix2d result;
  result << J(1, 1), -J(1, 0), -J(0, 1), J(0, 0);
  return result;
}

double FaceDensity::value(const Eigen::Matrix2d& J) const
{
  const double d = J.determinant();
  if (!(this->epsilon > 0 || d > 0))
  {
    return std::numeric_limits<double>::infinity();
  }
  const double phi = J.squaredNorm() * Weight(d, this->epsilon).value;
  return infiniteUnlessFinite(toPower(phi, this->power));
}

double FaceDensity::gradient(const Eigen::Matrix2d& J, Eigen::Matrix2d& derivative) const
{
  const Weight weight(J.determinant(), this->epsilon);
  const double square = J.squaredNorm(), phi = square * weight.value;
  derivative = 2 * weight.value * J + square * weight.first * cofactor(J);
  if (this->power > 1)
  {
    derivative *= this->power * toPower(phi, this->power - 1);
  }
  return this->value(J);
}

FaceDensity::Hessian FaceDensity::hessian(const Eigen::Matrix2d& J) const
{
  const PlaneSingularValues svd(J);
  const double s0 = svd.s[0], s1 = svd.s[1], square = s0 * s0 + s1 * s1;
  const Weight weight(s0 * s1, this->epsilon);
  const double byDeterminant = square * weight.first;

  // Along the singular values, and the twist and the shear of the axes.
  Eigen::Matrix2d A;
  A(0, 0) = 2 * weight.value + 4 * s0 * s1 * weight.first + s1 * s1 * square * weight.second;
  A(1, 1) = 2 * weight.value + 4 * s0 * s1 * weight.first + s0 * s0 * square * weight.second;
  A(0, 1) = A(1, 0) = 2 * square * weight.first + byDeterminant + s0 * s1 * square * weight.second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
  const Eigen::Matrix2d& axes = eigen.eigenvectors();

  Hessian result = Hessian::Zero();
  const auto add = [&](double curvature, const Eigen::Matrix2d& mode)
  {
    if (curvature > 0)
    {
      const Eigen::Matrix2d direction = svd.U * mode * svd.V.transpose();
      const Eigen::Map<const Eigen::Vector4d> entries(direction.data());
      result += curvature * entries * entries.transpose();
    }
  };
  for (int k = 0; k < 2; ++k)
  {
    add(eigen.eigenvalues()[k], axes.col(k).asDiagonal().toDenseMatrix());
  }
  Eigen::Matrix2d twist, shear;
  twist << 0, -std::sqrt(0.5), std::sqrt(0.5), 0;
  shear << 0, std::sqrt(0.5), std::sqrt(0.5), 0;
  add(2 * weight.value + byDeterminant, twist);
  add(2 * weight.value - byDeterminant, shear);
  if (this->power > 1)
  {
    const double phi = square * weight.value;
    const double p = this->power, slope = toPower(phi, this->power - 1);
    const Eigen::Matrix2d first = 2 * weight.value * J + byDeterminant * cofactor(J);
    const Eigen::Map<const Eigen::Vector4d> g(first.data());
    result = p * slope * result + p * (p - 1) * (slope / phi) * (g * g.transpose());
  }
  return result;
}

namespace
{
constexpr Index Grain = 256;
/// Of a block that the upper part has not, or whose other node is fixed.
constexpr std::uint16_t NoPlace = 0xffff;

using Plane = FaceEnergy::Plane;
/// How the two edges of a corner, as columns, change with its nodes.
constexpr double EdgeOfNode[3][2] = { { -1, -1 }, { 1, 0 }, { 0, 1 } };
}

FaceEnergy::Plane FaceEnergy::tangents(const Eigen::RowVector3d& normal)
{
  Plane plane;
  plane.col(0) = normal.unitOrthogonal().transpose();
  plane.col(1) = normal.cross(plane.col(0).transpose()).transpose();
  return plane;
}

FaceEnergy::FaceEnergy(std::vector<FaceCorner> corners, const std::vector<Index>& free, Index nodes)
  : corners_(std::move(corners))
  , free_(free)
  , row_(inverseIndex(free, nodes))
  , uses_(gatherMap(static_cast<Index>(3 * corners_.size()), static_cast<Index>(free.size()),
      [this](Index place) { return Index(this->rowAt(place)); }))
{
}

void FaceEnergy::setPlanes(const Points& cornerNormals, const Points& nodeNormals)
{
  this->planes_.resize(this->corners_.size());
  for (std::size_t c = 0; c < this->planes_.size(); ++c)
  {
    this->planes_[c] = FaceEnergy::tangents(cornerNormals.row(static_cast<Index>(c)));
  }
  this->normals_ = nodeNormals;
}

Eigen::Matrix2d FaceEnergy::jacobian(Index corner, const Points& points) const
{
  const FaceCorner& own = this->corners_[corner];
  Eigen::Matrix<double, 3, 2> edges;
  for (int k = 0; k < 2; ++k)
  {
    edges.col(k) = (points.row(own.node[k + 1]) - points.row(own.node[0])).transpose();
  }
  return this->planes_[corner].transpose() * edges * own.inverse;
}

EnergyState FaceEnergy::evaluate(const Points& points, Monitor& monitor) const
{
  return reproducibleSum(static_cast<Index>(this->corners_.size()), monitor, EnergyState(),
    [&](Index c)
    {
      const Eigen::Matrix2d J = this->jacobian(c, points);
      const double d = J.determinant();
      return EnergyState{ this->corners_[c].weight * this->density_.value(J), d, d > 0 ? 0 : 1 };
    });
}

Objective::Value FaceEnergy::value(const Points& points, Monitor& monitor) const
{
  const EnergyState state = this->evaluate(points, monitor);
  return { state.energy, this->density_.epsilon > 0 || state.minimumDeterminant > 0 };
}

void FaceEnergy::gradient(const Points& points, Points& result, Monitor& monitor) const
{
  const Index corners = static_cast<Index>(this->corners_.size());
  this->parts_.resize(3 * corners, 3);
  parallel(corners, Grain, monitor,
    [&](Index c)
    {
      Eigen::Matrix2d slope;
      this->density_.gradient(this->jacobian(c, points), slope);
      const FaceCorner& own = this->corners_[c];
      const Eigen::Matrix<double, 3, 2> force =
        own.weight * this->planes_[c] * slope * own.inverse.transpose();
      this->parts_.row(3 * c) = -force.rowwise().sum().transpose();
      this->parts_.row(3 * c + 1) = force.col(0).transpose();
      this->parts_.row(3 * c + 2) = force.col(1).transpose();
    });
  gatherSum(this->uses_, this->parts_, result, monitor);
  for (Index i = 0; i < result.rows(); ++i)
  {
    const Eigen::RowVector3d normal = this->normals_.row(i);
    result.row(i) -= result.row(i).dot(normal) * normal;
  }
}

void FaceEnergy::openMatrix(BlockCsr3f& matrix) const
{
  const Index rows = static_cast<Index>(this->free_.size());
  BlockPattern pattern;
  std::vector<std::int32_t> row, found;
  for (Index i = 0; i < rows; ++i)
  {
    found.clear();
    for (const Index* use = this->uses_.begin(i); use != this->uses_.end(i); ++use)
    {
      for (Index k = 0; k < 3; ++k)
      {
        found.push_back(this->rowAt(*use - *use % 3 + k));
      }
    }
    row.assign(1, static_cast<std::int32_t>(i));
    std::copy_if(found.begin(), found.end(), std::back_inserter(row),
      [i](std::int32_t column) { return column >= i; });
    sortUnique(row);
    for (const std::int32_t column : found)
    {
      const auto place = std::lower_bound(row.begin(), row.end(), column) - row.begin();
      pattern.places.push_back(column < i ? NoPlace : static_cast<std::uint16_t>(place));
    }
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.offsets.push_back(static_cast<Index>(pattern.columns.size()));
    pattern.placeOffsets.push_back(static_cast<Index>(pattern.places.size()));
  }
  matrix.open(this->pattern_, std::move(pattern));
}

void FaceEnergy::addAlongNormal(Index row, BlockCsr3f& matrix) const
{
  Eigen::Map<Eigen::Matrix3f> block(matrix.blocks(row)); // that of the diagonal
  const Eigen::Vector3f normal = this->normals_.row(row).transpose().cast<float>();
  block += 0.5f * block.trace() * normal * normal.transpose();
}

void FaceEnergy::hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this->pattern_))
  {
    this->openMatrix(result);
  }
  result.setZero();
  const Index corners = static_cast<Index>(this->corners_.size());
  // By the corner's two edges in its plane: the first edge's two entries, then the second's.
  std::vector<FaceDensity::Hessian> ofEdges(corners);
  parallel(corners, Grain, monitor,
    [&](Index c)
    {
      const FaceCorner& own = this->corners_[c];
      const FaceDensity::Hessian H = own.weight * this->density_.hessian(this->jacobian(c, points));
      FaceDensity::Hessian& edges = ofEdges[c];
      for (int a = 0; a < 2; ++a)
      {
        for (int b = 0; b < 2; ++b)
        {
          Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
          for (int k = 0; k < 2; ++k)
          {
            for (int l = 0; l < 2; ++l)
            {
              sum += own.inverse(a, k) * own.inverse(b, l) * H.block<2, 2>(2 * k, 2 * l);
            }
          }
          edges.block<2, 2>(2 * a, 2 * b) = sum;
        }
      }
    });
  const auto tangential = [this](Index row, const Plane& plane)
  {
    const Eigen::RowVector3d normal = this->normals_.row(row);
    return Plane(plane - normal.transpose() * (normal * plane));
  };
  parallel(result.rows(), Grain, monitor,
    [&](Index row)
    {
      const std::uint16_t* place = result.places(row);
      for (const Index* use = this->uses_.begin(row); use != this->uses_.end(row); ++use)
      {
        const Index c = *use / 3, own = *use % 3;
        const Plane left = tangential(row, this->planes_[c]);
        for (Index other = 0; other < 3; ++other, ++place)
        {
          if (*place == NoPlace)
          {
            continue;
          }
          Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
          for (int a = 0; a < 2; ++a)
          {
            for (int b = 0; b < 2; ++b)
            {
              sum +=
                EdgeOfNode[own][a] * EdgeOfNode[other][b] * ofEdges[c].block<2, 2>(2 * a, 2 * b);
            }
          }
          const Plane right = tangential(this->rowAt(3 * c + other), this->planes_[c]);
          Eigen::Map<Eigen::Matrix3f> block(result.blocks(row) + 9 * static_cast<Index>(*place));
          block += (left * sum * right.transpose()).cast<float>();
        }
      }
      this->addAlongNormal(row, result);
    });
}
}
