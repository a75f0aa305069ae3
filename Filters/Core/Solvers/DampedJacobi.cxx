// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/DampedJacobi.h"

#include "Solvers/RowProducts.h"
#include "Support/HugePages.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace morph
{
namespace
{
constexpr float SmoothedRange = 4; // smooths eigenvalues in [largest / range, largest]
constexpr int LanczosSteps = 10;
constexpr float LanczosMargin = 1.1f; // covers the error of the Lanczos result
}

float largestEigenvalue(
  const CsrRows<float>& A, const std::vector<float>& inverseDiagonal, Monitor& monitor)
{
  // Lanczos on D^-1/2 A D^-1/2, whose spectrum is that of D^-1 A. Ten steps come within some
  // percent of the largest eigenvalue; the power method is then still far below.
  const auto zeros = [&A] { return largeVector<float>(A.rows, 0.f); };
  std::vector<float> root = zeros(), before = zeros(), now = zeros(), next = zeros(),
                     scaled = zeros();
  std::uint32_t state = 1; // a fixed random start
  for (int i = 0; i < A.rows; ++i)
  {
    root[i] = std::sqrt(inverseDiagonal[i]);
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
    monitor.parallelFor(A.rows, DampedJacobi::Grain,
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
  // No eigenvalue exceeds the largest row sum.
  absoluteRowSums(A, scaled, monitor);
  float rowSum = 0;
  for (int i = 0; i < A.rows; ++i)
  {
    rowSum = std::max(rowSum, scaled[i] * inverseDiagonal[i]);
  }
  return bound > 0 && std::isfinite(bound) ? std::min(LanczosMargin * bound, rowSum) : rowSum;
}

DampedJacobi::DampedJacobi(std::vector<float> inverseDiagonal, float largest)
  : weight_(std::move(inverseDiagonal))
{
  const float centre = largest * (1 + 1 / SmoothedRange) / 2;
  for (float& weight : this->weight_)
  {
    weight /= centre;
  }
}

void DampedJacobi::start(const Eigen::Vector4f* rhs, Eigen::Vector4f* x, Monitor& monitor) const
{
  monitor.parallelFor(static_cast<Index>(this->weight_.size()), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        x[i] = this->weight_[i] * rhs[i];
      }
    });
}

Eigen::Vector4d DampedJacobi::step(const CsrRows<float>& A, const Eigen::Vector4f* rhs,
  const Eigen::Vector4f* from, Eigen::Vector4f* to, Monitor& monitor) const
{
  return reproducibleSumOfBlocks(A.rows, monitor, Eigen::Vector4d(Eigen::Vector4d::Zero()),
    [&](Index first, Index last)
    {
      Eigen::Vector4d products = Eigen::Vector4d::Zero();
      forRowProducts(A, from, first, last,
        [&](Index i, const Eigen::Vector4f& product)
        {
          to[i] = from[i] + this->weight_[i] * (rhs[i] - product);
          products += rhs[i].cast<double>().cwiseProduct(to[i].cast<double>());
        });
      return products;
    });
}
}
