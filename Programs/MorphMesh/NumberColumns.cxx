// SPDX-License-Identifier: BSD-3-Clause
#include "NumberColumns.h"

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

std::vector<std::size_t> placesOf(
  const std::vector<std::string>& names, const std::string& header, const std::string& path)
{
  const std::vector<std::string> found = splitLine(header);
  std::vector<std::size_t> places;
  for (const std::string& name : names)
  {
    const bool isOptional = name.front() == '?';
    const auto at = std::find(found.begin(), found.end(), isOptional ? name.substr(1) : name);
    if (at == found.end() && !isOptional)
    {
      throw Failure(path + ", line 1: there is no column " + name + ". The columns " +
                    listOf(names) + " are needed.");
    }
    places.push_back(at == found.end() ? Missing : static_cast<std::size_t>(at - found.begin()));
  }
  return places;
}

double numberOf(const std::string& text, const std::string& where)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(number))
  {
    throw Failure(where + "'" + text + "' is no number.");
  }
  return number;
}
}

std::vector<NumberLine> readNumbers(
  const std::string& path, const std::vector<std::string>& columns)
{
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line))
  {
    throw Failure("Cannot read " + path + ", or it is empty.");
  }
  const std::vector<std::size_t> places = placesOf(columns, line, path);
  std::vector<NumberLine> lines;
  for (int number = 2; std::getline(file, line); ++number)
  {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
    {
      continue;
    }
    NumberLine next{ path + ", line " + std::to_string(number) + ": ", {} };
    const std::vector<std::string> fields = splitLine(line);
    for (const std::size_t place : places)
    {
      next.numbers.push_back(
        place == Missing ? 0 : numberOf(place < fields.size() ? fields[place] : "", next.where));
    }
    lines.push_back(next);
  }
  return lines;
}
}
