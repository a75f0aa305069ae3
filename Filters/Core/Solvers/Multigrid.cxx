// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Solvers/CsrMatrix.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace morph
{
Index GaussSeidel::blockSize() const
{
  constexpr Index Blocks = 16;
  constexpr Index Least = 4096; // of less, waking a thread would take as long
  return std::max((static_cast<Index>(this->places_.size()) + Blocks - 1) / Blocks, Least);
}

void GaussSeidel::locate(const CsrRows<float>& A, Index row)
{
  const Index first = row / this->blockSize() * this->blockSize();
  const auto find = [&](Index column)
  {
    return static_cast<int>(std::lower_bound(A.column + A.start[row], A.column + A.start[row + 1],
                              static_cast<int>(column)) -
                            A.column);
  };
  Place& own = this->places_[row];
  own.first = find(first);
  own.diagonal = find(row);
  own.last = find(std::min(first + this->blockSize(), A.rows));
}

bool GaussSeidel::prepare(const CsrRows<float>& A, float least, Monitor& monitor)
{
  this->places_.resize(A.rows);
  parallel(A.rows, monitor,
    [&](Index i)
    {
      this->locate(A, i);
      Place& own = this->places_[i];
      const bool isThere = own.diagonal < own.last && A.column[own.diagonal] == i;
      const float diagonal = isThere ? A.value[own.diagonal] : 0;
      float size = 0;
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        size += k < own.first || k >= own.last ? std::abs(A.value[k]) : 0;
      }
      own.added = size / 2;
      own.inverse = diagonal >= least && std::isfinite(diagonal) ? 1 / (diagonal + own.added) : 0;
    });
  return std::all_of(this->places_.begin(), this->places_.end(),
    [](const Place& place) { return place.inverse > 0; });
}

void GaussSeidel::prepareTransposed(
  const GaussSeidel& other, const CsrRows<float>& A, Monitor& monitor)
{
  this->places_ = other.places_;
  parallel(A.rows, monitor, [&](Index i) { this->locate(A, i); });
}

template <typename Body>
void GaussSeidel::forBlocks(Index rows, Monitor& monitor, const Body& body) const
{
  const Index size = this->blockSize();
  parallel((rows + size - 1) / size, 1, monitor,
    [&](Index block) { body(block * size, std::min((block + 1) * size, rows)); });
}

void GaussSeidel::sweep(const CsrRows<float>& A, const Row* rhs, Row* x, Monitor& monitor) const
{
  this->forBlocks(A.rows, monitor,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const Place& own = this->places_[i];
        x[i] = own.inverse * (rhs[i] - rowSum(A, own.first, own.diagonal, x));
      }
    });
}

void GaussSeidel::residual(
  const CsrRows<float>& A, const Row* x, Row* residual, Monitor& monitor) const
{
  // The sweep has solved (D* + L) x = rhs, so rhs - A x = (D* - D - U - F) x.
  this->forBlocks(A.rows, monitor,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const Place& own = this->places_[i];
        residual[i] = own.added * x[i] - (rowSum(A, own.diagonal + 1, A.start[i + 1], x) +
                                           rowSum(A, A.start[i], own.first, x));
      }
    });
}

void GaussSeidel::sweepBack(
  const CsrRows<float>& A, const Row* rhs, const Row* x, Row* to, Monitor& monitor) const
{
  this->forBlocks(A.rows, monitor,
    [&](Index first, Index last)
    {
      for (Index i = last; i-- > first;)
      {
        const Place& own = this->places_[i];
        const Row rest = rowSum(A, A.start[i], own.diagonal + 1, x) +
                         rowSum(A, own.last, A.start[i + 1], x) +
                         rowSum(A, own.diagonal + 1, own.last, to);
        to[i] = x[i] + own.inverse * (rhs[i] - rest);
      }
    });
}

namespace
{
constexpr int CoarsestSize = 200; // maximum number of rows for a dense factorisation
constexpr int MostLevels = 20;
constexpr Index Grain = 4096;

/// The inverse of a dense matrix; empty where it is singular to rounding, or not positive definite
/// though it should be.
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& A, Multigrid::Symmetry symmetry)
{
  constexpr double LeastReciprocalCondition = 1e-13;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(A.rows(), A.rows());
  if (symmetry == Multigrid::Symmetry::Symmetric)
  {
    const Eigen::LLT<Eigen::MatrixXd> factors(A);
    return factors.info() == Eigen::Success ? factors.solve(identity) : Eigen::MatrixXd();
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(A);
  return factors.rcond() > LeastReciprocalCondition ? factors.inverse() : Eigen::MatrixXd();
}

/// The mean places of the rows of each aggregate.
Points centersOf(const Points& places, const std::vector<int>& aggregateOf, Index aggregates)
{
  Points centers = Points::Zero(aggregates, 3);
  std::vector<int> members(aggregates, 0);
  for (Index i = 0; i < places.rows(); ++i)
  {
    centers.row(aggregateOf[i]) += places.row(i);
    ++members[aggregateOf[i]];
  }
  for (Index g = 0; g < aggregates; ++g)
  {
    centers.row(g) /= members[g];
  }
  return centers;
}
}

