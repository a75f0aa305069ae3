// SPDX-License-Identifier: BSD-3-Clause
#include "MeshEnergy.h"

#include "BlockSum.h"
#include "CellShape.h"
#include "SimplicialDecomposition.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>

namespace morph
{
namespace
{
constexpr Index Grain = 256;
constexpr double StiffenedTheta = 0.1;

using CornerHessian = Eigen::Matrix<double, 24, 24>;

/// The corners of one cell, at `points`.
struct Cell
{
  Cell(const Mesh& mesh, Index id, const Points& points)
    : shape(*cellShape(mesh.types[id]))
    , nodes(mesh.cell(id))
    , n(numberOfCorners(shape.shape))
  {
    for (int a = 0; a < this->n; ++a)
    {
      this->x.col(a) = points.row(this->node(a)).transpose();
    }
  }
  Index node(int corner) const { return this->nodes[this->shape.cornerNode[corner]]; }

  Eigen::Matrix3d jacobian(const int* corner, const TargetShapes::Tetrahedron& target) const
  {
    Eigen::Matrix3d D;
    for (int k = 0; k < 3; ++k)
    {
      D.col(k) = this->x.col(corner[k + 1]) - this->x.col(corner[0]);
    }
    return D * Eigen::Map<const Eigen::Matrix3d>(target.inverse);
  }

