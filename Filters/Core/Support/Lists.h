// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace morph
{
/// Makes a list ascending, each of its values once.
template <typename List>
void sortUnique(List& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Numbers: first, first + 1, ...
template <typename Number = Index>
std::vector<Number> consecutive(std::size_t count, Number first = 0)
{
  std::vector<Number> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}
}
