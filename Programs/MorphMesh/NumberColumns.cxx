// SPDX-License-Identifier: BSD-3-Clause
#include "NumberColumns.h"

#include "Messages.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace morph_mesh
{
namespace
{
constexpr std::size_t Missing = static_cast<std::size_t>(-1);

std::string listOf(const std::vector<std::string>& names)
{
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const bool isOptional = names[i].front() == '?';
    list += i == 0 ? "" : i + 1 == names.size() ? " and " : ", ";
    list += isOptional ? names[i].substr(1) + " (optional)" : names[i];
  }
  return list;
}

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos
           ? std::string()
           : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A line for a message, which may be long.
std::string cited(const std::string& line)
{
  return "'" + trimmed(line.size() > 80 ? line.substr(0, 80) + "..." : line) + "'";
}

std::vector<std::size_t> placesOf(const std::vector<std::string>& names, const TableLine& header)
{
  std::vector<std::string> found = header.fields;
  for (std::string& name : found)
  {
    name = vtksys::SystemTools::LowerCase(name);
  }
  std::vector<std::size_t> places;
  for (const std::string& name : names)
  {
    const bool isOptional = name.front() == '?';
    const auto at = std::find(found.begin(), found.end(), isOptional ? name.substr(1) : name);
    if (at == found.end() && !isOptional)
    {
      throw Failure(header.where + "there is no column " + name + " in " + cited(header.text) +
                    ". The columns " + listOf(names) +
                    " are needed, with commas, semicolons or tabs between them.");
    }
    places.push_back(at == found.end() ? Missing : static_cast<std::size_t>(at - found.begin()));
  }
  return places;
}
}

std::vector<std::string> splitLine(const std::string& line, char separator)
{
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line)
  {
    if (c == '"')
    {
      quoted = !quoted;
    }
    else if (c == separator && !quoted)
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

std::vector<TableLine> readLines(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
  {
    throw Failure("Cannot read " + path +
                  (std::filesystem::exists(path) ? ": the system does not give its content."
                                                 : ": there is no such file."));
  }
  std::ostringstream whole;
  whole << file.rdbuf();
  std::string content = whole.str();
  if (content.find('\0') != std::string::npos)
  {
    throw Failure(
      "Cannot read " + path + ": it is no text in UTF-8. Save it as CSV UTF-8 (comma delimited).");
  }
  if (content.rfind("\xef\xbb\xbf", 0) == 0) // byte order mark of UTF-8
  {
    content.erase(0, 3);
  }
  std::vector<TableLine> lines;
  char separator = ',';
  std::istringstream rest(content);
  const char end = content.find('\n') == std::string::npos ? '\r' : '\n';
  std::string text;
  for (int number = 1; std::getline(rest, text, end); ++number)
  {
    if (number == 1 && text.rfind("sep=", 0) == 0)
    {
      continue; // what Excel has before the table
    }
    if (lines.empty())
    {
      separator = text.find(';') != std::string::npos   ? ';'
                  : text.find(',') != std::string::npos ? ','
                                                        : '\t';
    }
    TableLine line{ path + ", line " + std::to_string(number) + ": ", text,
      splitLine(text, separator) };
    if (std::all_of(line.fields.begin(), line.fields.end(),
          [](const std::string& field) { return field.empty(); }))
    {
      continue;
    }
    const std::size_t columns = lines.empty() ? line.fields.size() : lines.front().fields.size();
    while (line.fields.size() > columns && line.fields.back().empty())
    {
      line.fields.pop_back();
    }
    if (line.fields.size() != columns)
    {
      throw Failure(line.where + cited(text) + " has " + std::to_string(line.fields.size()) +
                    " columns; the first line has " + std::to_string(columns) + ".");
    }
    if (separator != ',' && !lines.empty())
    {
      for (std::string& field : line.fields)
      {
        std::replace(field.begin(), field.end(), ',', '.'); // decimal signs
      }
    }
    lines.push_back(std::move(line));
  }
  if (lines.empty())
  {
    throw Failure("Cannot read " + path + ": the table is empty.");
  }
  return lines;
}

std::optional<double> decimal(const std::string& text)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const bool isHexadecimal = text.find_first_of("xX") != std::string::npos;
  return text.empty() || *end != '\0' || isHexadecimal || !std::isfinite(number)
           ? std::nullopt
           : std::optional(number);
}

double numberIn(const TableLine& line, std::size_t field)
{
  const std::string& text = line.fields[field];
  const std::optional<double> number = decimal(text);
  if (!number)
  {
    throw Failure(line.where + "'" + text + "' is no finite number, in " + cited(line.text) + ".");
  }
  return *number;
}

std::vector<NumberLine> readNumbers(
  const std::string& path, const std::vector<std::string>& columns)
{
  const std::vector<TableLine> lines = readLines(path);
  const std::vector<std::size_t> places = placesOf(columns, lines.front());
  std::vector<NumberLine> result;
  for (auto line = lines.begin() + 1; line != lines.end(); ++line)
  {
    NumberLine& next = result.emplace_back();
    next.where = line->where;
    for (const std::size_t place : places)
    {
      next.numbers.push_back(place == Missing ? 0 : numberIn(*line, place));
    }
  }
  return result;
}
}
