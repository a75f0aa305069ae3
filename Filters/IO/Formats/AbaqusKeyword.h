// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace morph::io
{
/// A keyword line of an input file: "*ELEMENT, TYPE=C3D8, ELSET=Block".
struct AbaqusKeyword
{
  std::string name;                              ///< upper case, single blanks: "NODE PRINT"
  std::map<std::string, std::string> parameters; ///< names in upper case; values as written

  bool has(const std::string& parameter) const { return this->parameters.count(parameter) > 0; }
  /// Its value, in upper case where `upper`; empty where it is not given.
  std::string value(const std::string& parameter, bool upper = false) const;
};

/// `line`: with its continuation lines, without the star.
AbaqusKeyword parseAbaqusKeyword(std::string_view line);

std::string upperCase(std::string_view text);
/// A label without its quotes, which it needs where it has blanks: "my part"."my set".
std::string unquoted(std::string_view label);
}
