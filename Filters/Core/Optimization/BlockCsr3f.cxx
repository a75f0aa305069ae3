// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/BlockCsr3f.h"

#include "Solvers/ConjugateGradients.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <iterator>
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
    const SimdDouble4 zero = {};
    for (Index i = 0; i < rows; ++i)
    {
      const Index row =
        i < chunk.own ? chunk.begin + i : matrix.copyRow_[firstCopy + i - chunk.own];
      const double* from = x.data() + 3 * row;
      store(SimdDouble4{ from[0], from[1], from[2], 0 }, in + 4 * i);
      store(SimdDouble4{}, out + 4 * i);
    }
    const std::int32_t* column =
      matrix.pattern_.columns.data() + matrix.pattern_.offsets[chunk.begin];
    const float* block = matrix.blocks(chunk.begin);
    for (Index i = 0; i < chunk.own; ++i)
    {
      const float* end = matrix.blocks(chunk.begin + i + 1);
      const SimdDouble4 own = load(in + 4 * i);
      SimdDouble4 entries[3], sum[3];
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
        // Lane j of the transposed block's product is the sum of column j times `own`.
        store(load(result) + sumsOf(entries[0] * own, entries[1] * own, entries[2] * own, zero),
          result);
      }
      store(load(out + 4 * i) + (sum[0] + sum[1] + sum[2]), out + 4 * i);
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
    sortUnique(after);
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
  sortUnique(this->copiedRow_);
  std::vector<std::int32_t> order = consecutive<std::int32_t>(this->copyRow_.size());
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
  parallel(static_cast<Index>(this->copiedRow_.size()), Grain, monitor,
    [&](Index i)
    {
      for (Index use = this->useOffsets_[i]; use < this->useOffsets_[i + 1]; ++use)
      {
        y.row(this->copiedRow_[i]) += copies.row(this->uses_[use]);
      }
    });
}

std::vector<BlockCsr3f::InverseBlock> BlockCsr3f::inverseDiagonal(
  Monitor& monitor, const CopiedRows& copies) const
{
  const Index n = this->rows();
  Points columns[3] = { Points(n, 3), Points(n, 3), Points(n, 3) };
  parallel(n, Grain, monitor,
    [&](Index row)
    {
      const Eigen::Map<const Eigen::Matrix3f> D(this->blocks(row));
      for (int j = 0; j < 3; ++j)
      {
        columns[j].row(row) = D.col(j).transpose().cast<double>();
      }
    });
  for (Points& column : columns)
  {
    copies.add(column);
  }
  std::vector<InverseBlock> inverse(n, InverseBlock(Eigen::Matrix3d::Zero()));
  parallel(n, Grain, monitor,
    [&](Index row)
    {
      Eigen::Matrix3d D;
      D << columns[0].row(row).transpose(), columns[1].row(row).transpose(),
        columns[2].row(row).transpose();
      D.diagonal().array() += Shift * D.trace();
      if (D.trace() > 0)
      {
        inverse[row] = InverseBlock(D.ldlt().solve(Eigen::Matrix3d::Identity()));
      }
    });
  return inverse;
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
    parallel(this->matrix_.rows(), Grain, this->monitor_, [&](Index row) { body(row); });
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
  const auto run = [&](const PointsSystem::Operator& precondition, double part)
  {
    x.setZero(this->rows(), 3);
    PointsVectors work;
    PointsSystem system = { [&](const Points& from, Points& to)
      {
        this->multiply(from, to, monitor);
        copies.add(to);
      },
      precondition, [&](const Points& v, const Points& w) { return copies.dot(v, w, monitor); }, b,
      x, monitor, work };
    work.r = b;
    work.z.resize(this->rows(), 3);
    Sums norm2 = system.one(copies.dot(b, b, monitor));
    SolverGoal goal;
    goal.goal2 = part * part * norm2;
    goal.mostIterations = most;
    int made = 0;
    const bool isDefinite = runConjugateGradients(system, norm2, goal, made, monitor);
    if (!isDefinite && made == 0)
    {
      x = work.z; // no curvature at all: the preconditioned gradient is still a direction
    }
    iterations += made;
    return isDefinite;
  };
  if (whole)
  {
    if (whole->rows() != this->rows())
    {
      throw Error("The preconditioner has " + std::to_string(whole->rows()) + " rows, the matrix " +
                  std::to_string(this->rows()) + ".");
    }
    const TwoLevels levels(*this, *whole, inverse, monitor);
    if (run(std::cref(levels), wholeTolerance))
    {
      return iterations;
    }
  }
  run(
    [&](const Points& from, Points& to)
    {
      parallel(this->rows(), monitor,
        [&](Index row) { inverse[row].multiply(from.data() + 3 * row, to.data() + 3 * row); });
    },
    tolerance);
  return iterations;
}
}
