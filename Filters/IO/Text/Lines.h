// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace morph::io
{
/// A part of a text.
struct Span
{
  std::size_t begin = 0, end = 0;

  std::size_t size() const { return this->end - this->begin; }
  std::string_view of(std::string_view text) const
  {
    return text.substr(this->begin, this->size());
  }
};

/// Goes through the lines of a text. Lines end with a line feed, or with a carriage return and a
/// line feed; neither belongs to the line, nor does a byte order mark at the beginning.
class Lines
{
public:
  explicit Lines(std::string_view text, std::size_t at = 0);
  /// Moves to the next line; false after the last one.
  bool next();
  Span span() const { return this->span_; }
  std::string_view line() const { return this->span_.of(this->text_); }
  int number() const { return this->number_; }   ///< from 1
  std::size_t at() const { return this->next_; } ///< where the next line begins

private:
  std::string_view text_;
  std::size_t next_ = 0;
  Span span_;
  int number_ = 0;
};

/// The part of `span` without blanks and tabs around it.
Span trimmed(std::string_view text, Span span);
std::string_view trimmed(std::string_view text);

/// The parts between commas, trimmed; one for an empty text.
void splitAtCommas(std::string_view text, Span span, std::vector<Span>& parts);

/// The parts between blanks and tabs, none of them empty.
void splitAtBlanks(std::string_view text, Span span, std::vector<Span>& parts);
}
