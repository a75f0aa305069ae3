// SPDX-License-Identifier: BSD-3-Clause
#include "BlockMatrix.h"

#include "BlockSum.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double Shift = 1e-7; // of a diagonal block's trace: keeps singular ones invertible

using Row = Eigen::RowVector3d;

double dot(const Points& a, const Points& b, Monitor& monitor)
{
  return blockSum(a.rows(), monitor, 0., [&](Index i) { return a.row(i).dot(b.row(i)); });
}
}

void BlockMatrix::open(
  const void* owner, std::vector<Index> offsets, std::vector<std::int32_t> columns)
{
  this->owner_ = owner;
  this->offsets_ = std::move(offsets);
  this->columns_ = std::move(columns);
  this->values_.assign(9 * this->columns_.size(), 0.f);
}

void BlockMatrix::multiply(const Points& x, Points& y, Monitor& monitor) const
{
  y.resize(this->rows(), 3);
  monitor.parallelFor(this->rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const float* block = this->blocks(row);
        double sum[3] = { 0, 0, 0 };
        for (Index k = this->offsets_[row]; k < this->offsets_[row + 1]; ++k, block += 9)
        {
          const double* v = x.data() + 3 * static_cast<Index>(this->columns_[k]);
          sum[0] += block[0] * v[0] + block[1] * v[1] + block[2] * v[2];
          sum[1] += block[3] * v[0] + block[4] * v[1] + block[5] * v[2];
          sum[2] += block[6] * v[0] + block[7] * v[1] + block[8] * v[2];
        }
        std::copy(sum, sum + 3, y.data() + 3 * row);
      }
    });
}

int BlockMatrix::solve(
  const Points& b, Points& x, double tolerance, int most, Monitor& monitor) const
{
  const Index n = this->rows();
  std::vector<Eigen::Matrix3d> inverse(n);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const auto begin = this->columns_.begin() + this->offsets_[row];
        const auto end = this->columns_.begin() + this->offsets_[row + 1];
        const Index k = std::lower_bound(begin, end, static_cast<std::int32_t>(row)) - begin;
        Eigen::Matrix3d D =
          Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(this->blocks(row) + 9 * k)
            .cast<double>();
        D.diagonal().array() += Shift * D.trace();
        inverse[row] = D.trace() > 0 ? Eigen::Matrix3d(D.ldlt().solve(Eigen::Matrix3d::Identity()))
                                     : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
      }
    });
  const auto precondition = [&](const Points& from, Points& to)
  {
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index row = first; row < last; ++row)
        {
          to.row(row) = from.row(row) * inverse[row];
        }
      });
  };

  x.setZero(n, 3);
  Points r = b, z(n, 3), p(n, 3), Ap(n, 3);
  precondition(r, z);
  p = z;
  double rz = dot(r, z, monitor);
  const double goal = tolerance * tolerance * dot(b, b, monitor);
  int iteration = 0;
  while (iteration < most && rz > 0)
  {
    monitor.check();
    this->multiply(p, Ap, monitor);
    const double curvature = dot(p, Ap, monitor);
    if (!(curvature > 0))
    {
      break;
    }
    ++iteration;
    const double alpha = rz / curvature;
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        const Index rows = last - first;
        x.middleRows(first, rows) += alpha * p.middleRows(first, rows);
        r.middleRows(first, rows) -= alpha * Ap.middleRows(first, rows);
      });
    if (dot(r, r, monitor) <= goal)
    {
      break;
    }
    precondition(r, z);
    const double next = dot(r, z, monitor);
    const double beta = next / rz;
    rz = next;
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        const Index rows = last - first;
        p.middleRows(first, rows) = z.middleRows(first, rows) + beta * p.middleRows(first, rows);
      });
  }
  if (iteration == 0)
  {
    x = z; // no curvature at all: the preconditioned gradient is a direction still
  }
  return iteration;
}

std::size_t BlockMatrix::memory() const
{
  return sizeof(Index) * this->offsets_.size() +
         this->columns_.size() * (sizeof(std::int32_t) + 9 * sizeof(float));
}
}
