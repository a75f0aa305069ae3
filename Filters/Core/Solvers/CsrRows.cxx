// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CsrRows.h"

#include "Solvers/AssembleRows.h"
#include "Support/HugePages.h"

#include <numeric>

namespace morph
{
namespace
{
template <typename ScalarA, typename ScalarB>
CsrRows<double> multiply(
  const CsrRows<ScalarA>& A, const CsrRows<ScalarB>& B, int columns, Monitor& monitor)
{
  return assembleRows<double>(A.rows, columns, monitor,
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

CsrRows<double> product(
  const CsrRows<double>& A, const CsrRows<float>& B, int columns, Monitor& monitor)
{
  return multiply(A, B, columns, monitor);
}

CsrRows<double> product(
  const CsrRows<float>& A, const CsrRows<double>& B, int columns, Monitor& monitor)
{
  return multiply(A, B, columns, monitor);
}
}
