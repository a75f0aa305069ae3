// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Multigrid.h"

#include "Support/Error.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace morph
{
namespace
{
constexpr int CoarsestSize = 200; // rows a dense factorisation may have
constexpr int MostLevels = 20;
constexpr int SmootherDegree = 2;
constexpr float SmootherRange = 4; // smooths eigenvalues in [largest / range, largest]
constexpr double NearShare = 0.1;  // near: within sqrt(10) times the nearest neighbor's distance
constexpr Index Grain = 4096;
constexpr Index MostRanges = 128; // of a product's rows, each with scratch of its own
constexpr int LanczosSteps = 10;
constexpr float LanczosMargin = 1.1f; // what its result may be below the largest eigenvalue

/// (A x)_i for a row of four single-precision lanes.
template <typename M>
Eigen::Vector4f rowProduct(const M& A, int i, const Multigrid::Vector& x)
{
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  const int last = A.start[i + 1];
  for (int k = A.start[i]; k < last; ++k)
  {
    sum += A.value[k] * x[A.column[k]];
  }
  return sum;
}

double distance2(const Points& points, Index i, Index j)
{
  const double* a = points.data() + 3 * i;
  const double* b = points.data() + 3 * j;
  const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

}

bool Multigrid::addLevel(ExactMatrix& exact, double unit, Monitor& monitor)
{
  std::vector<std::uint8_t> positive(exact.rows);
  Level level;
  level.inverseDiagonal.resize(exact.rows);
  monitor.parallelFor(exact.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const int* row = exact.column + exact.start[i];
        const int* found = std::find(row, exact.column + exact.start[i + 1], static_cast<int>(i));
        const bool has = found != exact.column + exact.start[i + 1];
        const float diagonal =
          has ? static_cast<float>(exact.value[found - exact.column] / unit) : 0.f;
        positive[i] = diagonal > 0 && std::isfinite(1 / diagonal);
        level.inverseDiagonal[i] = 1 / diagonal;
      }
    });
  if (std::find(positive.begin(), positive.end(), 0) != positive.end())
  {
    return false;
  }

  Matrix& A = level.A;
  A.rows = exact.rows;
  A.ownStart.swap(exact.ownStart);
  A.ownColumn.swap(exact.ownColumn);
  A.ownValue.resize(static_cast<Index>(exact.entries()));
  const double scale = 1 / unit;
  monitor.parallelFor(A.ownValue.size(), 16 * Grain,
    [&](Index first, Index last)
    {
      for (Index k = first; k < last; ++k)
      {
        A.ownValue[k] = static_cast<float>(exact.value[k] * scale);
      }
    });
  A.start = exact.start;
  A.column = exact.column;
  A.value = A.ownValue.data();
  this->levels_.push_back(std::move(level));
  return true;
}

