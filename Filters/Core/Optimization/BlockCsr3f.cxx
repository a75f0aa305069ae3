// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/BlockCsr3f.h"

#include "Support/Simd.h"
#include "Support/SimdDispatch.h"
#include "Support/SimdMath.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr std::size_t Padding = 1;
constexpr double Shift = 1e-7; // of a diagonal block's trace: makes singular blocks invertible

using Row = Eigen::RowVector3d;

/// A row of the matrix times a vector, one block column at a time; the fourth lane is unused.
struct RowProduct
{
  static MORPH_SIMD_INLINE void run(Index row, const BlockCsr3f& matrix, const Points& x, Points& y)
  {
    SimdDouble4 sum[3] = {};
    const std::int32_t* column = matrix.columns(row);
    const float* end = matrix.blocks(row + 1);
    for (const float* block = matrix.blocks(row); block != end; block += 9, ++column)
    {
      const double* v = x.data() + 3 * static_cast<Index>(*column);
      for (Index j = 0; j < 3; ++j)
      {
        SimdFloat4 entries;
        std::memcpy(&entries, block + 3 * j, sizeof(entries));
        sum[j] += __builtin_convertvector(entries, SimdDouble4) * v[j];
      }
    }
    const SimdDouble4 whole = sum[0] + sum[1] + sum[2];
    for (int i = 0; i < 3; ++i)
    {
      y(row, i) = whole[i];
    }
  }
};
}

PatternId::PatternId()
{
  static std::atomic<std::uint64_t> last{ 0 };
  this->number_ = ++last;
}

void BlockCsr3f::open(const PatternId& id, BlockPattern pattern)
{
  this->id_ = id.number();
  this->pattern_ = std::move(pattern);
  this->values_.assign(9 * this->pattern_.columns.size() + Padding, 0.f);
}

void BlockCsr3f::multiply(const Points& x, Points& y, Monitor& monitor) const
{
  y.resize(this->rows(), 3);
  monitor.parallelFor(this->rows(), Grain,
    [&](Index first, Index last) { dispatchedFor<RowProduct>(first, last, *this, x, y); });
}

int BlockCsr3f::solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor,
  const CopiedRows& copies) const
{
  const Index n = this->rows();
  Points columns[3] = { Points(n, 3), Points(n, 3), Points(n, 3) }; // of the diagonal blocks
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const std::int32_t *begin = this->columns(row), *end = this->columns(row + 1);
        const Index k = std::lower_bound(begin, end, static_cast<std::int32_t>(row)) - begin;
        const Eigen::Map<const Eigen::Matrix3f> D(this->blocks(row) + 9 * k);
        for (int j = 0; j < 3; ++j)
        {
          columns[j].row(row) = D.col(j).transpose().cast<double>();
        }
      }
    });
  for (Points& column : columns)
  {
    copies.add(column);
  }
  std::vector<Eigen::Matrix3d> inverse(n);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        Eigen::Matrix3d D;
        D << columns[0].row(row).transpose(), columns[1].row(row).transpose(),
          columns[2].row(row).transpose();
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
  double rz = copies.dot(r, z, monitor);
  const double goal = tolerance * tolerance * copies.dot(b, b, monitor);
  int iteration = 0;
  while (iteration < most && rz > 0)
  {
    monitor.check();
    this->multiply(p, Ap, monitor);
    copies.add(Ap);
    const double curvature = copies.dot(p, Ap, monitor);
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
    if (copies.dot(r, r, monitor) <= goal)
    {
      break;
    }
    precondition(r, z);
    const double next = copies.dot(r, z, monitor);
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
    x = z; // no curvature at all: the preconditioned gradient is still a direction
  }
  return iteration;
}
}
