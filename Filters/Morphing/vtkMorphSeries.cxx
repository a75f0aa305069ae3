// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphSeries.h"

#include <algorithm>

void vtkMorphSeries::Clear()
{
  this->Kept.clear();
  this->Stride = 1;
}

void vtkMorphSeries::Keep(int number, Step step, double megabytes)
{
  const double size = std::max(1., 24. * static_cast<double>(step->Moved.rows()));
  this->Kept[number] = std::move(step);
  this->Thin(number);
  // The last one is there besides, so that going back does not thin out what helps to go back.
  const auto full = [&]
  {
    const auto counted = this->Kept.size() - (number % this->Stride != 0);
    return static_cast<double>(counted) * size > 1e6 * megabytes;
  };
  while (full() && this->Stride <= this->Kept.rbegin()->first)
  {
    this->Stride *= 2;
    this->Thin(number);
  }
  if (full())
  {
    const Step last = this->Kept[number];
    this->Kept = { { number, last } };
  }
}

void vtkMorphSeries::Thin(int last)
{
  for (auto it = this->Kept.begin(); it != this->Kept.end();)
  {
    const bool stays = it->first == last || it->first % this->Stride == 0;
    it = stays ? std::next(it) : this->Kept.erase(it);
  }
}

std::pair<int, vtkMorphSeries::Step> vtkMorphSeries::LastUntil(int number) const
{
  auto after = this->Kept.upper_bound(number);
  if (after == this->Kept.begin())
  {
    return { -1, nullptr };
  }
  return *std::prev(after);
}
