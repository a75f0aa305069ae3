// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Solvers/Aggregation.h"
#include "Solvers/RowProducts.h"
#include "Support/Error.h"
#include "Support/HugePages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace morph
{
namespace
{
constexpr int CoarsestSize = 200; // maximum number of rows for a dense factorisation
constexpr int MostLevels = 20;
constexpr Index Grain = 4096;

/// Refers to the matrix's arrays.
CsrRows<double> rowsOf(const CsrMatrix& matrix)
{
  CsrRows<double> rows;
  rows.rows = static_cast<int>(matrix.rows());
  rows.start = matrix.outerIndexPtr();
  rows.column = matrix.innerIndexPtr();
  rows.value = matrix.valuePtr();
  return rows;
}
}

float Multigrid::addLevel(const ScaledRows& A, Monitor& monitor)
{
  std::vector<std::uint8_t> positive(A.rows);
  auto inverseDiagonal = largeVector<float>(A.rows);
  monitor.parallelFor(A.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const int *row = A.column + A.start[i], *end = A.column + A.start[i + 1];
        const int* found = std::find(row, end, static_cast<int>(i));
        const float diagonal = found != end ? A.entry(static_cast<int>(found - A.column)) : 0.f;
        positive[i] = diagonal > 0 && std::isfinite(1 / diagonal);
        inverseDiagonal[i] = 1 / diagonal;
      }
    });
  if (std::find(positive.begin(), positive.end(), 0) != positive.end())
  {
    return 0;
  }
  const float largest = largestEigenvalue(A, inverseDiagonal, monitor);
  Level level;
  level.rows = A.rows;
  level.smoother = DampedJacobi(std::move(inverseDiagonal), largest);
  this->levels_.push_back(std::move(level));
  return largest;
}

void Multigrid::storeMatrix(ExactMatrix& exact, double scale, Monitor& monitor)
{
  Matrix& A = this->levels_.back().A;
  const ScaledRows scaled(exact, scale);
  A.rows = exact.rows;
  A.ownStart.swap(exact.ownStart);
  A.ownColumn.swap(exact.ownColumn);
  resizeUndefined(A.ownValue, static_cast<Index>(scaled.entries()));
  monitor.parallelFor(A.ownValue.size(), 16 * Grain,
    [&](Index first, Index last)
    {
      for (Index k = first; k < last; ++k)
      {
        A.ownValue[k] = scaled.entry(static_cast<int>(k));
      }
    });
  A.adopt();
}

void Multigrid::prepare(const CsrMatrix& matrix, Symmetry symmetry, double unit,
  const ConstPoints& coordinates, Monitor& monitor)
{
  this->levels_.clear();
  this->levels_.reserve(MostLevels); // levels contain pointers into themselves
  this->symmetricCoarsest_.reset();
  this->generalCoarsest_.reset();
  const double scale = 1 / unit;
  ExactMatrix exact = rowsOf(matrix);
  this->finest_ = ScaledRows(exact, scale);
  float largest = this->addLevel(this->finest_, monitor);
  if (largest == 0)
  {
    throw Error(Error::Kind::Singular,
      "The cells' sizes differ by more than 1e38: their stiffness cannot be solved for together.");
  }
  Points places;
  resizeUndefined(places, coordinates.rows(), 3);
  places = coordinates;

  // A level has about an eighth of the rows of the finer one.
  double left = 1;
  const auto progress = [&](double part) { monitor.progress(1 - left * (1 - 0.875 * part)); };
  while (exact.rows > CoarsestSize && this->numberOfLevels() < MostLevels)
  {
    monitor.check();
    Level& level = this->levels_.back();
    const ScaledRows A(exact, scale);
    std::vector<int> group;
    std::vector<std::uint8_t> near = nearNeighbors(A, places, monitor);
    const int groups = aggregate(A, places, near, group);
    if (groups > 0.8 * A.rows)
    {
      break; // nothing left to group: this level only has the smoother
    }
    progress(0.3);
    level.P = smoothedProlongation(A, largest, near, group, groups, monitor);
    level.R = transpose(level.P, groups);
    near = {};
    progress(0.4);

    ExactMatrix coarse = tripleProduct(level.R, exact, level.P, groups, monitor);
    progress(1);
    left *= 0.125;
    largest = this->addLevel(ScaledRows(coarse, scale), monitor);
    if (largest == 0)
    {
      break; // rounding near flat cells spoiled the level
    }
    this->storeMatrix(coarse, scale, monitor);
    std::swap(exact, coarse);

    Points centres = Points::Zero(groups, 3);
    std::vector<int> members(groups, 0);
    for (std::size_t i = 0; i < group.size(); ++i)
    {
      centres.row(group[i]) += places.row(static_cast<Index>(i));
      ++members[group[i]];
    }
    for (int g = 0; g < groups; ++g)
    {
      centres.row(g) /= members[g];
    }
    places.swap(centres);
  }

  Level& last = this->levels_.back();
  last.P = last.R = {};
  this->factorizeCoarsest(exact, symmetry, unit);
}

