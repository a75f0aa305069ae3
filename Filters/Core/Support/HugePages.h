// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace morph
{
/// Asks Linux for huge pages behind a new array that nobody has written yet. Small arrays and other
/// systems stay as they are. The first write to each 4 KiB page costs a fault of 0.2 microseconds
/// and more, up to 15 in a virtual machine. A huge page takes one fault for 2 MiB. The content of
/// the array does not change. See madvise(2), MADV_HUGEPAGE.
void adviseHugePages(void* data, std::size_t bytes) noexcept;

/// Returns `bytes`, above 0, of new memory on huge pages; freePages() gives all of it back to the
/// system. Throws std::bad_alloc.
///@{
void* allocatePages(std::size_t bytes);
void freePages(void* data, std::size_t bytes) noexcept;
/// Gives back the whole pages behind the first `kept` bytes. Returns how many bytes are left: all,
/// on other systems than Linux, unless `kept` is 0.
std::size_t freePagesBehind(void* data, std::size_t bytes, std::size_t kept) noexcept;
///@}

/// Resizes a vector whose values are not needed any more, with huge pages where it grows.
template <typename T>
void resizeLarge(std::vector<T>& vector, std::size_t size)
{
  if (vector.capacity() < size)
  {
    vector.clear();
    vector.shrink_to_fit();
    vector.reserve(size);
    adviseHugePages(vector.data(), size * sizeof(T));
  }
  vector.resize(size);
}

/// Returns a vector of `size` elements on huge pages; without `value`, Eigen's are undefined.
///@{
template <typename T>
std::vector<T> largeVector(std::size_t size)
{
  std::vector<T> result;
  resizeLarge(result, size);
  return result;
}
template <typename T>
std::vector<T> largeVector(std::size_t size, T value)
{
  std::vector<T> result;
  result.reserve(size);
  adviseHugePages(result.data(), size * sizeof(T));
  result.resize(size, value);
  return result;
}
///@}

/// Resizes one of Eigen's arrays, whose values are then undefined, with huge pages. An array of
/// this size stays as it is.
template <typename Array, typename... Sizes>
void resizeUndefined(Array& array, Sizes... sizes)
{
  const auto* before = array.data();
  array.resize(sizes...);
  if (array.data() != before)
  {
    adviseHugePages(array.data(), static_cast<std::size_t>(array.size()) * sizeof(*array.data()));
  }
}
}
