// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CondensedSolver.h"

#include "Solvers/AssembleRows.h"
#include "Support/Error.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr int MostStages = 4;
constexpr Index MostNeighbors = 16;
// Pairs of entries that a row may add: it takes vectors of the iteration along, which cost as much.
constexpr std::size_t MostAdded = 8;
constexpr Index Grain = 4096;
constexpr Index LeastPart = 8; // of the rows: fewer are not worth a pass

/// Whether row i has an entry in column j; the columns of a row ascend.
bool couples(const CsrMatrix& matrix, int i, int j)
{
  const int* columns = matrix.innerIndexPtr();
  return std::binary_search(
    columns + matrix.outerIndexPtr()[i], columns + matrix.outerIndexPtr()[i + 1], j);
}

/// Whether the matrix has hardly more entries without the row. `neighbors`: the columns of its
/// other entries.
bool staysSparse(const CsrMatrix& matrix, const std::vector<int>& neighbors)
{
  const std::size_t most = neighbors.size() + MostAdded; // 2 n + 1 entries go, in pairs
  std::size_t missing = 0;
  for (std::size_t a = 0; a < neighbors.size() && missing <= most; ++a)
  {
    for (std::size_t b = a + 1; b < neighbors.size(); ++b)
    {
      missing += !couples(matrix, neighbors[a], neighbors[b]);
    }
  }
  return missing <= most;
}

/// For each row its place in `rows`, or -1.
std::vector<int> placesOf(const std::vector<int>& rows, Index count)
{
  std::vector<int> places(static_cast<std::size_t>(count), -1);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    places[rows[i]] = static_cast<int>(i);
  }
  return places;
}

CsrMatrix sorted(const CsrRows<double>& rows, Index columns)
{
  const Eigen::Map<const CsrMatrix> unsorted(
    rows.rows, columns, static_cast<Index>(rows.entries()), rows.start, rows.column, rows.value);
  const Eigen::SparseMatrix<double, Eigen::ColMajor, int> byColumn(unsorted);
  return CsrMatrix(byColumn);
}

MultiVector rowsOf(const MultiVector& all, const std::vector<int>& rows, Monitor& monitor)
{
  MultiVector result(rows.size());
  monitor.parallelFor(static_cast<Index>(rows.size()), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        result[i] = all[rows[i]];
      }
    });
  return result;
}
}

std::vector<int> CondensedSolver::choose(
  const CsrMatrix& matrix, const std::vector<bool>& removable)
{
  std::vector<int> chosen, neighbors;
  std::vector<bool> isBeside(static_cast<std::size_t>(matrix.rows()), false);
  for (int row = 0; row < matrix.rows(); ++row)
  {
    if (!removable[row] || isBeside[row] ||
        matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row] > MostNeighbors + 1)
    {
      continue;
    }
    neighbors.clear();
    double diagonal = 0;
    for (CsrMatrix::InnerIterator entry(matrix, row); entry; ++entry)
    {
      if (entry.col() == row)
      {
        diagonal = entry.value();
      }
      else
      {
        neighbors.push_back(static_cast<int>(entry.col()));
      }
    }
    if (diagonal > 0 && std::isfinite(diagonal) && staysSparse(matrix, neighbors))
    {
      chosen.push_back(row);
      for (const int neighbor : neighbors)
      {
        isBeside[neighbor] = true;
      }
    }
  }
  return chosen;
}

CondensedSolver::Stage CondensedSolver::condense(
  CsrMatrix& matrix, const std::vector<int>& removed, Monitor& monitor)
{
  Stage stage;
  stage.removed = removed;
  const std::vector<int> placeOfRemoved = placesOf(removed, matrix.rows());
  for (int row = 0; row < matrix.rows(); ++row)
  {
    if (placeOfRemoved[row] < 0)
    {
      stage.kept.push_back(row);
    }
  }
  const std::vector<int> placeOfKept = placesOf(stage.kept, matrix.rows());
  const auto width = static_cast<Index>(stage.kept.size());
  stage.inverse.resize(static_cast<Index>(removed.size()));
  for (std::size_t i = 0; i < removed.size(); ++i)
  {
    stage.inverse[static_cast<Index>(i)] = 1 / matrix.coeff(removed[i], removed[i]);
  }
  stage.coupling =
    sorted(assembleRows<double>(static_cast<int>(removed.size()), monitor,
             [&](int i, const auto& add)
             {
               for (CsrMatrix::InnerIterator entry(matrix, removed[i]); entry; ++entry)
               {
                 if (entry.col() != removed[i])
                 {
                   add(placeOfKept[entry.col()], entry.value());
                 }
               }
             }),
      width);
  stage.transposed = stage.coupling.transpose();
  // Own entries first, and factors that commute: the result is symmetric to the last bit.
  CsrMatrix rest = sorted(
    assembleRows<double>(static_cast<int>(width), monitor,
      [&](int i, const auto& add)
      {
        const int row = stage.kept[i];
        for (CsrMatrix::InnerIterator entry(matrix, row); entry; ++entry)
        {
          if (placeOfKept[entry.col()] >= 0)
          {
            add(placeOfKept[entry.col()], entry.value());
          }
        }
        for (CsrMatrix::InnerIterator entry(matrix, row); entry; ++entry)
        {
          const int r = placeOfRemoved[entry.col()];
          if (r < 0)
          {
            continue;
          }
          for (CsrMatrix::InnerIterator other(stage.coupling, r); other; ++other)
          {
            add(static_cast<int>(other.col()), -(entry.value() * other.value()) * stage.inverse[r]);
          }
        }
      }),
    width);
  matrix.swap(rest);
  return stage;
}

