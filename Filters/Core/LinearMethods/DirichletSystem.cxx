// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/DirichletSystem.h"

#include "Mesh/UnknownOrdering.h"
#include "Support/Error.h"

#include <algorithm>
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

AffineGuess::AffineGuess(const Points& points, const NodePartition& partition,
  const RowComponents& components, const CsrMatrix& coupling)
  : components_(components)
  , coupled_(components.count)
{
  for (Index row = 0; row < coupling.rows(); ++row)
  {
    std::vector<int>& columns = this->coupled_[components.of(row)];
    for (CsrMatrix::InnerIterator entry(coupling, row); entry; ++entry)
    {
      columns.push_back(static_cast<int>(entry.col()));
    }
  }
  for (std::vector<int>& columns : this->coupled_)
  {
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    columns.shrink_to_fit();
    Points places(static_cast<Index>(columns.size()), 3);
    for (Index i = 0; i < places.rows(); ++i)
    {
      places.row(i) = points.row(partition.prescribed[columns[i]]);
    }
    this->leastSquares_.emplace_back(places);
  }
}

std::vector<AffineFit> AffineGuess::fits(const Points& prescribed) const
{
  std::vector<AffineFit> result;
  result.reserve(this->coupled_.size());
  for (std::size_t c = 0; c < this->coupled_.size(); ++c)
  {
    result.push_back(this->leastSquares_[c].fit(prescribed(this->coupled_[c], allColumns)));
  }
  return result;
}

void AffineGuess::takeOff(const Points& points, const NodePartition& partition,
  const CsrMatrix& coupling, const Points& prescribed, Points& rhs, Points& x, Points& fitted,
  Monitor& monitor) const
{
  fitted.setZero(x.rows(), 3);
  fitted.swap(x);
  const std::vector<AffineFit> fits = this->fits(prescribed);
  monitor.parallelFor(coupling.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        const AffineFit& fit = fits[this->component(i)];
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
        {
          sum -= entry.value() * (prescribed.row(entry.col()) -
                                   fit.displacement(points.row(partition.prescribed[entry.col()])));
        }
        rhs.row(i) = sum;
      }
    });
}

void AffineGuess::addTranspose(const Points& points, const NodePartition& partition,
  const std::vector<Index>& rows, const CsrMatrix& coupling, const Points& gradient,
  const Points& solution, Points& prescribed) const
{
  const std::size_t components = this->coupled_.size();
  // The places at which each component's fit is evaluated, and the gradient there.
  std::vector<std::vector<Index>> places(components);
  std::vector<std::vector<Eigen::RowVector3d>> loads(components);
  for (Index i = 0; i < coupling.rows(); ++i)
  {
    const int c = this->component(i);
    places[c].push_back(rows[i]);
    loads[c].push_back(gradient.row(i));
    for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
    {
      places[c].push_back(partition.prescribed[entry.col()]);
      loads[c].push_back(entry.value() * solution.row(i));
    }
  }
  for (std::size_t c = 0; c < components; ++c)
  {
    Points x(static_cast<Index>(places[c].size()), 3), load = x;
    for (Index k = 0; k < x.rows(); ++k)
    {
      x.row(k) = points.row(places[c][k]);
      load.row(k) = loads[c][k];
    }
    Points some = Points::Zero(static_cast<Index>(this->coupled_[c].size()), 3);
    if (some.rows() == 0)
    {
      continue;
    }
    this->leastSquares_[c].fitTranspose(x, load, some);
    for (Index k = 0; k < some.rows(); ++k)
    {
      prescribed.row(this->coupled_[c][k]) += some.row(k);
    }
  }
}

std::size_t AffineGuess::memory() const
{
  std::size_t bytes = sizeof(int) * this->components_.ofRow.size();
  for (const std::vector<int>& columns : this->coupled_)
  {
    bytes += sizeof(AffineLeastSquares) + (sizeof(int) + 3 * sizeof(double)) * columns.size();
  }
  return bytes;
}

void rightHandSideAndGuess(const Points& points, const std::vector<Index>& rows,
  const AffineGuess& guess, const CsrMatrix& coupling, const Points& prescribed, Points& rhs,
  Points& x, Monitor& monitor)
{
  const std::vector<AffineFit> fits = guess.fits(prescribed);
  const Index n = static_cast<Index>(rows.size());
  rhs.resize(n, 3);
  x.resize(n, 3);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        x.row(i) = fits[guess.component(i)].displacement(points.row(rows[i]));
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (CsrMatrix::InnerIterator entry(coupling, static_cast<int>(i)); entry; ++entry)
        {
          sum -= entry.value() * prescribed.row(entry.col());
        }
        rhs.row(i) = sum;
      }
    });
}

Points permute(const Points& free, const std::vector<Index>& rows, const NodePartition& partition)
{
  Points result(free.rows(), 3);
  for (Index i = 0; i < free.rows(); ++i)
  {
    result.row(i) = free.row(indexInFree(rows, partition.free, i));
  }
  return result;
}

void unpermute(const Points& x, const std::vector<Index>& rows, const NodePartition& partition,
  Points& free, Monitor& monitor)
{
  monitor.parallelFor(x.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        free.row(indexInFree(rows, partition.free, i)) = x.row(i);
      }
    });
}
}
