// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Text/Lines.h"
#include "Text/NumberPlaces.h"

#include <string>
#include <string_view>
#include <vector>

namespace morph::io
{
/// An entry of the bulk data: its name and the fields of all its lines, from the second one on.
struct NastranCard
{
  std::string name; ///< upper case, without the star of the large format; empty: none
  std::size_t at = 0;
  bool isLarge = false, isFree = false;
  std::vector<NumberField> fields;

  /// Whether a number of the line is written between commas, and its longest length.
  NumberRules rules(std::size_t field) const;
};

/// Reads the entries of a text of bulk data: small (8 characters a field), large (16) and free
/// fields (commas). Comments ($) are skipped. See "Bulk Data Entry Formats" in the MSC Nastran
/// Quick Reference Guide.
class NastranCards
{
public:
  explicit NastranCards(std::string_view text, std::size_t at = 0)
    : text_(text)
    , lines_(text, at)
  {
  }
  /// Reads the next entry, with its continuation lines. False at the end.
  bool next(NastranCard& card);

private:
  bool nextLine();
  void addFields(NastranCard& card, Span line);
  void addFixed(NastranCard& card, Span line) const;
  bool continues() const;

  std::string_view text_;
  Lines lines_;
  Span line_;
  std::vector<NumberField> free_; ///< of a line between commas
  bool isHeld_ = false;           ///< line_ was read already
};
}