  const CellShape& shape;
  const Index* nodes;
  int n;
  Eigen::Matrix<double, 3, 8> x;
};

/// d(J)/d(corner k) = e_j (x) g_k: the columns are g_0 to g_3.
Eigen::Matrix<double, 3, 4> shapeGradients(const TargetShapes::Tetrahedron& target)
{
  const Eigen::Map<const Eigen::Matrix3d> inverse(target.inverse);
  Eigen::Matrix<double, 3, 4> g;
  g.rightCols<3>() = inverse.transpose();
  g.col(0) = -g.rightCols<3>().rowwise().sum();
  return g;
}

/// Tetrahedral cells weigh shape against volume differently, and are never stiffened: it lowers their scaled Jacobian.
FoldoverDensity densityOf(const FoldoverDensity& density, const TargetShapes::Tetrahedron& target)
{
  FoldoverDensity own = density;
  own.theta = target.theta;
  own.stiffness = target.theta > StiffenedTheta ? 0 : density.stiffness;
  return own;
}

struct Sum
{
  double energy = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  Sum& operator+=(const Sum& other)
  {
    this->energy += other.energy;
    this->least = std::min(this->least, other.least);
    this->most = std::max(this->most, other.most);
    return *this;
  }
};
}

MeshEnergy::MeshEnergy(const Mesh& mesh, const std::vector<Index>& free)
  : mesh_(mesh)
  , free_(free)
  , row_(mesh.numberOfNodes(), -1)
  , around_(nodeToCells(mesh))
{
  for (std::size_t i = 0; i < free.size(); ++i)
  {
    this->row_[free[i]] = static_cast<std::int32_t>(i);
  }
  this->blockStart_.assign(mesh.numberOfCells() + 1, 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Shape shape = cellShape(mesh.types[c])->shape;
    this->blockStart_[c + 1] = this->blockStart_[c] + numberOfCorners(shape);
    const SimplicialDecomposition parts = simplicialDecomposition(shape);
    for (int t = 0; t < parts.count; ++t)
    {
      this->movable_ += this->isMovable(c, parts.tets[t].corner) ? 1 : 0;
    }
  }
}

bool MeshEnergy::isMovable(Index cell, const int* corner) const
{
  const CellShape& shape = *cellShape(this->mesh_.types[cell]);
  const Index* nodes = this->mesh_.cell(cell);
  return std::any_of(
    corner, corner + 4, [&](int a) { return this->row_[nodes[shape.cornerNode[a]]] >= 0; });
}

std::vector<Index> MeshEnergy::infeasibleCells(const TargetShapes& targets, const Points& points) const
{
  std::vector<Index> result;
  for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
  {
    const SimplicialDecomposition parts = simplicialDecomposition(cellShape(this->mesh_.types[c])->shape);
    for (int t = 0; t < parts.count; ++t)
    {
      const int* corner = parts.tets[t].corner;
      if (!this->isMovable(c, corner) &&
        !(Cell(this->mesh_, c, points).jacobian(corner, targets.tetrahedra[targets.start[c] + t]).determinant() > 0))
      {
        result.push_back(c);
        break;
      }
    }
  }
  return result;
}

MeshEnergy::State MeshEnergy::evaluate(
  const Points& points, const TargetShapes& targets, const FoldoverDensity& density, Monitor& monitor) const
{
  const Sum sum = blockSum(this->mesh_.numberOfCells(), monitor, Sum{}, [&](Index c) {
    Sum result;
    const SimplicialDecomposition parts = simplicialDecomposition(cellShape(this->mesh_.types[c])->shape);
    if (parts.count == 0)
    {
      return result;
    }
    const Cell cell(this->mesh_, c, points);
    for (int t = 0; t < parts.count; ++t)
    {
      if (!this->isMovable(c, parts.tets[t].corner))
      {
        continue;
      }
      const TargetShapes::Tetrahedron& target = targets.tetrahedra[targets.start[c] + t];
      const Eigen::Matrix3d J = cell.jacobian(parts.tets[t].corner, target);
      const FoldoverDensity own = densityOf(density, target);
      const double phi = own.distortion(J);
      const double gap = 1 - own.stiffness * phi;
      result.energy += target.weight * (gap > 0 ? phi / gap : std::numeric_limits<double>::infinity());
      result.least = std::min(result.least, J.determinant());
      result.most = target.theta > StiffenedTheta ? result.most : std::max(result.most, phi);
    }
    return result;
  });
  return { sum.energy, sum.least, sum.most };
}

void MeshEnergy::gradient(const Points& points, const TargetShapes& targets, const FoldoverDensity& density,
  Points& result, Monitor& monitor) const
{
  Points parts(this->blockStart_.back(), 3); // corner by corner of each cell
  monitor.parallelFor(this->mesh_.numberOfCells(), Grain, [&](Index first, Index last) {
    for (Index c = first; c < last; ++c)
    {
      const SimplicialDecomposition split = simplicialDecomposition(cellShape(this->mesh_.types[c])->shape);
      if (split.count == 0)
      {
        continue;
      }
      const Cell cell(this->mesh_, c, points);
      auto own = parts.middleRows(this->blockStart_[c], cell.n);
      own.setZero();
      for (int t = 0; t < split.count; ++t)
      {
        const int* corner = split.tets[t].corner;
        if (!this->isMovable(c, corner))
        {
          continue;
        }
        const TargetShapes::Tetrahedron& target = targets.tetrahedra[targets.start[c] + t];
        Eigen::Matrix3d P;
        densityOf(density, target).gradient(cell.jacobian(corner, target), P);
        const Eigen::Matrix<double, 3, 4> force = target.weight * P * shapeGradients(target);
        for (int k = 0; k < 4; ++k)
        {
          own.row(corner[k]) += force.col(k).transpose();
        }
      }
    }
  });
  result.resize(static_cast<Index>(this->free_.size()), 3);
  monitor.parallelFor(result.rows(), Grain, [&](Index first, Index last) {
    for (Index i = first; i < last; ++i)
    {
      const Index node = this->free_[i];
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const Index* c = this->around_.begin(node); c != this->around_.end(node); ++c)
      {
        const Cell cell(this->mesh_, *c, points);
        for (int a = 0; a < cell.n; ++a)
        {
          if (cell.node(a) == node)
          {
            sum += parts.row(this->blockStart_[*c] + a);
          }
        }
      }
      result.row(i) = sum;
    }
  });
}

