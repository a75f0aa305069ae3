// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/Series.h"

#include <algorithm>

namespace morph::filters
{
void Series::Clear()
{
  this->Kept.clear();
  this->Stride = 1;
  this->Last = 0;
}

void Series::Check(vtkMTimeType options, bool varies, vtkMTimeType boundary)
{
  if (options != this->OptionsTime || varies != this->Varied ||
      (varies && boundary != this->BoundaryTime))
  {
    this->Clear();
  }
  this->Varied = varies;
  this->OptionsTime = options;
  this->BoundaryTime = boundary;
}

void Series::Keep(int number, Step step, double megabytes)
{
  const double size = std::max(1., 24. * static_cast<double>(step->Moved.rows()));
  // A pass over all that is kept would make a run of many steps quadratic in their number.
  if (this->Last % this->Stride != 0)
  {
    this->Kept.erase(this->Last);
  }
  this->Kept[number] = std::move(step);
  this->Last = number;
  // The last one is there besides, so that going back does not thin out what helps to go back.
  const auto full = [&]
  {
    const auto counted = this->Kept.size() - (number % this->Stride != 0);
    return static_cast<double>(counted) * size > 1e6 * megabytes;
  };
  while (full() && this->Stride <= this->Kept.rbegin()->first)
  {
    this->Stride *= 2;
    this->Thin();
  }
  if (full())
  {
    const Step last = this->Kept[number];
    this->Kept = { { number, last } };
  }
}

void Series::Thin()
{
  for (auto it = this->Kept.begin(); it != this->Kept.end();)
  {
    const bool stays = it->first == this->Last || it->first % this->Stride == 0;
    it = stays ? std::next(it) : this->Kept.erase(it);
  }
}

std::pair<int, Series::Step> Series::LastUntil(int number) const
{
  auto after = this->Kept.upper_bound(number);
  if (after == this->Kept.begin())
  {
    return { -1, nullptr };
  }
  return *std::prev(after);
}
}
