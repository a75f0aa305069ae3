// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Aggregation.h"

#include "Solvers/AssembleRows.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace morph
{
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
