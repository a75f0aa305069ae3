// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/IncompleteLU.h"

#include <algorithm>
#include <cmath>

namespace morph
{
IncompleteLU::IncompleteLU(const CsrMatrix& matrix)
  : matrix_(&matrix)
  , value_(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros())
  , diagonal_(matrix.rows())
{
  constexpr double SmallestPivot = 1e-8; // of the diagonal entry
  const int* start = matrix.outerIndexPtr();
  const int* column = matrix.innerIndexPtr();
  std::vector<int> place(matrix.cols(), -1);
  for (int i = 0; i < matrix.rows(); ++i)
  {
    this->diagonal_[i] =
      static_cast<int>(std::lower_bound(column + start[i], column + start[i + 1], i) - column);
    for (int k = start[i]; k < start[i + 1]; ++k)
    {
      place[column[k]] = k;
    }
    for (int k = start[i]; k < this->diagonal_[i]; ++k)
    {
      const int j = column[k];
      this->value_[k] *= this->value_[this->diagonal_[j]];
      for (int m = this->diagonal_[j] + 1; m < start[j + 1]; ++m)
      {
        if (place[column[m]] >= 0)
        {
          this->value_[place[column[m]]] -= this->value_[k] * this->value_[m];
        }
      }
    }
    for (int k = start[i]; k < start[i + 1]; ++k)
    {
      place[column[k]] = -1;
    }
    const double entry = matrix.valuePtr()[this->diagonal_[i]];
    double& pivot = this->value_[this->diagonal_[i]];
    pivot = 1 / (std::abs(pivot) > SmallestPivot * entry ? pivot : entry);
  }
}

void IncompleteLU::apply(MultiVector& x) const
{
  const int* start = this->matrix_->outerIndexPtr();
  const int* column = this->matrix_->innerIndexPtr();
  const int rows = static_cast<int>(this->matrix_->rows());
  for (int i = 0; i < rows; ++i)
  {
    for (int k = start[i]; k < this->diagonal_[i]; ++k)
    {
      x[i] -= this->value_[k] * x[column[k]];
    }
  }
  for (int i = rows - 1; i >= 0; --i)
  {
    for (int k = this->diagonal_[i] + 1; k < start[i + 1]; ++k)
    {
      x[i] -= this->value_[k] * x[column[k]];
    }
    x[i] *= this->value_[this->diagonal_[i]];
  }
}
}
