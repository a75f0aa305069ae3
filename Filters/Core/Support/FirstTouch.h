// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/HugePages.h"
#include "Support/Monitor.h"

#include <cstddef>
#include <vector>

namespace morph
{
/// Writes one byte of each page of new memory, in parallel, as the system clears a page at its
/// first write. The content is undefined afterwards. Small arrays stay as they are.
void touchPages(void* data, std::size_t bytes, Monitor& monitor);

/// As resizeLarge() and largeVector() in HugePages.h, where several threads clear the pages.
///@{
template <typename T>
void resizeLarge(std::vector<T>& vector, std::size_t size, Monitor& monitor)
{
  if (vector.capacity() < size)
  {
    vector.clear();
    vector.shrink_to_fit();
    vector.reserve(size);
    adviseHugePages(vector.data(), size * sizeof(T));
    touchPages(vector.data(), size * sizeof(T), monitor);
  }
  vector.resize(size);
}

template <typename T>
std::vector<T> largeVector(std::size_t size, T value, Monitor& monitor)
{
  std::vector<T> result;
  result.reserve(size);
  adviseHugePages(result.data(), size * sizeof(T));
  touchPages(result.data(), size * sizeof(T), monitor);
  result.resize(size, value);
  return result;
}
///@}
}