void CondensedSolver::prepare(CsrMatrix& matrix, const std::vector<bool>& removable,
  const ConstPoints& coordinates, Monitor& monitor)
{
  this->stages_.clear();
  this->components_ = {};
  Points places = coordinates;
  std::vector<bool> may = removable;
  std::vector<Index> ids(static_cast<std::size_t>(matrix.rows())); // of the remaining rows
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    ids[i] = static_cast<Index>(i);
  }
  for (int i = 0; i < MostStages && std::find(may.begin(), may.end(), true) != may.end(); ++i)
  {
    const std::vector<int> removed = choose(matrix, may);
    const auto count = static_cast<Index>(removed.size());
    if (LeastPart * count < matrix.rows() || count == matrix.rows())
    {
      break;
    }
    if (this->stages_.empty())
    {
      this->components_ = rowComponents(matrix);
    }
    monitor.check();
    Stage stage = condense(matrix, removed, monitor);
    places = Points(places(stage.kept, allColumns));
    for (std::size_t k = 0; k < stage.kept.size(); ++k)
    {
      may[k] = may[stage.kept[k]];
      ids[k] = ids[stage.kept[k]];
    }
    may.resize(stage.kept.size());
    ids.resize(stage.kept.size());
    this->stages_.push_back(std::move(stage));
  }
  try
  {
    this->solver_.prepare(matrix, places, monitor);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> rows;
    for (const Index row : error.rows())
    {
      rows.push_back(ids[static_cast<std::size_t>(row)]);
    }
    throw SingularRows(rows);
  }
}

SolveReport CondensedSolver::solve(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  return solveColumns(*this, b, x, tolerance, maxIterations, monitor);
}

SolveReport CondensedSolver::solve(
  const MultiVector& b, MultiVector& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  if (this->stages_.empty())
  {
    return this->solver_.solve(b, x, tolerance, maxIterations, monitor);
  }
  std::vector<MultiVector> given, found; // of each stage's remaining rows
  for (const Stage& stage : this->stages_)
  {
    const MultiVector& all = given.empty() ? b : given.back();
    MultiVector next = rowsOf(all, stage.kept, monitor);
    monitor.parallelFor(static_cast<Index>(next.size()), Grain,
      [&](Index first, Index last)
      {
        for (Index k = first; k < last; ++k)
        {
          for (CsrMatrix::InnerIterator entry(stage.transposed, static_cast<int>(k)); entry;
               ++entry)
          {
            const int r = static_cast<int>(entry.col());
            next[k] -= (entry.value() * stage.inverse[r]) * all[stage.removed[r]];
          }
        }
      });
    found.push_back(rowsOf(found.empty() ? x : found.back(), stage.kept, monitor));
    given.push_back(std::move(next));
  }
  const SolveReport report =
    this->solver_.solve(given.back(), found.back(), tolerance, maxIterations, monitor);
  for (std::size_t i = this->stages_.size(); i-- > 0;)
  {
    const Stage& stage = this->stages_[i];
    const MultiVector &right = i == 0 ? b : given[i - 1], &kept = found[i];
    MultiVector& all = i == 0 ? x : found[i - 1];
    monitor.parallelFor(static_cast<Index>(kept.size()), Grain,
      [&](Index first, Index last)
      {
        for (Index k = first; k < last; ++k)
        {
          all[stage.kept[k]] = kept[k];
        }
      });
    monitor.parallelFor(stage.coupling.rows(), Grain,
      [&](Index first, Index last)
      {
        for (Index r = first; r < last; ++r)
        {
          MultiVectorRow sum = right[stage.removed[r]];
          for (CsrMatrix::InnerIterator entry(stage.coupling, static_cast<int>(r)); entry; ++entry)
          {
            sum -= entry.value() * kept[entry.col()];
          }
          all[stage.removed[r]] = stage.inverse[r] * sum;
        }
      });
  }
  return report;
}

const RowComponents& CondensedSolver::components() const
{
  return this->stages_.empty() ? this->solver_.components() : this->components_;
}

std::size_t CondensedSolver::memory() const
{
  std::size_t bytes = this->solver_.memory() + sizeof(int) * this->components_.ofRow.size();
  for (const Stage& stage : this->stages_)
  {
    bytes +=
      sizeof(int) * (stage.kept.size() + 2 * stage.removed.size()) +
      sizeof(double) * stage.removed.size() +
      2 * (sizeof(int) + sizeof(double)) * static_cast<std::size_t>(stage.coupling.nonZeros());
  }
  return bytes;
}
}
