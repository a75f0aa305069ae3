// SPDX-License-Identifier: BSD-3-Clause
#include "Support/HugePages.h"

#ifdef __linux__
#include <cstdint>

#include <sys/mman.h>
#include <unistd.h>
#endif

#include <new>

namespace morph
{
void adviseHugePages(void* data, std::size_t bytes) noexcept
{
#ifdef __linux__
  constexpr std::uintptr_t Page = std::uintptr_t(1) << 21;
  // The whole pages in the array: their neighbors may hold other data.
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + Page - 1) / Page * Page;
  const auto end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / Page * Page;
  if (begin < end)
  {
    // A kernel without huge pages refuses; small pages serve as well.
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }
#else
  static_cast<void>(data);
  static_cast<void>(bytes);
#endif
}

// malloc keeps what is freed between other blocks, so that the peak would be twice as high.
void* allocatePages(std::size_t bytes)
{
#ifdef __linux__
  void* data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  adviseHugePages(data, bytes);
  return data;
#else
  return ::operator new(bytes);
#endif
}

void freePages(void* data, std::size_t bytes) noexcept
{
#ifdef __linux__
  munmap(data, bytes);
#else
  ::operator delete(data);
  static_cast<void>(bytes);
#endif
}

std::size_t freePagesBehind(void* data, std::size_t bytes, std::size_t kept) noexcept
{
  if (kept == 0)
  {
    freePages(data, bytes);
    return 0;
  }
#ifdef __linux__
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t left = (kept + page - 1) / page * page;
  if (left < bytes)
  {
    munmap(static_cast<char*>(data) + left, bytes - left);
    return left;
  }
#endif
  return bytes;
}
}
