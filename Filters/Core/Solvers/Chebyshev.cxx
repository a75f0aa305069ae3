// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Chebyshev.h"

#include "Support/ReproducibleSum.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace morph
{
namespace
{
constexpr float SmootherRange = 4; // smooths eigenvalues in [largest / range, largest]
constexpr Index Grain = 4096;
constexpr int LanczosSteps = 10;
constexpr float LanczosMargin = 1.1f; // covers the error of the Lanczos result
}

float largestEigenvalue(
  const CsrRows<float>& A, const std::vector<float>& inverseDiagonal, Monitor& monitor)
{
  // Lanczos on D^-1/2 A D^-1/2, whose spectrum is that of D^-1 A. Ten steps come within some
  // percent of the largest eigenvalue; the power method is then still far below.
  std::vector<float> root(A.rows), before(A.rows, 0.f), now(A.rows), next(A.rows), scaled(A.rows);
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
    rowSum = std::max(rowSum, sum * inverseDiagonal[i]);
  }
  return bound > 0 && std::isfinite(bound) ? std::min(LanczosMargin * bound, rowSum) : rowSum;
}

void chebyshevSmooth(const CsrRows<float>& A, const std::vector<float>& inverseDiagonal,
  float largest, const FloatMultiVector& rhs, bool fromZero, FloatMultiVector& x,
  FloatMultiVector& direction, FloatMultiVector& spare, Monitor& monitor)
{
  const float high = largest, low = high / SmootherRange;
  const float centre = (high + low) / 2, half = (high - low) / 2;
  float rho = half / centre;
  for (int step = 0; step < ChebyshevDegree; ++step)
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
      monitor.parallelFor(A.rows, Grain,
        [&](Index first, Index last)
        {
          for (Index i = first; i < last; ++i)
          {
            x[i] = take * inverseDiagonal[i] * rhs[i];
            if (ChebyshevDegree > 1)
            {
              direction[i] = x[i];
            }
          }
        });
      continue;
    }
    monitor.parallelFor(A.rows, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          Eigen::Vector4f move =
            take * inverseDiagonal[i] * (rhs[i] - rowProduct(A, static_cast<int>(i), x));
          if (ChebyshevDegree > 1)
          {
            move += keep * direction[i];
            direction[i] = move;
          }
          spare[i] = x[i] + move;
        }
      });
    x.swap(spare);
  }
}
}
