// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HigherOrderNodes.h"

#include "Mesh/CellShape.h"

#include <Eigen/LU>

#include <algorithm>

namespace morph
{
namespace
{
/// Makes the smallest change of the weights N of the corners X that reproduces `target`. Makes none
/// where the corners lie in a plane.
void makeLinear(const Eigen::Matrix<double, Eigen::Dynamic, 3>& X, const Eigen::Vector3d& target,
  Eigen::Ref<Eigen::VectorXd> N)
{
  Eigen::Matrix<double, Eigen::Dynamic, 4> A(X.rows(), 4);
  A << Eigen::VectorXd::Ones(X.rows()), X;
  Eigen::Vector4d missing;
  missing << 0, target - X.transpose() * N;
  const Eigen::FullPivLU<Eigen::Matrix4d> normal(A.transpose() * A);
  if (normal.rank() == 4)
  {
    N += A * normal.solve(missing);
  }
}

/// Computes the linear cell's shape functions at `target`. Where the cell cannot be inverted, it
/// takes those at `nominal`, changed to reproduce the target, so that affine motions stay exact.
void invertCell(const CellShape& shape, const double (*corners)[3], const Eigen::Vector3d& target,
  const double nominal[3], double* N)
{
  using Corners = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;
  const int n = shape.numberOfCorners;
  const Corners X(corners[0], n, 3);
  const double extent = (X.colwise().maxCoeff() - X.colwise().minCoeff()).norm();

  Eigen::Vector3d xi(nominal[0], nominal[1], nominal[2]);
  for (int iteration = 0; iteration < 20; ++iteration)
  {
    double dN[8][3];
    shapeFunctions(shape.shape, xi.data(), N, dN);
    const Eigen::Vector3d missing =
      target - X.transpose() * Eigen::Map<const Eigen::VectorXd>(N, n);
    if (missing.norm() <= 1e-14 * extent)
    {
      return;
    }
    const Eigen::Matrix3d J = X.transpose() * Corners(dN[0], n, 3);
    xi += J.inverse() * missing;
    if (!((xi.array() - 0.5).abs() < 1.5).all()) // true also where the inverse failed
    {
      break;
    }
  }
  shapeFunctions(shape.shape, xi.data(), N, nullptr);
  const Eigen::Vector3d missing = target - X.transpose() * Eigen::Map<const Eigen::VectorXd>(N, n);
  if (!(missing.norm() <= 1e-11 * extent))
  {
    shapeFunctions(shape.shape, nominal, N, nullptr);
    makeLinear(X / extent, target / extent, Eigen::Map<Eigen::VectorXd>(N, n));
  }
}
}

void HigherOrderNodes::prepare(const Mesh& rest, const NodePartition& partition)
{
  this->ids_ = partition.higherOrderNodes;
  this->weights_.resize(static_cast<Index>(this->ids_.size()), rest.numberOfNodes());
  if (this->ids_.empty())
  {
    return;
  }
  std::vector<Index> row(rest.numberOfNodes(), -1);
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    row[this->ids_[i]] = static_cast<Index>(i);
  }

  std::vector<Eigen::Triplet<double, int>> entries;
  std::vector<int> cells(this->ids_.size(), 0);
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(rest, c);
    if (!shape || shape->dimension != 3 || shape->numberOfNodes == shape->numberOfCorners)
    {
      continue;
    }
    // Relative to the first corner: far from the origin, rounding would exceed the cell's size.
    const Eigen::RowVector3d origin = rest.points.row(rest.cell(c)[0]);
    double corners[8][3];
    for (int a = 0; a < shape->numberOfCorners; ++a)
    {
      const Eigen::RowVector3d point = rest.points.row(rest.cell(c)[a]) - origin;
      std::copy(point.data(), point.data() + 3, corners[a]);
    }
    for (int k = shape->numberOfCorners; k < shape->numberOfNodes; ++k)
    {
      const Index r = row[rest.cell(c)[k]];
      if (r < 0)
      {
        continue;
      }
      double N[8];
      invertCell(*shape, corners, (rest.points.row(rest.cell(c)[k]) - origin).transpose(),
        shape->extraNodes[k - shape->numberOfCorners], N);
      ++cells[r];
      for (int a = 0; a < shape->numberOfCorners; ++a)
      {
        if (N[a] != 0)
        {
          entries.emplace_back(static_cast<int>(r), static_cast<int>(rest.cell(c)[a]), N[a]);
        }
      }
    }
  }
  this->weights_.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    this->weights_.row(static_cast<Index>(i)) *= 1. / cells[i];
  }
}

void HigherOrderNodes::apply(Points& displacement) const
{
  const Points moved = this->weights_ * displacement;
  displacement(this->ids_, allColumns) = moved;
}

void HigherOrderNodes::applyTranspose(Points& gradient) const
{
  const Points own = gradient(this->ids_, allColumns);
  gradient(this->ids_, allColumns).setZero();
  gradient += this->weights_.transpose() * own;
}
}
