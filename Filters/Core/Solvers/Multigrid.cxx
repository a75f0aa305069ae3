// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Solvers/Aggregation.h"
#include "Solvers/RowProducts.h"
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
  monitor.parallelFor(level.R.rows(), Grain / 8,
    [&](Index first, Index last)
    { rowProducts(CsrRows<float>(level.R), residual, first, last, below.rhs.data() + first); });
  this->cycle(k + 1, below.rhs.data(), below.x.data(), workspace, monitor);
  monitor.parallelFor(level.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(CsrRows<float>(level.P), below.x.data(), first, last,
        [&](Index i, const Row& product) { work[i] += product; });
    });
  level.smoother.sweepBack(A, rhs, work, x, monitor);
}
}
