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

/// Reads a CSV file: a line of column names, then a line a design. Columns are found by their
/// names, which may be quoted. Throws Failure where the file cannot be read, a shape has no column
/// or two, a line has another number of columns, or a weight is no finite number.
DesignTable readTable(const std::string& path, const std::vector<std::string>& shapes);

/// Splits a line of a CSV file at its commas; fields may be quoted, and lose blanks around them.
std::vector<std::string> splitLine(const std::string& line);
}
