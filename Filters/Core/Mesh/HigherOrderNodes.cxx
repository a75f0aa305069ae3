// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HigherOrderNodes.h"

#include "Geometry/AffineFit.h"
#include "Mesh/CellShape.h"

#include <Eigen/SVD>

#include <algorithm>
#include <vector>

namespace morph
{
namespace
{
/// Moves the four corners of a face, 4 x 3, and a place near it into the plane that fits them best.
/// They may be uneven by rounding, or by so little that an affine fit to all three coordinates
/// would tell what is beside them apart by that.
void flatten(Points& corners, Eigen::RowVector3d& place)
{
  const Eigen::RowVector3d mean = corners.colwise().mean();
  const Eigen::MatrixXd arms = corners.rowwise() - mean;
  const Eigen::Vector3d normal =
    Eigen::JacobiSVD<Eigen::MatrixXd>(arms, Eigen::ComputeThinV).matrixV().col(2);
  corners -= arms * normal * normal.transpose();
  place -= (place - mean).dot(normal) * normal.transpose();
}

/// Returns the weights of `corners`, #corners x 3, at `place`, where the type of the cell has its
/// node at `nominal`.
Eigen::VectorXd weightsAt(const CellShape& shape, const Points& corners,
  const Eigen::RowVector3d& place, const double nominal[3])
{
  double N[8];
  shapeFunctions(shape.shape, nominal, N, nullptr);
  std::vector<Index> between;
  for (int a = 0; a < shape.numberOfCorners; ++a)
  {
    if (N[a] != 0)
    {
      between.push_back(a);
    }
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(shape.numberOfCorners);
  Points ends = corners(between, allColumns);
  Eigen::RowVector3d at = place;
  if (ends.rows() == 4 && shape.numberOfCorners > 4)
  {
    flatten(ends, at);
  }
  weights(between) = AffineLeastSquares(ends, at).weights(at);
  const Eigen::RowVector3d reached = weights.transpose() * corners;
  const double extent = (corners.colwise().maxCoeff() - corners.colwise().minCoeff()).norm();
  if ((place - reached).norm() > 1e-14 * extent)
  {
    const AffineLeastSquares all(corners);
    weights += all.weights(place) - all.weights(reached);
  }
  return weights;
}
}

void HigherOrderNodes::prepare(
  const Mesh& rest, const NodePartition& partition, const Communicator& communicator)
{
  this->ids_ = partition.higherOrderNodes;
  this->weights_.resize(static_cast<Index>(this->ids_.size()), rest.numberOfNodes());
  this->rows_.reset();
  if (communicator.all(this->ids_.empty()))
  {
    return;
  }
  this->rows_ = communicator.rows(this->ids_);
  std::vector<Index> row(rest.numberOfNodes(), -1);
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    row[this->ids_[i]] = static_cast<Index>(i);
  }

  std::vector<Eigen::Triplet<double, int>> entries;
  Points cells = Points::Zero(this->weights_.rows(), 3); // in the first column
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const CellShape* shape = cellShape(rest, c);
    if (!shape || shape->dimension != 3 || shape->numberOfNodes == shape->numberOfCorners)
    {
      continue;
    }
    // Relative to the first corner: far from the origin, rounding would exceed the cell's size.
    const Eigen::RowVector3d origin = rest.points.row(rest.cell(c)[0]);
    const std::vector<Index> ids(rest.cell(c), rest.cell(c) + shape->numberOfCorners);
    const Points corners = rest.points(ids, allColumns).rowwise() - origin;
    for (int k = shape->numberOfCorners; k < shape->numberOfNodes; ++k)
    {
      const Index r = row[rest.cell(c)[k]];
      if (r < 0)
      {
        continue;
      }
      const Eigen::VectorXd N = weightsAt(*shape, corners,
        rest.points.row(rest.cell(c)[k]) - origin, shape->extraNodes[k - shape->numberOfCorners]);
      ++cells(r, 0);
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
  this->rows_->add(cells);
  for (Index i = 0; i < cells.rows(); ++i)
  {
    this->weights_.row(i) *= 1. / cells(i, 0);
  }
}

void HigherOrderNodes::apply(Points& displacement) const
{
  if (!this->empty())
  {
    Points moved = this->weights_ * displacement;
    this->rows_->add(moved);
    displacement(this->ids_, allColumns) = moved;
  }
}

void HigherOrderNodes::carry(const Points& rest, Points& points) const
{
  if (!this->empty())
  {
    Points displacement = points - rest;
    this->apply(displacement);
    points(this->ids_, allColumns) =
      rest(this->ids_, allColumns) + displacement(this->ids_, allColumns);
  }
}

void HigherOrderNodes::applyTranspose(Points& gradient) const
{
  const Points own = gradient(this->ids_, allColumns);
  gradient(this->ids_, allColumns).setZero();
  gradient += this->weights_.transpose() * own;
}

std::map<Index, double> HigherOrderNodes::weightsOf(Index node) const
{
  std::map<Index, double> weights;
  const auto found = std::lower_bound(this->ids_.begin(), this->ids_.end(), node);
  if (found != this->ids_.end() && *found == node)
  {
    using Corners = Eigen::SparseMatrix<double, Eigen::RowMajor, int>::InnerIterator;
    for (Corners corner(this->weights_, found - this->ids_.begin()); corner; ++corner)
    {
      weights[corner.col()] = corner.value();
    }
  }
  return weights;
}
}