void Multigrid::prepareTransposed(const Multigrid& other, const CsrMatrix& matrix)
{
  this->levels_.clear();
  this->levels_.reserve(MostLevels);
  this->symmetricCoarsest_ = other.symmetricCoarsest_;
  this->generalCoarsest_.reset();
  if (other.generalCoarsest_)
  {
    this->generalCoarsest_.emplace(other.generalCoarsest_->reconstructedMatrix().transpose());
  }
  const auto refer = [](const Matrix& from, Matrix& to)
  {
    to.rows = from.rows;
    to.start = from.start;
    to.column = from.column;
    to.value = from.value;
  };
  this->finest_ = ScaledRows(rowsOf(matrix), other.finest_.scale);
  // The cycle smooths alike before and after the coarse correction, so transposing the matrices
  // transposes it.
  for (const Level& from : other.levels_)
  {
    this->levels_.emplace_back();
    Level& level = this->levels_.back();
    level.rows = from.rows;
    level.A = transpose(from.A, from.A.rows);
    level.A.adopt();
    refer(from.P, level.P);
    refer(from.R, level.R);
    level.smoother = from.smoother;
  }
}

void Multigrid::factorizeCoarsest(const ExactMatrix& exact, Symmetry symmetry, double unit)
{
  constexpr double LeastReciprocalCondition = 1e-13;
  if (exact.rows > 4 * CoarsestSize)
  {
    return;
  }
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(exact.rows, exact.rows);
  for (int i = 0; i < exact.rows; ++i)
  {
    for (int k = exact.start[i]; k < exact.start[i + 1]; ++k)
    {
      dense(i, exact.column[k]) += exact.value[k] / unit;
    }
  }
  if (symmetry == Symmetry::General)
  {
    this->generalCoarsest_.emplace(dense);
    if (!(this->generalCoarsest_->rcond() > LeastReciprocalCondition))
    {
      this->generalCoarsest_.reset();
    }
    return;
  }
  this->symmetricCoarsest_.emplace(dense);
  if (this->symmetricCoarsest_->info() != Eigen::Success)
  {
    this->symmetricCoarsest_.reset();
  }
}

bool Multigrid::solveCoarsest(const Row* rhs, Row* x) const
{
  using FourColumns = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;
  using Solution = Eigen::Matrix<double, Eigen::Dynamic, 4>;
  const int n = this->levels_.back().rows;
  const Solution right = Eigen::Map<const FourColumns>(rhs[0].data(), n, 4).cast<double>();
  Eigen::Map<FourColumns> left(x[0].data(), n, 4);
  if (this->symmetricCoarsest_)
  {
    left = Solution(this->symmetricCoarsest_->solve(right)).cast<float>();
    return true;
  }
  if (this->generalCoarsest_)
  {
    left = Solution(this->generalCoarsest_->solve(right)).cast<float>();
    return true;
  }
  return false;
}

