// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace morph_mesh
{
/// A line of a table.
struct TableLine
{
  std::string where; ///< "nodes.csv, line 3: "
  std::string text;
  std::vector<std::string> fields;
};

/// Splits a line; fields may be quoted, and lose blanks around them.
std::vector<std::string> splitLine(const std::string& line, char separator = ',');

/// The lines of a table, as spreadsheets write it, that are not empty. The first has the names of
/// the columns. Fields are between semicolons, commas or tabs, the first of these that the first
/// line has; where it is not the comma, commas are decimal signs. A byte order mark is skipped.
/// Throws Failure where it cannot be read, is empty, or a line has another number of fields than
/// the first; empty ones at its end do not count.
std::vector<TableLine> readLines(const std::string& path);

/// The finite decimal number that a text is, if it is one.
std::optional<double> decimal(const std::string& text);

/// The number in a field. Throws Failure where it is no finite number.
double numberIn(const TableLine& line, std::size_t field);

/// A line of a table: its numbers in the columns that were asked for.
struct NumberLine
{
  std::string where; ///< "nodes.csv, line 3: "
  std::vector<double> numbers;
};

/// Reads the columns of these names, which the first line of a table has in any order, in small or
/// large letters. A name that begins with '?' may be missing: its number is then 0. Throws Failure
/// as readLines() and numberIn() do, and for a column that is missing.
std::vector<NumberLine> readNumbers(
  const std::string& path, const std::vector<std::string>& columns);
}