void Multigrid::round(const CsrMatrix& matrix, Monitor& monitor)
{
  constexpr int MostExponent = 1000; // its power of two and the inverse are finite
  const double* value = matrix.valuePtr();
  double largest = 0;
  for (Index k = 0; k < matrix.nonZeros(); ++k)
  {
    const double size = std::abs(value[k]);
    largest = size > largest && size <= std::numeric_limits<double>::max() ? size : largest;
  }
  const int exponent =
    largest > 0 ? std::clamp(std::ilogb(largest) - LargestExponent, -MostExponent, MostExponent)
                : 0;
  this->unit_ = std::ldexp(1., exponent);
  this->finest_ = &matrix;
  this->finestValues_.resize(matrix.nonZeros());
  const double scale = 1 / this->unit_;
  parallel(matrix.nonZeros(), monitor,
    [&](Index k) { this->finestValues_[k] = static_cast<float>(scale * value[k]); });
}

bool Multigrid::addLevel(const CsrRows<float>& A, Monitor& monitor)
{
  // Single precision has room for 2^-60 of such an entry and for its inverse.
  const float least = std::ldexp(1.f, LargestExponent - 126);
  GaussSeidel smoother;
  if (!smoother.prepare(A, least, monitor))
  {
    return false;
  }
  Level& level = this->levels_.emplace_back();
  level.rows = A.rows;
  level.smoother = std::move(smoother);
  return true;
}

void Multigrid::prepare(
  const CsrMatrix& matrix, Symmetry symmetry, const ConstPoints& coordinates, Monitor& monitor)
{
  *this = {};
  this->levels_.reserve(MostLevels); // `level` below stays valid
  this->round(matrix, monitor);
  if (matrix.rows() == 0)
  {
    return; // no level: see apply()
  }
  if (!this->addLevel(this->matrix(0), monitor))
  {
    throw Error(Error::Kind::Singular,
      "The cells' sizes differ by more than 1e38: their stiffness cannot be solved for together.");
  }
  Points places = coordinates;

  // A level has about an eighth of the rows of the finer one.
  double left = 1;
  const auto progress = [&](double part) { monitor.progress(1 - left * (1 - 0.875 * part)); };
  // Next to slivers single precision would cancel completely, so levels are made in double.
  CsrMatrix exact; // of the last level but the finest
  while (this->levels_.back().rows > CoarsestSize && this->numberOfLevels() < MostLevels)
  {
    monitor.check();
    Level& level = this->levels_.back();
    const CsrRows<float> A = this->matrix(this->levels_.size() - 1);
    std::vector<int> aggregateOf;
    level.P = prolongation(A, places, aggregateOf, monitor);
    if (level.P.cols() == 0)
    {
      break; // nothing left to group: this level only has the smoother
    }
    level.R = level.P.transpose();
    progress(0.4);

    CsrMatrix coarse = this->numberOfLevels() == 1
                         ? tripleProduct(level.R, matrix, level.P, 1 / this->unit_, monitor)
                         : tripleProduct(level.R, exact, level.P, 1, monitor);
    progress(1);
    left *= 0.125;
    CsrMatrixOf<float> single = rounded(coarse);
    if (!this->addLevel(single, monitor))
    {
      break; // rounding near flat cells spoiled the level
    }
    this->levels_.back().A.swap(single);
    exact.swap(coarse);
    places = centersOf(places, aggregateOf, level.P.cols());
  }

  Level& last = this->levels_.back();
  last.P = last.R = CsrMatrixOf<float>();
  if (last.rows <= 4 * CoarsestSize)
  {
    const bool isFinest = this->numberOfLevels() == 1;
    this->coarsestInverse_ = inverseOf(
      isFinest ? Eigen::MatrixXd(matrix) / this->unit_ : Eigen::MatrixXd(exact), symmetry);
  }
}

void Multigrid::prepareTransposed(const Multigrid& other, const CsrMatrix& matrix)
{
  // The sweep back is the transpose of the first one, so transposing the matrices transposes the
  // cycle.
  *this = other;
  Monitor silent;
  this->round(matrix, silent);
  for (std::size_t k = 0; k < this->levels_.size(); ++k)
  {
    Level& level = this->levels_[k];
    level.A = CsrMatrixOf<float>(level.A.transpose());
    level.smoother.prepareTransposed(other.levels_[k].smoother, this->matrix(k), silent);
  }
  this->coarsestInverse_ = other.coarsestInverse_.transpose();
}

