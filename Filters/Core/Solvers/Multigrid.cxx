// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Solvers/Aggregation.h"
#include "Solvers/RowProducts.h"
#include "Support/Error.h"
#include "Support/HugePages.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

namespace morph
{
namespace
{
constexpr int CoarsestSize = 200; // maximum number of rows for a dense factorisation
constexpr int MostLevels = 20;
constexpr Index Grain = 4096;

/// Refers to the arrays of `rows`.
CsrRows<float> referTo(const CsrRows<float>& rows)
{
  CsrRows<float> result;
  result.rows = rows.rows;
  result.start = rows.start;
  result.column = rows.column;
  result.step = rows.step;
  result.value = rows.value;
  return result;
}

/// Rounds `exact` to single precision. The result takes over its structure, to which `exact` then
/// refers.
CsrRows<float> roundRows(CsrRows<double>& exact, Monitor& monitor)
{
  CsrRows<float> rounded;
  rounded.rows = exact.rows;
  rounded.ownStart.swap(exact.ownStart);
  rounded.ownColumn.swap(exact.ownColumn);
  resizeUndefined(rounded.ownValue, static_cast<Index>(exact.entries()));
  monitor.parallelFor(rounded.ownValue.size(), 16 * Grain,
    [&](Index first, Index last)
    {
      for (Index k = first; k < last; ++k)
      {
        rounded.ownValue[k] = static_cast<float>(exact.value[k]);
      }
    });
  rounded.adopt();
  return rounded;
}

/// A dense matrix of the structure of `rows`. entry(k): the value of entry k.
template <typename Entry>
Eigen::MatrixXd denseMatrix(const CsrRows<float>& rows, const Entry& entry)
{
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows.rows, rows.rows);
  for (int i = 0; i < rows.rows; ++i)
  {
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
    {
      dense(i, rows.column[k]) += entry(k);
    }
  }
  return dense;
}
}

float Multigrid::addLevel(const Matrix& A, Monitor& monitor)
{
  // Single precision has room for 2^-60 of such an entry and for its inverse.
  const float least = std::ldexp(1.f, MixedPrecisionMatrix::LargestExponent - 126);
  std::vector<std::uint8_t> usable(A.rows);
  auto inverseDiagonal = largeVector<float>(A.rows);
  monitor.parallelFor(A.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const int *row = A.column + A.start[i], *end = A.column + A.start[i + 1];
        const int* found = std::find(row, end, static_cast<int>(i));
        const float diagonal = found != end ? A.value[found - A.column] : 0.f;
        usable[i] = diagonal >= least && std::isfinite(diagonal);
        inverseDiagonal[i] = 1 / diagonal;
      }
    });
  if (std::find(usable.begin(), usable.end(), 0) != usable.end())
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

