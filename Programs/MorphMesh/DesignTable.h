// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace morph_mesh
{
/// A table of designs: a column of weights for each shape.
struct DesignTable
{
  std::vector<std::vector<double>> rows; ///< #designs x #shapes
  std::vector<std::string> ignored;      ///< columns that are no shape's
};

/// Reads a table: a line of column names, then a line a design. Throws Failure where the file
/// cannot be read, a shape has no column or two, or a weight is no finite number.
DesignTable readTable(const std::string& path, const std::vector<std::string>& shapes);
}