Multigrid::Workspace Multigrid::workspace() const
{
  Workspace vectors;
  for (const Level& level : this->levels_)
  {
    Vectors& own = vectors.emplace_back();
    own.work.resize(level.rows);
    if (vectors.size() > 1) // the caller has the finest level's
    {
      own.rhs.resize(level.rows);
      own.x.resize(level.rows);
    }
  }
  return vectors;
}

void Multigrid::apply(const Row* rhs, Row* x, Workspace& workspace, Monitor& monitor) const
{
  if (!this->levels_.empty())
  {
    this->cycle(0, rhs, x, workspace, monitor);
  }
}

void Multigrid::cycle(
  std::size_t k, const Row* rhs, Row* x, Workspace& workspace, Monitor& monitor) const
{
  const Level& level = this->levels_[k];
  const CsrRows<float> A = this->matrix(k);
  Row* work = workspace[k].work.data();
  if (k + 1 == this->levels_.size())
  {
    if (this->coarsestInverse_.size() > 0)
    {
      using FourColumns = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;
      const Eigen::Map<const FourColumns> right(rhs->data(), level.rows, 4);
      Eigen::Map<FourColumns>(x->data(), level.rows, 4) =
        (this->coarsestInverse_ * right.cast<double>()).cast<float>();
      return;
    }
    level.smoother.sweep(A, rhs, work, monitor);
    level.smoother.sweepBack(A, rhs, work, x, monitor);
    return;
  }

  Vectors& below = workspace[k + 1];
  level.smoother.sweep(A, rhs, work, monitor);
  Row* residual = x;
  level.smoother.residual(A, work, residual, monitor);
  const CsrRows<float> R = level.R, P = level.P;
  parallel(R.rows, Grain / 8, monitor,
    [&](Index i) { below.rhs[i] = rowSum(R, R.start[i], R.start[i + 1], residual); });
  this->cycle(k + 1, below.rhs.data(), below.x.data(), workspace, monitor);
  parallel(level.rows, monitor,
    [&](Index i) { work[i] += rowSum(P, P.start[i], P.start[i + 1], below.x.data()); });
  level.smoother.sweepBack(A, rhs, work, x, monitor);
}

namespace
{
double distance2(const Points& points, Index i, Index j)
{
  const double* a = points.data() + 3 * i;
  const double* b = points.data() + 3 * j;
  const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/// How near the column of an entry is to its row; Far for the diagonal.
enum class Nearness : std::uint8_t
{
  Far,
  OneSided, ///< near as seen from the row, not from the column
  Mutual
};

/// Of each entry of A.
std::vector<Nearness> nearNeighbors(
  const CsrRows<float>& A, const Points& coordinates, Monitor& monitor)
{
  // Coarsens along the short side from an aspect ratio of 1.6 on.
  constexpr double Share = 0.4;
  const auto distanceTo = [&](Index i, int k)
  { return A.column[k] == i ? HUGE_VAL : distance2(coordinates, i, A.column[k]); };
  std::vector<double> nearest(A.rows, HUGE_VAL);
  parallel(A.rows, monitor,
    [&](Index i)
    {
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        nearest[i] = std::min(nearest[i], distanceTo(i, k));
      }
    });
  std::vector<Nearness> near(A.entries(), Nearness::Far);
  parallel(A.rows, monitor,
    [&](Index i)
    {
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        const double part = Share * distanceTo(i, k);
        if (part < HUGE_VAL && part <= nearest[i])
        {
          near[k] = part <= nearest[A.column[k]] ? Nearness::Mutual : Nearness::OneSided;
        }
      }
    });
  return near;
}

/// The aggregate of each row.
struct Aggregates
{
  std::vector<int>& of; ///< #rows
  int count = 0;
  int ofMutual = 0; ///< so many, the first ones, started from mutual neighbors
};

