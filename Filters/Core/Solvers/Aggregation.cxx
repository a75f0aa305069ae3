// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/Aggregation.h"

#include "Solvers/AssembleRows.h"
#include "Support/HugePages.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double NearShare = 0.2; // of the squared distance: sqrt(5) times the nearest distance
constexpr float LeastDiagonal = 0.25f; // of a filtered row, in units of the matrix's own
constexpr Index Grain = 4096;

double distance2(const Points& points, Index i, Index j)
{
  const double* a = points.data() + 3 * i;
  const double* b = points.data() + 3 * j;
  const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}
}

std::vector<std::uint8_t> nearNeighbors(
  const CsrRows<float>& A, const Points& coordinates, Monitor& monitor)
{
  auto near = largeVector<std::uint8_t>(A.entries());
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

int aggregate(const CsrRows<float>& A, const Points& coordinates,
  const std::vector<std::uint8_t>& near, std::vector<int>& group)
{
  const int n = A.rows;
  constexpr int None = -1;
  group.assign(n, None);
  int groups = 0;
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
  // Then each remaining node joins the group of its nearest grouped neighbor; nodes without one
  // form groups.
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

CsrRows<float> smoothedProlongation(const CsrRows<float>& A, float eigenvalue,
  const std::vector<std::uint8_t>& near, const std::vector<int>& group, int groups,
  Monitor& monitor)
{
  const float omega = 4.f / 3.f / eigenvalue;
  const auto makeRow = [&](int i, const auto& add)
  {
    float diagonal = 0, own = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k)
    {
      diagonal += near[k] ? 0 : A.value[k];
      own += A.column[k] == i ? A.value[k] : 0;
    }
    // The far neighbors nearly outweigh it: smoothing the row would blow it up, and the next level
    // would be singular to rounding. Layers of hexahedra have such rows where their height comes
    // near their width.
    if (!(diagonal > LeastDiagonal * own))
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
  };
  return assembleRows<float>(A.rows, groups, monitor, [&] { return makeRow; });
}
}
