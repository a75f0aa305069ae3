// SPDX-License-Identifier: BSD-3-Clause
#include "MeshEnergy.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr Index Grain = 256;
constexpr double Largest = 1e20; // of an entry: its square still is a float

/// Where the block of corners a <= b stands in the upper triangle of a cell with `n` corners.
int place(int a, int b, int n)
{
  return a * n - a * (a - 1) / 2 + b - a;
}

/// The blocks of a tetrahedron's four corners: moving all alike changes nothing, so those of corner 0 follow from the others.
void completeBlocks(const Eigen::Matrix3d (&three)[3][3], Eigen::Matrix3d (&four)[4][4])
{
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      four[a + 1][b + 1] = three[a][b];
      four[b + 1][a + 1] = three[a][b].transpose();
    }
  }
  four[0][0].setZero();
  for (int b = 1; b < 4; ++b)
  {
    four[0][b] = -(four[1][b] + four[2][b] + four[3][b]);
    four[b][0] = four[0][b].transpose();
    four[0][0] -= four[0][b];
  }
}
}

void MeshEnergy::openMatrix(BlockMatrix& matrix) const
{
  std::vector<Index> cellOf(this->corner_.size());
  for (Index c = 0; c < this->cells(); ++c)
  {
    std::fill(
      cellOf.begin() + this->cornerStart_[c], cellOf.begin() + this->cornerStart_[c + 1], c);
  }
  std::vector<Index> offsets{ 0 };
  std::vector<std::int32_t> columns, row;
  for (Index i = 0; i < static_cast<Index>(this->free_.size()); ++i)
  {
    row.assign(1, static_cast<std::int32_t>(i));
    for (const Index* use = this->uses_.begin(i); use != this->uses_.end(i); ++use)
    {
      const Index c = cellOf[*use];
      for (int a = 0; a < this->numberOfCorners(c); ++a)
      {
        const std::int32_t at = this->row_[this->corners(c)[a]];
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
  matrix.open(this, std::move(offsets), std::move(columns));
}

void MeshEnergy::cellHessian(Index cell, const Points& points, float* blocks) const
{
  const int n = this->numberOfCorners(cell);
  const Corners x = this->positions(cell, points);
  Eigen::Matrix3d sum[36];
  std::fill_n(sum, n * (n + 1) / 2, Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  Eigen::Matrix3d D, three[3][3], four[4][4];
  for (Index t = this->start_[cell]; t < this->start_[cell + 1]; ++t)
  {
    const TargetShapes::Tetrahedron& tetrahedron = this->tetrahedra_[t];
    const std::int8_t* corner = tetrahedron.corner;
    const Eigen::Map<const Eigen::Matrix3d> inverse(tetrahedron.inverse);
    for (int k = 0; k < 3; ++k)
    {
      D.col(k) = x.col(corner[k + 1]) - x.col(corner[0]);
    }
    this->densityOf(tetrahedron).hessian(D * inverse, inverse.transpose(), three);
    double most = 0;
    for (int a = 0; a < 3; ++a)
    {
      most = std::max(most, three[a][a].diagonal().maxCoeff());
    }
    const double weight = tetrahedron.weight * (most > Largest ? Largest / most : 1);
    completeBlocks(three, four);
    for (int a = 0; a < 4; ++a)
    {
      for (int b = 0; b < 4; ++b)
      {
        if (corner[a] <= corner[b])
        {
          sum[place(corner[a], corner[b], n)] += weight * four[a][b];
        }
      }
    }
  }
  for (int k = 0; k < n * (n + 1) / 2; ++k)
  {
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(blocks + 9 * k) = sum[k].cast<float>();
  }
}

void MeshEnergy::hessian(const Points& points, BlockMatrix& result, Monitor& monitor) const
{
  if (!result.isOpenFor(this))
  {
    this->openMatrix(result);
  }
  // The blocks of each cell, upper triangle of its corners; then each row gathers its own, cell by cell.
  std::vector<Index> start(this->cells() + 1, 0);
  for (Index c = 0; c < this->cells(); ++c)
  {
    const int n = this->numberOfCorners(c);
    start[c + 1] = start[c] + 9 * (n * (n + 1) / 2);
  }
  std::vector<float> blocks(start.back());
  monitor.parallelFor(this->cells(), Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        this->cellHessian(c, points, blocks.data() + start[c]);
      }
    });
  monitor.check();
  this->gatherBlocks(blocks, start, result, monitor);
}

void MeshEnergy::gatherBlocks(const std::vector<float>& blocks, const std::vector<Index>& start,
  BlockMatrix& result, Monitor& monitor) const
{
  std::vector<std::int32_t> cellOf(this->corner_.size());
  for (Index c = 0; c < this->cells(); ++c)
  {
    std::fill(cellOf.begin() + this->cornerStart_[c], cellOf.begin() + this->cornerStart_[c + 1],
      static_cast<std::int32_t>(c));
  }
  monitor.parallelFor(result.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const std::int32_t* columns = result.columns(row);
        const Index size = result.offsets()[row + 1] - result.offsets()[row];
        float* out = result.blocks(row);
        std::fill(out, out + 9 * size, 0.f);
        for (const Index* use = this->uses_.begin(row); use != this->uses_.end(row); ++use)
        {
          const Index c = cellOf[*use];
          const int n = this->numberOfCorners(c),
                    own = static_cast<int>(*use - this->cornerStart_[c]);
          for (int other = 0; other < n; ++other)
          {
            const std::int32_t column = this->row_[this->corners(c)[other]];
            if (column < 0)
            {
              continue;
            }
            float* block = out + 9 * (std::lower_bound(columns, columns + size, column) - columns);
            const float* in =
              blocks.data() + start[c] + 9 * place(std::min(own, other), std::max(own, other), n);
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
    });
}
}
