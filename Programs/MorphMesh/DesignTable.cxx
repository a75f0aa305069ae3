// SPDX-License-Identifier: BSD-3-Clause
#include "DesignTable.h"

#include "Messages.h"
#include "NumberColumns.h"

#include <algorithm>

namespace morph_mesh
{
namespace
{
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
}

DesignTable readTable(const std::string& path, const std::vector<std::string>& shapes)
{
  const std::vector<TableLine> lines = readLines(path);
  const std::vector<std::string>& header = lines.front().fields;
  std::vector<std::size_t> columns;
  for (const std::string& shape : shapes)
  {
    columns.push_back(columnOf(header, shape, path));
  }
  DesignTable table;
  std::copy_if(header.begin(), header.end(), std::back_inserter(table.ignored),
    [&](const std::string& name)
    { return std::find(shapes.begin(), shapes.end(), name) == shapes.end(); });
  for (auto line = lines.begin() + 1; line != lines.end(); ++line)
  {
    std::vector<double>& row = table.rows.emplace_back();
    for (const std::size_t column : columns)
    {
      row.push_back(numberIn(*line, column));
    }
  }
  if (table.rows.empty())
  {
    throw Failure(path + " has no design: give a line of weights for each.");
  }
  return table;
}
}