void Multigrid::prepare(const CsrMatrix& matrix, Symmetry symmetry, double unit,
  const ConstPoints& coordinates, Monitor& monitor)
{
  this->levels_.clear();
  this->levels_.reserve(MostLevels); // a level points into itself
  this->symmetricCoarsest_.reset();
  this->generalCoarsest_.reset();
  ExactMatrix exact;
  exact.rows = static_cast<int>(matrix.rows());
  exact.start = matrix.outerIndexPtr();
  exact.column = matrix.innerIndexPtr();
  exact.value = matrix.valuePtr();
  if (!this->addLevel(exact, unit, monitor))
  {
    throw Error(Error::Kind::Singular,
      "The cells' sizes differ by more than 1e38: their stiffness cannot be solved for together.");
  }
  Points places = coordinates;

  // A level has about an eighth of the rows of the one before.
  double left = 1;
  const auto progress = [&](double part) { monitor.progress(1 - left * (1 - 0.875 * part)); };
  while (exact.rows > CoarsestSize && this->numberOfLevels() < MostLevels)
  {
    monitor.check();
    Level& level = this->levels_.back();
    const Matrix& A = level.A;
    std::vector<int> group;
    std::vector<std::uint8_t> near = nearNeighbors(A, places, monitor);
    const int groups = aggregate(A, places, near, group);
    if (groups > 0.8 * A.rows)
    {
      break; // nothing left to group: the smoother is all there is
    }
    progress(0.2);
    level.eigenvalue = largestEigenvalue(level, monitor);
    progress(0.3);
    level.P = prolongation(level, near, group, groups, monitor);
    level.R = transpose(level.P, groups);
    near = {};
    progress(0.4);

    ExactMatrix right = product(exact, level.P, groups, monitor);
    progress(0.7);
    ExactMatrix coarse = product(level.R, right, groups, monitor);
    right = {};
    progress(1);
    left *= 0.125;
    if (!this->addLevel(coarse, unit, monitor))
    {
      break; // lost to rounding next to cells that are nearly flat
    }
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
  last.eigenvalue = largestEigenvalue(last, monitor);
  this->factorizeCoarsest(exact, symmetry, unit);
}

void Multigrid::prepareTransposed(const Multigrid& other)
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
  // The cycle's two smoothing steps are the same polynomial in D^-1 A, so transposing the matrices
  // transposes the cycle.
  for (const Level& from : other.levels_)
  {
    this->levels_.emplace_back();
    Level& level = this->levels_.back();
    level.A = transpose(from.A, from.A.rows);
    level.A.adopt();
    refer(from.P, level.P);
    refer(from.R, level.R);
    level.inverseDiagonal = from.inverseDiagonal;
    level.eigenvalue = from.eigenvalue;
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

bool Multigrid::solveCoarsest(const Vector& rhs, Vector& x) const
{
  using FourColumns = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;
  using Solution = Eigen::Matrix<double, Eigen::Dynamic, 4>;
  const int n = this->levels_.back().A.rows;
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

float Multigrid::largestEigenvalue(const Level& level, Monitor& monitor)
{
  // Lanczos on D^-1/2 A D^-1/2, whose spectrum is that of D^-1 A: in ten steps within some percent
  // of the top, where the power method is still far below.
  const Matrix& A = level.A;
  std::vector<float> root(A.rows), before(A.rows, 0.f), now(A.rows), next(A.rows), scaled(A.rows);
  std::uint32_t state = 1; // a random start, always the same
  for (int i = 0; i < A.rows; ++i)
  {
    root[i] = std::sqrt(level.inverseDiagonal[i]);
    state = state * 1664525u + 1013904223u;
    now[i] = static_cast<float>(state >> 8) / (1 << 24) - 0.5f;
  }

  const int steps = std::min(LanczosSteps, A.rows);
  Eigen::VectorXd diagonal(steps), off(steps);
  double norm = std::sqrt(reproducibleSum(
    A.rows, monitor, 0., [&](Index i) { return static_cast<double>(now[i]) * now[i]; }));
  int made = 0;
  while (made < steps && norm > 0)
  {
    const float scale = static_cast<float>(1 / norm);
    const float back = made > 0 ? static_cast<float>(norm) : 0.f;
    monitor.parallelFor(A.rows, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          now[i] *= scale;
          scaled[i] = root[i] * now[i];
        }
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
  const float bound = static_cast<float>(tridiagonal.eigenvalues().maxCoeff());
  float rowSum = 0; // no eigenvalue exceeds the largest row sum
  for (int i = 0; i < A.rows; ++i)
  {
    float sum = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      sum += std::abs(A.value[k]);
    }
    rowSum = std::max(rowSum, sum * level.inverseDiagonal[i]);
  }
  return bound > 0 && std::isfinite(bound) ? std::min(LanczosMargin * bound, rowSum) : rowSum;
}

std::vector<std::uint8_t> Multigrid::nearNeighbors(
  const Matrix& A, const Points& coordinates, Monitor& monitor)
{
  std::vector<std::uint8_t> near(A.entries());
  monitor.parallelFor(A.rows, Grain,
    [&](Index first, Index last)
    {
      std::vector<double> distances;
      for (Index i = first; i < last; ++i)
      {
        distances.clear();
        double nearest = HUGE_VAL;
        for (int k = A.start[i]; k < A.start[i + 1]; ++k)
        {
          distances.push_back(A.column[k] == i ? HUGE_VAL : distance2(coordinates, i, A.column[k]));
          nearest = std::min(nearest, distances.back());
        }
        for (std::size_t k = 0; k < distances.size(); ++k)
        {
          near[A.start[i] + k] = distances[k] < HUGE_VAL && distances[k] * NearShare <= nearest;
        }
      }
    });
  return near;
}

int Multigrid::aggregate(const Matrix& A, const Points& coordinates,
  const std::vector<std::uint8_t>& near, std::vector<int>& group)
{
  const int n = A.rows;
  constexpr int None = -1;
  group.assign(n, None);
  int groups = 0;
  // First, whole neighborhoods that nobody has touched.
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
      if (near[k])
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
  // Then each node left over joins the group of its nearest grouped neighbor; those with none group
  // among themselves.
  const std::vector<int> first = group;
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
      if (near[k] && first[j] != None && distance2(coordinates, i, j) < best)
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
      if (near[k] && group[A.column[k]] == None)
      {
        group[A.column[k]] = groups;
      }
    }
    ++groups;
  }
  return groups;
}

namespace
{
/// Rows made by chunks of a fixed size, then put together: the result does not depend on the
/// threads. makeRow(i, add) calls add(column, value) in any order, and again for the same column;
/// columns stay in the order of their first call. The columns are groups, far fewer than nodes:
/// each range of chunks may have an array of that size, as long as there are few ranges.
template <typename M, typename MakeRow>
M assembleRows(int rows, int columns, Monitor& monitor, const MakeRow& makeRow)
{
  using Scalar = typename M::Values::Scalar;
  struct Chunk
  {
    std::vector<int> size, column;
    std::vector<Scalar> value;
  };
  const Index chunks = (rows + Grain - 1) / Grain;
  std::vector<Chunk> parts(chunks);
  monitor.parallelFor(chunks, 1 + chunks / MostRanges,
    [&](Index firstChunk, Index lastChunk)
    {
      // Where a column stands in the row, if that place has been given to it.
      std::vector<int> place(columns, 0);
      Chunk scratch; // keeps its capacity from chunk to chunk
      for (Index c = firstChunk; c < lastChunk; ++c)
      {
        scratch.size.clear();
        scratch.column.clear();
        scratch.value.clear();
        const int last = static_cast<int>(std::min<Index>(rows, (c + 1) * Grain));
        for (int i = static_cast<int>(c * Grain); i < last; ++i)
        {
          const std::size_t start = scratch.column.size();
          makeRow(i,
            [&](int column, Scalar value)
            {
              const std::size_t at = start + place[column];
              if (at < scratch.column.size() && scratch.column[at] == column)
              {
                scratch.value[at] += value;
                return;
              }
              place[column] = static_cast<int>(scratch.column.size() - start);
              scratch.column.push_back(column);
              scratch.value.push_back(value);
            });
          scratch.size.push_back(static_cast<int>(scratch.column.size() - start));
        }
        parts[c] = scratch;
      }
    });

  M result;
  result.rows = rows;
  result.ownStart.reserve(rows + 1);
  result.ownStart.push_back(0);
  std::vector<std::size_t> at(chunks + 1, 0);
  for (Index c = 0; c < chunks; ++c)
  {
    at[c + 1] = at[c] + parts[c].value.size();
    requireEntries(static_cast<Index>(at[c + 1]));
    for (int size : parts[c].size)
    {
      result.ownStart.push_back(result.ownStart.back() + size);
    }
  }
  result.ownColumn.resize(at[chunks]);
  result.ownValue.resize(at[chunks]);
  monitor.parallelFor(chunks, 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        std::copy(parts[c].column.begin(), parts[c].column.end(), result.ownColumn.data() + at[c]);
        std::copy(parts[c].value.begin(), parts[c].value.end(), result.ownValue.data() + at[c]);
        parts[c] = {};
      }
    });
  result.adopt();
  return result;
}
}

