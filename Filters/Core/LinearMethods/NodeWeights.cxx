// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/NodeWeights.h"

#include "Geometry/ThinSvd3.h"
#include "LinearMethods/ElementStiffness.h"
#include "Mesh/CellShape.h"
#include "Mesh/StandingCells.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double LargestResidual = 1e-10; // of the local size
}

WeightColumns::WeightColumns(
  Index nodeCount, const std::vector<Index>& rows, const std::vector<Index>& prescribed)
  : ofNode(nodeCount, -1)
  , nodes(rows)
{
  this->nodes.insert(this->nodes.end(), prescribed.begin(), prescribed.end());
  for (std::size_t i = 0; i < this->nodes.size(); ++i)
  {
    this->ofNode[this->nodes[i]] = static_cast<int>(i);
  }
}

NodeWeights::NodeWeights(const Mesh& mesh, const Adjacency& around, const WeightColumns& columns)
  : mesh_(&mesh)
  , around_(&around)
  , numbers_(&columns)
{
}

/// Adds the nodes that share a volume cell with `node` and were not found since the last clear.
void NodeWeights::gather(Index node)
{
  for (const Index* cell = this->around_->begin(node); cell != this->around_->end(node); ++cell)
  {
    const Index* nodes = this->mesh_->cell(*cell);
    const int n = cellShape(this->mesh_->types[*cell])->numberOfCorners;
    for (int k = 0; k < n; ++k)
    {
      const int column = this->numbers_->ofNode[nodes[k]];
      if (this->met_.add(column, 0))
      {
        this->columns_.push_back(column);
      }
    }
  }
}

void NodeWeights::widen()
{
  const std::vector<int> ring = this->columns_;
  for (int column : ring)
  {
    this->gather(this->numbers_->nodes[column]);
  }
  std::sort(this->columns_.begin(), this->columns_.end());
}

void NodeWeights::takeOffsets(Index node)
{
  if (this->mesh_->layer.isCurved())
  {
    return this->takeTangents(node);
  }
  const double* origin = this->mesh_->points.data() + 3 * node;
  this->offsets_.resize(this->columns_.size());
  for (std::size_t i = 0; i < this->columns_.size(); ++i)
  {
    const double* point = this->mesh_->points.data() + 3 * this->numbers_->nodes[this->columns_[i]];
    this->offsets_[i] = { point[0] - origin[0], point[1] - origin[1], point[2] - origin[2] };
  }
}

/// Of a curved layer: its neighbors as they lie in the tangent plane of their node, each front or
/// back with its own.
void NodeWeights::takeTangents(Index node)
{
  const Points& points = this->mesh_->points;
  const Index count = this->mesh_->layer.nodes, front = this->mesh_->layer.frontOf(node);
  const Eigen::RowVector3d across = points.row(front + count) - points.row(front);
  const Eigen::RowVector3d normal = across.stableNormalized();
  this->offsets_.resize(this->columns_.size());
  for (std::size_t i = 0; i < this->columns_.size(); ++i)
  {
    const Index other = this->numbers_->nodes[this->columns_[i]];
    const Eigen::RowVector3d arm =
      points.row(this->mesh_->layer.frontOf(other)) - points.row(front);
    const double sides = (other >= count) - (node >= count);
    const Eigen::RowVector3d offset = arm - arm.dot(normal) * normal + sides * across;
    this->offsets_[i] = { offset[0], offset[1], offset[2] };
  }
}

bool NodeWeights::logBarrier()
{
  this->weights_.resize(this->columns_.size());
  const LogBarrierWeights::Result result =
    this->solver_.compute(reinterpret_cast<const double(*)[3]>(this->offsets_.data()),
      static_cast<int>(this->columns_.size()), this->weights_.data());
  this->iterations_ += result.iterations;
  return result.place != LogBarrierWeights::Place::Outside;
}

/// Minimizes |w - 1 / k|^2 with sum w_j = 1 and sum w_j d_j = 0: w_j = (1 - (d_j - m) . C^-1 m) /
/// k. m is the mean and C the covariance of the d_j.
bool NodeWeights::leastNormAffine()
{
  const Index k = static_cast<Index>(this->offsets_.size());
  if (k == 0)
  {
    return false;
  }
  const Eigen::Map<const Points> d(this->offsets_[0].data(), k, 3);
  const double size = d.cwiseAbs().maxCoeff();
  const Eigen::RowVector3d mean = d.colwise().mean() / size;
  const Points centered = (d / size).rowwise() - mean;
  const ThinSvd3 principal(centered);
  Eigen::VectorXd w = Eigen::VectorXd::Constant(k, 1. / static_cast<double>(k));
  for (int c = 0; c < principal.dimension; ++c)
  {
    const Eigen::Vector3d scaled = principal.axes.col(c) / principal.extent[c];
    w -= (centered * scaled) * mean.dot(scaled);
  }
  const Eigen::RowVector3d residual = w.transpose() * d / size;
  if (!w.allFinite() || !(residual.norm() <= LargestResidual) ||
      !(std::abs(w.sum() - 1) <= LargestResidual))
  {
    return false;
  }
  this->weights_.resize(this->columns_.size());
  Eigen::Map<Eigen::VectorXd>(this->weights_.data(), k) = w;
  return true;
}

bool NodeWeights::stiffness(Index node)
{
  const int own = this->numbers_->ofNode[node];
  double diagonal = 0;
  this->weights_.assign(this->columns_.size(), 0);
  for (const Index* cell = this->around_->begin(node); cell != this->around_->end(node); ++cell)
  {
    const CellShape& shape = *cellShape(this->mesh_->types[*cell]);
    const int n = shape.numberOfCorners;
    double corners[8][3], K[triangleSize(8)];
    int column[8];
    for (int a = 0; a < n; ++a)
    {
      column[a] = this->numbers_->ofNode[this->mesh_->cell(*cell)[shape.cornerNode[a]]];
    }
    copyStanding(*this->mesh_, *cell, shape, this->mesh_->points, corners[0]);
    elementStiffness(shape.shape, corners, K);
    for (int a = 0; a < n; ++a)
    {
      for (int b = 0; b < n && column[a] == own; ++b)
      {
        const double value = K[triangleIndex(n, a, b)];
        if (column[b] == own)
        {
          diagonal += value;
          continue;
        }
        const auto place =
          std::lower_bound(this->columns_.begin(), this->columns_.end(), column[b]);
        this->weights_[place - this->columns_.begin()] -= value;
      }
    }
  }
  for (double& w : this->weights_)
  {
    w /= diagonal;
  }
  return diagonal > 0 && std::isfinite(1 / diagonal);
}

NodeWeights::Kind NodeWeights::compute(Index node, bool relax)
{
  const auto oneRing = [&]
  {
    this->columns_.clear();
    this->met_.clear();
    this->met_.add(this->numbers_->ofNode[node], 0);
    this->gather(node);
    std::sort(this->columns_.begin(), this->columns_.end());
    this->takeOffsets(node);
  };
  this->iterations_ = 0;
  oneRing();
  if (this->logBarrier())
  {
    return Kind::OneRing;
  }
  if (!relax)
  {
    return Kind::None;
  }
  this->widen();
  this->takeOffsets(node);
  if (this->logBarrier())
  {
    return Kind::TwoRing;
  }
  oneRing();
  if (this->leastNormAffine())
  {
    return Kind::Affine;
  }
  return this->stiffness(node) ? Kind::Stiffness : Kind::None;
}
}