void Multigrid::prepare(const MixedPrecisionMatrix& matrix, Symmetry symmetry,
  const ConstPoints& coordinates, Monitor& monitor)
{
  this->levels_.clear();
  this->levels_.reserve(MostLevels); // `level` below stays valid
  this->symmetricCoarsest_.reset();
  this->generalCoarsest_.reset();
  this->finest_ = &matrix.rounded();
  assert(!this->finest_->step);
  if (matrix.rows() == 0)
  {
    return; // no level: see apply()
  }
  float largest = this->addLevel(*this->finest_, monitor);
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
  ExactMatrix exact; // of the last level but the finest
  while (this->levels_.back().rows > CoarsestSize && this->numberOfLevels() < MostLevels)
  {
    monitor.check();
    Level& level = this->levels_.back();
    const Matrix& A = this->matrix(this->levels_.size() - 1);
    std::vector<int> group;
    std::vector<std::uint8_t> near = nearNeighbors(A, places, monitor);
    const int groups = aggregate(A, places, near, group);
    if (groups > 0.8 * level.rows)
    {
      break; // nothing left to group: this level only has the smoother
    }
    progress(0.3);
    level.P = smoothedProlongation(A, largest, near, group, groups, monitor);
    level.R = transpose(level.P, groups);
    near = {};
    progress(0.4);

    ExactMatrix coarse = this->numberOfLevels() == 1
                           ? tripleProduct(level.R, matrix, level.P, groups, monitor)
                           : tripleProduct(level.R, exact, level.P, groups, monitor);
    progress(1);
    left *= 0.125;
    Matrix rounded = roundRows(coarse, monitor);
    largest = this->addLevel(rounded, monitor);
    if (largest == 0)
    {
      break; // rounding near flat cells spoiled the level
    }
    this->levels_.back().A = std::move(rounded);
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
  if (last.rows <= 4 * CoarsestSize)
  {
    const bool isFinest = this->numberOfLevels() == 1;
    this->factorizeCoarsest(denseMatrix(this->matrix(this->levels_.size() - 1),
                              [&](int k) { return isFinest ? matrix.inUnits(k) : exact.value[k]; }),
      symmetry);
  }
}

void Multigrid::prepareTransposed(const Multigrid& other, const MixedPrecisionMatrix& matrix)
{
  this->levels_.clear();
  this->levels_.reserve(MostLevels);
  this->symmetricCoarsest_ = other.symmetricCoarsest_;
  this->generalCoarsest_.reset();
  if (other.generalCoarsest_)
  {
    this->generalCoarsest_.emplace(other.generalCoarsest_->reconstructedMatrix().transpose());
  }
  // The cycle smooths alike before and after the coarse correction, so transposing the matrices
  // transposes it.
  this->finest_ = &matrix.rounded();
  for (const Level& from : other.levels_)
  {
    this->levels_.emplace_back();
    Level& level = this->levels_.back();
    level.rows = from.rows;
    if (this->numberOfLevels() > 1)
    {
      level.A = transpose(from.A, from.rows);
    }
    level.P = referTo(from.P);
    level.R = referTo(from.R);
    level.smoother = from.smoother;
  }
}

void Multigrid::factorizeCoarsest(const Eigen::MatrixXd& A, Symmetry symmetry)
{
  constexpr double LeastReciprocalCondition = 1e-13;
  if (symmetry == Symmetry::General)
  {
    this->generalCoarsest_.emplace(A);
    if (!(this->generalCoarsest_->rcond() > LeastReciprocalCondition))
    {
      this->generalCoarsest_.reset();
    }
    return;
  }
  this->symmetricCoarsest_.emplace(A);
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

Eigen::Vector4d Multigrid::apply(
  const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor& monitor) const
{
  return this->levels_.empty() ? Eigen::Vector4d(Eigen::Vector4d::Zero())
                               : this->cycle(0, rhs, work, x, workspace, monitor);
}

Eigen::Vector4d Multigrid::cycle(
  std::size_t k, const Row* rhs, Row* work, Row* x, Workspace& workspace, Monitor& monitor) const
{
  const Level& level = this->levels_[k];
  const Matrix& A = this->matrix(k);
  if (k + 1 == this->levels_.size())
  {
    if (!this->solveCoarsest(rhs, x))
    {
      level.smoother.start(rhs, work, monitor);
      return level.smoother.step(A, rhs, work, x, monitor);
    }
    return reproducibleSum(level.rows, monitor, Eigen::Vector4d(Eigen::Vector4d::Zero()),
      [&](Index i)
      { return Eigen::Vector4d(rhs[i].cast<double>().cwiseProduct(x[i].cast<double>())); });
  }

  Workspace::Level& below = workspace.levels_[k + 1];
  level.smoother.start(rhs, work, monitor);
  Row* residual = x;
  monitor.parallelFor(level.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(
        A, work, first, last, [&](Index i, const Row& product) { residual[i] = rhs[i] - product; });
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
  return level.smoother.step(A, rhs, work, x, monitor);
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
  const double node = sizeof(Row);
  for (std::size_t k = 0; k + 1 < this->levels_.size(); ++k)
  {
    const Level& level = this->levels_[k];
    // The residual, and smoothing after the correction.
    bytes += 2 * this->matrix(k).bytesRead() + level.P.bytesRead() + level.R.bytesRead();
    bytes += 11 * node * level.rows;
  }
  return bytes + this->coarsestBytes();
}
}