Multigrid::Matrix Multigrid::prolongation(const Level& level, const std::vector<std::uint8_t>& near,
  const std::vector<int>& group, int groups, Monitor& monitor)
{
  // P = (I - omega D^-1 A_F) T, T constant on the groups. A_F keeps the near neighbors and adds the
  // entries of the others to its diagonal.
  const Matrix& A = level.A;
  const float omega = 4.f / 3.f / level.eigenvalue;
  return assembleRows<Matrix>(A.rows, groups, monitor,
    [&](int i, const auto& add)
    {
      float diagonal = 0;
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        diagonal += near[k] ? 0 : A.value[k];
      }
      if (!(diagonal > 0)) // the far neighbors outweigh it: leave the row as it is
      {
        add(group[i], 1);
        return;
      }
      add(group[i], 1 - omega);
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        if (near[k])
        {
          add(group[A.column[k]], -omega / diagonal * A.value[k]);
        }
      }
    });
}

Multigrid::Matrix Multigrid::transpose(const Matrix& A, int columns)
{
  Matrix result;
  result.rows = columns;
  result.ownStart.assign(columns + 1, 0);
  const std::size_t entries = A.entries();
  for (std::size_t k = 0; k < entries; ++k)
  {
    ++result.ownStart[A.column[k] + 1];
  }
  std::partial_sum(result.ownStart.begin(), result.ownStart.end(), result.ownStart.begin());
  result.ownColumn.resize(static_cast<Index>(entries));
  result.ownValue.resize(static_cast<Index>(entries));
  std::vector<int> next(result.ownStart.begin(), result.ownStart.end() - 1);
  for (int i = 0; i < A.rows; ++i)
  {
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      const int at = next[A.column[k]]++;
      result.ownColumn[at] = i;
      result.ownValue[at] = A.value[k];
    }
  }
  result.adopt();
  return result;
}

template <typename ScalarA, typename ScalarB>
Multigrid::ExactMatrix Multigrid::product(
  const Rows<ScalarA>& A, const Rows<ScalarB>& B, int columns, Monitor& monitor)
{
  return assembleRows<ExactMatrix>(A.rows, columns, monitor,
    [&](int i, const auto& add)
    {
      for (int k = A.start[i]; k < A.start[i + 1]; ++k)
      {
        const int j = A.column[k];
        for (int m = B.start[j]; m < B.start[j + 1]; ++m)
        {
          add(B.column[m], static_cast<double>(A.value[k]) * B.value[m]);
        }
      }
    });
}

