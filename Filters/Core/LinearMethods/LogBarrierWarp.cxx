// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/LogBarrierWarp.h"

#include "Geometry/RotationFit.h"
#include "LinearMethods/ElementStiffness.h"
#include "LinearMethods/LogBarrierWeights.h"
#include "Mesh/CellShape.h"
#include "Mesh/StandingCells.h"
#include "Mesh/Topology.h"
#include "Solvers/CsrMatrix.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace morph
{
namespace
{
constexpr double LargestResidual = 1e-10; // of the local size

/// Columns of [W_I W_B]: the free nodes in the order of the rows, then the prescribed nodes.
struct WeightColumns
{
  WeightColumns(Index nodes, const std::vector<Index>& rows, const std::vector<Index>& prescribed);

  std::vector<int> ofNode;  ///< #nodes, -1 for a node in neither
  std::vector<Index> nodes; ///< node of each column
};

/// One row of LBWARP's weights: a node's neighbors and their weights. Use one object a thread.
class NodeWeights
{
public:
  /// The origin of the weights.
  enum class Kind
  {
    OneRing, ///< log-barrier weights among the nodes that share a volume cell with the node
    TwoRing, ///< log-barrier weights among these nodes and their neighbors
    /// affine weights of minimum norm of the one ring: exact for affine maps, some negative
    Affine,
    Stiffness, ///< FEMWARP's row
    None       ///< no weights: only OneRing was allowed, or every cell around has zero volume
  };

  /// The arguments must outlive this object. `around`: nodeToCells(mesh).
  NodeWeights(const Mesh& mesh, const Adjacency& around, const WeightColumns& columns);

  /// Computes the weights of `node`. With `relax` the kinds are tried in order, otherwise only the
  /// first.
  Kind compute(Index node, bool relax);

  /// Ascending, without the node's own column.
  const std::vector<int>& columns() const { return this->columns_; }
  /// One per column, sum 1.
  const std::vector<double>& weights() const { return this->weights_; }

private:
  void gather(Index node);
  void widen();
  void takeOffsets(Index node);
  void takeTangents(Index node);
  bool logBarrier();
  bool leastNormAffine();
  bool stiffness(Index node);

  const Mesh* mesh_;
  const Adjacency* around_;
  const WeightColumns* numbers_;

  LogBarrierWeights solver_;
  std::vector<int> columns_;
  std::vector<double> weights_;
  std::vector<std::array<double, 3>> offsets_;
  SparseRow met_; ///< the node's own column and those gathered
};

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
  const auto* offsets = reinterpret_cast<const double(*)[3]>(this->offsets_.data());
  return this->solver_
           .compute(offsets, static_cast<int>(this->columns_.size()), this->weights_.data())
           .place != LogBarrierWeights::Place::Outside;
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

/// Returns I - W_I and -W_B, whose rows sum to zero. `found`: becomes one a row.
SplitMatrix weightRows(const Mesh& mesh, const std::vector<Index>& rows,
  const std::vector<Index>& prescribed, bool relax, std::vector<NodeWeights::Kind>& found,
  Monitor& monitor)
{
  const Adjacency around = nodeToCells(mesh, monitor);
  const WeightColumns columns(mesh.numberOfNodes(), rows, prescribed);
  monitor.check();
  monitor.progress(0.1);
  const Index n = static_cast<Index>(rows.size());
  found.resize(rows.size());
  const auto makeRows = [&]() -> MakeRow
  {
    return [&, weights = NodeWeights(mesh, around, columns)](Index i, SparseRow& row) mutable
    {
      const NodeWeights::Kind kind = weights.compute(rows[i], relax);
      found[i] = kind;
      row.add(static_cast<int>(i), 1);
      for (std::size_t k = 0; kind != NodeWeights::Kind::None && k < weights.columns().size(); ++k)
      {
        row.add(weights.columns()[k], -weights.weights()[k]);
      }
    };
  };
  return assembleRows(n, n, n + static_cast<Index>(prescribed.size()), monitor, makeRows);
}
}

void LogBarrierWarp::doPrepare(const Mesh& rest, Monitor& monitor)
{
  const NodePartition& partition = this->partition();
  const Communicator& processes = this->processes();
  const ConnectedComponents parts = connectedComponents(rest, monitor, processes);
  requirePrescribedBodies(parts, partition, processes);
  const std::vector<Index> columns = this->setRows(rest, partition.free, parts);
  const bool relax = this->outsideHull_ == OutsideHull::Relax;
  std::vector<NodeWeights::Kind> found;
  SplitMatrix matrix = weightRows(rest, this->rows(), columns, relax, found, monitor);
  monitor.check();
  monitor.progress(0.5);
  std::vector<Index> emptyHere, outsideHere;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    if (found[i] != NodeWeights::Kind::OneRing)
    {
      outsideHere.push_back(this->rows()[i]);
    }
    if (found[i] == NodeWeights::Kind::None)
    {
      emptyHere.push_back(this->rows()[i]);
    }
  }
  const auto count = [&](NodeWeights::Kind kind)
  { return processes.sum(Index(std::count(found.begin(), found.end(), kind))); };
  const std::vector<Index> empty = processes.gatherNodes(emptyHere),
                           outside = processes.gatherNodes(outsideHere);
  if (!empty.empty() && relax)
  {
    this->throwSingular(emptyHere);
  }
  if (!empty.empty())
  {
    std::ostringstream text;
    text << empty.size() << (empty.size() == 1 ? " free node does" : " free nodes do")
         << " not lie inside the hull of the neighbors, at inverted or strongly concave cells, and "
         << "so cannot be a convex combination of them: node ids " << listIds(empty)
         << ". Repair the undeformed mesh, prescribe those nodes, or set `OutsideHull` to Relax.";
    throw Error(text.str());
  }
  const Index twoRing = count(NodeWeights::Kind::TwoRing),
              affine = count(NodeWeights::Kind::Affine),
              stiffness = count(NodeWeights::Kind::Stiffness);
  this->statistics_ = { { "OutsideHullNodes", static_cast<Index>(outside.size()) },
    { "TwoRingNodes", twoRing }, { "AffineNodes", affine }, { "StiffnessNodes", stiffness } };
  if (!outside.empty())
  {
    monitor.warn("Free nodes outside the hull of their neighbors: node ids " + listIds(outside) +
                 ". " + std::to_string(twoRing) +
                 " took weights among a second ring of neighbors, " + std::to_string(affine) +
                 " affine weights, " + std::to_string(stiffness) + " FEMWARP's row.");
  }
  monitor.check();
  monitor.progress(0.6);
  ProgressRange last(monitor, 0.6, 1);
  this->setEquations(matrix.inside, matrix.outside, columns, true, last);
}
}
