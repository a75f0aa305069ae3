// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"
#include "Text/Lines.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace morph::io
{
/// Reads the numbers of a MSH file, one after another, text or binary.
class GmshCursor
{
public:
  /// `at`, `end`: the part of `content` that is read. `path`: for messages.
  GmshCursor(const std::string& content, const std::string& path, std::size_t at, std::size_t end,
    bool isBinary);

  std::size_t at() const { return this->at_; }
  bool isBinary() const { return this->isBinary_; }
  Index integer(); ///< binary: of 4 bytes
  Index size();    ///< binary: of 8 bytes
  double number(); ///< binary: of 8 bytes; `place()` is then its first byte
  Span place() const { return this->place_; } ///< of the last number of a text
  /// A count of things with at least so many bytes each, so that a damaged one is found.
  Index count(bool isSize, std::size_t leastBytes);
  std::string quoted(); ///< "a name", in text and binary files
  void toNextLine();
  [[noreturn]] void fail(const std::string& reason) const;

private:
  Index whole(std::size_t bytes);
  std::string_view word();

  const std::string& content_;
  const std::string& path_;
  std::size_t at_, end_;
  bool isBinary_;
  Span place_;
};

/// The sections "$Name ... $EndName" of a MSH file.
struct GmshSections
{
  struct Section
  {
    std::string name;
    std::size_t begin = 0, end = 0; ///< what is between its two lines
  };
  /// Throws Error where it is no file of the versions 2 or 4.1.
  GmshSections(const std::string& content, const std::string& path);

  /// The section of that name; null where there is none. Throws Error where there are two.
  const Section* find(const std::string& name) const;
  GmshCursor cursor(const Section& section) const;
  /// That behind the `count` at the section's begin, which version 2 has as text always.
  GmshCursor listCursor(const Section& section, std::size_t leastBytes, Index& count) const;

  bool isVersion4 = false, isBinary = false;

private:
  void readFormat();

  const std::string& content_;
  const std::string& path_;
  std::vector<Section> sections_;
};
}
