// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/AbaqusKeyword.h"

#include "Text/Lines.h"

#include <algorithm>
#include <cctype>

namespace morph::io
{
std::string upperCase(std::string_view text)
{
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
    [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

std::string unquoted(std::string_view label)
{
  std::string result(label);
  result.erase(std::remove(result.begin(), result.end(), '"'), result.end());
  return result;
}

std::string AbaqusKeyword::value(const std::string& parameter, bool upper) const
{
  const auto found = this->parameters.find(parameter);
  if (found == this->parameters.end())
  {
    return "";
  }
  return upper ? upperCase(found->second) : found->second;
}

AbaqusKeyword parseAbaqusKeyword(std::string_view line)
{
  AbaqusKeyword keyword;
  std::vector<Span> parts;
  splitAtCommas(line, { 0, line.size() }, parts);
  std::vector<Span> words;
  splitAtBlanks(line, parts.front(), words);
  for (const Span& word : words)
  {
    keyword.name += (keyword.name.empty() ? "" : " ") + upperCase(word.of(line));
  }
  for (std::size_t i = 1; i < parts.size(); ++i)
  {
    const std::string_view part = parts[i].of(line);
    const std::size_t equals = part.find('=');
    if (!part.empty())
    {
      keyword.parameters[upperCase(trimmed(part.substr(0, equals)))] =
        equals == std::string_view::npos ? "" : unquoted(trimmed(part.substr(equals + 1)));
    }
  }
  return keyword;
}
}
