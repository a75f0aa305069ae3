// SPDX-License-Identifier: BSD-3-Clause
#include "Text/NumberPlaces.h"

#include "Support/Error.h"
#include "Text/NumberText.h"

#include <algorithm>
#include <cmath>

namespace morph::io
{
namespace
{
using Field = NumberRules::Field;

[[noreturn]] void refuse(const std::string& text, const NumberChange& change)
{
  const auto line = 1 + std::count(text.begin(),
                          text.begin() + static_cast<std::ptrdiff_t>(change.place.begin), '\n');
  throw Error("The coordinate " + std::to_string(change.value) + " does not fit into line " +
              std::to_string(line) + ". Choose a format with wider fields, or another unit.");
}

std::string fixedText(
  const std::string& text, const NumberChange& change, std::string_view old, std::string& number)
{
  const NumberPlace& place = change.place;
  const std::size_t width = std::max<std::size_t>(place.length, change.rules.width);
  const auto fitting = fittingNumber(change.value, width, change.rules.shortExponent);
  if (!fitting)
  {
    refuse(text, change);
  }
  number = *fitting;
  const std::string blanks(width - number.size(), ' ');
  const bool isLeft = old.empty() || old[0] != ' ';
  return isLeft ? number + blanks : blanks + number;
}

std::string freeNumber(const std::string& text, const NumberChange& change, std::string_view old)
{
  std::string number = exactNumber(change.value, old);
  const std::size_t longest = std::max(change.rules.longest, old.size());
  if (change.rules.longest > 0 && number.size() > longest)
  {
    const auto fitting = fittingNumber(change.value, longest, change.rules.shortExponent);
    if (!fitting)
    {
      refuse(text, change);
    }
    number = *fitting;
  }
  return number;
}

/// Removes or adds blanks before a free number, so that columns keep their right edge.
void align(std::string& result, std::size_t written, std::size_t old)
{
  const std::size_t end = result.find_last_not_of(' ');
  const std::size_t blanks = end == std::string::npos ? 0 : result.size() - end - 1;
  if (blanks < 2)
  {
    return;
  }
  if (written > old)
  {
    result.resize(result.size() - std::min(blanks - 1, written - old));
  }
  else
  {
    result.append(old - written, ' ');
  }
}
}

NumberField fixedField(std::string_view text, Span line, std::size_t column, std::size_t width)
{
  const std::size_t at = line.begin + column;
  const std::size_t begin = std::min(at, line.end), end = std::min(at + width, line.end);
  NumberField field;
  field.width = width;
  field.span = trimmed(text, { begin, end });
  field.place.begin = begin;
  field.place.length = static_cast<std::uint32_t>(end - begin);
  field.place.missing = static_cast<std::uint32_t>(at - begin);
  return field;
}

NumberField tabbedField(std::string_view text, Span line, std::size_t column, std::size_t width)
{
  if (line.of(text).find('\t') == std::string_view::npos)
  {
    return fixedField(text, line, column, width);
  }
  std::size_t at = line.begin, reached = 0;
  const auto goTo = [&](std::size_t aim)
  {
    for (; at < line.end && reached < aim; ++at)
    {
      reached = text[at] == '\t' ? (reached / 8 + 1) * 8 : reached + 1;
    }
    return at;
  };
  const std::size_t begin = goTo(column), missing = column - std::min(column, reached);
  NumberField field = fixedField(text, { begin, goTo(column + width) }, 0, width);
  field.place.missing = static_cast<std::uint32_t>(missing);
  return field;
}

void freeFields(
  std::string_view text, Span line, std::size_t least, std::vector<NumberField>& fields)
{
  fields.clear();
  for (std::size_t begin = line.begin; begin <= line.end;)
  {
    const std::size_t comma = std::min(text.substr(0, line.end).find(',', begin), line.end);
    NumberField field;
    field.span = trimmed(text, { begin, comma });
    field.place.begin = field.span.begin;
    field.place.length = static_cast<std::uint32_t>(field.span.size());
    fields.push_back(field);
    begin = comma + 1;
  }
  const std::size_t end = fields.back().span.end;
  NumberField beyond;
  beyond.span = { end, end };
  beyond.place.begin = end;
  beyond.place.missing = 1;
  fields.resize(std::max(least, fields.size()), beyond);
}

std::string withNumbers(
  const std::string& text, const std::vector<NumberChange>& changes, double& largestRounding)
{
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  std::size_t at = 0;
  for (const NumberChange& change : changes)
  {
    const NumberPlace& place = change.place;
    const std::string_view old = std::string_view(text).substr(place.begin, place.length);
    result.append(text, at, place.begin - at);
    at = place.begin + place.length;
    result.append(place.missing, change.rules.separator);
    if (change.rules.field == Field::Fixed)
    {
      std::string number;
      const std::string field = fixedText(text, change, old, number);
      result += field;
      largestRounding =
        std::max(largestRounding, std::abs(parseNumber(number).value_or(0) - change.value));
      continue;
    }
    const std::string number = freeNumber(text, change, old);
    if (place.missing == 0)
    {
      align(result, number.size(), place.length);
    }
    result += number;
    largestRounding =
      std::max(largestRounding, std::abs(parseNumber(number).value_or(0) - change.value));
  }
  result.append(text, at, std::string::npos);
  return result;
}
}
