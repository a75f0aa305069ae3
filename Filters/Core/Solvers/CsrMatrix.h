// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/SparseCore>

#include <vector>

namespace morph
{
/// A sparse matrix in compressed rows, 12 bytes an entry.
using CsrMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Throws Error if an int cannot number the entries.
void requireEntries(Index entries);

/// Gives `matrix` the size (#sizes - 1) x width and allocates sizes[i + 1] entries in row i;
/// sizes[0] is 0. Columns and values are not set. Throws Error as requireEntries().
void allocateRows(CsrMatrix& matrix, Index width, const std::vector<int>& sizes);
}
