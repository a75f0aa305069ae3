// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace morph_mesh
{
/// Ends the program with exit status 1 and one message where a reader of VTK, or one through a
/// library of others, misbehaves. These readers trust their files: on a damaged file some crash,
/// take all memory or never end. The message names the file. It comes, during the object's
/// lifetime,
/// - after a signal of the processor, or abort();
/// - after 3 s of computing and 2 s more for each megabyte of the file.
/// Memory is limited to the current use, 1 GiB and 1100 times the size of the file, the maximum
/// expansion of zlib; beyond that the readers get std::bad_alloc.
/// Output of C libraries to standard error is dropped.
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