Aggregates aggregate(const CsrRows<float>& A, const Points& coordinates,
  const std::vector<Nearness>& near, std::vector<int>& of)
{
  Aggregates result = { of };
  std::vector<int>& group = of;
  int& groups = result.count;
  const int n = static_cast<int>(A.rows);
  constexpr int None = -1;
  group.assign(n, None);
  // First, whole neighborhoods without a grouped node.
  std::vector<int> neighbors;
  for (int i = 0; i < n; ++i)
  {
    if (group[i] != None)
    {
      continue;
    }
    neighbors.clear();
    bool free = true;
    for (int k = A.start[i]; k < A.start[i + 1] && free; ++k)
    {
      if (near[k] == Nearness::Mutual)
      {
        free = group[A.column[k]] == None;
        neighbors.push_back(A.column[k]);
      }
    }
    if (free && !neighbors.empty())
    {
      group[i] = groups;
      for (int j : neighbors)
      {
        group[j] = groups;
      }
      ++groups;
    }
  }
  // Then each remaining node joins the group of its nearest grouped neighbor; nodes without one
  // form groups.
  const std::vector<int> first = group;
  result.ofMutual = groups;
  for (int i = 0; i < n; ++i)
  {
    if (group[i] != None)
    {
      continue;
    }
    double best = HUGE_VAL;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      const int j = A.column[k];
      if (near[k] != Nearness::Far && first[j] != None && distance2(coordinates, i, j) < best)
      {
        best = distance2(coordinates, i, j);
        group[i] = first[j];
      }
    }
  }
  for (int i = 0; i < n; ++i)
  {
    if (group[i] != None)
    {
      continue;
    }
    group[i] = groups;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      if (near[k] != Nearness::Far && group[A.column[k]] == None)
      {
        group[A.column[k]] = groups;
      }
    }
    ++groups;
  }
  return result;
}

CsrMatrixOf<float> smoothedProlongation(const CsrRows<float>& A, const std::vector<Nearness>& near,
  const Aggregates& aggregates, Monitor& monitor)
{
  const std::vector<int>& group = aggregates.of;
  const MakeRow makeRow = [&](Index i, SparseRow& row)
  {
    float diagonal = 0, size = 0;
    bool isHarmonic = group[i] < aggregates.ofMutual;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      diagonal += near[k] == Nearness::Far ? A.value[k] : 0;
      size += near[k] == Nearness::Far ? 0 : std::abs(A.value[k]);
      isHarmonic = isHarmonic && near[k] != Nearness::Mutual;
    }
    const float omega = (isHarmonic ? 2 : 4.f / 3) / (size + std::abs(diagonal));
    row.add(group[i], 1 - omega * diagonal);
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      if (near[k] != Nearness::Far)
      {
        row.add(group[A.column[k]], -omega * A.value[k]);
      }
    }
  };
  return rounded(assembleRows(A.rows, aggregates.count, aggregates.count, monitor,
    [&] {
      return makeRow;
    }).inside);
}
}

CsrMatrixOf<float> prolongation(const CsrRows<float>& A, const Points& coordinates,
  std::vector<int>& aggregateOf, Monitor& monitor)
{
  constexpr double MostShare = 0.8;
  const std::vector<Nearness> near = nearNeighbors(A, coordinates, monitor);
  const Aggregates aggregates = aggregate(A, coordinates, near, aggregateOf);
  return aggregates.count > MostShare * static_cast<double>(A.rows)
           ? CsrMatrixOf<float>()
           : smoothedProlongation(A, near, aggregates, monitor);
}

CsrMatrix tripleProduct(const CsrMatrixOf<float>& R, const CsrMatrix& A,
  const CsrMatrixOf<float>& P, double factor, Monitor& monitor)
{
  const auto makeRows = [&]() -> MakeRow
  {
    return [&, RA = SparseRow()](Index i, SparseRow& row) mutable
    {
      RA.clear();
      for (CsrMatrixOf<float>::InnerIterator r(R, i); r; ++r)
      {
        const double scaled = factor * r.value();
        for (CsrMatrix::InnerIterator a(A, r.col()); a; ++a)
        {
          RA.add(static_cast<int>(a.col()), scaled * a.value());
        }
      }
      for (const auto& [column, value] : RA.entries())
      {
        for (CsrMatrixOf<float>::InnerIterator p(P, column); p; ++p)
        {
          row.add(static_cast<int>(p.col()), value * p.value());
        }
      }
    };
  };
  SplitMatrix product = assembleRows(R.rows(), P.cols(), P.cols(), monitor, makeRows);
  CsrMatrix result;
  result.swap(product.inside); // Eigen 3.4 would copy on a move
  return result;
}

CsrMatrixOf<float> rounded(const CsrMatrix& A)
{
  CsrMatrixOf<float> result(A.rows(), A.cols());
  result.resizeNonZeros(A.nonZeros());
  std::copy_n(A.outerIndexPtr(), A.rows() + 1, result.outerIndexPtr());
  std::copy_n(A.innerIndexPtr(), A.nonZeros(), result.innerIndexPtr());
  std::transform(A.valuePtr(), A.valuePtr() + A.nonZeros(), result.valuePtr(),
    [](double value) { return static_cast<float>(value); });
  return result;
}
}