Multigrid::Workspace::Workspace(const Multigrid& multigrid)
{
  for (const auto& level : multigrid.levels_)
  {
    this->levels_.emplace_back();
    Level& work = this->levels_.back();
    const std::size_t rows = level.A.rows;
    // The finest level's right-hand side and solution are the caller's.
    if (this->levels_.size() > 1)
    {
      work.rhs.resize(rows);
      work.x.resize(rows);
    }
    work.direction.resize(SmootherDegree > 1 ? rows : 0);
    work.spare.resize(rows);
  }
}

void Multigrid::apply(const Vector& rhs, Vector& x, Workspace& workspace, Monitor& monitor) const
{
  this->cycle(0, rhs, x, workspace, monitor);
}

void Multigrid::smooth(const Level& level, const Vector& rhs, bool fromZero, Vector& x,
  Workspace::Level& work, Monitor& monitor) const
{
  // Chebyshev polynomial of D^-1 A over [largest / range, largest]; a fixed linear map, so the
  // cycle stays symmetric.
  const float high = level.eigenvalue, low = high / SmootherRange;
  const float centre = (high + low) / 2, half = (high - low) / 2;
  float rho = half / centre;
  for (int step = 0; step < SmootherDegree; ++step)
  {
    float keep = 0, take = 1 / centre;
    if (step > 0)
    {
      const float next = 1 / (2 * centre / half - rho);
      keep = next * rho;
      take = 2 * next / half;
      rho = next;
    }
    if (step == 0 && fromZero)
    {
      monitor.parallelFor(level.A.rows, Grain,
        [&](Index first, Index last)
        {
          for (Index i = first; i < last; ++i)
          {
            x[i] = take * level.inverseDiagonal[i] * rhs[i];
            if (SmootherDegree > 1)
            {
              work.direction[i] = x[i];
            }
          }
        });
      continue;
    }
    monitor.parallelFor(level.A.rows, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          Eigen::Vector4f move = take * level.inverseDiagonal[i] *
                                 (rhs[i] - rowProduct(level.A, static_cast<int>(i), x));
          if (SmootherDegree > 1)
          {
            move += keep * work.direction[i];
            work.direction[i] = move;
          }
          work.spare[i] = x[i] + move;
        }
      });
    x.swap(work.spare);
  }
}

void Multigrid::cycle(
  std::size_t k, const Vector& rhs, Vector& x, Workspace& workspace, Monitor& monitor) const
{
  const Level& level = this->levels_[k];
  Workspace::Level& work = workspace.levels_[k];
  if (k + 1 == this->levels_.size())
  {
    if (!this->solveCoarsest(rhs, x))
    {
      this->smooth(level, rhs, true, x, work, monitor);
      this->smooth(level, rhs, false, x, work, monitor);
    }
    return;
  }

  Workspace::Level& below = workspace.levels_[k + 1];
  this->smooth(level, rhs, true, x, work, monitor);
  monitor.parallelFor(level.A.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        work.spare[i] = rhs[i] - rowProduct(level.A, static_cast<int>(i), x);
      }
    });
  monitor.parallelFor(level.R.rows, Grain / 8,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        below.rhs[i] = rowProduct(level.R, static_cast<int>(i), work.spare);
      }
    });
  this->cycle(k + 1, below.rhs, below.x, workspace, monitor);
  monitor.parallelFor(level.A.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        x[i] += rowProduct(level.P, static_cast<int>(i), below.x);
      }
    });
  this->smooth(level, rhs, false, x, work, monitor);
}

std::size_t Multigrid::coarsestBytes() const
{
  const std::size_t n = this->levels_.empty() ? 0 : this->levels_.back().A.rows;
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
    bytes += level.inverseDiagonal.size() * sizeof(float);
    const std::size_t vector = level.A.rows * sizeof(Eigen::Vector4f);
    bytes += (SmootherDegree > 1 ? 2 : 1) * vector;
    bytes += &level == &this->levels_.front() ? 0 : 2 * vector;
  }
  return bytes + this->coarsestBytes();
}

double Multigrid::bytesMoved() const
{
  double bytes = 0;
  const double entry = sizeof(float) + sizeof(int), node = sizeof(Eigen::Vector4f);
  for (std::size_t k = 0; k + 1 < this->levels_.size(); ++k)
  {
    const Level& level = this->levels_[k];
    bytes += 2 * SmootherDegree * entry *
             level.A.entries(); // smoothing twice, one pass saved, one residual
    bytes += entry * (level.P.entries() + level.R.entries());
    bytes += (4 * (2 * SmootherDegree) + 6) * node * level.A.rows;
  }
  return bytes + this->coarsestBytes();
}
}
