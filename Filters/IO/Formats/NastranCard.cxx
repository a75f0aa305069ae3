// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/NastranCard.h"

#include <algorithm>
#include <cctype>

namespace morph::io
{
namespace
{
constexpr std::size_t NameWidth = 8, LineWidth = 80;

/// The name of an entry, in upper case, with the star of the large format.
std::string nameOf(std::string_view line)
{
  const std::size_t end = line.find_first_of(",\t");
  std::string name(trimmed(line.substr(0, std::min(end, NameWidth))));
  std::transform(name.begin(), name.end(), name.begin(),
    [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}
}

NumberRules NastranCard::rules(std::size_t field) const
{
  NumberRules rules;
  rules.shortExponent = true;
  rules.separator = this->fields[field].width > 0 ? ' ' : ',';
  rules.width = this->fields[field].width;
  rules.field = rules.width > 0 ? NumberRules::Field::Fixed : NumberRules::Field::Free;
  rules.longest = this->isLarge ? 16 : 8;
  return rules;
}

bool NastranCards::nextLine()
{
  while (!this->isHeld_)
  {
    if (!this->lines_.next())
    {
      return false;
    }
    this->line_ = this->lines_.span();
    const std::size_t comment = this->line_.of(this->text_).find('$');
    if (comment != std::string_view::npos)
    {
      this->line_.end = this->line_.begin + comment;
    }
    this->isHeld_ = !trimmed(this->line_.of(this->text_)).empty();
  }
  return true;
}

bool NastranCards::continues() const
{
  const std::string_view line = this->line_.of(this->text_);
  return line[0] == '+' || line[0] == '*' || line[0] == ',' || nameOf(line).empty();
}

bool NastranCards::next(NastranCard& card)
{
  if (!this->nextLine())
  {
    return false;
  }
  card.fields.clear();
  card.at = this->line_.begin;
  card.name = nameOf(this->line_.of(this->text_));
  do
  {
    const std::string_view line = this->line_.of(this->text_);
    // What comes after the ten fields of a line is a comment.
    card.isFree = line.substr(0, LineWidth).find(',') != std::string_view::npos;
    const std::string start = nameOf(line);
    card.isLarge = !start.empty() && (start.back() == '*' || start.front() == '*');
    this->addFields(card, this->line_);
    this->isHeld_ = false;
  } while (this->nextLine() && this->continues());
  if (!card.name.empty() && card.name.back() == '*')
  {
    card.name.pop_back();
  }
  return true;
}

void NastranCards::addFields(NastranCard& card, Span line)
{
  if (!card.isFree)
  {
    this->addFixed(card, line);
    return;
  }
  const std::size_t most = card.isLarge ? 4 : 8;
  std::vector<NumberField>& all = this->free_;
  freeFields(this->text_, line, 1 + most, all);
  // A name, the fields, the name of the next line. Where there are more, the line continues itself.
  const std::size_t lines = all.size() > most + 2 ? (all.size() - 2) / most + 1 : 1;
  if (lines > 1)
  {
    freeFields(this->text_, line, 1 + most * lines, all);
  }
  const auto first = all.begin() + 1;
  card.fields.insert(card.fields.end(), first, first + static_cast<std::ptrdiff_t>(most * lines));
}

void NastranCards::addFixed(NastranCard& card, Span line) const
{
  const std::size_t width = card.isLarge ? 16 : 8, most = card.isLarge ? 4 : 8;
  for (std::size_t i = 0; i < most; ++i)
  {
    card.fields.push_back(tabbedField(this->text_, line, NameWidth + i * width, width));
  }
}
}
