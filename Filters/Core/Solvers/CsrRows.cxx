// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CsrRows.h"

#include "Solvers/AssembleRows.h"
#include "Solvers/ColumnMap.h"
#include "Solvers/MixedPrecisionMatrix.h"
#include "Support/HugePages.h"

#include <cmath>
#include <numeric>

namespace morph
{
namespace
{
/// Calls add(column, value times entry) for the entries of a row of B.
///@{
template <typename Scalar, typename Add>
void addRow(const CsrRows<Scalar>& B, int row, double value, const Add& add)
{
  for (int k = B.start[row]; k < B.start[row + 1]; ++k)
  {
    add(B.column[k], value * B.value[k]);
  }
}
template <typename Add>
void addRow(const MixedPrecisionMatrix& B, int row, double value, const Add& add)
{
  const CsrRows<float>& rows = B.rounded();
  for (int k = rows.start[row]; k < rows.start[row + 1]; ++k)
  {
    add(rows.column[k], value * B.inUnits(k));
  }
}
///@}

/// A row in work, whose entries have any order.
class SparseRow
{
public:
  explicit SparseRow(int columns)
    : columns_(columns)
  {
  }
  void clear()
  {
    this->columns_.clear();
    this->values_.clear();
  }
  void add(int column, double value)
  {
    const std::size_t at = this->columns_.localIndex(column);
    if (at == this->values_.size())
    {
      this->values_.push_back(0);
    }
    this->values_[at] += value;
  }
  int size() const { return this->columns_.size(); }
  int column(int at) const { return this->columns_.column(at); }
  double value(int at) const { return this->values_[at]; }

private:
  ColumnMap columns_;
  std::vector<double> values_;
};

template <typename Matrix>
CsrRows<double> productOfThree(
  const CsrRows<float>& R, const Matrix& A, const CsrRows<float>& P, int columns, Monitor& monitor)
{
  return assembleRows<double>(R.rows, columns, monitor,
    [&]
    {
      return [&, RA = SparseRow(P.rows)](int i, const auto& add) mutable
      {
        RA.clear();
        const auto addToRA = [&RA](int column, double value) { RA.add(column, value); };
        for (int k = R.start[i]; k < R.start[i + 1]; ++k)
        {
          addRow(A, R.column[k], R.value[k], addToRA);
        }
        for (int k = 0; k < RA.size(); ++k)
        {
          addRow(P, RA.column(k), RA.value(k), add);
        }
      };
    });
}
}

void absoluteRowSums(const CsrRows<float>& A, std::vector<float>& sums, Monitor& monitor)
{
  constexpr Index Grain = 4096;
  sums.resize(A.rows);
  monitor.parallelFor(A.rows, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        float sum = 0;
        for (int k = A.start[i]; k < A.start[i + 1]; ++k)
        {
          sum += std::abs(A.value[k]);
        }
        sums[i] = sum;
      }
    });
}

CsrRows<float> transpose(const CsrRows<float>& A, int columns)
{
  CsrRows<float> result;
  result.rows = columns;
  result.ownStart.assign(columns + 1, 0);
  const std::size_t entries = A.entries();
  for (std::size_t k = 0; k < entries; ++k)
  {
    ++result.ownStart[A.column[k] + 1];
  }
  std::partial_sum(result.ownStart.begin(), result.ownStart.end(), result.ownStart.begin());
  resizeUndefined(result.ownColumn, static_cast<Index>(entries));
  resizeUndefined(result.ownValue, static_cast<Index>(entries));
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

CsrRows<double> tripleProduct(const CsrRows<float>& R, const CsrRows<double>& A,
  const CsrRows<float>& P, int columns, Monitor& monitor)
{
  return productOfThree(R, A, P, columns, monitor);
}

CsrRows<double> tripleProduct(const CsrRows<float>& R, const MixedPrecisionMatrix& A,
  const CsrRows<float>& P, int columns, Monitor& monitor)
{
  return productOfThree(R, A, P, columns, monitor);
}
}