void MeshEnergy::openMatrix(BlockMatrix& matrix) const
{
  std::vector<Index> offsets{ 0 };
  std::vector<std::int32_t> columns;
  std::vector<std::int32_t> row;
  for (Index node : this->free_)
  {
    row.clear();
    for (const Index* c = this->around_.begin(node); c != this->around_.end(node); ++c)
    {
      const CellShape& shape = *cellShape(this->mesh_.types[*c]);
      for (int a = 0; a < numberOfCorners(shape.shape); ++a)
      {
        const std::int32_t at = this->row_[this->mesh_.cell(*c)[shape.cornerNode[a]]];
        if (at >= 0)
        {
          row.push_back(at);
        }
      }
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns.insert(columns.end(), row.begin(), row.end());
    offsets.push_back(static_cast<Index>(columns.size()));
  }
  matrix.open(std::move(offsets), std::move(columns));
}

void MeshEnergy::hessian(const Points& points, const TargetShapes& targets, const FoldoverDensity& density,
  BlockMatrix& result, Monitor& monitor) const
{
  if (result.rows() != static_cast<Index>(this->free_.size()))
  {
    this->openMatrix(result);
  }
  // The blocks of each cell, upper triangle of its corners; then each row gathers its own, cell by cell.
  const Index cells = this->mesh_.numberOfCells();
  std::vector<Index> start(cells + 1, 0);
  for (Index c = 0; c < cells; ++c)
  {
    const Index n = this->blockStart_[c + 1] - this->blockStart_[c];
    start[c + 1] = start[c] + 9 * (n * (n + 1) / 2);
  }
  Eigen::ArrayXf blocks(start.back());
  monitor.parallelFor(cells, Grain, [&](Index first, Index last) {
    CornerHessian H;
    FoldoverDensity::Hessian modes;
    for (Index c = first; c < last; ++c)
    {
      const SimplicialDecomposition split = simplicialDecomposition(cellShape(this->mesh_.types[c])->shape);
      if (split.count == 0)
      {
        continue;
      }
      const Cell cell(this->mesh_, c, points);
      H.topLeftCorner(3 * cell.n, 3 * cell.n).setZero();
      for (int t = 0; t < split.count; ++t)
      {
        const int* corner = split.tets[t].corner;
        if (!this->isMovable(c, corner))
        {
          continue;
        }
        const TargetShapes::Tetrahedron& target = targets.tetrahedra[targets.start[c] + t];
        densityOf(density, target).hessian(cell.jacobian(corner, target), modes);
        const Eigen::Matrix<double, 3, 4> g = shapeGradients(target);
        Eigen::Matrix<double, 12, 9> B; // one column a mode, times the root of its weight
        for (int m = 0; m < 9; ++m)
        {
          Eigen::Map<Eigen::Matrix<double, 3, 4>> column(B.col(m).data());
          column = std::sqrt(target.weight * modes.weight[m]) * modes.mode[m] * g;
        }
        const Eigen::Matrix<double, 12, 12> K = B * B.transpose();
        for (int a = 0; a < 4; ++a)
        {
          for (int b = 0; b < 4; ++b)
          {
            if (corner[a] <= corner[b])
            {
              H.block<3, 3>(3 * corner[a], 3 * corner[b]) += K.block<3, 3>(3 * a, 3 * b);
            }
          }
        }
      }
      float* out = blocks.data() + start[c];
      for (int a = 0; a < cell.n; ++a)
      {
        for (int b = a; b < cell.n; ++b, out += 9)
        {
          Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> block(out);
          block = H.block<3, 3>(3 * a, 3 * b).cast<float>();
        }
      }
    }
  });
  monitor.check();

  monitor.parallelFor(result.rows(), Grain, [&](Index first, Index last) {
    for (Index row = first; row < last; ++row)
    {
      const Index node = this->free_[row];
      const std::int32_t* columns = result.columns(row);
      const Index size = result.offsets()[row + 1] - result.offsets()[row];
      float* out = result.blocks(row);
      std::fill(out, out + 9 * size, 0.f);
      for (const Index* c = this->around_.begin(node); c != this->around_.end(node); ++c)
      {
        const CellShape& shape = *cellShape(this->mesh_.types[*c]);
        const Index* nodes = this->mesh_.cell(*c);
        const int n = numberOfCorners(shape.shape);
        for (int own = 0; own < n; ++own)
        {
          if (nodes[shape.cornerNode[own]] != node)
          {
            continue;
          }
          for (int other = 0; other < n; ++other)
          {
            const std::int32_t column = this->row_[nodes[shape.cornerNode[other]]];
            if (column < 0)
            {
              continue;
            }
            float* block = out + 9 * (std::lower_bound(columns, columns + size, column) - columns);
            const int a = std::min(own, other), b = std::max(own, other);
            const float* in = blocks.data() + start[*c] + 9 * (a * n - a * (a - 1) / 2 + b - a);
            for (int i = 0; i < 3; ++i)
            {
              for (int j = 0; j < 3; ++j)
              {
                block[3 * i + j] += own <= other ? in[3 * i + j] : in[3 * j + i];
              }
            }
          }
        }
      }
    }
  });
}
}
