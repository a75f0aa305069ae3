// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace morph_mesh
{
/// Throws Failure where replaceFile() would for the file at `path`, or for its folder.
void requireReplaceable(const std::string& path);

/// Writes a file as a whole, or leaves the old file as it was. A temporary file beside it,
/// ".<name>.morph-mesh-XXXXXX", is written, flushed to disk and renamed. It is removed after an
/// error and when the user interrupts; only SIGKILL and a power failure can leave it.
/// A symbolic link stays and its target is replaced; the mode of an existing file is kept, and its
/// owner where the system allows that. Other hard links keep the old content.
/// Throws Failure.
void replaceFile(const std::string& path, std::string_view content);
}
