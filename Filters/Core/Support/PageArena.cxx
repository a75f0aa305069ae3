// SPDX-License-Identifier: BSD-3-Clause
#include "Support/PageArena.h"

#include "Support/HugePages.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr std::size_t FirstBlock = std::size_t(1) << 16, LargestBlock = std::size_t(1) << 24;
}

PageArena::~PageArena()
{
  for (const Block& block : this->blocks_)
  {
    if (block.data != nullptr) // its allocation may have failed
    {
      freePages(block.data, block.bytes);
    }
  }
}

void* PageArena::take(std::size_t bytes)
{
  bytes = (bytes + Unit - 1) / Unit * Unit;
  if (bytes > this->left_)
  {
    const std::size_t doublings = std::min<std::size_t>(this->blocks_.size(), 8);
    const std::size_t size = std::max(bytes, std::min(LargestBlock, FirstBlock << doublings));
    this->blocks_.push_back({ nullptr, size });
    this->blocks_.back().data = allocatePages(size);
    this->next_ = static_cast<char*>(this->blocks_.back().data);
    this->left_ = size;
  }
  void* place = this->next_;
  this->next_ += bytes;
  this->left_ -= bytes;
  return place;
}
}
