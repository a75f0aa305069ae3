// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/SparseCore>

#include <vector>

namespace morph
{
/// Compressed rows, 12 bytes an entry.
using CsrMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Throws Error for more entries than an int can number.
void requireEntries(Index entries);

/// Gives `matrix` the size (#sizes - 1) x width with room for sizes[i + 1] entries in row i,
/// columns and values not set; sizes[0] is 0. Throws Error as requireEntries().
void allocateRows(CsrMatrix& matrix, Index width, const std::vector<int>& sizes);
}
