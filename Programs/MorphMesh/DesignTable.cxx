// SPDX-License-Identifier: BSD-3-Clause
#include "DesignTable.h"

#include "Messages.h"
#include "NumberColumns.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>

namespace morph_mesh
{
namespace
{
/// The column of a shape: of its name, or, if there is none, of its name in other letters.
std::size_t columnOf(
  const std::vector<std::string>& header, const std::string& shape, const std::string& path)
{
  const auto lower = [](const std::string& name) { return vtksys::SystemTools::LowerCase(name); };
  const bool isExact = std::find(header.begin(), header.end(), shape) != header.end();
  const auto isOf = [&](const std::string& name)
  { return isExact ? name == shape : lower(name) == lower(shape); };
  const auto found = std::find_if(header.begin(), header.end(), isOf);
  if (found == header.end())
  {
    throw Failure(path + " has no column '" + shape + "', the name of a shape's file.");
  }
  if (std::find_if(found + 1, header.end(), isOf) != header.end())
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
  for (std::size_t i = 0; i < header.size(); ++i)
  {
    if (std::find(columns.begin(), columns.end(), i) == columns.end())
    {
      table.ignored.push_back(header[i]);
    }
  }
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
