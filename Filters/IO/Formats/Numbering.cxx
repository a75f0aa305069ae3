// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/Numbering.h"

#include "Support/Error.h"

#include <algorithm>

namespace morph::io
{
Numbering::Numbering(const std::vector<Index>& numbers, const char* what, const std::string& file)
{
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0)
    {
      this->places_.emplace_back(numbers[i], static_cast<Index>(i));
    }
  }
  if (!std::is_sorted(this->places_.begin(), this->places_.end()))
  {
    std::sort(this->places_.begin(), this->places_.end());
  }
  std::vector<Index> twice;
  for (std::size_t i = 1; i < this->places_.size(); ++i)
  {
    if (this->places_[i - 1].first == this->places_[i].first)
    {
      twice.push_back(this->places_[i].first);
    }
  }
  if (!twice.empty())
  {
    throw Error("Cannot read " + file + ": it defines more than one " + what +
                " with the numbers " + listIds(twice) + ".");
  }
}

/// The first place with this number or a higher one. In most files the numbers have no gaps.
Numbering::Places::const_iterator Numbering::from(Index number) const
{
  const Index first = this->places_.empty() ? 0 : this->places_.front().first;
  const Index last = this->places_.empty() ? -1 : this->places_.back().first;
  if (number >= first && number <= last)
  {
    const auto guess = static_cast<std::size_t>(number - first);
    if (guess < this->places_.size() && this->places_[guess].first == number)
    {
      return this->places_.begin() + static_cast<std::ptrdiff_t>(guess);
    }
  }
  return std::lower_bound(
    this->places_.begin(), this->places_.end(), std::pair{ number, Index(-1) });
}

Index Numbering::find(Index number) const
{
  const auto place = this->from(number);
  return place != this->places_.end() && place->first == number ? place->second : -1;
}

void Numbering::add(Index first, Index last, std::vector<Index>& positions, Index step) const
{
  for (auto place = this->from(first); place != this->places_.end() && place->first <= last;
       ++place)
  {
    if (step == 1 || (place->first - first) % step == 0)
    {
      positions.push_back(place->second);
    }
  }
}
}
