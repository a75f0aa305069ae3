// SPDX-License-Identifier: BSD-3-Clause
#include "DesignTable.h"

#include "Messages.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace morph_mesh
{
namespace
{
std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos
           ? std::string()
           : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::size_t columnOf(
  const std::vector<std::string>& header, const std::string& shape, const std::string& path)
{
  const auto found = std::find(header.begin(), header.end(), shape);
  if (found == header.end())
  {
    throw Failure(path + " has no column '" + shape + "', the name of a shape's file.");
  }
  if (std::find(found + 1, header.end(), shape) != header.end())
  {
    throw Failure(path + " has two columns '" + shape + "'.");
  }
  return found - header.begin();
}

double weight(const std::string& text, const std::string& place)
{
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
  {
    throw Failure(place + ": '" + text + "' is no finite number.");
  }
  return value;
}
}

std::vector<std::string> splitLine(const std::string& line)
{
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line)
  {
    if (c == '"')
    {
      quoted = !quoted;
    }
    else if (c == ',' && !quoted)
    {
      fields.emplace_back();
    }
    else
    {
      fields.back() += c;
    }
  }
  std::transform(fields.begin(), fields.end(), fields.begin(), trimmed);
  return fields;
}

DesignTable readTable(const std::string& path, const std::vector<std::string>& shapes)
{
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line))
  {
    throw Failure("Cannot read " + path + ": it does not exist, or is empty.");
  }
  const std::vector<std::string> header = splitLine(line);
  std::vector<std::size_t> columns;
  for (const std::string& shape : shapes)
  {
    columns.push_back(columnOf(header, shape, path));
  }
  DesignTable table;
  std::copy_if(header.begin(), header.end(), std::back_inserter(table.ignored),
    [&](const std::string& name)
    { return std::find(shapes.begin(), shapes.end(), name) == shapes.end(); });
  for (int number = 2; std::getline(file, line); ++number)
  {
    if (trimmed(line).empty())
    {
      continue;
    }
    const std::string place = path + ", line " + std::to_string(number);
    const std::vector<std::string> fields = splitLine(line);
    if (fields.size() != header.size())
    {
      throw Failure(place + " has " + std::to_string(fields.size()) + " columns; the first has " +
                    std::to_string(header.size()) + ".");
    }
    std::vector<double>& row = table.rows.emplace_back();
    for (std::size_t i = 0; i < columns.size(); ++i)
    {
      row.push_back(weight(fields[columns[i]], place + ", column " + shapes[i]));
    }
  }
  if (table.rows.empty())
  {
    throw Failure(path + " has no design: give a line of weights for each.");
  }
  return table;
}
}
