// SPDX-License-Identifier: BSD-3-Clause
#include "Text/Lines.h"

#include <algorithm>

namespace morph::io
{
namespace
{
bool isBlank(char c)
{
  return c == ' ' || c == '\t' || c == '\r';
}
}

Lines::Lines(std::string_view text, std::size_t at)
  : text_(text)
  , next_(at)
{
  if (at == 0 && text.substr(0, 3) == "\xef\xbb\xbf")
  {
    this->next_ = 3;
  }
}

bool Lines::next()
{
  if (this->next_ >= this->text_.size())
  {
    return false;
  }
  this->span_.begin = this->next_;
  const std::size_t feed = std::min(this->text_.find('\n', this->next_), this->text_.size());
  this->next_ = feed + 1;
  const bool hasReturn = feed > this->span_.begin && this->text_[feed - 1] == '\r';
  this->span_.end = feed - (hasReturn ? 1 : 0);
  ++this->number_;
  return true;
}

Span trimmed(std::string_view text, Span span)
{
  while (span.begin < span.end && isBlank(text[span.begin]))
  {
    ++span.begin;
  }
  while (span.end > span.begin && isBlank(text[span.end - 1]))
  {
    --span.end;
  }
  return span;
}

std::string_view trimmed(std::string_view text)
{
  return trimmed(text, { 0, text.size() }).of(text);
}

void splitAtCommas(std::string_view text, Span span, std::vector<Span>& parts)
{
  parts.clear();
  for (std::size_t begin = span.begin;;)
  {
    const std::size_t comma = std::min(text.substr(0, span.end).find(',', begin), span.end);
    parts.push_back(trimmed(text, { begin, comma }));
    if (comma >= span.end)
    {
      return;
    }
    begin = comma + 1;
  }
}

void splitAtBlanks(std::string_view text, Span span, std::vector<Span>& parts)
{
  parts.clear();
  for (std::size_t begin = span.begin; begin < span.end;)
  {
    while (begin < span.end && isBlank(text[begin]))
    {
      ++begin;
    }
    std::size_t end = begin;
    while (end < span.end && !isBlank(text[end]))
    {
      ++end;
    }
    if (end > begin)
    {
      parts.push_back({ begin, end });
    }
    begin = end;
  }
}
}
