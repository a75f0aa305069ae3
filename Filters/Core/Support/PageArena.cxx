// SPDX-License-Identifier: BSD-3-Clause
#include "Support/PageArena.h"

#include "Support/HugePages.h"

#include <algorithm>
#include <new>

namespace morph
{
namespace
{
constexpr std::size_t FirstBlock = std::size_t(1) << 16, LargestBlock = std::size_t(1) << 24;

/// Whether a block is worth pages of its own. In smaller ones lies no whole huge page, and malloc
/// has pages at hand that cost no fault.
bool isLarge(std::size_t bytes)
{
  return bytes >= std::size_t(1) << 22;
}
}

PageArena::~PageArena()
{
  for (const Block& block : this->blocks_)
  {
    if (block.data == nullptr) // its allocation failed
    {
      continue;
    }
    if (isLarge(block.bytes))
    {
      freePages(block.data, block.bytes);
    }
    else
    {
      ::operator delete(block.data);
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
    this->blocks_.back().data = isLarge(size) ? allocatePages(size) : ::operator new(size);
    this->next_ = static_cast<char*>(this->blocks_.back().data);
    this->left_ = size;
  }
  void* place = this->next_;
  this->next_ += bytes;
  this->left_ -= bytes;
  return place;
}
}
