// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace morph_mesh
{
/// VTK's readers trust their files: on a damaged one some crash, take all memory or never end.
/// While this object lives, such a reader ends the program with exit status 1 and one message that
/// names the file:
/// - after a signal of the processor, or abort();
/// - after 3 s of computing and 2 s more for each megabyte of the file.
/// Memory is limited to what was taken before, 1 GiB and 1100 times the size of the file, the most
/// that zlib can expand to; beyond that the readers get std::bad_alloc.
/// What C libraries print to standard error is dropped.
/// One object at a time; no thread may have been started with these signals blocked.
class ReadingGuard
{
public:
  /// `bytes`: the size of the file with all others that it names.
  ReadingGuard(const std::string& path, std::uintmax_t bytes);
  ~ReadingGuard();
  ReadingGuard(const ReadingGuard&) = delete;
  ReadingGuard& operator=(const ReadingGuard&) = delete;
};
}
