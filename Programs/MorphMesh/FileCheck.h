// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace morph_mesh
{
/// Throws Failure for a file that VTK's reader of its extension should not see. Such a reader
/// trusts its file: it may crash on another, take all memory or never end. The message tells which
/// it is:
/// - there is no such file;
/// - it does not begin as files with this extension do;
/// - it is damaged: it has no end, or is too short for the counts of its header.
/// Damage within the data is left to the reader. Cost: 64 KiB are read. Files with extensions
/// that are unknown here pass.
void requireWholeFile(const std::string& path);
}
