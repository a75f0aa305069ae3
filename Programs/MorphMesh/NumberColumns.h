// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace morph_mesh
{
/// A line of a file of comma-separated values: its numbers in the columns that were asked for.
struct NumberLine
{
  std::string where; ///< "nodes.csv, line 3: "
  std::vector<double> numbers;
};

/// Reads the columns of these names, which the file's first line has in any order. A name that
/// begins with '?' may be missing: its number is then 0. Empty lines are skipped. Throws Failure
/// for a file that cannot be read, a column that is missing, and what is no finite number.
std::vector<NumberLine> readNumbers(
  const std::string& path, const std::vector<std::string>& columns);
}
