// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/BlockCsr3f.h"

#include "Support/Error.h"
#include "Support/Simd.h"
#include "Support/SimdDispatch.h"
#include "Support/SimdMath.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <iterator>
#include <numeric>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr Index ChunkRows = 1024; // with their copies they stay in cache
constexpr std::size_t Padding = 1;
constexpr double Shift = 1e-7; // of a diagonal block's trace: makes singular blocks invertible

MORPH_SIMD_INLINE void readBlock(const float* block, SimdDouble4 (&column)[3])
{
  for (int j = 0; j < 3; ++j)
  {
    column[j] = widened(block + 3 * j);
  }
}

MORPH_SIMD_INLINE void read(const double* from, SimdDouble4& x)
{
  std::memcpy(&x, from, sizeof(x));
}

MORPH_SIMD_INLINE void write(const SimdDouble4& x, double* to)
{
  std::memcpy(to, &x, sizeof(x));
}

/// Sums the first three lanes of each product column[j] * x, whose fourth lane is 0, in lane j.
MORPH_SIMD_INLINE void addTransposed(
  const SimdDouble4 (&column)[3], const SimdDouble4& x, SimdDouble4& sum)
{
  const SimdDouble4 a = column[0] * x, b = column[1] * x, c = column[2] * x, zero = {};
  const SimdDouble4 ab =
    __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const SimdDouble4 c0 =
    __builtin_shufflevector(c, zero, 0, 4, 2, 6) + __builtin_shufflevector(c, zero, 1, 5, 3, 7);
  sum += __builtin_shufflevector(ab, c0, 0, 1, 4, 5) + __builtin_shufflevector(ab, c0, 2, 3, 6, 7);
}
}

/// A chunk's rows and the work on them.
struct BlockCsr3f::Chunk
{
  Chunk(const BlockCsr3f& matrix, Index chunk)
    : begin(chunk * ChunkRows)
    , own(std::min(matrix.rows() - this->begin, ChunkRows))
    , copies(matrix.copyOffsets_[chunk + 1] - matrix.copyOffsets_[chunk])
  {
  }
  Index begin, own, copies;
};

/// A chunk's part of a product. Four numbers a row are in `work`, the fourth 0: those of x, then
/// those of y.
struct BlockCsr3f::ChunkProduct
{
  static MORPH_SIMD_INLINE void run(Index number, const BlockCsr3f& matrix, const Points& x,
    Points& y, Points& copies, std::vector<double>& work)
  {
    const Chunk chunk(matrix, number);
    const Index rows = chunk.own + chunk.copies, firstCopy = matrix.copyOffsets_[number];
    double *in = work.data(), *out = in + 4 * rows;
    for (Index i = 0; i < rows; ++i)
    {
      const Index row =
        i < chunk.own ? chunk.begin + i : matrix.copyRow_[firstCopy + i - chunk.own];
      const double* from = x.data() + 3 * row;
      write(SimdDouble4{ from[0], from[1], from[2], 0 }, in + 4 * i);
      write(SimdDouble4{}, out + 4 * i);
    }
    const std::int32_t* column =
      matrix.pattern_.columns.data() + matrix.pattern_.offsets[chunk.begin];
    const float* block = matrix.blocks(chunk.begin);
    for (Index i = 0; i < chunk.own; ++i)
    {
      const float* end = matrix.blocks(chunk.begin + i + 1);
      SimdDouble4 own, entries[3], sum[3];
      read(in + 4 * i, own);
      readBlock(block, entries);
      for (int j = 0; j < 3; ++j)
      {
        sum[j] = entries[j] * own[j];
      }
      for (block += 9, ++column; block != end; block += 9, ++column)
      {
        const double* other = in + 4 * static_cast<Index>(*column);
        double* result = out + 4 * static_cast<Index>(*column);
        readBlock(block, entries);
        for (int j = 0; j < 3; ++j)
        {
          sum[j] += entries[j] * other[j];
        }
        SimdDouble4 transposed;
        read(result, transposed);
        addTransposed(entries, own, transposed);
        write(transposed, result);
      }
      SimdDouble4 whole;
      read(out + 4 * i, whole);
      write(whole + (sum[0] + sum[1] + sum[2]), out + 4 * i);
    }
    for (Index i = 0; i < rows; ++i)
    {
      double* to = i < chunk.own ? y.data() + 3 * (chunk.begin + i)
                                 : copies.data() + 3 * (firstCopy + i - chunk.own);
      std::copy(out + 4 * i, out + 4 * i + 3, to);
    }
  }
};

/// The upper triangle of the inverse of a diagonal block, by columns.
struct BlockCsr3f::InverseBlock
{
  float entry[6];

