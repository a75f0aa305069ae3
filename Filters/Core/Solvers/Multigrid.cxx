// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Solvers/Aggregation.h"
#include "Solvers/RowProducts.h"
#include "Support/Error.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
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
constexpr float SmoothedRange = 4; // smooths eigenvalues in [largest / range, largest]
constexpr int LanczosSteps = 10;
constexpr float LanczosMargin = 1.1f; // covers the error of the Lanczos result

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

/// The mean places of the rows of each group.
Points centersOf(const Points& places, const std::vector<int>& group, int groups)
{
  Points centers = Points::Zero(groups, 3);
  std::vector<int> members(groups, 0);
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    centers.row(group[i]) += places.row(static_cast<Index>(i));
    ++members[group[i]];
  }
  for (int g = 0; g < groups; ++g)
  {
    centers.row(g) /= members[g];
  }
  return centers;
}
}

float largestEigenvalue(
  const CsrRows<float>& A, const std::vector<float>& inverseDiagonal, Monitor& monitor)
{
  // Lanczos on D^-1/2 A D^-1/2, whose spectrum is that of D^-1 A. Ten steps come within some
  // percent of the largest eigenvalue; the power method is then still far below.
  std::vector<float> root(A.rows), before(A.rows), now(A.rows), next(A.rows), scaled(A.rows);
  std::uint32_t state = 1; // a fixed random start
  for (Index i = 0; i < A.rows; ++i)
  {
    root[i] = std::sqrt(inverseDiagonal[i]);
    state = state * 1664525u + 1013904223u;
    now[i] = static_cast<float>(state >> 8) / (1 << 24) - 0.5f;
  }

  const int steps = static_cast<int>(std::min<Index>(LanczosSteps, A.rows));
  Eigen::VectorXd diagonal(steps), off(steps);
  double norm = std::sqrt(reproducibleSum(
    A.rows, monitor, 0., [&](Index i) { return static_cast<double>(now[i]) * now[i]; }));
  int made = 0;
  while (made < steps && norm > 0)
  {
    const float scale = static_cast<float>(1 / norm);
    const float back = made > 0 ? static_cast<float>(norm) : 0.f;
    parallel(A.rows, monitor,
      [&](Index i)
      {
        now[i] *= scale;
        scaled[i] = root[i] * now[i];
      });
    const double along = reproducibleSum(A.rows, monitor, 0.,
      [&](Index i)
      {
        float sum = 0;
        for (int k = A.start[i]; k < A.start[i + 1]; ++k)
        {
          sum += A.value[k] * scaled[A.column[k]];
        }
        next[i] = root[i] * sum - back * before[i];
        return static_cast<double>(next[i]) * now[i];
      });
    norm = std::sqrt(reproducibleSum(A.rows, monitor, 0.,
      [&](Index i)
      {
        next[i] -= static_cast<float>(along) * now[i];
        return static_cast<double>(next[i]) * next[i];
      }));
    diagonal[made] = along;
    off[made] = norm;
    ++made;
    before.swap(now);
    now.swap(next);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
  tridiagonal.computeFromTridiagonal(
    diagonal.head(made), off.head(std::max(made - 1, 0)), Eigen::EigenvaluesOnly);
  const float estimate = LanczosMargin * static_cast<float>(tridiagonal.eigenvalues().maxCoeff());
  // No eigenvalue exceeds the largest row sum.
  float bound = 0;
  for (Index i = 0; i < A.rows; ++i)
  {
    float sum = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      sum += std::abs(A.value[k]);
    }
    bound = std::max(bound, sum * inverseDiagonal[i]);
  }
  return estimate > 0 && std::isfinite(estimate) ? std::min(estimate, bound) : bound;
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

float Multigrid::addLevel(const CsrRows<float>& A, Monitor& monitor)
{
  // Single precision has room for 2^-60 of such an entry and for its inverse.
  const float least = std::ldexp(1.f, LargestExponent - 126);
  std::vector<float> inverseDiagonal(A.rows);
  parallel(A.rows, monitor,
    [&](Index i)
    {
      const int *row = A.column + A.start[i], *end = A.column + A.start[i + 1];
      const int* found = std::find(row, end, static_cast<int>(i));
      const float diagonal = found != end ? A.value[found - A.column] : 0.f;
      inverseDiagonal[i] = diagonal >= least && std::isfinite(diagonal) ? 1 / diagonal : 0;
    });
  if (std::find(inverseDiagonal.begin(), inverseDiagonal.end(), 0) != inverseDiagonal.end())
  {
    return 0;
  }
  const float largest = largestEigenvalue(A, inverseDiagonal, monitor);
  Level& level = this->levels_.emplace_back();
  level.rows = A.rows;
  level.weight.swap(inverseDiagonal);
  for (float& weight : level.weight)
  {
    weight /= largest * (1 + 1 / SmoothedRange) / 2; // the middle of the range
  }
  return largest;
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
  float largest = this->addLevel(this->matrix(0), monitor);
  if (largest == 0)
  {
    throw Error(Error::Kind::Singular,
      "The cells' sizes differ by more than 1e38: their stiffness cannot be solved for together.");
  }
  Points places = coordinates;
  // Of the squared distances. 0.4 coarsens along the short side from an aspect ratio of 1.6 on.
  // That saves up to half of the iterations of FEMWARP there, and costs LBWARP some.
  const double share = symmetry == Symmetry::Symmetric ? 0.4 : 0.2;

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
    std::vector<int> group;
    std::vector<std::uint8_t> near = nearNeighbors(A, places, share, monitor);
    const int groups = aggregate(A, places, near, group);
    if (groups > 0.8 * static_cast<double>(level.rows))
    {
      break; // nothing left to group: this level only has the smoother
    }
    progress(0.3);
    level.P = smoothedProlongation(A, largest, near, group, groups, monitor);
    level.R = level.P.transpose();
    near = {};
    progress(0.4);

    CsrMatrix coarse = this->numberOfLevels() == 1
                         ? tripleProduct(level.R, matrix, level.P, 1 / this->unit_, monitor)
                         : tripleProduct(level.R, exact, level.P, 1, monitor);
    progress(1);
    left *= 0.125;
    CsrMatrixOf<float> single = rounded(coarse);
    largest = this->addLevel(single, monitor);
    if (largest == 0)
    {
      break; // rounding near flat cells spoiled the level
    }
    this->levels_.back().A.swap(single);
    exact.swap(coarse);
    places = centersOf(places, group, groups);
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
  // The cycle smooths alike before and after the coarse correction, so transposing the matrices
  // transposes it.
  *this = other;
  for (Level& level : this->levels_)
  {
    level.A = CsrMatrixOf<float>(level.A.transpose());
  }
  this->coarsestInverse_ = other.coarsestInverse_.transpose();
  Monitor silent;
  this->round(matrix, silent);
}

Multigrid::Workspace::Workspace(const Multigrid& multigrid)
{
  for (const Multigrid::Level& level : multigrid.levels_)
  {
    Level& own = this->levels_.emplace_back();
    own.work.resize(level.rows);
    if (this->levels_.size() > 1) // the caller has the finest level's
    {
      own.rhs.resize(level.rows);
      own.x.resize(level.rows);
    }
  }
}

void Multigrid::apply(const Row* rhs, Row* x, Workspace& workspace, Monitor& monitor) const
{
  if (!this->levels_.empty())
  {
    this->cycle(0, rhs, x, workspace, monitor);
  }
}

void Multigrid::smoothFromZero(const Level& level, const Row* rhs, Row* x, Monitor& monitor) const
{
  parallel(level.rows, monitor, [&](Index i) { x[i] = level.weight[i] * rhs[i]; });
}

void Multigrid::smooth(
  std::size_t k, const Row* rhs, const Row* from, Row* to, Monitor& monitor) const
{
  const CsrRows<float> A = this->matrix(k);
  const std::vector<float>& weight = this->levels_[k].weight;
  monitor.parallelFor(A.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(A, from, first, last,
        [&](Index i, const Row& product) { to[i] = from[i] + weight[i] * (rhs[i] - product); });
    });
}

void Multigrid::cycle(
  std::size_t k, const Row* rhs, Row* x, Workspace& workspace, Monitor& monitor) const
{
  const Level& level = this->levels_[k];
  Row* work = workspace.levels_[k].work.data();
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
    this->smoothFromZero(level, rhs, work, monitor);
    this->smooth(k, rhs, work, x, monitor);
    return;
  }

  Workspace::Level& below = workspace.levels_[k + 1];
  this->smoothFromZero(level, rhs, work, monitor);
  Row* residual = x;
  monitor.parallelFor(level.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(this->matrix(k), work, first, last,
        [&](Index i, const Row& product) { residual[i] = rhs[i] - product; });
    });
  monitor.parallelFor(level.R.rows(), Grain / 8,
    [&](Index first, Index last)
    { rowProducts(level.R, residual, first, last, below.rhs.data() + first); });
  this->cycle(k + 1, below.rhs.data(), below.x.data(), workspace, monitor);
  monitor.parallelFor(level.rows, Grain,
    [&](Index first, Index last)
    {
      forRowProducts(CsrRows<float>(level.P), below.x.data(), first, last,
        [&](Index i, const Row& product) { work[i] += product; });
    });
  this->smooth(k, rhs, work, x, monitor);
}
}
