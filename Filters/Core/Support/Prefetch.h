// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace morph
{
/// Asks the processor for the part of an array that a loop reads 512 entries after entry k, and for
/// `lines` cache lines of it. Processors do so by themselves, but not across pages of memory.
template <typename T>
inline __attribute__((always_inline)) void prefetchAhead(
  const T* array, std::int64_t k, int lines = 1)
{
  constexpr std::uintptr_t Ahead = 512, Line = 64;
  // No pointer arithmetic: the place may lie beyond the array, where a prefetch does no harm.
  const auto place =
    reinterpret_cast<std::uintptr_t>(array) + sizeof(T) * (static_cast<std::uintptr_t>(k) + Ahead);
  for (int line = 0; line < lines; ++line)
  {
    __builtin_prefetch(reinterpret_cast<const void*>(place + line * Line));
  }
}
}
