// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace morph::io
{
/// The bytes of a file. Throws Error where it is no regular file, or cannot be read.
std::string readFile(const std::string& path);

/// The first bytes of a file, at most `most`; empty where it cannot be read.
std::string readHead(const std::string& path, std::size_t most);

/// The extension in lower case, with its dot; that before ".gz" where there is one.
std::string extensionOf(const std::string& path);
}
