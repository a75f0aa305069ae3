// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Series.h"

#include <algorithm>

namespace morph
{
void Series::clear()
{
  this->kept_.clear();
  this->stride_ = 1;
  this->last_ = 0;
}

void Series::check(std::uint64_t options, bool varies, std::uint64_t boundary)
{
  const State state{ options, varies, varies ? boundary : 0 };
  if (state != this->state_)
  {
    this->clear();
  }
  this->state_ = state;
}

void Series::keep(int number, Step step, double megabytes)
{
  const double size = std::max(1., 24. * static_cast<double>(step->moved.rows()));
  // A pass over all that is kept would make a run of many steps quadratic in their number.
  if (this->last_ % this->stride_ != 0)
  {
    this->kept_.erase(this->last_);
  }
  this->kept_[number] = std::move(step);
  this->last_ = number;
  // The last one is there besides, so that going back does not thin out what helps to go back.
  const auto full = [&]
  {
    const auto counted = this->kept_.size() - (number % this->stride_ != 0);
    return static_cast<double>(counted) * size > 1e6 * megabytes;
  };
  while (full() && this->stride_ <= this->kept_.rbegin()->first)
  {
    this->stride_ *= 2;
    this->thin();
  }
  if (full())
  {
    const Step last = this->kept_[number];
    this->kept_ = { { number, last } };
  }
}

void Series::thin()
{
  for (auto it = this->kept_.begin(); it != this->kept_.end();)
  {
    const bool stays = it->first == this->last_ || it->first % this->stride_ == 0;
    it = stays ? std::next(it) : this->kept_.erase(it);
  }
}

std::pair<int, Series::Step> Series::lastUntil(int number) const
{
  auto after = this->kept_.upper_bound(number);
  if (after == this->kept_.begin())
  {
    return { -1, nullptr };
  }
  return *std::prev(after);
}
}
