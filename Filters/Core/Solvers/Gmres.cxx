// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Gmres.h"

#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr int Steps = 30;

/// The least-squares problem of one column: its Hessenberg matrix, kept triangular by Givens
/// rotations.
struct Projected
{
  Eigen::Matrix<double, Steps + 1, Steps> H = Eigen::Matrix<double, Steps + 1, Steps>::Zero();
  Eigen::Matrix<double, Steps + 1, 1> rhs = Eigen::Matrix<double, Steps + 1, 1>::Zero();
  std::array<double, Steps> cosine = {}, sine = {};
  /// columns of H in use; fewer than the steps made where the column has come to its end
  int size = 0;

  /// Rotates the new column j, and the right-hand side with it.
  void rotate(int j)
  {
    for (int i = 0; i < j; ++i)
    {
      const double upper = this->H(i, j), lower = this->H(i + 1, j);
      this->H(i, j) = this->cosine[i] * upper + this->sine[i] * lower;
      this->H(i + 1, j) = this->cosine[i] * lower - this->sine[i] * upper;
    }
    const double length = std::hypot(this->H(j, j), this->H(j + 1, j));
    if (!(length > 0)) // A is singular on this space: no use of the step
    {
      return;
    }
    this->cosine[j] = this->H(j, j) / length;
    this->sine[j] = this->H(j + 1, j) / length;
    this->H(j, j) = length;
    this->H(j + 1, j) = 0;
    this->rhs[j + 1] = -this->sine[j] * this->rhs[j];
    this->rhs[j] *= this->cosine[j];
    this->size = j + 1;
  }

  Eigen::VectorXd solution() const
  {
    Eigen::VectorXd y = this->rhs.head(this->size);
    for (int i = this->size - 1; i >= 0; --i)
    {
      for (int j = i + 1; j < this->size; ++j)
      {
        y[i] -= this->H(i, j) * y[j];
      }
      y[i] /= this->H(i, i);
    }
    return y;
  }
};
}

Gmres::Gmres(const CsrMatrix& matrix)
  : matrix_(&matrix)
  , preconditioner_(matrix)
{
}

int Gmres::run(const MultiVector& residual, const MultiVectorRow& norm2,
  const MultiVectorRow& goal2, MultiVector& solution, Monitor& monitor)
{
  monitor.check();
  const Index n = this->matrix_->rows();
  const MultiVectorRow zero = MultiVectorRow::Zero();
  std::array<Projected, 3> columns;
  MultiVectorRow inverse = zero;
  for (int c = 0; c < 3; ++c)
  {
    columns[c].rhs[0] = std::sqrt(norm2[c]);
    inverse[c] = norm2[c] > goal2[c] ? 1 / columns[c].rhs[0] : 0;
  }
  const auto basis = [&](int j) -> MultiVector&
  {
    if (static_cast<int>(this->basis_.size()) <= j)
    {
      this->basis_.emplace_back(n);
    }
    return this->basis_[j];
  };
  MultiVector work(n);
  MultiVector& start = basis(0);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        start[i] = residual[i].cwiseProduct(inverse);
      }
    });

  Eigen::Array4i running = (inverse.array() != 0).cast<int>();
  int made = 0;
  while (made < Steps && running.any())
  {
    monitor.check();
    basis(made + 1);
    work = this->basis_[made];
    this->preconditioner_.apply(work);
    MultiVector& next = this->basis_[made + 1];
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          next[i] = rowProduct(*this->matrix_, i, work);
        }
      });
    for (int k = 0; k <= made; ++k)
    {
      const MultiVector& old = this->basis_[k];
      const MultiVectorRow along = reproducibleSum(
        n, monitor, zero, [&](Index i) { return MultiVectorRow(next[i].cwiseProduct(old[i])); });
      monitor.parallelFor(n, Grain,
        [&](Index first, Index last)
        {
          for (Index i = first; i < last; ++i)
          {
            next[i] -= along.cwiseProduct(old[i]);
          }
        });
      for (int c = 0; c < 3; ++c)
      {
        columns[c].H(k, made) = along[c];
      }
    }
    const MultiVectorRow length2 = reproducibleSum(
      n, monitor, zero, [&](Index i) { return MultiVectorRow(next[i].cwiseAbs2()); });
    MultiVectorRow shrink = zero;
    for (int c = 0; c < 3; ++c)
    {
      if (!running[c])
      {
        continue;
      }
      const double length = std::sqrt(length2[c]);
      columns[c].H(made + 1, made) = length;
      columns[c].rotate(made);
      shrink[c] = length > 0 ? 1 / length : 0;
      // The end of the space, or the goal.
      if (!(length > 0) || !(columns[c].size == made + 1) ||
          columns[c].rhs[made + 1] * columns[c].rhs[made + 1] <= goal2[c])
      {
        running[c] = 0;
        shrink[c] = 0;
      }
    }
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          next[i] = next[i].cwiseProduct(shrink);
        }
      });
    ++made;
  }

  std::vector<MultiVectorRow> y(made, zero);
  for (int c = 0; c < 3; ++c)
  {
    const Eigen::VectorXd own = columns[c].solution();
    for (int k = 0; k < columns[c].size; ++k)
    {
      y[k][c] = own[k];
    }
  }
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        work[i] = zero;
        for (int k = 0; k < made; ++k)
        {
          work[i] += y[k].cwiseProduct(this->basis_[k][i]);
        }
      }
    });
  this->preconditioner_.apply(work);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        solution[i] += work[i];
      }
    });
  return std::max(made, 1);
}
}