Multigrid::Workspace::Workspace(const Multigrid& multigrid)
{
  this->levels_.resize(multigrid.levels_.size());
  for (std::size_t k = 1; k < this->levels_.size(); ++k) // the caller has the finest level's
  {
    const std::size_t rows = multigrid.levels_[k].rows;
    resizeLarge(this->levels_[k].rhs, rows);
    resizeLarge(this->levels_[k].work, rows);
    resizeLarge(this->levels_[k].x, rows);
  }
}

void Multigrid::apply(
  const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor& monitor) const
{
  this->cycle(0, rhs, work, x, workspace, monitor);
}

template <typename Use>
void Multigrid::withMatrix(std::size_t k, const Use& use) const
{
  if (k == 0)
  {
    use(this->finest_);
    return;
  }
  use(this->levels_[k].A);
}

void Multigrid::cycle(
  std::size_t k, const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor& monitor) const
{
  const Level& level = this->levels_[k];
  const auto stepToX = [&]
  { this->withMatrix(k, [&](const auto& A) { level.smoother.step(A, rhs, work, x, monitor); }); };
  if (k + 1 == this->levels_.size())
  {
    if (!this->solveCoarsest(rhs, x))
    {
      level.smoother.start(rhs, work, monitor);
      stepToX();
    }
    return;
  }

  Workspace::Level& below = workspace.levels_[k + 1];
  level.smoother.start(rhs, work, monitor);
  Row* residual = x;
  this->withMatrix(k,
    [&](const auto& A)
    {
      monitor.parallelFor(A.rows, Grain,
        [&](Index first, Index last)
        {
          forRowProducts(A, work, first, last,
            [&](Index i, const Row& product) { residual[i] = rhs[i] - product; });
        });
    });
  monitor.parallelFor(level.R.rows, Grain / 8,
    [&](Index first, Index last)
    { rowProducts(level.R, residual, first, last, below.rhs.data() + first); });
  this->cycle(k + 1, below.rhs.data(), below.work.data(), below.x.data(), workspace, monitor);
  monitor.parallelFor(level.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(level.P, below.x.data(), first, last,
        [&](Index i, const Row& product) { work[i] += product; });
    });
  stepToX();
}

std::size_t Multigrid::coarsestBytes() const
{
  const std::size_t n = this->levels_.empty() ? 0 : this->levels_.back().rows;
  return this->symmetricCoarsest_ || this->generalCoarsest_ ? n * n * sizeof(double) : 0;
}

std::size_t Multigrid::memory() const
{
  std::size_t bytes = 0;
  for (const Level& level : this->levels_)
  {
    for (const Matrix* m : { &level.A, &level.P, &level.R })
    {
      bytes += m->ownValue.size() * sizeof(float) +
               (m->ownStart.size() + m->ownColumn.size()) * sizeof(int);
    }
    bytes += level.smoother.memory();
  }
  return bytes + this->coarsestBytes();
}

std::size_t Multigrid::workspaceBytes() const
{
  std::size_t rows = 0;
  for (std::size_t k = 1; k < this->levels_.size(); ++k)
  {
    rows += this->levels_[k].rows;
  }
  return 3 * rows * sizeof(Row);
}

double Multigrid::bytesMoved() const
{
  double bytes = 0;
  const double entry = sizeof(float) + sizeof(int), node = sizeof(Row);
  const double finestEntry = sizeof(double) + sizeof(int);
  for (std::size_t k = 0; k + 1 < this->levels_.size(); ++k)
  {
    const Level& level = this->levels_[k];
    // The residual, and smoothing after the correction.
    bytes += 2 * (k == 0 ? finestEntry * this->finest_.entries() : entry * level.A.entries());
    bytes += entry * (level.P.entries() + level.R.entries());
    bytes += 11 * node * level.rows;
  }
  return bytes + this->coarsestBytes();
}
}
