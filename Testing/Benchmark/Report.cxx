// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace benchmark
{
namespace
{
std::string number(double value, const char* format = "%.4g")
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

const char* relation(const Target& target)
{
  switch (target.kind)
  {
    case Target::Kind::AtLeast:
      return ">=";
    case Target::Kind::AtMost:
      return "<=";
    case Target::Kind::None:
      break;
  }
  return "";
}

/// "yes", "no", or nothing without a target. A figure that is not a number meets none.
const char* met(const Target& target, double measured)
{
  switch (target.kind)
  {
    case Target::Kind::AtLeast:
      return measured >= target.value ? "yes" : "no";
    case Target::Kind::AtMost:
      return measured <= target.value ? "yes" : "no";
    case Target::Kind::None:
      break;
  }
  return "";
}

using Line = std::array<std::string, 5>;

std::string align(const std::vector<Line>& lines)
{
  std::array<std::size_t, 5> width = {};
  for (const Line& line : lines)
  {
    for (std::size_t c = 0; c < line.size(); ++c)
    {
      width[c] = std::max(width[c], line[c].size());
    }
  }
  std::string text;
  for (const Line& line : lines)
  {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c)
    {
      const std::string pad(width[c] - line[c].size(), ' ');
      const bool right = c == 1 || c == 2; // the numbers
      row += (c ? "  " : "") + (right ? pad + line[c] : line[c] + pad);
    }
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}
}

void Report::add(const std::string& figure, double measured, const std::string& unit, Target target)
{
  this->rows_.push_back({ figure, measured, unit, target });
}

std::string Report::table() const
{
  std::vector<Line> judged = { { "figure", "target", "measured", "unit", "met" } };
  std::vector<Line> others;
  for (const Row& row : this->rows_)
  {
    if (row.target.kind == Target::Kind::None)
    {
      others.push_back({ row.figure, "", number(row.measured), row.unit, "" });
    }
    else
    {
      judged.push_back(
        { row.figure, std::string(relation(row.target)) + " " + number(row.target.value),
          number(row.measured), row.unit, met(row.target, row.measured) });
    }
  }
  judged.push_back({});
  judged.insert(judged.end(), others.begin(), others.end());
  return align(judged);
}

void Report::writeCsv(const std::string& file) const
{
  std::ofstream stream(file);
  stream << "figure,unit,relation,target,measured,met\n";
  for (const Row& row : this->rows_)
  {
    const bool judged = row.target.kind != Target::Kind::None;
    stream << '"' << row.figure << "\"," << row.unit << ',' << relation(row.target) << ','
           << (judged ? number(row.target.value, "%.10g") : "") << ','
           << number(row.measured, "%.10g") << ',' << met(row.target, row.measured) << '\n';
  }
  stream.flush();
  if (!stream)
  {
    throw std::runtime_error("Cannot write " + file + ".");
  }
}
}
