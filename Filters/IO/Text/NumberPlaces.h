// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Text/Lines.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace morph::io
{
/// Where a text has a number, or lacks one.
struct NumberPlace
{
  std::uint64_t begin = 0;
  std::uint32_t length = 0;
  std::uint32_t missing = 0; ///< characters to add before it, where the line is too short
};

/// A field of a line, and where a number may take its place.
struct NumberField
{
  Span span; ///< its characters without blanks around them
  NumberPlace place;
  std::size_t width = 0; ///< of a fixed field; 0: between commas
};

/// The field of a line that begins at a column, from 0 on; the line may end before it.
NumberField fixedField(std::string_view text, Span line, std::size_t column, std::size_t width);
/// The same in a line with tabs, each of which goes on to the next column that 8 divides.
NumberField tabbedField(std::string_view text, Span line, std::size_t column, std::size_t width);
/// Sets the fields of a line between commas; those beyond it are empty, up to `least` of them.
void freeFields(
  std::string_view text, Span line, std::size_t least, std::vector<NumberField>& fields);

/// How the numbers of a text may be written.
struct NumberRules
{
  enum class Field
  {
    Free,  ///< of any length: the line grows where it must
    Fixed, ///< of a fixed width
  };
  Field field = Field::Free;
  std::size_t width = 0;      ///< of a fixed field, where its line ends in it
  std::size_t longest = 0;    ///< of a free field, or that of the old number; 0: no limit
  bool shortExponent = false; ///< as Nastran allows
  char separator = ' ';       ///< what is added where a number is missing
};

/// A number that takes the place of another.
struct NumberChange
{
  NumberPlace place;
  double value = 0;
  NumberRules rules;
};

/// Replaces numbers in a text, and changes no other byte. `changes`: ascending by place. A number
/// in a free field is written exactly unless `longest` forbids; one in a fixed field as precisely
/// as its place allows, on the side where the old one was. Sets `largestRounding` to the largest
/// difference between a value and what is written, where that is larger. Throws Error with the line
/// of a number that does not fit.
std::string withNumbers(
  const std::string& text, const std::vector<NumberChange>& changes, double& largestRounding);
}
