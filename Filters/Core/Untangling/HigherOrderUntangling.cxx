// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/HigherOrderUntangling.h"

#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Quality/CellMap.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace morph
{
namespace
{
constexpr int Sweeps = 6, Rounds = 3;
constexpr double Enough = 0.05; // coefficient over six times the volume of the straight cell
constexpr double FirstStep = 0.25, LastStep = 1e-3; // of the cube root of that volume
constexpr int StepsOfLength = 8;

using Vector = Eigen::Vector3d;

/// The axes and the diagonals, in both directions.
std::vector<Vector> compass()
{
  std::vector<Vector> directions;
  for (int j = 0; j < 3; ++j)
  {
    directions.push_back(Vector::Unit(j));
    directions.push_back(-Vector::Unit(j));
  }
  for (int k = 0; k < 8; ++k)
  {
    directions.push_back(Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1) / std::sqrt(3.));
  }
  return directions;
}

class Search
{
public:
  Search(const Mesh& mesh, const NodePartition& partition,
    const std::vector<std::int8_t>& orientation, Points& points, Monitor& monitor)
    : mesh_(mesh)
    , orientation_(orientation)
    , points_(points)
    , monitor_(monitor)
    , isMovable_(mesh.numberOfNodes(), 0)
    , directions_(compass())
  {
    for (Index node : partition.higherOrderNodes)
    {
      this->isMovable_[node] = 1;
    }
  }

  HigherOrderUntangling run()
  {
    HigherOrderUntangling result;
    std::vector<Index> bad = this->invertedInside();
    this->collect(bad);
    const Points before = this->points_;
    for (int round = 0; round < Rounds && !bad.empty(); ++round)
    {
      this->straighten(bad);
      bad = this->invertedInside();
      this->collect(bad);
    }
    for (int sweep = 0; sweep < Sweeps && !bad.empty(); ++sweep)
    {
      this->monitor_.check();
      bool any = false;
      for (const auto& [node, cells] : this->around_)
      {
        if (std::any_of(cells.begin(), cells.end(),
              [&](Index c) { return std::binary_search(bad.begin(), bad.end(), c); }))
        {
          any = this->improve(node, cells) || any;
        }
      }
      bad.erase(
        std::remove_if(bad.begin(), bad.end(), [&](Index c) { return !this->isInverted(c); }),
        bad.end());
      if (!any)
      {
        break;
      }
    }
    result.left = bad;
    for (const auto& [node, cells] : this->around_)
    {
      result.movedNodes += this->points_.row(node) != before.row(node) ? 1 : 0;
    }
    return result;
  }

private:
  using Nodes = Vector[MostNodesOfVolume];

  /// Moves the movable nodes of the cells towards the means of the corners that they lie between.
  /// It is the least of four parts of the way that leaves the fewest cells around inverted.
  void straighten(const std::vector<Index>& cells)
  {
    std::map<Index, Eigen::RowVector3d> straight;
    for (Index c : cells)
    {
      const CellShape& shape = *cellShape(this->mesh_, c);
      for (int i = shape.numberOfCorners; i < shape.numberOfNodes; ++i)
      {
        const Index node = this->mesh_.cell(c)[i];
        if (this->isMovable_[node])
        {
          double N[8];
          shapeFunctions(shape.shape, shape.extraNodes[i - shape.numberOfCorners], N, nullptr);
          Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
          for (int a = 0; a < shape.numberOfCorners; ++a)
          {
            mean += N[a] * this->points_.row(this->mesh_.cell(c)[a]);
          }
          straight[node] = mean;
        }
      }
    }
    const Points start = this->points_;
    Points best = start;
    Index fewest = this->invertedAround(straight);
    for (const double part : { 0.25, 0.5, 0.75, 1. })
    {
      for (const auto& [node, mean] : straight)
      {
        this->points_.row(node) = (1 - part) * start.row(node) + part * mean;
      }
      const Index inverted = this->invertedAround(straight);
      if (inverted < fewest)
      {
        fewest = inverted;
        best = this->points_;
      }
    }
    this->points_ = best;
  }

  /// Returns the number of inverted cells at these nodes.
  Index invertedAround(const std::map<Index, Eigen::RowVector3d>& nodes) const
  {
    std::vector<Index> cells;
    for (const auto& [node, mean] : nodes)
    {
      const std::vector<Index>& around = this->around_.at(node);
      cells.insert(cells.end(), around.begin(), around.end());
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return std::count_if(cells.begin(), cells.end(), [&](Index c) { return this->isInverted(c); });
  }

  /// Copies the nodes of a cell, a mirrored one as its mirror image.
  void nodesOf(Index cell, Nodes& x) const
  {
    const Index* id = this->mesh_.cell(cell);
    const int count = cellShape(this->mesh_, cell)->numberOfNodes;
    for (int i = 0; i < count; ++i)
    {
      x[i] = this->points_.row(id[i]).transpose();
      x[i][2] *= this->orientation_[cell];
    }
  }

  bool isInverted(Index cell) const
  {
    Nodes x;
    this->nodesOf(cell, x);
    return proveJacobian(this->mesh_.types[cell], x).certificate == Certificate::Inverted;
  }

  /// Returns six times the volume of the cell through the corners.
  double straightVolume(Index cell) const
  {
    const CellShape& shape = *cellShape(this->mesh_, cell);
    double corners[8][3];
    copyCorners(this->mesh_, cell, shape, this->points_, corners[0]);
    return 6 * this->orientation_[cell] * signedVolume(shape.shape, corners);
  }

  std::vector<Index> invertedInside() const
  {
    const Quality corners =
      measureCorners(this->mesh_, this->points_, this->orientation_, {}, this->monitor_);
    const CertificateReport report =
      certify(this->mesh_, this->points_, this->orientation_, {}, this->monitor_);
    std::vector<Index> cells;
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      if (report.cells[c] == Certificate::Inverted && corners.scaledJacobian[c] > 0 &&
          isQuadraticVolume(*cellShape(this->mesh_, c)) && this->straightVolume(c) > 0)
      {
        cells.push_back(c);
      }
    }
    return cells;
  }

  /// Finds the movable nodes of the cells, and all quadratic cells at each.
  void collect(const std::vector<Index>& cells)
  {
    const auto visit = [&](Index c, const auto& onNode)
    {
      const CellShape& shape = *cellShape(this->mesh_, c);
      for (int i = shape.numberOfCorners; i < shape.numberOfNodes; ++i)
      {
        const Index node = this->mesh_.cell(c)[i];
        if (this->isMovable_[node])
        {
          onNode(node);
        }
      }
    };
    for (auto& [node, around] : this->around_)
    {
      around.clear();
    }
    for (Index c : cells)
    {
      visit(c, [&](Index node) { this->around_[node]; });
    }
    if (cells.empty())
    {
      return;
    }
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      if (isQuadraticVolume(*cellShape(this->mesh_, c)))
      {
        visit(c,
          [&](Index node)
          {
            const auto found = this->around_.find(node);
            if (found != this->around_.end())
            {
              found->second.push_back(c);
            }
          });
      }
    }
  }

  /// Returns the minimum coefficient over the cells, each in units of its straight volume.
  double value(const std::vector<Index>& cells) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (Index c : cells)
    {
      Nodes x;
      this->nodesOf(c, x);
      const CellMap& map = *CellMap::find(this->mesh_.types[c]);
      BernsteinHalving::Part whole = map.halving().whole();
      map.determinant(map.derivatives(x), 0, whole.c);
      least = std::min(least, map.halving().minimum(whole) / std::abs(this->straightVolume(c)));
    }
    return least;
  }

  /// Moves a node to raise the value of its cells. Returns whether it did.
  bool improve(Index node, const std::vector<Index>& cells)
  {
    double best = this->value(cells);
    const double start = best;
    double unit = std::numeric_limits<double>::infinity();
    for (Index c : cells)
    {
      unit = std::min(unit, std::cbrt(std::abs(this->straightVolume(c))));
    }
    for (double step = FirstStep; step > LastStep && best < Enough; step /= 2)
    {
      for (int k = 0; k < StepsOfLength && this->step(node, cells, step * unit, best); ++k)
      {
      }
    }
    return best > start;
  }

  /// Takes the best step of this length, if it raises the value.
  bool step(Index node, const std::vector<Index>& cells, double length, double& best)
  {
    const Eigen::RowVector3d from = this->points_.row(node);
    Eigen::RowVector3d to = from;
    const double before = best;
    for (const Vector& direction : this->directions_)
    {
      this->points_.row(node) = from + length * direction.transpose();
      const double value = this->value(cells);
      if (value > best)
      {
        best = value;
        to = this->points_.row(node);
      }
    }
    this->points_.row(node) = to;
    return best > before;
  }

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  Points& points_;
  Monitor& monitor_;
  std::vector<char> isMovable_;
  const std::vector<Vector> directions_;
  std::map<Index, std::vector<Index>> around_; ///< quadratic cells at each node that may move
};
}

HigherOrderUntangling untangleHigherOrder(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, Points& points, Monitor& monitor)
{
  if (partition.higherOrderNodes.empty())
  {
    return {};
  }
  return Search(mesh, partition, orientation, points, monitor).run();
}
}
