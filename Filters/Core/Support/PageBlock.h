// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/HugePages.h"

#include <cstddef>
#include <utility>

namespace morph
{
/// Memory of its own pages, of which the end can be given back to the system.
class PageBlock
{
public:
  PageBlock() = default;
  /// Throws std::bad_alloc.
  explicit PageBlock(std::size_t bytes)
    : data_(bytes > 0 ? allocatePages(bytes) : nullptr)
    , bytes_(bytes)
  {
  }
  ~PageBlock() { this->shrink(0); }
  PageBlock(PageBlock&& other) noexcept
    : data_(std::exchange(other.data_, nullptr))
    , bytes_(std::exchange(other.bytes_, 0))
  {
  }
  PageBlock& operator=(PageBlock&& other) noexcept
  {
    std::swap(this->data_, other.data_);
    std::swap(this->bytes_, other.bytes_);
    return *this;
  }

  char* data() const { return static_cast<char*>(this->data_); }
  std::size_t bytes() const { return this->bytes_; }

  /// Gives back all pages behind the first `bytes`, which keep their content.
  void shrink(std::size_t bytes) noexcept
  {
    if (bytes < this->bytes_)
    {
      this->bytes_ = freePagesBehind(this->data_, this->bytes_, bytes);
      this->data_ = this->bytes_ > 0 ? this->data_ : nullptr;
    }
  }

private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0; ///< of the pages that are left
};
}
