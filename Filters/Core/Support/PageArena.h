// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace morph
{
/// Memory that grows in blocks and is freed at once, for a thread's part of a large intermediate
/// result. Large blocks lie on huge pages, see adviseHugePages().
class PageArena
{
public:
  PageArena() = default;
  ~PageArena();
  PageArena(const PageArena&) = delete;
  PageArena& operator=(const PageArena&) = delete;

  /// Copies `values`, and returns their new place.
  template <typename T>
  const T* copy(const std::vector<T>& values)
  {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= Unit);
    const std::size_t bytes = values.size() * sizeof(T);
    void* place = this->take(bytes);
    if (bytes > 0)
    {
      std::memcpy(place, values.data(), bytes);
    }
    return static_cast<const T*>(place);
  }

private:
  static constexpr std::size_t Unit = 16; ///< of sizes, and so of places

  void* take(std::size_t bytes);

  struct Block
  {
    void* data;
    std::size_t bytes;
  };
  std::vector<Block> blocks_;
  std::size_t left_ = 0; ///< bytes at the end of the last block
  char* next_ = nullptr;
};
}
