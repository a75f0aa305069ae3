// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace morph
{
using Index = std::int64_t; ///< node and cell ids; as wide as vtkIdType

/// n x 3 coordinates or vectors, one row per node: the memory layout of a double vtkPoints array.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Read-only argument: binds to Points and to an Eigen::Map over foreign memory without a copy.
using ConstPoints = Eigen::Ref<const Points>;

/// points(ids, allColumns) are the rows `ids`. Eigen 5 has no Eigen::all; 3.4 deprecates the other.
#if EIGEN_MAJOR_VERSION < 5
static const auto allColumns = Eigen::all;
#else
static const auto allColumns = Eigen::placeholders::all;
#endif
}
