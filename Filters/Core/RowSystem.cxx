// SPDX-License-Identifier: BSD-3-Clause
#include "RowSystem.h"

#include "AffineFit.h"
#include "Error.h"
#include "RowOrder.h"

#include <sstream>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
}

void requireTolerance(double tolerance)
{
  if (!(tolerance > 0 && tolerance < 1))
  {
    std::ostringstream text;
    text << "The tolerance must lie between 0 and 1; it is " << tolerance << ".";
    throw Error(text.str());
  }
}

Points rowPositions(const Points& points, const std::vector<Index>& rows)
{
  Points positions(static_cast<Index>(rows.size()), 3);
  for (Index i = 0; i < positions.rows(); ++i)
  {
    positions.row(i) = points.row(rows[i]);
  }
  return positions;
}

void startSystem(const Points& points, const std::vector<Index>& rows,
  const NodePartition& partition, const SparseMatrix& coupling, const Points& prescribed,
  Points& rhs, Points& x, Monitor& monitor)
{
  const AffineFit fit(points, partition.prescribed, prescribed);
  const Index n = static_cast<Index>(rows.size());
  rhs.resize(n, 3);
  x.resize(n, 3);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        x.row(i) = fit.displacement(points.row(rows[i]));
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (SparseMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
        {
          sum -= entry.value() * prescribed.row(entry.col());
        }
        rhs.row(i) = sum;
      }
    });
}

Points toRows(const Points& free, const std::vector<Index>& rows, const NodePartition& partition)
{
  Points result(free.rows(), 3);
  for (Index i = 0; i < free.rows(); ++i)
  {
    result.row(i) = free.row(placeInFree(rows, partition.free, i));
  }
  return result;
}

void fromRows(const Points& x, const std::vector<Index>& rows, const NodePartition& partition,
  Points& free, Monitor& monitor)
{
  monitor.parallelFor(x.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        free.row(placeInFree(rows, partition.free, i)) = x.row(i);
      }
    });
}
}
