// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace morph::io
{
/// Unpacks the content of a .gz file, that of several members in a row too. `path`: for messages.
/// Throws Error where it is damaged, and where this was built without zlib.
std::string gunzip(const std::string& packed, const std::string& path);

/// The content of a .gz file. Throws Error where this was built without zlib.
std::string gzip(const std::string& content, const std::string& path);
}