  explicit InverseBlock(const Eigen::Matrix3d& A)
    : entry{ static_cast<float>(A(0, 0)), static_cast<float>(A(0, 1)), static_cast<float>(A(1, 1)),
      static_cast<float>(A(0, 2)), static_cast<float>(A(1, 2)), static_cast<float>(A(2, 2)) }
  {
  }
  void multiply(const double* x, double* y) const
  {
    y[0] = this->entry[0] * x[0] + this->entry[1] * x[1] + this->entry[3] * x[2];
    y[1] = this->entry[1] * x[0] + this->entry[2] * x[1] + this->entry[4] * x[2];
    y[2] = this->entry[3] * x[0] + this->entry[4] * x[1] + this->entry[5] * x[2];
  }
};

PatternId::PatternId()
{
  static std::atomic<std::uint64_t> last{ 0 };
  this->number_ = ++last;
}

void BlockCsr3f::open(const PatternId& id, BlockPattern pattern)
{
  this->id_ = id.number();
  this->pattern_ = std::move(pattern);
  this->numberByChunks();
  this->values_.assign(9 * this->pattern_.columns.size() + Padding, 0.f);
}

void BlockCsr3f::numberByChunks()
{
  const Index rows = this->rows(), chunks = (rows + ChunkRows - 1) / ChunkRows;
  this->copyOffsets_.assign(1, 0);
  this->copyRow_.clear();
  this->mostRows_ = 0;
  std::vector<std::int32_t> after;
  for (Index chunk = 0; chunk < chunks; ++chunk)
  {
    const Index begin = chunk * ChunkRows, end = std::min(rows, begin + ChunkRows);
    std::int32_t *first = this->pattern_.columns.data() + this->pattern_.offsets[begin],
                 *last = this->pattern_.columns.data() + this->pattern_.offsets[end];
    after.clear();
    std::copy_if(
      first, last, std::back_inserter(after), [&](std::int32_t column) { return column >= end; });
    std::sort(after.begin(), after.end());
    after.erase(std::unique(after.begin(), after.end()), after.end());
    std::transform(first, last, first,
      [&](std::int32_t column)
      {
        const auto copy = std::lower_bound(after.begin(), after.end(), column) - after.begin();
        return static_cast<std::int32_t>(column < end ? column - begin : end - begin + copy);
      });
    this->copyRow_.insert(this->copyRow_.end(), after.begin(), after.end());
    this->copyOffsets_.push_back(static_cast<Index>(this->copyRow_.size()));
    this->mostRows_ = std::max(this->mostRows_, end - begin + static_cast<Index>(after.size()));
  }
  this->copiedRow_ = this->copyRow_;
  std::sort(this->copiedRow_.begin(), this->copiedRow_.end());
  this->copiedRow_.erase(
    std::unique(this->copiedRow_.begin(), this->copiedRow_.end()), this->copiedRow_.end());
  std::vector<std::int32_t> order(this->copyRow_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](std::int32_t a, std::int32_t b) { return this->copyRow_[a] < this->copyRow_[b]; });
  this->uses_ = std::move(order);
  this->useOffsets_.assign(1, 0);
  for (std::size_t use = 0; use < this->uses_.size(); ++use)
  {
    const bool isLast = use + 1 == this->uses_.size() ||
                        this->copyRow_[this->uses_[use + 1]] != this->copyRow_[this->uses_[use]];
    if (isLast)
    {
      this->useOffsets_.push_back(static_cast<Index>(use + 1));
    }
  }
}

void BlockCsr3f::multiply(const Points& x, Points& y, Monitor& monitor) const
{
  y.resize(this->rows(), 3);
  Points copies(static_cast<Index>(this->copyRow_.size()), 3);
  monitor.parallelFor(static_cast<Index>(this->copyOffsets_.size()) - 1, 1,
    [&](Index first, Index last)
    {
      std::vector<double> work(8 * this->mostRows_);
      dispatchedFor<ChunkProduct>(first, last, *this, x, y, copies, work);
    });
  monitor.parallelFor(static_cast<Index>(this->copiedRow_.size()), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        for (Index use = this->useOffsets_[i]; use < this->useOffsets_[i + 1]; ++use)
        {
          y.row(this->copiedRow_[i]) += copies.row(this->uses_[use]);
        }
      }
    });
}

std::vector<BlockCsr3f::InverseBlock> BlockCsr3f::inverseDiagonal(
  Monitor& monitor, const CopiedRows& copies) const
{
  const Index n = this->rows();
  Points columns[3] = { Points(n, 3), Points(n, 3), Points(n, 3) };
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const Eigen::Map<const Eigen::Matrix3f> D(this->blocks(row));
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
  std::vector<InverseBlock> inverse(n, InverseBlock(Eigen::Matrix3d::Zero()));
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        Eigen::Matrix3d D;
        D << columns[0].row(row).transpose(), columns[1].row(row).transpose(),
          columns[2].row(row).transpose();
        D.diagonal().array() += Shift * D.trace();
        if (D.trace() > 0)
        {
          inverse[row] = InverseBlock(D.ldlt().solve(Eigen::Matrix3d::Identity()));
        }
      }
    });
  return inverse;
}

