// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/SparseCore>

namespace morph
{
/// A sparse matrix in compressed rows, 12 bytes an entry.
using CsrMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Throws Error if an int cannot number the entries.
void requireEntries(Index entries);

/// Gives `matrix` the size rows x width and room for `entries`. Starts of rows, columns and values
/// are not set. Throws Error as requireEntries().
void allocateRows(CsrMatrix& matrix, Index rows, Index width, Index entries);
}