namespace
{
/// Preconditioned conjugate gradients from x = 0. `isDefinite`: becomes false where it ended at a
/// direction that shows matrix or preconditioner not to be positive definite.
template <typename Precondition>
int conjugateGradients(const BlockCsr3f& A, const Precondition& precondition, const Points& b,
  Points& x, double tolerance, int most, Monitor& monitor, const CopiedRows& copies,
  bool& isDefinite)
{
  const Index n = A.rows();
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
    A.multiply(p, Ap, monitor);
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
    if (iteration == most || copies.dot(r, r, monitor) <= goal)
    {
      return iteration;
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
  isDefinite = false;
  if (iteration == 0)
  {
    x = z; // no curvature at all: the preconditioned gradient is still a direction
  }
  return iteration;
}
}

/// Symmetric: a step by the diagonal blocks, the correction of the whole mesh, and a step again.
class BlockCsr3f::TwoLevels
{
public:
  TwoLevels(const BlockCsr3f& matrix, const NodePreconditioner& whole,
    const std::vector<InverseBlock>& inverse, Monitor& monitor)
    : matrix_(matrix)
    , whole_(whole)
    , inverse_(inverse)
    , monitor_(monitor)
    , weight_(matrix.rows())
    , left_(matrix.rows(), 3)
    , correction_(matrix.rows(), 3)
  {
    // Makes the diagonal of the scalar matrix that of this one, in the mean over the components.
    for (Index row = 0; row < matrix.rows(); ++row)
    {
      const float* D = matrix.blocks(row);
      const double mean = (static_cast<double>(D[0]) + D[4] + D[8]) / 3;
      this->weight_[row] = mean > 0 ? std::sqrt(whole.diagonal(row) / mean) : 0;
    }
  }

  void operator()(const Points& from, Points& to) const
  {
    this->forRows(
      [&](Index row)
      {
        this->inverse_[row].multiply(from.data() + 3 * row, to.data() + 3 * row);
        to.row(row) *= Damping;
      });
    this->matrix_.multiply(to, this->left_, this->monitor_);
    this->forRows([&](Index row)
      { this->left_.row(row) = this->weight_[row] * (from.row(row) - this->left_.row(row)); });
    this->whole_.apply(this->left_, this->correction_, this->monitor_);
    this->forRows(
      [&](Index row) { to.row(row) += this->weight_[row] * this->correction_.row(row); });
    this->matrix_.multiply(to, this->left_, this->monitor_);
    this->forRows(
      [&](Index row)
      {
        const Eigen::RowVector3d left = from.row(row) - this->left_.row(row);
        Eigen::RowVector3d step;
        this->inverse_[row].multiply(left.data(), step.data());
        to.row(row) += Damping * step;
      });
  }

private:
  // Of the steps by diagonal blocks: the largest eigenvalue is about 2.5 in hexahedra.
  static constexpr double Damping = 0.6;

  template <typename Body>
  void forRows(const Body& body) const
  {
    this->monitor_.parallelFor(this->matrix_.rows(), Grain,
      [&](Index first, Index last)
      {
        for (Index row = first; row < last; ++row)
        {
          body(row);
        }
      });
  }

  const BlockCsr3f& matrix_;
  const NodePreconditioner& whole_;
  const std::vector<InverseBlock>& inverse_;
  Monitor& monitor_;
  std::vector<double> weight_;
  mutable Points left_, correction_;
};

int BlockCsr3f::solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor,
  const CopiedRows& copies, const NodePreconditioner* whole, double wholeTolerance) const
{
  const std::vector<InverseBlock> inverse = this->inverseDiagonal(monitor, copies);
  int iterations = 0;
  bool isDefinite = whole != nullptr;
  if (whole)
  {
    if (whole->rows() != this->rows())
    {
      throw Error("The preconditioner has " + std::to_string(whole->rows()) + " rows, the matrix " +
                  std::to_string(this->rows()) + ".");
    }
    iterations = conjugateGradients(*this, TwoLevels(*this, *whole, inverse, monitor), b, x,
      wholeTolerance, most, monitor, copies, isDefinite);
  }
  if (!isDefinite)
  {
    const auto byBlocks = [&](const Points& from, Points& to)
    {
      monitor.parallelFor(this->rows(), Grain,
        [&](Index first, Index last)
        {
          for (Index row = first; row < last; ++row)
          {
            inverse[row].multiply(from.data() + 3 * row, to.data() + 3 * row);
          }
        });
    };
    iterations +=
      conjugateGradients(*this, byBlocks, b, x, tolerance, most, monitor, copies, isDefinite);
  }
  return iterations;
}
}
